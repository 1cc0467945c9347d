// Cells of other shapes into tetrahedra, so that neighbours agree on the diagonals of the faces they share. Topology
// only: what comes out is positively oriented where the cell is convex and its corners stand in the order below.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry.h"

namespace atomesh {

// Corners in VTK's order: bases counter-clockwise seen from the inside (of the wedge from the outside), then the top in
// the same order, or the pyramid's apex.
enum class CellShape : std::uint8_t { tetrahedron, pyramid, wedge, hexahedron, pentagonal_prism, hexagonal_prism };

std::size_t corner_count(CellShape shape);

// Appends the cell's tetrahedra. Every face of four or more corners is split from its smallest vertex number, the rest
// follows: 2 tetrahedra from a pyramid, 3 from a wedge, 5 or 6 from a hexahedron (Dompierre, Labbé, Vallet, Camarero
// 1999, "How to subdivide pyramids, prisms and hexahedra into tetrahedra"). Corners may be named more than once (a
// hexahedron with a collapsed edge); tetrahedra that would name a vertex twice are not made. Throws Error when the
// number of corners is not the shape's.
void split_cell(CellShape shape, std::span<const Index> corners, std::vector<Tetrahedron>& tetrahedra);

// The same for a convex polyhedron given by its faces, each outward.
void split_polyhedron(std::span<const std::vector<Index>> faces, std::vector<Tetrahedron>& tetrahedra);

// The faces of a hexahedron by its corners 0 to 7, outward. Each has one diagonal between two of the corners 0, 2, 5, 7
// and one between two of 1, 3, 4, 6.
inline constexpr std::array<std::array<int, 4>, 6> hexahedron_faces{
    {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};

// A hexahedron by chosen diagonals: bit f of `odd` takes the diagonal of face f between 1, 3, 4, 6, else that between
// 0, 2, 5, 7. All alike give 5 tetrahedra, else 6. False, and nothing appended, for the few choices that cannot be met
// without a new vertex.
bool split_hexahedron(std::span<const Index, 8> corners, unsigned odd, std::vector<Tetrahedron>& tetrahedra);

}  // namespace atomesh
