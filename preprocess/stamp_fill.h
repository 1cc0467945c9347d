// What stamping leaves open, filled.
#pragma once

#include <vector>

#include "preprocess/stamp_sample.h"

namespace atomesh {

struct Filling {
  std::vector<Tetrahedron> tetrahedra;
  // Points, ascending, where these and the stamped ones do not fit without gap or overlap: where the corners of
  // polytopes leave their spheres by about as much as the tolerance allows, the two disagree about which points share
  // one.
  std::vector<Index> conflict;
};

// The Delaunay cells of radius up to largest_radius that are not stamped, from a triangulation of the open points
// alone, and copies of those found at models.
Filling fill_open(const StampedSample& sample, const OpenPoints& points, Progress& progress);

}  // namespace atomesh
