// Volume rendering of tetrahedra by cell projection (seed 5.3.1, 5.3.2, A.5): the cells under each tile of the picture,
// each intersected with sixteen rays at a time, ordered per block of 4×4 pixels and composed front to back.
//
// Any set of cells that do not overlap is drawn right, cyclic ones included; where cells overlap, the one whose entry
// is nearer comes first. Memory beyond the scene: 24 bytes a vertex, 1 to 5 bytes a cell, 4 bytes for each tile a cell
// touches, and what one tile needs for each thread.
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
