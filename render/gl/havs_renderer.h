// The renderer "havs": mode volume on OpenGL without a window (Volume on a HeadlessContext, both made when first asked
// for). The other modes are the renderer "cpu"'s: UsageError. Throws UnavailableError where there is no sufficient
// OpenGL.
//
// Not to the last bit what Frame promises: to rounding for windows (half floats, 2^-12, where the order of cells was
// repaired), and for lattices to what a vertex moved by 1/512 of the lattice's step changes.
#pragma once

#include "render/renderer.h"

namespace atomesh {

const Renderer& havs_renderer();

}  // namespace atomesh
