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
  // Places, out of one for every eighty atoms, where the walk met itself with other numbers; a dislocation has some.
  std::size_t seams = 0;
};

struct LatticeSites {
  std::vector<LatticeTemplate> patterns;                    // one a grain's cell
  std::vector<LatticePatch> patches;                        // most atoms first
  std::vector<LatticeSite> of;                              // of each atom
  std::vector<Vec3> fractional(std::size_t pattern) const;  // of the pattern's basis atoms, in its vectors
};

struct LatticeSiteOptions {
  // Å within which an atom occupies the site that its neighbours predict; 0: 0.3 × the nearest-neighbour distance, and
  // never more than 0.45 of it.
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
// Patterns are what make_lattice_template makes of the cells, without polytopes where it refuses. Throws Error for a
// position that is not finite and what check_unit_cell throws; a crystal that is not known gives no patches.
LatticeSites assign_lattice_sites(const Atoms& atoms, const Crystal& crystal, const LatticeSiteOptions& options,
                                  Progress& progress = no_progress());

// Finds the atom on a site. Dense where the patch is compact, hashed where it is not.
class SiteTable {
 public:
  // The cells from min to max, `basis` sites each, of which about `atoms` will be taken.
  SiteTable(const std::array<std::int32_t, 3>& min, const std::array<std::int32_t, 3>& max, std::size_t basis,
            std::size_t atoms);
  SiteTable(const LatticeSites& sites, std::uint16_t patch);

  // no_index where no atom sits; any cell may be asked for.
  Index atom(const std::array<std::int32_t, 3>& cell, std::uint16_t basis) const {
    const std::uint64_t key = key_of(cell, basis);
    if (key == no_key) return no_index;
    return dense_.empty() ? values_[slot(key)] : dense_[key];
  }
  // Puts an atom on a site inside the cells given.
  void put(const std::array<std::int32_t, 3>& cell, std::uint16_t basis, Index atom);

 private:
  static constexpr std::uint64_t no_key = ~std::uint64_t{0};
  std::uint64_t key_of(const std::array<std::int32_t, 3>& cell, std::uint16_t basis) const {
    std::uint64_t key = 0;
    for (int k = 0; k < 3; ++k) {
      const std::int64_t place = std::int64_t{cell[k]} - min_[k];
      if (place < 0 || place >= size_[k]) return no_key;
      key = key * static_cast<std::uint64_t>(size_[k]) + static_cast<std::uint64_t>(place);
    }
    return key * basis_ + basis;
  }
  std::size_t slot(std::uint64_t key) const;  // where it is, or would be, in keys_

  std::array<std::int64_t, 3> min_{}, size_{};
  std::uint64_t basis_ = 0;
  std::vector<Index> dense_;
  std::vector<std::uint64_t> keys_;  // hashed, linear probing
  std::vector<Index> values_;
  std::size_t taken_ = 0;
};

}  // namespace atomesh
