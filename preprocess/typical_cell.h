// The cell of the greater part of a strained sample.
#pragma once

#include <optional>

#include "preprocess/explain_atoms.h"

namespace atomesh {

// A fit around one place has that place's strain. Each block (at most some thousands, evenly chosen) tells how the cell
// is deformed in it; the median over the blocks is what most of the crystal has, whatever a dot, a crack or a
// dislocation does to the rest, and so for the sites. Nothing where the fit is the better measure: the blocks
// differ by noise alone, or the fit saw most of the sample and the median does not differ from it beyond doubt.
std::optional<FittedCell> typical_cell(const Atoms& atoms, const StrainBlocks& blocks, const FittedCell& cell,
                                       const Claims& claims, Progress& progress);

}  // namespace atomesh
