// One place of a sample → the unit cell that repeats around it.
#pragma once

#include <optional>
#include <string>

#include "preprocess/fitted_cell.h"

namespace atomesh {

// How far translations are looked for, in edges of the cube an atom has for itself: the first finds most crystals, the
// second holds 64 atoms in any compact cell, the third a cell twice as long as that.
inline constexpr std::array<double, 3> translation_reaches{4.2, 7.0, 11.0};

struct ProposeOptions {
  std::size_t largest_basis = 64;
  double reach = translation_reaches.front();
  std::size_t seeds = 400;  // atoms that judge translations, nearest to the place: few see a small undisturbed region
  bool tell_species = true;
};

struct CellProposal {
  std::optional<FittedCell> cell;
  // Share of the cell's sites that hold an atom. A lattice too fine has sites enough for any atom, and many that hold
  // none (the three places of a graphite layer, of which each layer takes two).
  double occupancy = 1.0;
  double best_translation = 0.0;  // the highest share of atoms a translation mapped on atoms
};

// Translations, lattice, basis, fit: what the atoms around `center` repeat. The cell is checked there: at least 60 % of
// the atoms near `center` sit on its sites.
CellProposal propose_cell(const Atoms& atoms, const Vec3& center, const LocalScale& scale,
                          const ProposeOptions& options, Progress& progress);

// The basis of a lattice: the points within `radius` of the cluster's centre folded into one cell; places that at least
// half of the cells have are sites, of the species most of them hold. Nothing when there are more than `largest` sites.
std::optional<FittedCell> collect_basis(const LocalCluster& cluster, double radius, const Mat3& lattice,
                                        const LocalScale& scale, std::size_t largest);

}  // namespace atomesh
