// Puts more vertices into a mesh.
#pragma once

#include <span>
#include <vector>

#include "core/geometry.h"
#include "core/progress.h"

namespace atomesh {

// Each of `added` (indices into points) becomes a vertex of the tetrahedra around it: those that contain it, and with
// them those whose circumsphere it lies in, as long as what they make together is star-shaped about the point and keeps
// all its own vertices (Bowyer and Watson's cavity, which a mesh that is not Delaunay may refuse), are replaced by
// tetrahedra from the point to their outside. Every one of these is positively oriented (exactly). All tetrahedra given
// are. Points that lie in none are returned, ascending; the nearest vertex of the tetrahedra around a point must be
// within `reach` Å of it.
std::vector<Index> insert_points(std::vector<Tetrahedron>& tetrahedra, std::span<const Vec3> points,
                                 std::span<const Index> added, double reach, Progress& progress = no_progress());

}  // namespace atomesh
