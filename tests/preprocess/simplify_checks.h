// What every simplification must keep, looked at from outside: the meshes before and after, atom by atom.
#pragma once

#include "core/atoms.h"
#include "core/defects.h"
#include "core/surface.h"
#include "core/tet_mesh.h"
#include "preprocess/simplify.h"

namespace atomesh::test {

struct Simplified {
  TetMesh before, after;
  Surface surface;
  SimplifyReport report;
};

// Simplifies the mesh of these atoms and checks that nothing was lost: sound mesh and surface, the same surface over
// the same atoms, volume, Euler number, the frozen vertices, the tetrahedra at defects, and the report's own claims.
Simplified simplified(const TetMesh& mesh, const Atoms& atoms, const Defects& defects, const std::string& strategy,
                      const std::string& what);

// The carved mesh of the atoms.
TetMesh carved_mesh(const Atoms& atoms);
// One atom at each vertex of a mesh whose vertex i is atom i.
Atoms atoms_of(const TetMesh& mesh);
// Value 1 for the atoms within `radius` of one of the places, 0 for all others.
Defects defects_near(const Atoms& atoms, const std::vector<Vec3>& places, double radius);

}  // namespace atomesh::test
