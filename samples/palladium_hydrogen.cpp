// Palladium that has taken up hydrogen through its face x = 0: hydrogen on octahedral sites, thinning out inwards as
// diffusion into a half-space does.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "samples/crystal.h"
#include "samples/generators.h"
#include "samples/random.h"

namespace atomesh {

namespace {

constexpr double edge = 3.89;            // Å
constexpr double at_the_face = 0.6;      // share of the octahedral sites taken there, as in the hydride PdH0.6
constexpr double diffusion_depth = 0.3;  // 2√(Dt) in units of the block's depth

double share_taken(double depth) {
  return at_the_face * std::erfc(depth / diffusion_depth);
}

struct Candidate {
  Vec3 site;
  std::size_t number;
  double priority;
};

}  // namespace

Sample grow_palladium_hydrogen(std::size_t atoms, std::uint64_t seed, Progress& progress) {
  Sample sample;
  sample.unit_cell = fcc_cell("Pd", edge);
  // One octahedral site for each Pd; the mean of erfc(x/l) over a depth of 1 ≫ l is l/√π.
  const double hydrogen_per_palladium = at_the_face * diffusion_depth / std::sqrt(std::numbers::pi);
  const BlockShape shape =
      choose_block(static_cast<double>(atoms) / 4.0 / (1.0 + hydrogen_per_palladium), Vec3(edge), Vec3(1.0));
  sample.atoms = build_block(*sample.unit_cell, shape);
  const std::uint16_t hydrogen = sample.atoms.add_species("H");

  // Octahedral sites are the odd points of the grid of half edges whose even points are the Pd sites; those on the
  // block's outermost planes are not inside it.
  std::vector<Candidate> candidates;
  const double depth = static_cast<double>(shape.cells[0]);
  for (std::size_t k = 1; k + 1 < 2 * shape.cells[2]; ++k) {
    progress.update(static_cast<double>(k) / (2.0 * static_cast<double>(shape.cells[2])));
    for (std::size_t j = 1; j + 1 < 2 * shape.cells[1]; ++j) {
      for (std::size_t i = 1; i + 1 < 2 * shape.cells[0]; ++i) {
        if ((i + j + k) % 2 == 0) continue;
        const Vec3 site = 0.5 * edge * Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
        const double share = share_taken(0.5 * static_cast<double>(i) / depth);
        const std::size_t number = candidates.size();
        candidates.push_back({site, number, Random::uniform_of(seed, number) / share});
      }
    }
  }
  // Taking every site of priority below 1 would draw each with its share; taking the lowest ones draws the same way and
  // meets the number of atoms asked for exactly.
  const std::size_t wanted = std::max(atoms, sample.atoms.size()) - sample.atoms.size();
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.priority < b.priority; });
  candidates.resize(std::min(wanted, candidates.size()));
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.number < b.number; });
  for (const Candidate& candidate : candidates) {
    sample.truth.extras.push_back(static_cast<Index>(sample.atoms.size()));
    sample.atoms.positions.push_back(candidate.site);
    sample.atoms.species.push_back(hydrogen);
  }
  return sample;
}

}  // namespace atomesh
