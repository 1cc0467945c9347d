// Mode atoms on the CPU: rays through a bounding-volume hierarchy of spheres (Embree).
#pragma once

#include "render/renderer.h"

namespace atomesh {

// Draws scene.balls as render/shared/optics.h has it. Embree, in float, only proposes spheres, slightly enlarged so
// that it misses none; whether, where and in what order the ray meets them is decided in double. A ray stops where less
// than `faintest` of the light behind would come through, so a channel is off by at most that.
//
// RenderStats: setup_ms is the hierarchy, steps the number of balls composed. Channels: depth, id (Ball::atom).
// Throws UnavailableError when Embree cannot start or runs out of memory.
Image draw_atom_balls(const Scene& scene, const Camera& camera, const Parameters& parameters, RenderStats& stats,
                      const Channels& channels, Progress& progress);

inline constexpr double faintest = 1e-3;

}  // namespace atomesh
