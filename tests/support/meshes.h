// Small tetrahedral meshes for tests, each with a property.
#pragma once

#include "core/tet_mesh.h"

namespace atomesh::test {

// A mesh of these; vertex i is atom i.
TetMesh mesh_of(std::vector<Vec3> vertices, std::vector<Tetrahedron> tetrahedra);

// The corner (0,0,0), (1,0,0), (0,1,0), (0,0,1): volume 1/6.
TetMesh corner_tetrahedron();
// All edges 2√2, corners of the cube [-1,1]³: volume 8/3, dihedral angles arccos(1/3).
TetMesh regular_tetrahedron();
// The cube [0, edge]³ + origin in six tetrahedra about its diagonal.
TetMesh cube_of_six(double edge = 1.0, const Vec3& origin = Vec3(0.0));
// Two tetrahedra with nothing in common but an edge: the surface is closed but no manifold there.
TetMesh two_at_an_edge();
// n³ cubes of edge 1 in six tetrahedra each, without those whose cube `hollow` names.
TetMesh cubes(int n, bool (*hollow)(int i, int j, int k));

}  // namespace atomesh::test
