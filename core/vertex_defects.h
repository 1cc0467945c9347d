// Defect values where the mesh has its vertices: what renderers colour and simplification must not touch.
#pragma once

#include <vector>

#include "core/atoms.h"
#include "core/defects.h"
#include "core/tet_mesh.h"

namespace atomesh {

struct DefectValues {
  float positional = 0.0F;
  float extra = 0.0F;
  float vacancy = 0.0F;

  bool any() const { return positional > 0.0F || extra > 0.0F || vacancy > 0.0F; }
};

// Of each vertex. The mesh names only the first of the atoms at one exact position; a defect that only a later one has
// counts too: the largest of each value. Zero for a vertex that is no atom, and everywhere without defects.present().
// Atoms whose vertex was simplified away cost next to nothing.
std::vector<DefectValues> vertex_defects(const TetMesh& mesh, const Atoms& atoms, const Defects& defects);

}  // namespace atomesh
