// The radius at which carve() would carve a crystal, told from its pattern.
#pragma once

#include <span>

#include "core/geometry.h"
#include "core/progress.h"
#include "preprocess/lattice_template.h"

namespace atomesh {

struct PatternRadius {
  double radius = 0.0;   // Å, by carve()'s automatic rule, for a sample that is all inside
  bool certain = false;  // every atom has the same void around it, so surfaces have little say
};

// `matrix`: the vectors as they are in the sample, strained or not against the template's.
PatternRadius pattern_radius(const LatticeTemplate& pattern, const Mat3& matrix);

// The same rule applied to a Delaunay mesh that lacks all tetrahedra above some radius. What is missing at a vertex on
// its outside is not known, so the rule can only be enclosed; where no tetrahedron lies between, that does not matter.
struct RadiusBounds {
  double least = 0.0, largest = 0.0;  // Å
  std::size_t between = 0;            // tetrahedra above the least and up to the largest
};
RadiusBounds enclose_radius(std::span<const Tetrahedron> tetrahedra, std::span<const Vec3> points,
                            Progress& progress = no_progress());

}  // namespace atomesh
