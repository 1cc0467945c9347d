// Volume rendering of tetrahedra by cell projection (seed 5.3.1, 5.3.2, A.5): the cells under each tile of the picture,
// each intersected with sixteen rays at a time, ordered per block of 4×4 pixels and composed front to back.
//
// Any set of cells that do not overlap is drawn right, cyclic ones included; where cells overlap, the one whose entry
// is nearer comes first. Rays pass 6e-5 of a pixel beside the pixel's centre (cell_projection_kernel.h says why): next
// to an exact picture a pixel is off by that share of its difference to its neighbours, beside the rounding of float.
// The surface's layers, which are either met or not, are met by the rays of mode surface, 4e-9 of a pixel beside.
// Memory beyond the scene: 33 bytes a vertex, 4 bytes for each tile of 32×32 pixels that a cell touches, in mode
// volume_surface as much for each that a surface triangle touches, and for each thread what its tile needs.
#pragma once

#include "core/camera.h"
#include "core/image.h"
#include "core/parameters.h"
#include "core/progress.h"
#include "render/renderer.h"
#include "render/scene.h"

namespace atomesh {

// Modes volume_surface and volume (Scene::mode says which), integrated exactly or by samples as `parameters` says.
// Premultiplied RGB and coverage. The picture does not depend on the number of threads.
Image draw_cell_projection(const Scene& scene, const Camera& camera, const Parameters& parameters, RenderStats& stats,
                           Progress& progress);

}  // namespace atomesh
