// Defect values where the mesh has its vertices: what renderers colour and simplification must not touch.
#pragma once

#include <unordered_map>
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

// Looks up the values of vertices. The mesh names only the first of the atoms at one exact position; a defect that only
// a later one has counts too: the largest of each value. Zero for a vertex that is no atom, and everywhere without
// defects.present(). Atoms whose vertex was simplified away cost next to nothing.
class VertexDefects {
 public:
  // Keeps references.
  VertexDefects(const TetMesh& mesh, const Atoms& atoms, const Defects& defects);

  DefectValues operator[](std::size_t vertex) const {
    if (!merged_.empty()) {
      if (const auto found = merged_.find(static_cast<Index>(vertex)); found != merged_.end()) return found->second;
    }
    const Index atom = present_ ? mesh_.vertex_atom[vertex] : no_index;
    return atom == no_index ? DefectValues{} : of_atom(atom);
  }

 private:
  DefectValues of_atom(std::size_t atom) const {
    return {defects_.positional[atom], defects_.extra[atom], defects_.vacancy[atom]};
  }

  const TetMesh& mesh_;
  const Defects& defects_;
  bool present_;
  std::unordered_map<Index, DefectValues> merged_;  // vertices of atoms at one position that have a defect
};

// Of each vertex.
std::vector<DefectValues> vertex_defects(const TetMesh& mesh, const Atoms& atoms, const Defects& defects);

}  // namespace atomesh
