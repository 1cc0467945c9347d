// The slivers that rounding leaves in a perfect crystal.
#pragma once

#include <span>
#include <vector>

#include "core/geometry.h"
#include "core/progress.h"

namespace atomesh {

// In a crystal many atoms share each empty sphere. Where their coordinates say so exactly, a mesher cuts that sphere's
// polytope into whole tetrahedra; where rounding has moved them by an ulp, Delaunay's rule, taken literally, slips
// tetrahedra with no thickness between four atoms of one circle. They have no volume to speak of, an angle of zero, and
// are a third of the cells of a crystal that is turned.
//
// When there are such slivers (thinner than sliver_thickness times their longest edge), all tetrahedra with the same
// circumsphere (to sliver_sphere_tolerance of its radius) are gathered into their polytope, and each polytope is cut
// anew by pull_polytope(), in the order of the atoms' coordinates: the result depends neither on the atoms' numbering
// nor on the mesher. Slivers on the hull go as well. What comes out is checked
// (no inverted cell, the same volume and hull area) and is Delaunay as validate() means it; should the check fail, as
// it may where slivers of every thickness stand side by side, nothing is changed. Returns the number of slivers
// removed.
std::size_t remove_slivers(std::vector<Tetrahedron>& tetrahedra, std::span<const Vec3> points,
                           Progress& progress = no_progress());

inline constexpr double sliver_thickness = 1e-8;
inline constexpr double sliver_sphere_tolerance = 1e-7;

}  // namespace atomesh
