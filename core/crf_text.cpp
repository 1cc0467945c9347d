#include "core/crf_text.h"

#include <algorithm>
#include <set>

#include "core/parameter_text.h"

namespace atomesh {

namespace {

// A basic TOML string. What set_parameter gives out has no control characters; species names may have quotes.
std::string toml_string(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

std::string comment(const ParameterRow& row) {
  std::string text = "# " + row.label + ". " + row.help;
  if (row.type == ParameterType::real || row.type == ParameterType::integer) {
    text += " (" + real_text(row.min) + " to " + real_text(row.max) + (row.unit.empty() ? "" : " " + row.unit) + ")";
  } else if (row.type == ParameterType::choice) {
    std::string words;
    for (const std::string& choice : row.choices) words += (words.empty() ? "" : ", ") + choice;
    text += " (" + words + ")";
  } else if (!row.unit.empty()) {
    text += " (" + row.unit + ")";
  }
  return text + "\n";
}

}  // namespace

std::string toml_key(std::string_view part) {
  const bool bare = !part.empty() && std::all_of(part.begin(), part.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '-';
  });
  return bare ? std::string(part) : toml_string(part);
}

std::string toml_value(const Parameters& parameters, const std::string& key) {
  const std::string text = get_parameter(parameters, key);
  switch (parameter_row(key).type) {
    case ParameterType::boolean:
    case ParameterType::integer:
      return text;
    case ParameterType::real:
      return text == "auto" ? toml_string(text) : text;
    case ParameterType::choice:
    case ParameterType::text:
      return toml_string(text);
    case ParameterType::rgb:
    case ParameterType::rgba:
    case ParameterType::vector: {
      std::string list = "[";
      for (const char c : text) list += c == ',' ? std::string(", ") : std::string(1, c);
      return list + "]";
    }
    case ParameterType::color_map:
      break;
  }
  if (text.find(':') == std::string::npos) return toml_string(text);
  std::string rows = "[\n";
  for (const ColorMapEntry& entry : parameters.volume.color_map.entries) {
    rows += "  [" + real_text(entry.scalar);
    for (int c = 0; c < 4; ++c) rows += ", " + real_text(entry.color[c]);
    rows += "],\n";
  }
  return rows + "]";
}

std::pair<std::string, std::string> split_key(const std::string& key) {
  const std::string& row_key = parameter_row(key).key;
  const std::size_t dot = row_key.rfind('.');
  return dot == std::string::npos ? std::pair<std::string, std::string>{"", key}
                                  : std::pair{key.substr(0, dot), key.substr(dot + 1)};
}

bool said_by_absence(const Parameters& parameters, const std::string& key) {
  return parameter_row(key).key.ends_with("<species>") && get_parameter(parameters, key) == "auto";
}

std::vector<std::string> keys_to_write(const Parameters& parameters) {
  std::set<std::string> species;
  for (const auto& [name, color] : parameters.atoms.colors) species.insert(name);
  for (const auto& [name, visible] : parameters.atoms.visible) species.insert(name);
  for (const auto& [name, radius] : parameters.atoms.radii) species.insert(name);
  std::vector<std::string> keys;
  for (std::string& key : parameter_keys({species.begin(), species.end()})) {
    if (!said_by_absence(parameters, key)) keys.push_back(std::move(key));
  }
  return keys;
}

std::string fresh_crf_text(const Parameters& parameters) {
  std::string text =
      "# Display and rendering parameters of atomesh (.crf, TOML). What is left out keeps its default.\n";
  std::string table;
  std::string group;
  std::set<std::string> explained;
  for (const std::string& key : keys_to_write(parameters)) {
    const ParameterRow& row = parameter_row(key);
    const auto [prefix, name] = split_key(key);
    if (row.group != group) {
      group = row.group;
      text += "\n# ---- " + group + "\n";
    }
    if (prefix != table) {
      table = prefix;
      text += "\n[" + table + "]\n";
    }
    // The lights and the cut planes are all alike: the first of them explains the rest.
    std::string kind = row.key;
    if (const std::size_t dot = kind.find('.'); prefix.find('.') != std::string::npos && kind[dot + 1] <= '9') {
      kind.replace(dot + 1, 1, "N");
    }
    if (explained.insert(kind).second) text += comment(row);
    text += toml_key(name) + " = " + toml_value(parameters, key) + "\n";
  }
  return text;
}

}  // namespace atomesh
