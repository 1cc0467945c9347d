// The volume: tetrahedra with an atom at every vertex.
#pragma once

#include <string>
#include <vector>

#include "core/geometry.h"
#include "core/progress.h"

namespace atomesh {

inline constexpr double delaunay_tolerance = 1e-6;

// Invariants, checked by validate(): every tetrahedron is positively oriented (signed_volume > 0, exactly), names four
// different vertices, and a face is shared by at most two tetrahedra, which see it with opposite orientation.
struct TetMesh {
  std::vector<Vec3> vertices;           // Å
  std::vector<Tetrahedron> tetrahedra;  // indices into vertices
  // Vertex → atom (index into Atoms). Several atoms on one exact position share one vertex, which names the first of
  // them. no_index for a vertex that is no atom. Atoms in no tetrahedron have one too; simplify() takes some.
  std::vector<Index> vertex_atom;
  // True while the tetrahedra are a subset of a Delaunay tetrahedralization of the vertices (carving keeps it): across
  // no face does a vertex lie inside the other tetrahedron's circumsphere by more than delaunay_tolerance of its
  // radius.
  bool delaunay = false;
};

// Sum of the tetrahedra's volumes, compensated summation, Å³.
double volume(const TetMesh& mesh, Progress& progress = no_progress());

// The smallest angle between two faces of one tetrahedron over the whole mesh, degrees; 0 for an empty mesh.
double min_dihedral_degrees(const TetMesh& mesh, Progress& progress = no_progress());

// neighbours[t][f]: the tetrahedron on the other side of face f of t (opposite vertex f), or no_index on the surface.
// Derived data: computed when a stage needs it, never stored; takes 24 bytes a tetrahedron, 16 of them the result.
// Throws Error when a face belongs to more than two.
std::vector<std::array<Index, 4>> face_neighbours(const TetMesh& mesh, Progress& progress = no_progress());

// Every invariant that fails, in words, at most `limit` of them; empty when the mesh is sound.
std::vector<std::string> validate(const TetMesh& mesh, std::size_t limit = 10, Progress& progress = no_progress());

}  // namespace atomesh
