// Who shares each face of a mesh, found bucket by bucket: what face_neighbours() and extract_surface() have in common.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "core/parallel.h"
#include "core/progress.h"
#include "core/tet_mesh.h"

namespace atomesh {

// One face of one tetrahedron, under its smallest vertex.
struct FaceEntry {
  std::uint64_t larger;  // middle vertex << 32 | largest vertex
  Index tetrahedron;
  Index face;  // opposite this corner of the tetrahedron
};

// Files every tetrahedron under the two vertices that are the smallest of one of its faces: three faces hold its
// smallest vertex, the fourth its second smallest. 8 bytes a tetrahedron and 8 a vertex; the faces themselves exist
// only for the few thousand vertices looked at.
class SharedFaces {
 public:
  SharedFaces(const TetMesh& mesh, Progress& progress);

  // Calls visit(range, vertex, sharing) once for every distinct face, on all threads; `sharing` are the entries of the
  // tetrahedra that have it, `range` counts consecutive ranges of vertices from 0 to ranges() - 1 and belongs to one
  // thread at a time. Vertices of one range come in ascending order.
  template <class Visit>
  void for_each(Visit&& visit, Progress& progress) const {
    const std::size_t vertices = mesh_.vertices.size();
    parallel_for(vertices, vertices_per_range, [&](std::size_t begin, std::size_t end) {
      progress.check();
      std::vector<FaceEntry> faces;
      for (std::size_t v = begin; v < end; ++v) {
        collect(static_cast<Index>(v), faces);
        for (auto i = faces.begin(); i != faces.end();) {
          auto j = i + 1;
          while (j != faces.end() && j->larger == i->larger) ++j;
          visit(begin / vertices_per_range, static_cast<Index>(v), std::span<const FaceEntry>(i, j));
          i = j;
        }
      }
    });
  }
  std::size_t ranges() const { return (mesh_.vertices.size() + vertices_per_range - 1) / vertices_per_range; }

 private:
  static constexpr std::size_t vertices_per_range = 4096;
  // The faces whose smallest vertex is v, sorted.
  void collect(Index v, std::vector<FaceEntry>& faces) const;

  const TetMesh& mesh_;
  std::vector<std::uint64_t> first_;  // of each vertex's tetrahedra in `filed_`
  std::vector<Index> filed_;
};

// Throws Error when more than two tetrahedra share the face that has v as its smallest vertex.
void require_at_most_two(Index v, std::span<const FaceEntry> sharing);

}  // namespace atomesh
