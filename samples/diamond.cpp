// Diamond with vacancies, and diamond with A centres (pairs of neighbouring substitutional nitrogen atoms).
#include <algorithm>
#include <cmath>

#include "samples/crystal.h"
#include "samples/generators.h"
#include "samples/random.h"

namespace atomesh {

namespace {

constexpr double edge = 3.567;                       // Å
constexpr double bond = 0.4330127018922193 * edge;   // √3/4 edge, 1.545 Å
constexpr double margin = 2.0 * edge;                // Å; defects keep this far from every face
constexpr double separation = 3.5 * edge;            // Å; between defects, so that each stands alone
constexpr Vec3 proportions(15, 15, 25);              // 15×15×25 cells are 45,000 sites
constexpr double sites_per_defective_site = 2500.0;  // 18 vacancies, or 9 pairs of nitrogen, in 45,000 sites
constexpr double nitrogen_retreat = 0.05;            // Å; each nitrogen of a pair steps back from the other

BlockShape diamond_block(double sites) {
  return choose_block(sites / 8.0, Vec3(edge), proportions);
}

std::size_t planned_sites(std::size_t atoms) {
  return std::max<std::size_t>(
      2, static_cast<std::size_t>(std::llround(static_cast<double>(atoms) / sites_per_defective_site)));
}

// Picks connected groups of sites, far from the faces and from each other.
class SitePicker {
 public:
  SitePicker(const Atoms& crystal, const BlockShape& shape, std::uint64_t seed)
      : crystal_(crystal), shape_(shape), bounds_(bounds_of(crystal.positions)), random_(seed) {
    for (std::size_t i = 0; i < crystal.size(); ++i) {
      const Vec3& p = crystal.positions[i];
      if (glm::all(glm::greaterThan(p, bounds_.min + margin)) && glm::all(glm::lessThan(p, bounds_.max - margin))) {
        inner_.push_back(static_cast<Index>(i));
      }
    }
  }

  // A random site and `size` - 1 further ones, each a neighbour of one picked before. Empty when there is no room left.
  std::vector<Index> pick(std::size_t size) {
    for (int attempt = 0; attempt < 20000 && !inner_.empty(); ++attempt) {
      const Index first = inner_[random_.below(inner_.size())];
      const Vec3& centre = crystal_.positions[first];
      const bool crowded = std::any_of(centres_.begin(), centres_.end(),
                                       [&](const Vec3& other) { return glm::distance(centre, other) < separation; });
      if (crowded) continue;
      centres_.push_back(centre);
      return grow(first, size);
    }
    return {};
  }

 private:
  std::vector<Index> grow(Index first, std::size_t size) {
    std::vector<Index> group{first};
    while (group.size() < size) {
      std::vector<Index> open = neighbours(group[random_.below(group.size())]);
      std::erase_if(open, [&](Index i) { return std::find(group.begin(), group.end(), i) != group.end(); });
      if (!open.empty()) group.push_back(open[random_.below(open.size())]);
    }
    return group;
  }

  // The crystal is in build_block's order, and an inner site's neighbours are in its own cell or one that touches it.
  std::vector<Index> neighbours(Index site) const {
    std::vector<Index> result;
    const std::size_t nx = shape_.cells[0];
    const std::size_t ny = shape_.cells[1];
    const std::size_t cell = site / 8;
    const std::size_t first = cell - (ny + 1) * nx - 1;
    for (std::size_t z = 0; z < 3; ++z) {
      for (std::size_t y = 0; y < 3; ++y) {
        for (std::size_t atom = 8 * (first + (z * ny + y) * nx); atom < 8 * (first + (z * ny + y) * nx + 3); ++atom) {
          const double d = glm::distance(crystal_.positions[atom], crystal_.positions[site]);
          if (d > 0.5 * bond && d < 1.1 * bond) result.push_back(static_cast<Index>(atom));
        }
      }
    }
    return result;
  }

  const Atoms& crystal_;
  BlockShape shape_;
  Bounds bounds_;
  Random random_;
  std::vector<Index> inner_;
  std::vector<Vec3> centres_;
};

}  // namespace

Sample grow_diamond_vacancy(std::size_t atoms, std::uint64_t seed, Progress& progress) {
  Sample sample;
  sample.unit_cell = zinc_blende_cell("C", "C", edge);
  const std::size_t planned = planned_sites(atoms);
  const BlockShape shape = diamond_block(static_cast<double>(atoms + planned));
  const Atoms crystal = build_block(*sample.unit_cell, shape);

  // Of eighteen vacancies four are one cluster, six are three pairs, eight stand alone.
  std::vector<std::size_t> sizes(planned / 18 + (planned % 18 >= 9 ? 1 : 0), 4);
  const std::size_t pairs = (planned - 4 * sizes.size()) * 3 / 14;
  sizes.insert(sizes.end(), pairs, 2);
  sizes.insert(sizes.end(), planned - 4 * (sizes.size() - pairs) - 2 * pairs, 1);

  SitePicker picker(crystal, shape, seed);
  std::vector<bool> removed(crystal.size(), false);
  for (const std::size_t size : sizes) {
    progress.check();
    for (const Index site : picker.pick(size)) {
      removed[site] = true;
      sample.truth.vacancies.push_back({crystal.positions[site], "C"});
    }
  }
  sample.atoms = without(crystal, removed);
  return sample;
}

Sample grow_diamond_a_centers(std::size_t atoms, std::uint64_t seed, Progress& progress) {
  Sample sample;
  sample.unit_cell = zinc_blende_cell("C", "C", edge);
  const BlockShape shape = diamond_block(static_cast<double>(atoms));
  sample.atoms = build_block(*sample.unit_cell, shape);
  const std::uint16_t nitrogen = sample.atoms.add_species("N");

  const Atoms crystal = sample.atoms;
  SitePicker picker(crystal, shape, seed);
  for (std::size_t pair = 0; pair < planned_sites(atoms) / 2; ++pair) {
    progress.check();
    const std::vector<Index> sites = picker.pick(2);
    if (sites.empty()) break;
    const Vec3 axis = glm::normalize(crystal.positions[sites[1]] - crystal.positions[sites[0]]);
    sample.atoms.positions[sites[0]] -= nitrogen_retreat * axis;
    sample.atoms.positions[sites[1]] += nitrogen_retreat * axis;
    for (const Index site : sites) {
      sample.atoms.species[site] = nitrogen;
      sample.truth.substitutions.push_back({site, static_cast<Index>(sample.truth.vacancies.size())});
      sample.truth.vacancies.push_back({crystal.positions[site], "C"});
      sample.truth.extras.push_back(site);
    }
  }
  std::sort(sample.truth.extras.begin(), sample.truth.extras.end());
  std::sort(sample.truth.substitutions.begin(), sample.truth.substitutions.end(),
            [](const auto& a, const auto& b) { return a.atom < b.atom; });
  return sample;
}

}  // namespace atomesh
