// A volume of fewer cells, for pictures that must be quick.
#pragma once

#include <cstddef>

#include "core/progress.h"
#include "render/scene.h"

namespace atomesh::gl {

// A scene of mode volume like this one of about so many cells, mostly fewer: the vertices in each box of a grid become
// one, that of the largest scalar, so that what stands out stays, and of equal ones the outermost; cells with two
// corners in one box are gone (vertex clustering, Rossignac and Borrel 1993). Those left fill the space of those there
// were, but for the outline, which may be off by a box, and for places that are filled more than once. Holds no solids.
// Throws CancelledError.
Scene coarse_volume(const Scene& volume, std::size_t cells, Progress& progress = no_progress());

}  // namespace atomesh::gl
