// Mode atoms on the CPU.
#pragma once

#include <memory>

#include "render/renderer.h"

namespace atomesh {

// How the balls of a ray are found, see ball_traversal.h. All give the same picture to the last bit.
enum class BallSearch { automatic, projection, hierarchy };

// Draws scene.balls as render/shared/optics.h has it. A ray stops where no more than `faintest` of the light behind
// would come through, so a channel is off by at most that. `automatic` projects unless that takes more than
// `most_projected_entries`.
//
// RenderStats: setup_ms is the search's preparation, steps the number of balls composed. Channels: depth, id
// (Ball::atom). Throws UnavailableError when Embree cannot start or runs out of memory, CancelledError.
std::unique_ptr<Frame> prepare_atom_balls(const Scene& scene, const Camera& camera, const Parameters& parameters,
                                          const PixelWindow& window, RenderStats& stats, const Progress& progress,
                                          BallSearch search = BallSearch::automatic);

inline constexpr double faintest = 1e-3;
inline constexpr std::size_t most_projected_entries = std::size_t{1} << 24U;

}  // namespace atomesh
