#include "core/parameter_text.h"
#include "core/parameters.h"

namespace atomesh {

namespace {

std::string values_text(const ParameterRow& row) {
  const std::string range = real_text(row.min) + " … " + real_text(row.max) + (row.unit.empty() ? "" : " " + row.unit);
  switch (row.type) {
    case ParameterType::boolean:
      return "true, false";
    case ParameterType::integer:
    case ParameterType::real:
      return range;
    case ParameterType::choice: {
      std::string text;
      for (const std::string& choice : row.choices) text += (text.empty() ? "" : ", ") + choice;
      return text;
    }
    case ParameterType::text:
      return "name";
    case ParameterType::rgb:
      return "color";
    case ParameterType::rgba:
      return "color with opacity";
    case ParameterType::vector:
      return "x,y,z" + (row.unit.empty() ? "" : " in " + row.unit);
    case ParameterType::color_map:
      break;
  }
  return "color map";
}

// The default of a numbered row ("light.1.enabled"): one value, or those that differ ("1: true; 3 to 8: false").
std::string numbered_default(const Parameters& defaults, const std::string& before, const std::string& after,
                             int count) {
  std::string text;
  for (int first = 1; first <= count;) {
    const std::string value = get_parameter(defaults, before + std::to_string(first) + after);
    int last = first;
    while (last < count && get_parameter(defaults, before + std::to_string(last + 1) + after) == value) ++last;
    if (first == 1 && last == count) return "`" + value + "`";
    if (!text.empty()) text += "; ";
    text += std::to_string(first) + (last > first ? " to " + std::to_string(last) : "") + ": `" + value + "`";
    first = last + 1;
  }
  return text;
}

// In a table's cell a bar would end the cell and an angle bracket would start a tag; keys stand in code quotes.
std::string cell(std::string text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

}  // namespace

std::string parameter_documentation() {
  const Parameters defaults;
  std::string text;
  std::string group;
  for (const ParameterRow& row : parameter_table()) {
    std::string key = row.key;
    std::string label = row.label;
    std::string value;
    if (row.key.starts_with("light.") || row.key.starts_with("cut_plane.")) {
      const std::size_t dot = row.key.find('.');
      if (row.key[dot + 1] != '1') continue;  // one row stands for all of them
      const std::string before = row.key.substr(0, dot + 1);
      const std::string after = row.key.substr(dot + 2);
      key = before + "N" + after;
      label.replace(label.find('1'), 1, "N");
      value = numbered_default(defaults, before, after, row.key.starts_with("light.") ? max_lights : max_cut_planes);
    } else {
      value = "`" + get_parameter(defaults, row.key) + "`";
    }
    if (row.group != group) {
      group = row.group;
      text += (text.empty() ? "### " : "\n### ") + group + "\n\n| key | name | values | default | meaning |\n";
      text += "| --- | --- | --- | --- | --- |\n";
    }
    text += "| `" + key + "` | " + cell(label) + " | " + cell(values_text(row)) + " | " + value + " | " +
            cell(row.help) + " |\n";
  }
  return text;
}

}  // namespace atomesh
