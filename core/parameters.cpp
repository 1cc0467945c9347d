#include "core/parameters.h"

#include <algorithm>

#include "core/error.h"
#include "core/parameter_table.h"
#include "core/parameter_text.h"

namespace atomesh {

namespace {

constexpr std::string_view species_mark = "<species>";

// The entry of a key and, for keys of a species, its name.
struct Found {
  const ParameterEntry* entry;
  std::string species;
};

[[noreturn]] void throw_unknown(std::string_view key) {
  std::vector<std::string> keys;
  for (const ParameterEntry& entry : parameter_entries()) keys.push_back(entry.row.key);
  // "face_alpha" means volume_surface.face_alpha, however far apart the two are in letters.
  std::string suggestion;
  const std::string tail = "." + std::string(key);
  for (const std::string& candidate : keys) {
    if (suggestion.empty() && candidate.ends_with(tail)) suggestion = candidate;
  }
  if (suggestion.empty()) suggestion = nearest_name(key, keys);
  throw UsageError("there is no parameter \"" + std::string(key) + "\"" +
                   (suggestion.empty() ? "" : "; did you mean " + suggestion + "?"));
}

Found find_entry(std::string_view key) {
  for (const ParameterEntry& entry : parameter_entries()) {
    if (entry.row.key == key) return {&entry, ""};
    if (!entry.row.key.ends_with(species_mark)) continue;
    const std::string_view prefix =
        std::string_view(entry.row.key).substr(0, entry.row.key.size() - species_mark.size());
    if (key.size() > prefix.size() && key.starts_with(prefix)) return {&entry, std::string(key.substr(prefix.size()))};
  }
  throw_unknown(key);
}

std::string range_text(const ParameterRow& row) {
  return "from " + real_text(row.min) + " to " + real_text(row.max) + (row.unit.empty() ? "" : " " + row.unit);
}

// Whether an unset number is a value too.
bool has_auto(const ParameterRow& row) {
  Parameters defaults;
  return !row.key.ends_with(species_mark) && row.type == ParameterType::real &&
         std::holds_alternative<std::optional<double>*>(find_entry(row.key).entry->slot(defaults));
}

bool is_control(char c) {
  return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
}

// Reads `text` into the value a slot points to. Returns false when it is not what the row expects; nothing is changed
// then.
class SetFromText {
 public:
  SetFromText(const Found& found, std::string_view text)
      : row_(found.entry->row), species_(found.species), text_(text) {}

  bool operator()(bool* value) const { return assign(value, read_boolean(text_)); }
  bool operator()(int* value) const { return assign(value, in_range(read_integer(text_))); }
  bool operator()(double* value) const { return assign(value, in_range(read_real(text_))); }
  bool operator()(float* value) const { return assign(value, in_range(read_real_float(text_))); }
  bool operator()(Vec3* value) const { return assign(value, components_in_range(read_vector(text_))); }
  bool operator()(Vec4f* value) const { return assign(value, components_in_range(read_rgba(text_))); }
  bool operator()(Vec3f* value) const {
    const auto read = row_.type == ParameterType::rgb ? read_rgb(text_) : read_vector_float(text_);
    return assign(value, components_in_range(read));
  }
  bool operator()(ColorMap* value) const {
    *value = read_color_map(text_);
    return true;
  }
  bool operator()(const DirectionSlot& slot) const {
    const auto read = components_in_range(read_vector(text_));
    return read && *read != Vec3(0.0) && assign(slot.vector, read);
  }
  bool operator()(const ChoiceSlot& slot) const {
    std::string word(text_);
    if (word == "<=") word = "less-equal";
    if (word == ">=") word = "greater-equal";
    std::replace(word.begin(), word.end(), '_', '-');
    const auto at = std::find(row_.choices.begin(), row_.choices.end(), word);
    if (at == row_.choices.end()) return false;
    slot.set(static_cast<std::size_t>(at - row_.choices.begin()));
    return true;
  }
  bool operator()(const NameSlot& slot) const {
    if (text_.empty() || std::any_of(text_.begin(), text_.end(), is_control)) return false;
    *slot.name = text_ == "auto" ? std::string() : std::string(text_);
    return true;
  }
  bool operator()(std::optional<double>* value) const {
    const auto read = in_range(read_real(text_));
    if (!read && text_ != "auto") return false;
    *value = read;
    return true;
  }
  // What is absent from these maps is what "auto" (or visible) means.
  bool operator()(SpeciesMap<Vec3f>* map) const { return assign_species(map, components_in_range(read_rgb(text_))); }
  bool operator()(SpeciesMap<double>* map) const { return assign_species(map, in_range(read_real(text_))); }
  bool operator()(SpeciesMap<bool>* map) const {
    const auto visible = read_boolean(text_);
    if (visible == true) {
      map->erase(species_);
      return true;
    }
    return assign_species(map, visible);
  }

 private:
  template <class Value>
  static bool assign(Value* value, const std::optional<Value>& read) {
    if (read) *value = *read;
    return read.has_value();
  }
  template <class Value>
  bool assign_species(SpeciesMap<Value>* map, const std::optional<Value>& read) const {
    if (text_ == "auto") {
      map->erase(species_);
      return true;
    }
    if (read) map->insert_or_assign(species_, *read);
    return read.has_value();
  }
  template <class Number>
  std::optional<Number> in_range(std::optional<Number> read) const {
    if (!read || *read < static_cast<Number>(row_.min) || *read > static_cast<Number>(row_.max)) return {};
    return read;
  }
  template <class Vector>
  std::optional<Vector> components_in_range(std::optional<Vector> read) const {
    if (!read) return {};
    for (int i = 0; i < Vector::length(); ++i) {
      if (!in_range(std::optional((*read)[i]))) return {};
    }
    return read;
  }

  const ParameterRow& row_;
  const std::string& species_;
  std::string_view text_;
};

struct TextOf {
  const Found& found;

  std::string operator()(const bool* value) const { return *value ? "true" : "false"; }
  std::string operator()(const int* value) const { return std::to_string(*value); }
  std::string operator()(const double* value) const { return real_text(*value); }
  std::string operator()(const float* value) const { return real_text(*value); }
  std::string operator()(const Vec3* value) const { return vector_text(*value); }
  std::string operator()(const Vec3f* value) const { return vector_text(*value); }
  std::string operator()(const Vec4f* value) const { return vector_text(*value); }
  std::string operator()(const ColorMap* value) const { return color_map_text(*value); }
  std::string operator()(const DirectionSlot& slot) const { return vector_text(*slot.vector); }
  std::string operator()(const ChoiceSlot& slot) const { return found.entry->row.choices.at(slot.index); }
  std::string operator()(const NameSlot& slot) const { return slot.name->empty() ? "auto" : *slot.name; }
  std::string operator()(const std::optional<double>* value) const { return *value ? real_text(**value) : "auto"; }
  std::string operator()(const SpeciesMap<bool>* map) const {
    const auto at = map->find(found.species);
    return at == map->end() || at->second ? "true" : "false";
  }
  template <class Value>
  std::string operator()(const SpeciesMap<Value>* map) const {
    const auto at = map->find(found.species);
    if (at == map->end()) return "auto";
    if constexpr (std::is_same_v<Value, double>) {
      return real_text(at->second);
    } else {
      return vector_text(at->second);
    }
  }
};

bool is_species_name(std::string_view name) {
  return !name.empty() && name != species_mark &&
         std::none_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) <= ' '; });
}

}  // namespace

std::array<Light, max_lights> Parameters::default_lights() {
  std::array<Light, max_lights> lights;
  // The key light, over the viewer's left shoulder, and a weaker one from the right that opens the shadows.
  lights[0] = {true, {-1.5F, 2.0F, 3.0F}, {1.0F, 1.0F, 1.0F}, 1.0F};
  lights[1] = {true, {2.5F, 0.0F, 2.0F}, {1.0F, 1.0F, 1.0F}, 0.35F};
  return lights;
}

const std::vector<ParameterRow>& parameter_table() {
  static const std::vector<ParameterRow> rows = [] {
    std::vector<ParameterRow> list;
    for (const ParameterEntry& entry : parameter_entries()) list.push_back(entry.row);
    return list;
  }();
  return rows;
}

const ParameterRow& parameter_row(std::string_view key) {
  return find_entry(key).entry->row;
}

std::vector<std::string> parameter_keys(const std::vector<std::string>& species) {
  std::vector<std::string> keys;
  for (const ParameterRow& row : parameter_table()) {
    if (!row.key.ends_with(species_mark)) {
      keys.push_back(row.key);
      continue;
    }
    const std::string prefix = row.key.substr(0, row.key.size() - species_mark.size());
    for (const std::string& name : species) keys.push_back(prefix + name);
  }
  return keys;
}

std::string expected_value(const ParameterRow& row) {
  switch (row.type) {
    case ParameterType::boolean:
      return "true or false";
    case ParameterType::integer:
      return "a whole number " + range_text(row);
    case ParameterType::real:
      return (has_auto(row) ? "auto or a number " : "a number ") + range_text(row);
    case ParameterType::choice: {
      std::string text;
      for (std::size_t i = 0; i < row.choices.size(); ++i) {
        if (i > 0) text += i + 1 == row.choices.size() ? " or " : ", ";
        text += row.choices[i];
      }
      return text;
    }
    case ParameterType::text:
      return "a name, without control characters, or auto";
    case ParameterType::rgb:
      return "a color, #rrggbb or r,g,b with each from 0 to 1";
    case ParameterType::rgba:
      return "a color, #rrggbb, #rrggbbaa or r,g,b,a with each from 0 to 1";
    case ParameterType::vector:
      return "x,y,z, each a number " + range_text(row);
    case ParameterType::color_map:
      break;
  }
  return "a preset's name or 2 to 32 entries scalar:color";
}

void set_parameter(Parameters& parameters, std::string_view key, std::string_view text) {
  const Found found = find_entry(key);
  const ParameterRow& row = found.entry->row;
  if (row.key.ends_with(species_mark) && !is_species_name(found.species)) {
    throw UsageError(std::string(key) + ": put the name of a species (no blanks) in the place of <species>");
  }
  bool done = false;
  try {
    done = std::visit(SetFromText(found, text), found.entry->slot(parameters));
  } catch (const UsageError& error) {
    throw UsageError(std::string(key) + ": " + error.what());
  }
  if (!done) throw UsageError(std::string(key) + " = \"" + std::string(text) + "\": expected " + expected_value(row));
}

std::string get_parameter(const Parameters& parameters, std::string_view key) {
  const Found found = find_entry(key);
  // The slots point into a struct that can be changed; nothing here changes it.
  return std::visit(TextOf{found}, found.entry->slot(const_cast<Parameters&>(parameters)));
}

void check_parameters(const Parameters& parameters) {
  std::vector<std::string> species;
  for (const auto& [name, color] : parameters.atoms.colors) species.push_back(name);
  for (const auto& [name, visible] : parameters.atoms.visible) species.push_back(name);
  for (const auto& [name, radius] : parameters.atoms.radii) species.push_back(name);
  Parameters copy;
  for (const std::string& key : parameter_keys(species)) set_parameter(copy, key, get_parameter(parameters, key));
}

std::string_view mode_name(Mode mode) {
  static const std::vector<std::string>& names = parameter_row("mode").choices;
  return names.at(static_cast<std::size_t>(mode));
}

Mode mode_from_name(std::string_view name) {
  Parameters parameters;
  try {
    set_parameter(parameters, "mode", name);
  } catch (const UsageError& error) {
    const std::string nearest = nearest_name(name, parameter_row("mode").choices);
    throw UsageError(error.what() + (nearest.empty() ? std::string() : "; did you mean " + nearest + "?"));
  }
  return parameters.mode;
}

}  // namespace atomesh
