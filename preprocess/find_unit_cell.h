// Atoms → Crystal: the unit cell that the atoms themselves repeat, and where its grains lie.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/atoms.h"
#include "core/progress.h"
#include "preprocess/crystal.h"

namespace atomesh {

struct FindCellOptions {
  // Share of the atoms that a cell must explain; below it the search goes on and, at its end, refuses.
  double least_explained = 0.5;
  std::size_t largest_basis = 64;  // atoms of a primitive cell that are looked for
  std::uint64_t seed = 1;          // of the choice of atoms that are asked
};

// One grain as it lies in the sample.
struct Grain {
  Mat3 rotation{1.0};     // turns grains[0]'s cell into this grain's; the smallest among the crystal's equivalents
  std::size_t atoms = 0;  // that belong to it
  Vec3 center{0.0};       // Å, mean of their positions
};

struct FindCellReport {
  bool found = false;
  // Share of the atoms that sit on a site of the cell (of their grain), within a quarter of the distance between sites;
  // where the crystal lies may differ a little from place to place (strain, a slid layer). Half the distance would
  // explain three quarters of a gas.
  double explained = 0.0;
  // Of those, the share that is of another species than most atoms on the site: impurities, the rarer species of an
  // alloy.
  double foreign = 0.0;
  double displacement = 0.0;  // Å, rms of those atoms from their sites, per axis: thermal noise, strain, rounding
  std::vector<Grain> grains;  // most atoms first; one for a single crystal
  // When refused: one sentence, what was tried and what the best candidate explained.
  std::string why;
  std::vector<std::string> notes;
};

// Primitive (reduced) vectors and basis of the crystal, least-squares fitted to the atoms and then symmetrized() within
// what the fit can tell apart (eight standard errors; where the atoms are off their sites at all, at least 0.1 % of the
// nearest-neighbour distance), its orientation the sample's. Works with vacancies, foreign atoms, thermal noise, vacuum
// around the sample, periodic or open boxes, in any orientation; a strained or cracked sample gives the cell of its
// greater part. Several grains: one cell each. Returns a Crystal that is not known() when nothing repeats (a glass,
// fewer than some tens of atoms) and says why. Same result at any number of threads and for any order of the atoms.
Crystal find_unit_cell(const Atoms& atoms, const FindCellOptions& options, FindCellReport& report,
                       Progress& progress = no_progress());

// What spglib says of a cell.
struct SpaceGroup {
  int number = 0;                               // 1 … 230
  std::string symbol;                           // international (Hermann–Mauguin), short: "Fm-3m"
  std::string point_group;                      // "m-3m"
  UnitCell conventional;                        // standardised, in spglib's own orientation, not the sample's
  double a = 0.0, b = 0.0, c = 0.0;             // Å, of the conventional cell
  double alpha = 0.0, beta = 0.0, gamma = 0.0;  // degrees
};
// `tolerance` Å: how far atoms may be from symmetric places; 0: 2 % of the nearest-neighbour distance, enough
// for what noise of 3 % leaves of error in a cell fitted to some thousand atoms. Nothing when
// spglib finds no group for it.
std::optional<SpaceGroup> find_space_group(const UnitCell& cell, double tolerance = 0.0);

// The same crystal with the symmetry it has within `tolerance` (Å) exact: its vectors and positions averaged over the
// operations of its space group, basis[0] and the orientation kept as nearly as that allows. What a cell fitted to
// noisy atoms is to a perfect crystal: its empty spheres hold all their atoms again. Nothing when spglib finds no group
// or a place would move by more than four tolerances.
std::optional<UnitCell> symmetrized(const UnitCell& cell, double tolerance);

}  // namespace atomesh
