#include "preprocess/local_mesh.h"

#include <algorithm>

namespace atomesh {

namespace {

constexpr std::size_t tetrahedra_per_check = 1 << 16;

Triangle sorted_face(const Tetrahedron& tet, int f) {
  Triangle t = outward_face(tet, f);
  std::sort(t.begin(), t.end());
  return t;
}

bool has(const Tetrahedron& tet, Index v) {
  return std::find(tet.begin(), tet.end(), v) != tet.end();
}

}  // namespace

LocalMesh::LocalMesh(std::vector<Tetrahedron>& tetrahedra, const std::vector<bool>& marked, const Progress& progress) {
  const auto touches = [&](const Tetrahedron& t) {
    return marked[t[0]] || marked[t[1]] || marked[t[2]] || marked[t[3]];
  };
  // The rim is made of faces of the region that a tetrahedron outside it shares: none of its corners is marked, so the
  // region's tetrahedron has one marked corner, opposite.
  std::vector<bool> of_region(marked.size(), false);
  std::size_t looked = 0;
  for (const Tetrahedron& t : tetrahedra) {
    if (looked++ % tetrahedra_per_check == 0) progress.check();
    if (!touches(t)) continue;
    add(t);
    for (const Index v : t) of_region[v] = true;
  }
  std::size_t kept = 0;
  for (const Tetrahedron& t : tetrahedra) {
    if (looked++ % tetrahedra_per_check == 0) progress.check();
    if (touches(t)) continue;
    tetrahedra[kept++] = t;
    for (int f = 0; f < 4; ++f) {
      const Triangle face = sorted_face(t, f);
      if (of_region[face[0]] && of_region[face[1]] && of_region[face[2]]) rim_.push_back(face);
    }
  }
  tetrahedra.resize(kept);
  std::sort(rim_.begin(), rim_.end());
}

void LocalMesh::give_back(std::vector<Tetrahedron>& tetrahedra) const {
  for (const Tetrahedron& t : tetrahedra_) {
    if (t[0] != no_index) tetrahedra.push_back(t);
  }
}

Index LocalMesh::add(const Tetrahedron& tetrahedron) {
  const auto t = static_cast<Index>(tetrahedra_.size());
  tetrahedra_.push_back(tetrahedron);
  for (const Index v : tetrahedron) at_[v].push_back(t);
  return t;
}

void LocalMesh::remove(Index t) {
  for (const Index v : tetrahedra_[t]) std::erase(at_[v], t);
  tetrahedra_[t].fill(no_index);
}

std::span<const Index> LocalMesh::at(Index vertex) const {
  const auto found = at_.find(vertex);
  return found == at_.end() ? std::span<const Index>() : std::span<const Index>(found->second);
}

Index LocalMesh::neighbour(Index t, int f) const {
  const Triangle face = outward_face(tetrahedra_[t], f);
  for (const Index other : at(face[0])) {
    if (other != t && has(tetrahedra_[other], face[1]) && has(tetrahedra_[other], face[2])) return other;
  }
  return no_index;
}

bool LocalMesh::on_rim(Index t, int f) const {
  return std::binary_search(rim_.begin(), rim_.end(), sorted_face(tetrahedra_[t], f));
}

}  // namespace atomesh
