// Free vertices pulled onto a neighbour, shortest edges first.
#pragma once

#include <array>

#include "core/progress.h"
#include "preprocess/star_mesh.h"

namespace atomesh {

// Among targets whose distance is within this factor of the nearest allowed one, the one that leaves the fattest
// tetrahedra is taken.
inline constexpr double collapse_near = 1.25;

// Tetrahedra of a worse shape (see shape_of() in cavity.h) than the first are not made, and once nothing more goes
// without, those worse than the second. In crystals of 10^4 to 10^6 atoms with a few defects 0.03 alone leaves about
// one in a hundred of the vertices that could go and angles of 2.5° at least; 0.01 after it one in three hundred, and
// 1°; without any limit it would be one in a thousand and angles as small as rounding lets them.
inline constexpr std::array<double, 2> collapse_shapes{0.03, 0.01};

// `free` is 1 for the vertices that may go, which must be inside the mesh; `kept` is 1 for those whose tetrahedra may
// not change, none of them next to a free one.
//
// A free vertex goes by the collapse of one of its edges onto the other end, which stays where it is. Only the star of
// the one that goes changes: its link is a polyhedron, and the other end must see every triangle of it strictly from
// within (certain: signs that rounding could change are refused or decided exactly). That is the link condition, and
// more. The new tetrahedra are all positive and have the polyhedron's triangles for their free faces, so they fill it
// once: volume and boundary stay. A vertex, edge or triangle that the links of both ends share without the edge's own
// link having it would span an edge, triangle or tetrahedron that the mesh has outside the polyhedron and that the fill
// has inside – the same straight piece in two places, which cannot be as long as no two tetrahedra overlap. This holds
// for an end on the boundary too, whose link Dey, Edelsbrunner, Guha and Nekhayev (1999, Publ. Inst. Math. 66,
// section 4) complete with a cone: the cone's apex is not in the link of the vertex that goes, which is inside; and
// however many sheets of the surface meet in the end that stays, none of them is touched.
//
// In a perfect crystal the ends that are near enough often lie in one plane with triangles of the polyhedron: the
// collapse would flatten what is behind these. Then the tetrahedra beyond such triangles are taken into the polyhedron,
// which is a flip of them before the collapse: see Cavity. Without that nothing at all can go from diamond.
//
// Clears `free` for the vertices that went and returns their number. One thread; the result depends on nothing but the
// mesh.
std::size_t collapse_edges(StarMesh& mesh, std::vector<std::uint8_t>& free, const std::vector<std::uint8_t>& kept,
                           Progress& progress);

}  // namespace atomesh
