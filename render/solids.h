// Opaque things in a volume: drawn first, they end the rays of what is in front of them.
#pragma once

#include "render/renderer.h"

namespace atomesh {

// `volume` where the scene has no solids. Else a frame that draws them by `renderer`, then the volume up to them
// (Channels::ray_end), and lays it over them. Keeps what `volume` keeps. Beyond that 20 bytes for each pixel of the
// window while it draws.
std::unique_ptr<Frame> with_solids(std::unique_ptr<Frame> volume, const Renderer& renderer, const Scene& scene,
                                   const Camera& camera, const Parameters& parameters, const PixelWindow& window,
                                   RenderStats& stats, Progress& progress);

}  // namespace atomesh
