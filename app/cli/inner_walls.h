// Walls inside a mesh whose cells do not share their faces: hanging vertices, faces that neighbours split differently.
#pragma once

#include <cstdint>
#include <span>

#include "core/surface.h"

namespace atomesh::cli {

// Triangles of the surface that lie back to back on another one: in one plane to 1e-4 rad, of opposite normals, with a
// common vertex and overlapping next to it. Where a coarse cell touches finer ones its corners are theirs too, so one
// is found for each coarse face; walls without a common vertex, and those at vertices where more than 256 triangles
// meet, are not.
std::uint64_t count_inner_walls(const Surface& surface, std::span<const Vec3> vertices);

}  // namespace atomesh::cli
