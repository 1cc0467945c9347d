// What stands behind a row of parameter_table(): where in the struct its value lives. Only parameters.cpp reads this.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/parameters.h"

namespace atomesh {

// A value of one of the enumerations; `set` takes an index into ParameterRow::choices.
struct ChoiceSlot {
  std::size_t index;
  std::function<void(std::size_t)> set;
};

template <class Value>
using SpeciesMap = std::map<std::string, Value, std::less<>>;

// A vector that must not be zero.
struct DirectionSlot {
  Vec3* vector;
};

// A name; empty is "auto".
struct NameSlot {
  std::string* name;
};

using ParameterSlot =
    std::variant<bool*, int*, double*, float*, Vec3*, Vec3f*, Vec4f*, ColorMap*, DirectionSlot, ChoiceSlot, NameSlot,
                 std::optional<double>*, SpeciesMap<Vec3f>*, SpeciesMap<bool>*, SpeciesMap<double>*>;

struct ParameterEntry {
  ParameterRow row;
  std::function<ParameterSlot(Parameters&)> slot;
};

const std::vector<ParameterEntry>& parameter_entries();

}  // namespace atomesh
