// Whether what is filled fits what is stamped.
#pragma once

#include <vector>

#include "preprocess/gather_polytopes.h"
#include "preprocess/stamp_sample.h"

namespace atomesh {

inline PolytopeTolerance tolerance_of(const StampedSample& sample) {
  return {0.2 * sample.options().tolerance, sample.options().tolerance};
}

// Corners of triangles where filled and stamped cells overlap or leave a gap: triangles seen twice from one side, and
// those seen from one side only with a cell to miss behind them. What is seen at a copy is seen at its model, so only
// triangles at models and unique points are looked at.
std::vector<Index> seam_conflicts(const StampedSample& sample, const OpenPoints& points,
                                  const std::vector<Tetrahedron>& filled, Progress& progress);

}  // namespace atomesh
