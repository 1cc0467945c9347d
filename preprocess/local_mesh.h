// A region of a mesh that is being changed: tetrahedra come and go, neighbours are found through their vertices.
#pragma once

#include <span>
#include <unordered_map>
#include <vector>

#include "core/geometry.h"
#include "core/progress.h"

namespace atomesh {

// Face `f` of a tetrahedron, counter-clockwise seen from outside.
inline Triangle outward_face(const Tetrahedron& tet, int f) {
  return {tet[face_corners[f][0]], tet[face_corners[f][1]], tet[face_corners[f][2]]};
}

// The same triangle always reads the same: its smallest corner first, its sense kept.
inline Triangle rotated(const Triangle& t) {
  if (t[1] < t[0] && t[1] < t[2]) return {t[1], t[2], t[0]};
  if (t[2] < t[0] && t[2] < t[1]) return {t[2], t[0], t[1]};
  return t;
}

class LocalMesh {
 public:
  // Takes the tetrahedra with a marked vertex out of `tetrahedra`, which keep their order; give_back() returns what
  // has become of them. Faces to those that stayed are the region's rim and count as outside, but they are not changed
  // by anything that leaves its own outside faces alone.
  LocalMesh(std::vector<Tetrahedron>& tetrahedra, const std::vector<bool>& marked,
            const Progress& progress = no_progress());
  void give_back(std::vector<Tetrahedron>& tetrahedra) const;

  std::size_t size() const { return tetrahedra_.size(); }  // numbers ever given, removed ones too
  bool alive(Index t) const { return tetrahedra_[t][0] != no_index; }
  const Tetrahedron& tetrahedron(Index t) const { return tetrahedra_[t]; }
  Index add(const Tetrahedron& tetrahedron);
  void remove(Index t);

  // Those at a vertex, in the order they came.
  std::span<const Index> at(Index vertex) const;
  // The one behind face f, no_index on the outside.
  Index neighbour(Index t, int f) const;
  // Whether face f lies on the rim, where the region was cut out.
  bool on_rim(Index t, int f) const;

 private:
  std::vector<Tetrahedron> tetrahedra_;
  std::unordered_map<Index, std::vector<Index>> at_;
  std::vector<Triangle> rim_;  // sorted corners, ascending
};

}  // namespace atomesh
