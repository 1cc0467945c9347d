#include "app/cli/defect_table.h"

#include <fmt/format.h>

#include <string>

namespace atomesh::cli {

TextTable cluster_table(const std::vector<DefectCluster>& clusters) {
  TextTable table({"kind", "x", "y", "z", "radius", "atoms", "vacancies", "extras", "substitutions", "peak"});
  for (const DefectCluster& cluster : clusters) {
    table.row({std::string(defect_kind_name(cluster.kind)), fmt::format("{:.3f}", cluster.centre.x),
               fmt::format("{:.3f}", cluster.centre.y), fmt::format("{:.3f}", cluster.centre.z),
               fmt::format("{:.3f}", cluster.radius), std::to_string(cluster.atoms.size()),
               std::to_string(cluster.vacancies.size()), std::to_string(cluster.extras.size()),
               std::to_string(cluster.substitutions.size()), fmt::format("{:.4g}", cluster.peak)});
  }
  return table;
}

TextTable site_table(const Material& material, std::optional<DefectKind> kind, std::size_t top) {
  TextTable table({"kind", "species", "x", "y", "z", "atom", "votes", "expected"});
  const Defects& defects = material.defects;
  std::size_t rows = 0;
  const auto row = [&](std::string_view what, const std::string& species, const Vec3& position, std::string atom,
                       std::optional<Index> votes, const std::string& expected = "") {
    if (top > 0 && rows++ >= top) return;
    table.row({std::string(what), species, fmt::format("{:.3f}", position.x), fmt::format("{:.3f}", position.y),
               fmt::format("{:.3f}", position.z), std::move(atom), votes ? fmt::format("{}", *votes) : "", expected});
  };
  if (kind.value_or(DefectKind::vacancy) == DefectKind::vacancy) {
    for (const VacancySite& site : defects.vacancies) {
      row("vacancy", material.atoms.species_table[site.species].name, site.position, "", site.votes);
    }
  }
  if (kind.value_or(DefectKind::extra) == DefectKind::extra) {
    for (const ExtraAtom& extra : defects.extras) {
      row("extra", std::string(material.atoms.species_name(extra.atom)), material.atoms.positions[extra.atom],
          std::to_string(extra.atom), extra.votes);
    }
  }
  if (kind.value_or(DefectKind::substitution) == DefectKind::substitution) {
    for (const Substitution& s : defects.substitutions) {
      row("substitution", material.atoms.species_name(s.atom), material.atoms.positions[s.atom], std::to_string(s.atom),
          std::nullopt, material.atoms.species_table[s.expected].name);
    }
  }
  return table;
}

}  // namespace atomesh::cli
