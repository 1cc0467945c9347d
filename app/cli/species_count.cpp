#include "app/cli/species_count.h"

#include <vector>

#include "app/cli/text_table.h"

namespace atomesh::cli {

namespace {

std::vector<std::size_t> counts_of(const Atoms& atoms) {
  std::vector<std::size_t> counts(atoms.species_table.size());
  for (const std::uint16_t species : atoms.species) ++counts[species];
  return counts;
}

}  // namespace

std::string species_text(const Atoms& atoms) {
  const std::vector<std::size_t> counts = counts_of(atoms);
  std::string text;
  for (std::size_t s = 0; s < counts.size(); ++s) {
    if (s > 0) text += ", ";
    text += atoms.species_table[s].name + " " + grouped(counts[s]);
  }
  return text;
}

Json species_json(const Atoms& atoms) {
  const std::vector<std::size_t> counts = counts_of(atoms);
  Json json = Json::object();
  for (std::size_t s = 0; s < counts.size(); ++s) json.set(atoms.species_table[s].name, counts[s]);
  return json;
}

}  // namespace atomesh::cli
