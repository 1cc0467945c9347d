#include "core/tet_mesh.h"

#include <algorithm>
#include <cmath>

#include "core/compensated_sum.h"
#include "core/error.h"
#include "core/parallel.h"

namespace atomesh {

namespace {

// One face of one tetrahedron: filed under its smallest vertex, compared by the two larger ones.
struct FaceEntry {
  std::uint64_t larger;  // middle vertex << 32 | largest vertex
  Index tetrahedron;
  Index face;
};

struct SortedFace {
  Index smallest, middle, largest;
};

SortedFace sorted_face(const Tetrahedron& tet, int face) {
  Index a = tet[face_corners[face][0]];
  Index b = tet[face_corners[face][1]];
  Index c = tet[face_corners[face][2]];
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  return {a, b, c};
}

constexpr std::size_t tetrahedra_per_range = 1 << 14;

}  // namespace

double volume(const TetMesh& mesh) {
  CompensatedSum sum;
  const auto& v = mesh.vertices;
  for (const Tetrahedron& t : mesh.tetrahedra) sum.add(signed_volume(v[t[0]], v[t[1]], v[t[2]], v[t[3]]));
  return sum.value();
}

double min_dihedral_degrees(const TetMesh& mesh) {
  if (mesh.tetrahedra.empty()) return 0.0;
  const std::size_t count = mesh.tetrahedra.size();
  std::vector<double> range_minimum((count + tetrahedra_per_range - 1) / tetrahedra_per_range);
  parallel_for(count, tetrahedra_per_range, [&](std::size_t begin, std::size_t end) {
    double smallest = std::numbers::pi;
    for (std::size_t i = begin; i < end; ++i) {
      std::array<Vec3, 4> normal;  // outward, twice the face's area long
      for (int f = 0; f < 4; ++f) {
        const Vec3& a = mesh.vertices[mesh.tetrahedra[i][face_corners[f][0]]];
        const Vec3& b = mesh.vertices[mesh.tetrahedra[i][face_corners[f][1]]];
        const Vec3& c = mesh.vertices[mesh.tetrahedra[i][face_corners[f][2]]];
        normal[f] = glm::cross(b - a, c - a);
      }
      for (int f = 0; f < 4; ++f) {
        for (int g = f + 1; g < 4; ++g) {
          // atan2 keeps the small angles that acos would round away.
          const double sine = glm::length(glm::cross(normal[f], normal[g]));
          smallest = std::min(smallest, std::atan2(sine, -glm::dot(normal[f], normal[g])));
        }
      }
    }
    range_minimum[begin / tetrahedra_per_range] = smallest;
  });
  return *std::min_element(range_minimum.begin(), range_minimum.end()) * 180.0 / std::numbers::pi;
}

std::vector<std::array<Index, 4>> face_neighbours(const TetMesh& mesh) {
  const std::size_t count = mesh.tetrahedra.size();
  std::vector<std::array<Index, 4>> neighbours(count, {no_index, no_index, no_index, no_index});

  std::vector<std::size_t> first(mesh.vertices.size() + 1, 0);  // of each vertex's faces in `entries`
  for (const Tetrahedron& tet : mesh.tetrahedra) {
    for (int f = 0; f < 4; ++f) ++first[sorted_face(tet, f).smallest + 1];
  }
  for (std::size_t v = 0; v + 1 < first.size(); ++v) first[v + 1] += first[v];
  std::vector<FaceEntry> entries(4 * count);
  {
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    for (std::size_t t = 0; t < count; ++t) {
      for (int f = 0; f < 4; ++f) {
        const SortedFace face = sorted_face(mesh.tetrahedra[t], f);
        entries[next[face.smallest]++] = {std::uint64_t{face.middle} << 32 | face.largest, static_cast<Index>(t),
                                          static_cast<Index>(f)};
      }
    }
  }

  constexpr std::size_t vertices_per_range = 4096;
  parallel_for(mesh.vertices.size(), vertices_per_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const auto from = entries.begin() + static_cast<std::ptrdiff_t>(first[v]);
      const auto to = entries.begin() + static_cast<std::ptrdiff_t>(first[v + 1]);
      std::sort(from, to, [](const FaceEntry& a, const FaceEntry& b) { return a.larger < b.larger; });
      for (auto i = from; i != to;) {
        auto j = i + 1;
        while (j != to && j->larger == i->larger) ++j;
        if (j - i > 2) {
          throw Error("the face of vertices " + std::to_string(v) + ", " + std::to_string(i->larger >> 32) + ", " +
                      std::to_string(i->larger & 0xffffffffU) + " belongs to " + std::to_string(j - i) +
                      " tetrahedra; at most two can share it");
        }
        if (j - i == 2) {
          neighbours[i[0].tetrahedron][i[0].face] = i[1].tetrahedron;
          neighbours[i[1].tetrahedron][i[1].face] = i[0].tetrahedron;
        }
        i = j;
      }
    }
  });
  return neighbours;
}

}  // namespace atomesh
