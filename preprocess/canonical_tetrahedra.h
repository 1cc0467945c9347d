// One order for one set of tetrahedra, however a mesher (and its threads) came by it.
#pragma once

#include <vector>

#include "core/geometry.h"
#include "core/progress.h"

namespace atomesh {

// The even permutation of the four vertices that puts the smallest first and the next smallest second; orientation is
// kept.
Tetrahedron canonical(Tetrahedron tetrahedron);

// Canonical tetrahedra in lexicographic order. Indices are below `vertices`. Takes 12 bytes a tetrahedron and up to 24
// a vertex.
void put_in_canonical_order(std::vector<Tetrahedron>& tetrahedra, std::size_t vertices,
                            Progress& progress = no_progress());

}  // namespace atomesh
