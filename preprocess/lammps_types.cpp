#include "preprocess/lammps_types.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "core/elements.h"
#include "core/error.h"

namespace atomesh::reading {

namespace {

std::string name_of_type(const Input& input, const TypeNames& names, bool reduced_units, const std::string& type) {
  const std::vector<std::string>& chosen = input.options.type_names;
  std::int64_t number = 0;
  if (!chosen.empty() && parse_integer(type, number)) {
    if (number < 1 || static_cast<std::uint64_t>(number) > chosen.size()) {
      throw UsageError(input.path + ": type " + type +
                       " has no name; expected names for the types 1 to the highest, got " +
                       count_of(chosen.size(), "name"));
    }
    return chosen[static_cast<std::size_t>(number - 1)];
  }
  const auto label = names.labels.find(type);
  if (label != names.labels.end() && find_element(label->second) != nullptr) return label->second;
  const auto mass = names.masses.find(type);
  if (mass != names.masses.end() && !reduced_units) {
    if (const Element* element = find_element_by_mass(mass->second)) return std::string(element->symbol);
  }
  return label != names.labels.end() ? label->second : type;
}

// Numbers in ascending order, then labels.
bool type_before(const std::string& a, const std::string& b) {
  std::int64_t x = 0;
  std::int64_t y = 0;
  const bool a_number = parse_integer(a, x);
  const bool b_number = parse_integer(b, y);
  if (a_number != b_number) return a_number;
  return a_number ? x < y : a < b;
}

}  // namespace

void name_types(const Input& input, const TypeNames& names, Atoms& atoms, ReadReport& report) {
  const bool reduced_units = std::all_of(names.masses.begin(), names.masses.end(),
                                         [](const auto& type_mass) { return type_mass.second == 1.0; });
  const std::vector<Species> types = std::move(atoms.species_table);
  std::vector<std::uint16_t> order(types.size());
  std::iota(order.begin(), order.end(), std::uint16_t{0});
  std::sort(order.begin(), order.end(),
            [&types](std::uint16_t a, std::uint16_t b) { return type_before(types[a].name, types[b].name); });
  atoms.species_table.clear();
  std::vector<std::uint16_t> species_of(types.size());
  for (const std::uint16_t type : order) {
    species_of[type] = atoms.add_species(name_of_type(input, names, reduced_units, types[type].name));
  }
  std::vector<std::int64_t> numbers(types.size());
  bool numbered = true;
  for (std::size_t t = 0; t < types.size(); ++t) numbered = parse_integer(types[t].name, numbers[t]) && numbered;
  if (atoms.species_table.size() < types.size() && numbered && atoms.find_column("type") == nullptr) {
    Column column{"type", {}};
    column.values.reserve(atoms.size());
    for (const std::uint16_t type : atoms.species) column.values.push_back(static_cast<double>(numbers[type]));
    atoms.columns.push_back(std::move(column));
    report.notes.push_back("Several types are the same element; the column \"type\" tells them apart.");
  }
  for (std::uint16_t& species : atoms.species) species = species_of[species];
}

void sort_by_id(const Input& input, Atoms& atoms, const std::function<std::uint64_t(std::size_t)>& line_of) {
  const std::vector<std::int64_t>& ids = atoms.ids;
  if (ids.empty() || std::is_sorted(ids.begin(), ids.end(), std::less_equal<>())) return;
  const auto twice = [&](std::size_t first, std::size_t second) {
    throw InputError(input.path, line_of(second),
                     "atom id " + std::to_string(ids[second]) + " stands on line " + std::to_string(line_of(first)) +
                         " already; expected every id once");
  };
  const auto [low, high] = std::minmax_element(ids.begin(), ids.end());
  // As unsigned: the difference of two ids may not fit a signed number.
  const std::uint64_t range = static_cast<std::uint64_t>(*high) - static_cast<std::uint64_t>(*low);
  std::vector<Index> order;
  if (range / 4 <= ids.size()) {
    // Nearly all ids of a range: every atom has its place.
    std::vector<Index> place(range + 1, no_index);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      Index& at = place[static_cast<std::uint64_t>(ids[i]) - static_cast<std::uint64_t>(*low)];
      if (at != no_index) twice(at, i);
      at = static_cast<Index>(i);
    }
    order.reserve(ids.size());
    std::copy_if(place.begin(), place.end(), std::back_inserter(order), [](Index i) { return i != no_index; });
  } else {
    order.resize(ids.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(), [&ids](Index a, Index b) { return ids[a] < ids[b]; });
    for (std::size_t i = 1; i < order.size(); ++i) {
      if (ids[order[i]] == ids[order[i - 1]]) twice(order[i - 1], order[i]);
    }
  }
  atoms = atoms.subset(order);
}

Box box_from_bounds(const Vec3& low, const Vec3& high, const Vec3& tilt) {
  Box box;
  const Vec3 length = high - low;
  box.origin = low;
  box.vectors = {Vec3(length.x, 0, 0), Vec3(tilt[0], length.y, 0), Vec3(tilt[1], tilt[2], length.z)};
  return box;
}

}  // namespace atomesh::reading
