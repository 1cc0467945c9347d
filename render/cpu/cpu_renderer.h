// The renderer "cpu": all five modes, vectorised, on all cores.
#pragma once

#include "render/renderer.h"

namespace atomesh {

const Renderer& cpu_renderer();

}  // namespace atomesh
