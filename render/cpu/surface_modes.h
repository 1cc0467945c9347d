// The two modes that need the surface alone (seed 5.3.3, 5.3.4, A.6): lit opaque polygons, and the thickness of the
// sample along each ray. Neither touches a tetrahedron.
#pragma once

#include <memory>

#include "render/renderer.h"

namespace atomesh {

// Mode surface: the nearest triangle in front of the eye, by Phong's model. Channels depth and id.
std::unique_ptr<Frame> prepare_surface(const Scene& scene, const Camera& camera, const Parameters& parameters,
                                       const PixelWindow& window, RenderStats& stats, const Progress& progress);

// Mode xray: opacity min(1, alpha_length · thickness). Channel thickness. An eye inside the sample counts from itself.
std::unique_ptr<Frame> prepare_xray(const Scene& scene, const Camera& camera, const Parameters& parameters,
                                    const PixelWindow& window, RenderStats& stats, const Progress& progress);

}  // namespace atomesh
