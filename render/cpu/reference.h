// The judge: a slow renderer in double precision that integrates every ray exactly, against which the others are
// tested.
//
// Each pixel's ray is intersected with every cell (or triangle, or ball) that may touch the pixel; what it meets is
// sorted by depth and composed front to back without early termination. Cells, surface triangles and balls are found
// independently of each other and of any neighbourhood. Two choices make it a judge:
//   - Whether a ray meets a face is decided exactly, from the vertices in view coordinates as they are in double; ties
//     (a ray through a vertex, along an edge, inside a face) are broken as if the ray stood an infinitely small ε
//     further right and ε² further up. So along every ray the cells join without gap or overlap.
//   - A segment's integral is converged to the rounding of double, see reference_optics.h.
// Balls are met by the shared lines of render/shared/ball_ray.h, here tried one by one.
// It starts from the same Scene in float as the other renderers, so differences to them are arithmetic only.
// Meant for small scenes: 10⁵ tetrahedra at 256×256 take seconds.
#pragma once

#include "render/renderer.h"

namespace atomesh {

const Renderer& reference_renderer();

}  // namespace atomesh
