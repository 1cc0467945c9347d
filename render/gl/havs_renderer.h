// The renderer "havs": mode volume on OpenGL without a window (Volume on a HeadlessContext, both made when first asked
// for). The other modes are the renderer "cpu"'s: UsageError. Throws UnavailableError where there is no sufficient
// OpenGL.
//
// Not to the last bit what Frame promises, but to rounding: of windows, lattices and threads.
#pragma once

#include "render/renderer.h"

namespace atomesh {

const Renderer& havs_renderer();

}  // namespace atomesh
