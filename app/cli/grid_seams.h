// Where structured grids close on themselves or touch: the turns of their hexahedra's diagonals need not match there.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "app/cli/mesh_cells.h"

namespace atomesh::cli {

// For split_hexahedron(): the diagonals of those cells, by cell, that must differ from the grid's own (all alike, in
// turns) for two cells to agree on a face that they share over the border of their blocks. `vertex_of` are the points'
// vertices, one for points of one place; `blanked` cells do not count. Where no choice of diagonals fits, the cell
// keeps its own.
std::unordered_map<std::uint64_t, unsigned> seam_diagonals(std::span<const StructuredBlock> blocks,
                                                           std::span<const Index> vertex_of,
                                                           const std::vector<bool>& blanked);

}  // namespace atomesh::cli
