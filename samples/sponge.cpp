// A sponge of silicon in oxide: the oxide is the empty space. The shape comes from a phase-field run of spinodal
// decomposition at 40 vol. % silicon, where both phases stay connected; cutting the diffuse interface on its silicon
// side leaves the 30 vol. % of the seed, as if the suboxide of the interface were oxide. What is left is filled with
// diamond sites, each moved at random.
#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "samples/crystal.h"
#include "samples/generators.h"
#include "samples/random.h"
#include "samples/spinodal.h"

namespace atomesh {

namespace {

constexpr double edge = 5.431;         // Å
constexpr double silicon_share = 0.3;  // of the volume
constexpr double largest_move = 0.12;  // Å along each axis; bonds of 2.35 Å keep at least 1.93 Å

}  // namespace

Sample grow_sponge(std::size_t atoms, std::uint64_t seed, Progress& progress) {
  const auto cells = static_cast<std::size_t>(std::lround(std::cbrt(static_cast<double>(atoms) / silicon_share / 8.0)));
  Atoms crystal = build_block(zinc_blende_cell("Si", "Si", edge), {{cells, cells, cells}});

  progress.stage("decompose");
  SpinodalOptions options;
  options.side = edge * static_cast<double>(cells);
  options.seed = seed;
  const PhaseField field = decompose(options, progress);

  progress.stage("fill");
  std::vector<double> silicon(crystal.size());
  parallel_for(crystal.size(), 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      silicon[i] = field.at(crystal.positions[i]);
      for (int axis = 0; axis < 3; ++axis) {
        const double random = Random::uniform_of(seed + 1, 3 * i + static_cast<std::size_t>(axis));
        crystal.positions[i][axis] += largest_move * (2.0 * random - 1.0);
      }
    }
  });
  // The sites richest in silicon, as many as were asked for: the level at which the interface is cut follows from the
  // count.
  std::vector<Index> richest(crystal.size());
  for (std::size_t i = 0; i < richest.size(); ++i) richest[i] = static_cast<Index>(i);
  const auto wanted = richest.begin() + static_cast<std::ptrdiff_t>(std::min(atoms, richest.size()));
  std::nth_element(richest.begin(), wanted, richest.end(),
                   [&](Index a, Index b) { return silicon[a] != silicon[b] ? silicon[a] > silicon[b] : a < b; });
  richest.erase(wanted, richest.end());
  std::sort(richest.begin(), richest.end());

  Sample sample;
  sample.atoms = crystal.subset(richest);
  return sample;
}

}  // namespace atomesh
