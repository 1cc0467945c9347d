// A tetrahedral mesh that can be changed a star at a time: who is behind each face, and one tetrahedron of each vertex.
#pragma once

#include <span>
#include <vector>

#include "core/tet_mesh.h"

namespace atomesh {

// A tetrahedron and one of its vertices: 4 × tetrahedron + corner. The same number names the face opposite.
using Corner = Index;

// Numbers given to the keys of a small set in the order they came, found again through a table that fits the
// processor's nearest cache for all but the largest stars.
class PlaceTable {
 public:
  void clear();
  // The number of the key; a new key gets the next one.
  Index place(Index key, bool& is_new);

 private:
  static constexpr std::uint64_t empty = ~std::uint64_t{0};
  void grow();
  std::size_t slot_of(Index key) const {
    std::size_t slot = (key * 0x9E3779B1U) & mask_;
    while (slots_[slot] != empty && slots_[slot] >> 32U != key) slot = (slot + 1) & mask_;
    return slot;
  }

  std::vector<std::uint64_t> slots_;  // key << 32 | number
  std::size_t mask_ = 0;
  Index count_ = 0;
};

// All around a vertex inside the mesh. The link is a closed polyhedron that the vertex sees from within.
struct Star {
  Index vertex = no_index;
  std::vector<Corner> corners;      // of the vertex, one for each of its tetrahedra
  std::vector<Index> link;          // the vertices around it
  std::vector<Triangle> triangles;  // opposite the corners, outward; indices into link
};

class StarMesh {
 public:
  // Takes the tetrahedra over. Throws Error when a face belongs to more than two of them, or past 2^30 tetrahedra.
  StarMesh(std::vector<Tetrahedron> tetrahedra, const std::vector<Vec3>& vertices, Progress& progress = no_progress());

  std::size_t tetrahedra() const { return living_; }
  const Vec3& position(Index v) const { return vertices_[v]; }
  bool on_surface(Index v) const { return surface_[v] != 0; }
  bool used(Index v) const { return corner_of_[v] != no_index; }

  // Squared, of each vertex that is used; 0 for the others.
  std::vector<double> shortest_edges(const Progress& progress = no_progress()) const;

  // Walks all around v, which must be inside: used and not on the surface.
  void gather(Index v, Star& star);
  // The star's vertex moves onto star.link[target]: the tetrahedra that have both vanish, the others have the target in
  // its place. The caller has made sure that the target sees every other triangle of the link from within.
  void collapse(const Star& star, Index target);
  // Replaces the tetrahedra `cells` by others that fill the same room: `faces` are those of their faces that have no
  // other of them behind. False, with nothing changed, when the free faces of `fill` are not these triangles, each
  // once. Vertices of the cells that the fill does not have are unused afterwards.
  bool refill(std::span<const Index> cells, std::span<const Corner> faces, std::span<const Tetrahedron> fill);
  // The same face seen from behind, no_index on the surface.
  Corner behind(Corner face) const { return behind_[face]; }
  // The vertex opposite across the face, no_index on the surface.
  Index across(Corner face) const;
  const Tetrahedron& tetrahedron(Corner corner) const { return tetrahedra_[corner / 4]; }

  // What is left, in no particular order; the StarMesh is empty afterwards.
  std::vector<Tetrahedron> take();

 private:
  void join(Corner a, Corner b) {
    if (a != no_index) behind_[a] = b;
    if (b != no_index) behind_[b] = a;
  }
  void remember_corners(Index tetrahedron) {
    for (Index i = 0; i < 4; ++i) corner_of_[tetrahedra_[tetrahedron][i]] = 4 * tetrahedron + i;
  }

  const std::vector<Vec3>& vertices_;
  std::vector<Tetrahedron> tetrahedra_;  // the first vertex of one that is gone is no_index
  std::vector<Corner> behind_;           // of each face, the same face seen from the other tetrahedron, or no_index
  std::vector<Corner> corner_of_;        // one corner of each vertex, or no_index
  std::vector<std::uint8_t> surface_;    // 1 for the vertices of the surface
  std::vector<Index> vacant_;            // tetrahedra that refill() may write over
  std::size_t living_ = 0;
  PlaceTable star_tetrahedra_, star_vertices_;  // of the star being gathered
  struct OpenFace {
    std::uint64_t smaller;  // its first two vertices, in ascending order
    Index largest;          // no_index: an empty slot
    Corner face;            // no_index: it was met
  };
  std::vector<OpenFace> open_;                    // faces of a refill, a hash table
  std::vector<std::pair<Corner, Corner>> pairs_;  // of its faces that met
  std::vector<Corner> outside_;                   // behind each triangle of its hole
  std::vector<Index> slots_;                      // of its new tetrahedra
};

}  // namespace atomesh
