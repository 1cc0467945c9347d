#include "core/parameter_file.h"

// toml++ 3.3 asserts what some broken files violate ("a = ,"): abort() in a debug build, anything at all in a release.
// Here that is an exception in every build; parse() makes it an InputError.
namespace atomesh::toml_assertion {
struct Failed {};
[[noreturn]] inline void fail() {
  throw Failed();
}
}  // namespace atomesh::toml_assertion
#undef NDEBUG
#define TOML_ASSERT(condition) (static_cast<bool>(condition) ? static_cast<void>(0) : atomesh::toml_assertion::fail())
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "core/crf_text.h"
#include "core/error.h"
#include "core/parameter_text.h"
#include "core/text_file.h"

namespace atomesh {

namespace {

// A value of the file: its key ("light.1.color") and where it stands.
struct Leaf {
  std::string key;
  const toml::node* node;
};

void collect(const toml::table& table, const std::string& prefix, std::vector<Leaf>& leaves) {
  for (const auto& [name, node] : table) {
    const std::string key = prefix + std::string(name.str());
    if (const toml::table* inner = node.as_table()) {
      collect(*inner, key + ".", leaves);
    } else {
      leaves.push_back({key, &node});
    }
  }
}

// In the order of the file, so that the first mistake is the one reported.
std::vector<Leaf> leaves_of(const toml::table& table) {
  std::vector<Leaf> leaves;
  collect(table, "", leaves);
  const auto place = [](const Leaf& leaf) { return leaf.node->source().begin; };
  std::stable_sort(leaves.begin(), leaves.end(), [&](const Leaf& a, const Leaf& b) { return place(a) < place(b); });
  return leaves;
}

// What set_parameter reads: numbers in full, arrays with commas. Nothing for a type the row does not have in TOML.
std::optional<std::string> number_text(const toml::node& node) {
  if (const auto* integer = node.as_integer()) return std::to_string(integer->get());
  if (const auto* real = node.as_floating_point()) return real_text(real->get());
  return {};
}

std::optional<std::string> numbers_text(const toml::node& node) {
  const toml::array* array = node.as_array();
  if (array == nullptr) return {};
  std::string text;
  for (const toml::node& item : *array) {
    const auto number = number_text(item);
    if (!number) return {};
    if (!text.empty()) text += ',';
    text += *number;
  }
  return text;
}

// Rows [scalar, r, g, b, a], or one string.
std::optional<std::string> color_map_node_text(const toml::node& node) {
  if (const auto* string = node.as_string()) return string->get();
  const toml::array* array = node.as_array();
  if (array == nullptr || array->empty()) return {};
  std::string text;
  for (const toml::node& item : *array) {
    const auto numbers = numbers_text(item);
    const std::size_t comma = numbers ? numbers->find(',') : std::string::npos;
    if (comma == std::string::npos) return {};
    if (!text.empty()) text += ' ';
    text += numbers->substr(0, comma) + ":" + numbers->substr(comma + 1);
  }
  return text;
}

std::optional<std::string> text_of(const toml::node& node, const ParameterRow& row) {
  const auto string = [&]() -> std::optional<std::string> {
    return node.is_string() ? std::optional(node.as_string()->get()) : std::nullopt;
  };
  switch (row.type) {
    case ParameterType::boolean:
      if (const auto* boolean = node.as_boolean()) return boolean->get() ? "true" : "false";
      return {};
    case ParameterType::integer:
      return node.is_integer() ? number_text(node) : std::nullopt;
    case ParameterType::real:
      return node.is_string() && *string() == "auto" ? string() : number_text(node);
    case ParameterType::choice:
    case ParameterType::text:
      return string();
    case ParameterType::rgb:
    case ParameterType::rgba:
      return node.is_string() ? string() : numbers_text(node);
    case ParameterType::vector:
      return numbers_text(node);
    case ParameterType::color_map:
      break;
  }
  return color_map_node_text(node);
}

const char* toml_form(const ParameterRow& row) {
  switch (row.type) {
    case ParameterType::boolean:
      return "true or false, without quotes";
    case ParameterType::integer:
      return "a whole number";
    case ParameterType::real:
      return "a number";
    case ParameterType::choice:
      return "one of its words in quotes";
    case ParameterType::text:
      return "a name in quotes";
    case ParameterType::rgb:
      return "a color, [r, g, b] or \"#rrggbb\"";
    case ParameterType::rgba:
      return "a color, [r, g, b, a] or \"#rrggbbaa\"";
    case ParameterType::vector:
      return "[x, y, z]";
    case ParameterType::color_map:
      break;
  }
  return "a preset's name in quotes, or rows [scalar, r, g, b, a]";
}

// True when parsing the first `bytes` of a text runs into one of toml++'s assertions.
bool fails_assertion(std::string_view text, std::size_t bytes) {
  try {
    static_cast<void>(toml::parse(text.substr(0, bytes)));
  } catch (const toml::parse_error&) {
    return false;  // because of the cut, or later
  } catch (const toml_assertion::Failed&) {
    return true;
  }
  return false;
}

toml::table parse(const std::string& path, std::string_view text) {
  try {
    return toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    throw InputError(path, error.source().begin.line, std::string(error.description()));
  } catch (const toml_assertion::Failed&) {
    // It does not say where. The parser goes from front to back, so halving finds the first line that makes it fail.
    std::vector<std::size_t> line_ends;
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\n') line_ends.push_back(i + 1);
    }
    line_ends.push_back(text.size());
    const auto line = std::partition_point(line_ends.begin(), line_ends.end(),
                                           [&](std::size_t end) { return !fails_assertion(text, end); });
    throw InputError(path, static_cast<std::uint64_t>(line - line_ends.begin()) + 1, "expected a value");
  }
}

Parameters read(const std::string& path, const toml::table& table, const Parameters& base) {
  Parameters parameters = base;
  for (const Leaf& leaf : leaves_of(table)) {
    try {
      const ParameterRow& row = parameter_row(leaf.key);
      const auto text = text_of(*leaf.node, row);
      if (!text) throw UsageError(leaf.key + ": expected " + toml_form(row));
      set_parameter(parameters, leaf.key, *text);
    } catch (const UsageError& error) {
      throw InputError(path, leaf.node->source().begin.line, error.what());
    }
  }
  return parameters;
}

// ---- writing into an existing file

// Byte offsets of the lines of a text; TOML places are line and column (in code points), both from 1.
class Places {
 public:
  explicit Places(std::string_view text) : text_(text), starts_{0} {
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\n') starts_.push_back(i + 1);
    }
  }
  std::size_t offset(const toml::source_position& place) const {
    std::size_t at = starts_.at(place.line - 1);
    for (std::uint32_t column = 1; column < place.column && at < text_.size(); ++column) {
      ++at;
      while (at < text_.size() && (static_cast<unsigned char>(text_[at]) & 0xC0U) == 0x80U) ++at;
    }
    return at;
  }
  // Behind the line that `place` is on, its newline included.
  std::size_t line_end(const toml::source_position& place) const {
    return place.line < starts_.size() ? starts_[place.line] : text_.size();
  }

 private:
  std::string_view text_;
  std::vector<std::size_t> starts_;
};

struct Edit {
  std::size_t begin;
  std::size_t end;
  std::string text;
};

std::string with_edits(std::string_view text, std::vector<Edit> edits) {
  std::stable_sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) { return a.begin < b.begin; });
  std::string result;
  std::size_t at = 0;
  for (const Edit& edit : edits) {
    result += text.substr(at, edit.begin - at);
    result += edit.text;
    at = edit.end;
  }
  return result + std::string(text.substr(at));
}

// Where the next key of a table can be added, and how the keys before it start ("" or, in dotted keys, "light.1.").
struct Room {
  std::size_t at = 0;
  std::string key_start;
};

// What stands before the last part of the key whose value begins at `value`.
std::string key_start(std::string_view text, std::size_t value) {
  const std::size_t line = value == 0 ? 0 : text.rfind('\n', value - 1) + 1;
  std::string_view key = text.substr(line, value - line);
  key = key.substr(0, key.rfind('='));
  bool in_quotes = false;
  std::size_t start = 0;
  for (std::size_t i = 0; i < key.size(); ++i) {
    if (key[i] == '"' || key[i] == '\'') in_quotes = !in_quotes;
    if (key[i] == '.' && !in_quotes) start = i + 1;
  }
  return std::string(key.substr(0, start));
}

// The old text with new values in their old places, missing keys behind the last key of their table (or in a new table
// at the end), and keys that now say "auto" gone. May not be valid TOML for unusual files: the caller checks.
std::string edited_text(const std::string& path, const std::string& old_text, const Parameters& parameters) {
  const toml::table table = parse(path, old_text);
  const Places places(old_text);
  std::vector<Edit> edits;
  std::set<std::string> present;
  std::map<std::string, Room> rooms;  // by table
  for (const Leaf& leaf : leaves_of(table)) {
    present.insert(leaf.key);
    const toml::source_region& region = leaf.node->source();
    const std::size_t begin = places.offset(region.begin);
    const std::size_t end = places.offset(region.end);
    const std::size_t behind = places.line_end(region.end);
    Room& room = rooms[split_key(leaf.key).first];
    if (behind > room.at) room = {behind, key_start(old_text, begin)};
    if (said_by_absence(parameters, leaf.key)) {
      edits.push_back({old_text.rfind('\n', begin) + 1, behind, ""});
      continue;
    }
    Parameters as_read;
    const auto text = text_of(*leaf.node, parameter_row(leaf.key));
    if (text) set_parameter(as_read, leaf.key, *text);
    if (!text || get_parameter(as_read, leaf.key) != get_parameter(parameters, leaf.key)) {
      edits.push_back({begin, end, toml_value(parameters, leaf.key)});
    }
  }
  // A file of dotted keys gets more of them behind its last one; TOML would not let them be continued as tables.
  Room dotted;
  for (const auto& [prefix, room] : rooms) {
    if (!prefix.empty() && room.key_start == prefix + "." && room.at > dotted.at) dotted = room;
  }
  std::map<std::size_t, std::string> added;  // lines, by place
  std::string top_level;
  std::string new_tables;
  std::string last_new;
  for (const std::string& key : keys_to_write(parameters)) {
    if (present.contains(key)) continue;
    const auto [prefix, name] = split_key(key);
    const std::string line = toml_key(name) + " = " + toml_value(parameters, key) + "\n";
    if (const auto room = rooms.find(prefix); room != rooms.end()) {
      added[room->second.at] += room->second.key_start + line;
    } else if (prefix.empty() || dotted.at > 0) {
      top_level += (prefix.empty() ? "" : prefix + ".") + line;
    } else {
      if (prefix != last_new) new_tables += "\n[" + prefix + "]\n";
      last_new = prefix;
      new_tables += line;
    }
  }
  if (!top_level.empty()) added[dotted.at] += top_level;
  for (const auto& [at, lines] : added) {
    const bool needs_newline = at > 0 && old_text[at - 1] != '\n';
    edits.push_back({at, at, (needs_newline ? "\n" : "") + lines});
  }
  std::string result = with_edits(old_text, std::move(edits));
  if (!result.empty() && result.back() != '\n') result += '\n';
  return result + new_tables;
}

// The edited file where that says exactly `parameters`, else a fresh one.
std::string text_to_write(const std::string& path, const Parameters& parameters) {
  if (!std::filesystem::is_regular_file(path)) return fresh_crf_text(parameters);
  try {
    const std::string old_text(MappedFile(path).bytes());
    std::string text = edited_text(path, old_text, parameters);
    if (read(path, parse(path, text), {}) == parameters) return text;
  } catch (const Error&) {
    // Not a parameter file, or one with mistakes: nothing in it can be kept.
  }
  return fresh_crf_text(parameters);
}

}  // namespace

Parameters read_crf(const std::string& path, const Parameters& base) {
  const MappedFile file(path);
  return parse_crf(file.bytes(), path, base);
}

Parameters parse_crf(std::string_view text, const std::string& name, const Parameters& base) {
  return read(name, parse(name, text), base);
}

void write_crf(const std::string& path, const Parameters& parameters) {
  check_parameters(parameters);
  const std::string text = text_to_write(path, parameters);
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace atomesh
