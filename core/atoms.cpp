#include "core/atoms.h"

#include "core/elements.h"
#include "core/error.h"

namespace atomesh {

std::uint16_t Atoms::add_species(std::string_view name) {
  for (std::size_t i = 0; i < species_table.size(); ++i) {
    if (species_table[i].name == name) return static_cast<std::uint16_t>(i);
  }
  if (species_table.size() >= 65535) throw Error("more than 65,535 different species");
  species_table.push_back({std::string(name), default_species_radius(name)});
  return static_cast<std::uint16_t>(species_table.size() - 1);
}

const Column* Atoms::find_column(std::string_view name) const {
  for (const Column& column : columns) {
    if (column.name == name) return &column;
  }
  return nullptr;
}

Atoms Atoms::subset(const std::vector<Index>& kept) const {
  const auto gather = [&kept](const auto& from) {
    std::decay_t<decltype(from)> to;
    to.reserve(kept.size());
    for (const Index i : kept) to.push_back(from[i]);
    return to;
  };
  Atoms result;
  result.positions = gather(positions);
  result.species = gather(species);
  if (!ids.empty()) result.ids = gather(ids);
  result.species_table = species_table;
  for (const Column& column : columns) result.columns.push_back({column.name, gather(column.values)});
  result.box = box;
  return result;
}

}  // namespace atomesh
