// Which site of the crystal each atom sits on.
#pragma once

#include <cstdint>
#include <vector>

#include "core/atoms.h"
#include "core/progress.h"
#include "preprocess/crystal.h"
#include "preprocess/lattice_template.h"

namespace atomesh {

inline constexpr std::uint16_t no_patch = 0xFFFF;

// Basis atom `basis` in cell (i, j, k) of a patch.
struct LatticeSite {
  std::array<std::int32_t, 3> cell{};
  std::uint16_t basis = 0;
  std::uint16_t patch = no_patch;  // no_patch: the atom sits on no site

  friend bool operator==(const LatticeSite&, const LatticeSite&) = default;
};

// Atoms that one walk over the crystal reached: their sites are numbered from one origin.
struct LatticePatch {
  std::uint16_t pattern = 0;  // into LatticeSites::patterns
  std::size_t atoms = 0;
  // Least-squares fit of the patch: site (c, b) is at origin + matrix·(c + fractional basis position of b).
  Mat3 matrix{1.0};
  Vec3 origin{0.0};
  double rms = 0.0, largest = 0.0;           // Å, of the atoms from the fitted sites
  std::array<std::int32_t, 3> min{}, max{};  // cells it spans, both included
};

struct LatticeSites {
  std::vector<LatticeTemplate> patterns;                    // one a grain's cell
  std::vector<LatticePatch> patches;                        // most atoms first
  std::vector<LatticeSite> of;                              // of each atom
  std::vector<Vec3> fractional(std::size_t pattern) const;  // of the pattern's basis atoms, in its vectors
};

struct LatticeSiteOptions {
  // Å within which an atom occupies the site that its neighbours predict; 0: 0.3 × the nearest-neighbour distance.
  double tolerance = 0.0;
  // Patches of fewer atoms are given up; their atoms sit on no site.
  std::size_t smallest_patch = 64;
};

// The breadth-first walk of the seed's A.2 (algorithm 13): from a seed atom to the cells around it, each site predicted
// from the atoms already placed near it, so that strain may add up over the sample while vacancies, foreign atoms and
// cavities are stepped over. A site takes the nearest atom within the tolerance, whatever its species; two atoms never
// share a site. Where the walk meets itself with other numbers (a dislocation) the atoms stay with the numbers that
// came first. What it does not reach (a slid layer, another grain) starts a patch of its own. Same result at any number
// of threads.
LatticeSites assign_lattice_sites(const Atoms& atoms, const Crystal& crystal, const LatticeSiteOptions& options,
                                  Progress& progress = no_progress());

// Finds the atom on a site. Dense where the patch is compact, hashed where it is not.
class SiteTable {
 public:
  SiteTable(const LatticeSites& sites, std::uint16_t patch);
  // no_index where no atom sits.
  Index atom(const std::array<std::int32_t, 3>& cell, std::uint16_t basis) const;

 private:
  std::array<std::int32_t, 3> min_{}, size_{};
  std::size_t basis_ = 0;
  std::vector<Index> dense_;
  std::vector<std::uint64_t> keys_;
  std::vector<Index> values_;
};

}  // namespace atomesh
