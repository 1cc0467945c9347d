#include "preprocess/assign_scalar.h"

#include <algorithm>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/text_file.h"

namespace atomesh {

namespace {

std::string suggestion(std::string_view word, const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(word, names);
  if (!nearest.empty()) return "; did you mean \"" + nearest + "\"?";
  if (names.empty()) return "; the file has none";
  std::string list = "; there are";
  for (const std::string& name : names) list += " \"" + name + "\"";
  return list;
}

std::vector<std::string> species_names(const Atoms& atoms) {
  std::vector<std::string> names;
  for (const Species& species : atoms.species_table) names.push_back(species.name);
  return names;
}

// "Ga=0,In=1" → a value for each atom.
std::vector<double> values_by_species(const Atoms& atoms, std::string_view text) {
  std::vector<double> of_species(atoms.species_table.size(), 0.0);
  while (!text.empty()) {
    const std::string_view item = text.substr(0, text.find(','));
    text.remove_prefix(std::min(text.size(), item.size() + 1));
    const std::size_t equals = item.find('=');
    double value = 0.0;
    if (equals == std::string_view::npos || !parse_real(item.substr(equals + 1), value)) {
      throw UsageError("--scalar: expected SPECIES=NUMBER, got \"" + std::string(item) + "\"");
    }
    const std::string_view name = item.substr(0, equals);
    const auto found = std::find_if(atoms.species_table.begin(), atoms.species_table.end(),
                                    [&](const Species& species) { return species.name == name; });
    if (found == atoms.species_table.end()) {
      throw UsageError("--scalar: the sample has no species \"" + std::string(name) + "\"" +
                       suggestion(name, species_names(atoms)));
    }
    of_species[static_cast<std::size_t>(found - atoms.species_table.begin())] = value;
  }
  std::vector<double> values(atoms.size());
  for (std::size_t a = 0; a < values.size(); ++a) values[a] = of_species[atoms.species[a]];
  return values;
}

std::vector<double> values_of_column(const Atoms& atoms, std::string_view name) {
  if (const Column* column = atoms.find_column(name)) return column->values;
  std::vector<std::string> names;
  for (const Column& column : atoms.columns) names.push_back(column.name);
  throw UsageError("--scalar: the file has no column \"" + std::string(name) + "\"" + suggestion(name, names));
}

}  // namespace

Defects assign_scalar(const Atoms& atoms, std::string_view scalar) {
  const bool by_species = scalar.find('=') != std::string_view::npos;
  const std::vector<double> values = by_species ? values_by_species(atoms, scalar) : values_of_column(atoms, scalar);
  const double smallest = values.empty() ? 0.0 : *std::min_element(values.begin(), values.end());
  Defects defects;
  defects.positional.resize(values.size());
  std::transform(values.begin(), values.end(), defects.positional.begin(),
                 [&](double value) { return static_cast<float>(value - smallest); });
  defects.vacancy.assign(values.size(), 0.0F);
  defects.extra.assign(values.size(), 0.0F);
  return defects;
}

}  // namespace atomesh
