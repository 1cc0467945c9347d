// What stamping leaves open, filled.
#pragma once

#include <optional>
#include <vector>

#include "preprocess/stamp_sample.h"

namespace atomesh {

// The Delaunay cells of radius up to largest_radius that are not stamped, from a triangulation of the open points
// alone. Nothing when they do not fit the stamped ones without gap or overlap: where the corners of polytopes leave
// their spheres by about as much as the tolerance allows, the two disagree about which points share one.
std::optional<std::vector<Tetrahedron>> fill_open(const StampedSample& sample, const LatticeSites& sites,
                                                  std::span<const Index> open, Progress& progress);

}  // namespace atomesh
