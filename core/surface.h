// The boundary of a volume: the faces that belong to one tetrahedron only.
#pragma once

#include <string>
#include <vector>

#include "core/geometry.h"
#include "core/tet_mesh.h"

namespace atomesh {

// Closed (every directed edge is met by as many opposite ones) and outward: corners counter-clockwise seen from
// outside. Corners index the mesh's vertices.
struct Surface {
  std::vector<Triangle> triangles;
  // Of each triangle: the tetrahedron behind it (index into TetMesh::tetrahedra), and which of its faces it is.
  std::vector<Index> tetrahedron;
  std::vector<std::uint8_t> face;
};

// The faces shared by no other tetrahedron, ordered by (tetrahedron, face). Takes 8 bytes a tetrahedron beside the
// result. Throws Error when a face belongs to more than two.
Surface extract_surface(const TetMesh& mesh, Progress& progress = no_progress());

// Outward unit normal of each triangle.
std::vector<Vec3f> face_normals(std::span<const Triangle> triangles, std::span<const Vec3> vertices);

// Unit normal of each mesh vertex: the average of the normals of the triangles around it weighted by their angle at
// the vertex, zero for vertices inside. Indexed like `vertices`.
std::vector<Vec3f> vertex_normals(std::span<const Triangle> triangles, std::span<const Vec3> vertices);

double area(const Surface& surface, std::span<const Vec3> vertices);  // Å²
// Volume enclosed, by the divergence theorem about the surface's centre, Å³.
double enclosed_volume(const Surface& surface, std::span<const Vec3> vertices);
bool is_closed(const Surface& surface, Progress& progress = no_progress());

// What is wrong with the surface of this mesh, in words: not closed, not outward, not the mesh's own boundary.
std::vector<std::string> validate(const Surface& surface, const TetMesh& mesh, std::size_t limit = 10,
                                  Progress& progress = no_progress());

}  // namespace atomesh
