#include "app/gui/pipeline_settings.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <utility>

#include "app/cli/pipeline_options.h"
#include "core/error.h"

namespace atomesh::gui {

namespace {

constexpr const char* simplify = "simplify-by";  // stands for --simplify too

std::string label_of(std::string name) {
  std::replace(name.begin(), name.end(), '-', ' ');
  name.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(name.front())));
  return name;
}

std::vector<std::string> choices_of(const std::string& name) {
  if (name == "format") return read_format_names();
  if (name == "mesher") return mesher_names();
  if (name == "carve") return {"auto", "off"};
  if (name == "unit-cell") return {"auto", "found", "none"};
  if (name == "noise") return {"auto"};
  if (name == simplify) {
    std::vector<std::string> choices = simplify_strategies();
    choices.insert(choices.begin(), "off");
    return choices;
  }
  return {};
}

// The help of some options ends with the default in brackets: "… [auto]".
std::string take_default(std::string& help) {
  const std::size_t open = help.rfind(" [");
  if (open == std::string::npos || !help.ends_with(']')) return "";
  const std::string text = help.substr(open + 2, help.size() - open - 3);
  help.erase(open);
  return text;
}

std::vector<PipelineSetting> make_settings() {
  CLI::App app;
  PipelineOptions options;
  cli::add_pipeline_options(app, options);
  std::vector<PipelineSetting> settings;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_lnames().empty() || option->get_lnames().front() == "help") continue;
    PipelineSetting setting;
    setting.name = option->get_lnames().front();
    if (setting.name == "simplify") continue;
    setting.label = setting.name == simplify ? "Simplify" : label_of(setting.name);
    const std::string& group = option->get_group();
    setting.group = group.substr(0, group.find(" ("));
    setting.type = option->get_type_name();
    setting.help = option->get_description();
    const std::string in_help = take_default(setting.help);
    setting.initial = option->get_default_str().empty() ? in_help : option->get_default_str();
    setting.choices = choices_of(setting.name);
    setting.open = setting.choices.empty() || setting.type.find('|') != std::string::npos;
    setting.file = setting.type.find("FILE") != std::string::npos;
    if (setting.name == simplify) setting.initial = "off";
    if (setting.name == "format") {
      setting.choices.insert(setting.choices.begin(), "auto");
      setting.initial = "auto";
    }
    settings.push_back(std::move(setting));
  }
  return settings;
}

}  // namespace

const std::vector<PipelineSetting>& pipeline_settings() {
  static const std::vector<PipelineSetting> settings = make_settings();
  return settings;
}

PipelineOptions pipeline_options(const PipelineValues& values) {
  CLI::App app;
  PipelineOptions options;
  cli::add_pipeline_options(app, options);
  std::vector<std::string> words;
  for (const auto& [name, value] : values) {
    const auto known = [&name = name](const PipelineSetting& setting) { return setting.name == name; };
    const auto& all = pipeline_settings();
    const auto setting = std::find_if(all.begin(), all.end(), known);
    if (setting == all.end()) throw UsageError("there is no setting of preprocessing called " + name);
    if (value != setting->initial && !value.empty()) words.push_back("--" + name + "=" + value);
  }
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    throw UsageError(error.what());
  }
  return options;
}

PipelineValues recorded_values(const std::vector<std::pair<std::string, std::string>>& options) {
  PipelineValues values;
  for (const auto& [recorded, value] : options) {
    std::string name = recorded == "simplify" ? simplify : recorded;
    std::replace(name.begin(), name.end(), '_', '-');
    for (const PipelineSetting& setting : pipeline_settings()) {
      if (setting.name == name && value != setting.initial && !value.empty()) values[name] = value;
    }
  }
  return values;
}

}  // namespace atomesh::gui
