// Free vertices taken out of a Delaunay mesh so that it stays one.
#pragma once

#include "core/progress.h"
#include "preprocess/star_mesh.h"

namespace atomesh {

// `free` is 1 for the vertices that may go; they must be inside the mesh, which must be a subset of a Delaunay
// tetrahedralization. They go one by one, shortest edge first; the hole each leaves, its star, is filled with the
// Delaunay tetrahedra of the vertices around it. All other tetrahedra stay as they are: their spheres are as empty as
// before. Where several vertices share a sphere the fill is cut so that its free faces are those of the hole, by one of
// the two rules meshes are made with; a vertex whose hole fits neither stays.
//
// Clears `free` for the vertices that went and returns their number. One thread; the result depends on nothing but the
// mesh.
std::size_t remove_vertices(StarMesh& mesh, std::vector<std::uint8_t>& free, Progress& progress);

// A vertex with more tetrahedra than this stays: the time to fill a hole grows with the square of them.
inline constexpr std::size_t remove_largest_star = 1024;

}  // namespace atomesh
