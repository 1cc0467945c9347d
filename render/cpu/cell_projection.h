// Volume rendering of tetrahedra by cell projection (seed 5.3.1, 5.3.2, A.5): the cells under each tile of the picture,
// each intersected with sixteen rays at a time, ordered per block of 4×4 pixels and composed front to back.
//
// Any set of cells that do not overlap is drawn right, cyclic ones included; where cells overlap, the one whose entry
// is nearer comes first. Rays pass 2.4e-7 of a pixel beside the pixel's centre (cell_projection_kernel.h says why). The
// surface's layers, which are either met or not, are met by the rays of mode surface, 4e-9 of a pixel beside.
//
// Where most vertices have one colour (mode volume_surface; a crystal with few defects), cells that have only such
// vertices are not projected: uniform_medium.h. Such a cell counts in RenderStats::steps with the stretch it is part
// of.
//
// Memory beyond the scene. For the frame: 33 bytes a vertex (6 bytes a tetrahedron of a Delaunay mesh), 4 bytes for
// each tile of 32×32 pixels that a cell touches (of small cells 4 to 8 bytes a tetrahedron), in mode volume_surface as
// much for each that a surface triangle touches, 512 bytes a tile; while it is prepared 12 bytes for each cell of a
// part of the mesh that a thread is at (at most 1/64 of it, or 4096 cells). For each thread that draws: about 350 bytes
// for each of the cells that are set up at once (a tile's, 32,768 of them at most, or as many as one block of 4×4
// pixels has) and 200 for each of a block's. Measured, two threads, RGBA, everything together at its peak: 0.3 M cells
// at 1024² 22 bytes a tetrahedron, 1.3 M 17, 6.7 M 14; 6.7 M cells at 32², 100² and 300² 9, 16 and 15.
#pragma once

#include <memory>

#include "core/camera.h"
#include "core/parameters.h"
#include "core/progress.h"
#include "render/renderer.h"
#include "render/scene.h"

namespace atomesh {

// Modes volume_surface and volume (Scene::mode says which), integrated as `parameters` say. Vertices are projected and
// cells sorted into the tiles under the window here, once for all drawing. No channels. Throws CancelledError.
std::unique_ptr<Frame> prepare_cell_projection(const Scene& scene, const Camera& camera, const Parameters& parameters,
                                               const PixelWindow& window, RenderStats& stats, const Progress& progress);

}  // namespace atomesh
