// The grains of a sample whose crystal is known: the same cell turned.
#pragma once

#include <vector>

#include "preprocess/explain_atoms.h"
#include "preprocess/fitted_cell.h"

namespace atomesh {

struct GrainSearch {
  // One cell a grain, most atoms first; each the same crystal turned and fitted in its grain.
  std::vector<FittedCell> cells;
  // Of each atom: the cell of its grain, no_grain where it belongs to none. Empty with one grain.
  std::vector<std::uint16_t> grain_of;
  std::size_t on_site = 0;  // atoms that sit on a site of their grain
  std::size_t foreign = 0;  // of them, of another species than the site's
  double squares = 0.0;     // Å², summed over them, of the distance from the site
};

// Where the first cell (and what it claims) leaves blocks of atoms, the orientation is sought that maps the cell's
// neighbour shells on an atom's neighbours, fitted around that atom and tried on all blocks that no grain fills yet. A
// grain of fewer than `least` atoms is none. An atom that several grains claim goes with the one that claims most of
// its neighbours (the layers that a twin shares with its parent); one that none claims goes with its neighbours where
// they agree (an interstitial) and belongs to no grain where they do not.
GrainSearch find_grains(const Atoms& atoms, const StrainBlocks& blocks, const LocalScale& scale,
                        const FittedCell& first, const Claims& claims, std::size_t least, Progress& progress);

}  // namespace atomesh
