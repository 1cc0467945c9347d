// A convex polytope with all its corners on one sphere, cut into tetrahedra so that polytopes that share a face cut it
// alike.
#pragma once

#include <span>
#include <vector>

#include "core/geometry.h"

namespace atomesh {

inline constexpr std::size_t pull_polytope_corners = 64;  // at most

// The pulling triangulation (de Loera, Rambau, Santos, Triangulations, 2010, section 4.3.2): the corner of lowest rank
// is joined to the triangles of the faces that do not contain it, and each face is a fan about its own corner of lowest
// rank. Corners within `tolerance` (Å) of the plane of a face count to it, so none of the tetrahedra is flatter than
// that. `corners` are indices into points, at least 4 of them; ranks must be distinct. Appends positively oriented
// tetrahedra; returns false, with some of them appended, when the corners span no volume.
bool pull_polytope(std::span<const Index> corners, std::span<const Vec3> points, std::span<const Index> rank,
                   double tolerance, std::vector<Tetrahedron>& tetrahedra);

}  // namespace atomesh
