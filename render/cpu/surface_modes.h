// The two modes that need the surface alone (seed 5.3.3, 5.3.4, A.6): lit opaque polygons, and the thickness of the
// sample along each ray. Neither touches a tetrahedron.
#pragma once

#include "core/camera.h"
#include "core/image.h"
#include "core/parameters.h"
#include "core/progress.h"
#include "render/renderer.h"
#include "render/scene.h"

namespace atomesh {

// Mode surface: the nearest triangle in front of the eye, by Phong's model. Channels depth and id.
Image draw_surface(const Scene& scene, const Camera& camera, const Parameters& parameters, RenderStats& stats,
                   const Channels& channels, Progress& progress);

// Mode xray: opacity min(1, alpha_length · thickness). Channel thickness. An eye inside the sample counts from itself.
Image draw_xray(const Scene& scene, const Camera& camera, const Parameters& parameters, RenderStats& stats,
                const Channels& channels, Progress& progress);

}  // namespace atomesh
