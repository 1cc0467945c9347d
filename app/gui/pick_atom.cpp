#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "app/gui/periodic_images.h"
#include "app/gui/pick.h"
#include "core/error.h"

namespace atomesh::gui {

namespace {

constexpr double shell = 1.3;  // of the nearest neighbour's distance
constexpr std::size_t most_neighbours = 32;
constexpr double same_place = 1e-6;  // Å
constexpr std::size_t atoms_between_checks = 1 << 16;

// Calls visit(atom, distance) for every atom, or image of one, within the radius that `radius` says at that time.
template <class Visit>
void for_each_near(const Atoms& atoms, const PeriodicImages& images, Index around, const double& radius,
                   const Progress& progress, Visit&& visit) {
  const Vec3 here = atoms.positions[around];
  for (std::size_t a = 0; a < atoms.size(); ++a) {
    if (a % atoms_between_checks == 0) progress.check();
    images.for_each_within(atoms.positions[a] - here, radius, [&](const Vec3& way) {
      const double distance = glm::length(way);
      if (a != around || distance > same_place) visit(static_cast<Index>(a), distance);
    });
  }
}

std::vector<Neighbour> find_neighbours(const Atoms& atoms, Index around, const Progress& progress) {
  if (atoms.size() == 0) return {};
  const PeriodicImages images(atoms.box);
  // Not further than the nearest of a few, or than the atom's own images.
  double nearest = std::numeric_limits<double>::max();
  for (std::size_t a = 0; a < std::min<std::size_t>(atoms.size(), 64); ++a) {
    const double distance = glm::length(images.shortest(atoms.positions[a] - atoms.positions[around]));
    if (distance > same_place) nearest = std::min(nearest, distance);
  }
  for (const Vec3& vector : atoms.box.vectors) {
    const double length = glm::length(vector);
    if (atoms.box.any_periodic() && length > same_place) nearest = std::min(nearest, length);
  }
  if (nearest == std::numeric_limits<double>::max()) {
    for (std::size_t a = 0; a < atoms.size(); ++a) {
      const double distance = glm::length(atoms.positions[a] - atoms.positions[around]);
      if (distance > same_place) nearest = std::min(nearest, distance);
    }
    if (nearest == std::numeric_limits<double>::max()) nearest = 0.0;
  }
  for_each_near(atoms, images, around, nearest, progress, [&nearest](Index, double distance) {
    if (distance > same_place) nearest = std::min(nearest, distance);
  });
  const double radius = std::max(shell * nearest, same_place);
  std::vector<Neighbour> found;
  for_each_near(atoms, images, around, radius, progress, [&found](Index atom, double distance) {
    found.push_back({atom, distance});
  });
  std::sort(found.begin(), found.end(), [](const Neighbour& a, const Neighbour& b) {
    return std::tie(a.distance, a.atom) < std::tie(b.distance, b.atom);
  });
  if (found.size() > most_neighbours) found.resize(most_neighbours);
  return found;
}

std::string place(const Vec3& p, const char* unit) {
  return fmt::format("{:.3f}, {:.3f}, {:.3f}{}", p.x, p.y, p.z, unit);
}

// "6 Cl at 2.820 Å", species by species, nearest first.
std::string neighbours_text(const Pick& pick, const Material& material) {
  struct Group {
    std::size_t count = 0;
    double nearest = 0.0;
    double farthest = 0.0;
  };
  std::vector<std::pair<std::string, Group>> groups;
  for (const Neighbour& neighbour : pick.neighbours) {
    const std::string& species = material.atoms.species_name(neighbour.atom);
    auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == species; });
    if (group == groups.end()) group = groups.insert(group, {species, {0, neighbour.distance, 0.0}});
    ++group->second.count;
    group->second.farthest = neighbour.distance;
  }
  std::string text;
  for (const auto& [species, group] : groups) {
    const std::string near = fmt::format("{:.3f}", group.nearest);
    const std::string far = fmt::format("{:.3f}", group.farthest);
    text += fmt::format("{}{} {} at {}{} Å", text.empty() ? "" : ", ", group.count, species, near,
                        near == far ? "" : " to " + far);
  }
  return text.empty() ? "none" : text;
}

// What the lists of defects say of the atom; "" when nothing.
std::string defect_text(const Defects& defects, const Atoms& atoms, Index atom) {
  for (const Substitution& substitution : defects.substitutions) {
    if (substitution.atom != atom) continue;
    return fmt::format("{} on a site of {}", atoms.species_name(atom), atoms.species_table[substitution.expected].name);
  }
  const auto extra =
      std::find_if(defects.extras.begin(), defects.extras.end(), [atom](const ExtraAtom& e) { return e.atom == atom; });
  return extra == defects.extras.end() ? "" : "extra atom";
}

}  // namespace

Vec3 shortest_way(const Box& box, const Vec3& a, const Vec3& b) {
  return PeriodicImages(box).shortest(b - a);
}

Pick pick_atom(const Material& material, Index atom, Progress& progress) {
  if (atom >= material.atoms.size()) {
    throw UsageError(fmt::format("atom {}: the material has {}", atom, material.atoms.size()));
  }
  Pick pick;
  pick.atom = atom;
  pick.position = material.atoms.positions[atom];
  if (material.defects.present()) {
    pick.defects = {material.defects.positional[atom], material.defects.extra[atom], material.defects.vacancy[atom]};
  }
  pick.neighbours = find_neighbours(material.atoms, atom, progress);
  return pick;
}

std::vector<std::pair<std::string, std::string>> describe(const Pick& pick, const Material& material) {
  const Atoms& atoms = material.atoms;
  const char* unit = atoms.size() > 0 ? " Å" : "";
  std::vector<std::pair<std::string, std::string>> rows;
  if (pick.atom != no_index && pick.atom < atoms.size()) {
    rows.emplace_back("Atom", fmt::format("{}", pick.atom));
    if (!atoms.ids.empty()) rows.emplace_back("Id", fmt::format("{}", atoms.ids[pick.atom]));
    rows.emplace_back("Species", atoms.species_name(pick.atom));
  }
  rows.emplace_back("Position", place(pick.position, unit));
  if (pick.atom != no_index && pick.atom < atoms.size()) {
    if (material.defects.present()) {
      rows.emplace_back("Positional defect", fmt::format("{:.4g}", pick.defects.positional));
      rows.emplace_back("Extra atom defect", fmt::format("{:.4g}", pick.defects.extra));
      rows.emplace_back("Vacancy defect", fmt::format("{:.4g}", pick.defects.vacancy));
      const std::string kind = defect_text(material.defects, atoms, pick.atom);
      if (!kind.empty()) rows.emplace_back("Defect", kind);
    }
    for (const Column& column : atoms.columns) {
      rows.emplace_back(column.name, fmt::format("{:.6g}", column.values[pick.atom]));
    }
    rows.emplace_back("Neighbors", neighbours_text(pick, material));
  }
  if (pick.field) rows.emplace_back("Field", fmt::format("{:.6g}", *pick.field));
  if (pick.tetrahedron != no_index) rows.emplace_back("Tetrahedron", fmt::format("{}", pick.tetrahedron));
  if (pick.triangle != no_index) rows.emplace_back("Triangle", fmt::format("{}", pick.triangle));
  return rows;
}

}  // namespace atomesh::gui
