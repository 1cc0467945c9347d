// CGAL as everybody calls it, for the bench to compare with.
#pragma once

#include <cstddef>
#include <span>

#include "core/geometry.h"

namespace atomesh {

// Delaunay_triangulation_3 over EPICK from an iterator range, sequential, nothing of ours in it. Returns the number of
// finite cells. Cannot be cancelled.
std::size_t delaunay_cgal_stock(std::span<const Vec3> points);

}  // namespace atomesh
