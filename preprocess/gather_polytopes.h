// Delaunay tetrahedra that are pieces of one polytope: what meshers make of many points on one empty sphere.
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry.h"
#include "core/progress.h"

namespace atomesh {

struct PolytopeTolerance {
  double thickness = 1e-8;  // a tetrahedron thinner than this times its longest edge is a sliver
  double sphere = 1e-7;     // of the radius: circumspheres that differ by less are one
};

// 1 for each sliver. Slivers have no sphere to speak of: they belong to no polytope and only lie between its pieces.
std::vector<std::uint8_t> find_slivers(std::span<const Tetrahedron> tetrahedra, std::span<const Vec3> points,
                                       const PolytopeTolerance& tolerance, const Progress& progress = no_progress());

// Joins what has one circumsphere and touches, face to face or with nothing but slivers between: pairs (polytope,
// tetrahedron), ascending, slivers left out. `neighbours` as face_neighbours() has them.
std::vector<std::pair<Index, Index>> gather_polytopes(std::span<const Tetrahedron> tetrahedra,
                                                      std::span<const Vec3> points,
                                                      std::span<const std::array<Index, 4>> neighbours,
                                                      const std::vector<std::uint8_t>& sliver,
                                                      const PolytopeTolerance& tolerance,
                                                      const Progress& progress = no_progress());

// Cuts every polytope of several tetrahedra anew with pull_polytope() and appends all to the result. Ranks as there,
// one a point. False when one of them defies it.
bool cut_polytopes(std::span<const Tetrahedron> tetrahedra, std::span<const Vec3> points,
                   std::span<const std::pair<Index, Index>> members, std::span<const Index> rank,
                   const PolytopeTolerance& tolerance, std::vector<Tetrahedron>& result,
                   const Progress& progress = no_progress());

}  // namespace atomesh
