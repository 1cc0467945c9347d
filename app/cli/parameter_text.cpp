#include "app/cli/parameter_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/error.h"

namespace atomesh::cli {

namespace {

constexpr std::string_view species_suffix = "<species>";

std::set<std::string> species_said(const Parameters& parameters) {
  std::set<std::string> names;
  for (const auto& [name, color] : parameters.atoms.colors) names.insert(name);
  for (const auto& [name, visible] : parameters.atoms.visible) names.insert(name);
  for (const auto& [name, radius] : parameters.atoms.radii) names.insert(name);
  return names;
}

bool says(const Parameters& parameters, std::string_view stem, const std::string& species) {
  const AtomsParameters& atoms = parameters.atoms;
  if (stem == "atoms.color.") return atoms.colors.contains(species);
  if (stem == "atoms.visible.") return atoms.visible.contains(species);
  return atoms.radii.contains(species);
}

}  // namespace

std::string parameter_lines(const Parameters& parameters) {
  std::string out;
  for (const ParameterRow& row : parameter_table()) {
    if (!row.key.ends_with(species_suffix)) {
      out += fmt::format("{}={}\n", row.key, get_parameter(parameters, row.key));
      continue;
    }
    const std::string stem = row.key.substr(0, row.key.size() - species_suffix.size());
    for (const std::string& species : species_said(parameters)) {
      if (says(parameters, stem, species)) {
        out += fmt::format("{}{}={}\n", stem, species, get_parameter(parameters, stem + species));
      }
    }
  }
  return out;
}

void check_species_key(const std::string& key, const Atoms& atoms) {
  const ParameterRow& row = parameter_row(key);
  if (!row.key.ends_with(species_suffix)) return;
  const std::string species = key.substr(row.key.size() - species_suffix.size());
  std::vector<std::string> names;
  for (const Species& known : atoms.species_table) names.push_back(known.name);
  if (std::find(names.begin(), names.end(), species) != names.end()) return;
  throw UsageError(
      fmt::format("--set {}: the sample has no species \"{}\"; it has {}", key, species, fmt::join(names, ", ")));
}

}  // namespace atomesh::cli
