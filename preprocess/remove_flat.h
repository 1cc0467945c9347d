// Flat tetrahedra on the outside of a mesh: what some meshers leave on the faces of a perfect crystal.
#pragma once

#include <span>
#include <vector>

#include "core/geometry.h"

namespace atomesh {

// Removes the tetrahedra of exactly zero volume that can go without leaving a gap, and returns how many: those whose
// faces on one of their two sides all lie on the outside, so that the other side's faces, which cover the same area,
// take over; again and again while there are any. Flat tetrahedra enclosed by others stay. Tetrahedra that are not flat
// are positively oriented.
std::size_t remove_flat_outside(std::vector<Tetrahedron>& tetrahedra, std::span<const Vec3> points);

// How many have exactly zero volume.
std::size_t count_flat(std::span<const Tetrahedron> tetrahedra, std::span<const Vec3> points);

}  // namespace atomesh
