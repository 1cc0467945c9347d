#include "tests/support/meshes.h"

#include <algorithm>
#include <numeric>

namespace atomesh::test {

TetMesh mesh_of(std::vector<Vec3> vertices, std::vector<Tetrahedron> tetrahedra) {
  TetMesh mesh;
  mesh.vertex_atom.resize(vertices.size());
  std::iota(mesh.vertex_atom.begin(), mesh.vertex_atom.end(), Index{0});
  mesh.vertices = std::move(vertices);
  mesh.tetrahedra = std::move(tetrahedra);
  return mesh;
}

TetMesh corner_tetrahedron() {
  return mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}});
}

TetMesh regular_tetrahedron() {
  return mesh_of({{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}}, {{0, 1, 2, 3}});
}

TetMesh cube_of_six(double edge, const Vec3& origin) {
  TetMesh mesh = cubes(1, [](int, int, int) { return false; });
  for (Vec3& p : mesh.vertices) p = origin + edge * p;
  return mesh;
}

TetMesh two_at_an_edge() {
  return mesh_of({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {{0, 2, 3, 1}, {0, 4, 5, 1}});
}

TetMesh cubes(int n, bool (*hollow)(int i, int j, int k)) {
  std::vector<Vec3> vertices;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      for (int k = 0; k <= n; ++k) vertices.emplace_back(i, j, k);
    }
  }
  const auto index = [n](const std::array<int, 3>& p) {
    return static_cast<Index>((p[0] * (n + 1) + p[1]) * (n + 1) + p[2]);
  };
  std::vector<Tetrahedron> tetrahedra;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) {
        if (hollow(i, j, k)) continue;
        // One tetrahedron for each order in which the three axes can be walked from corner to corner (Kuhn).
        std::array<int, 3> axes{0, 1, 2};
        do {
          std::array<int, 3> p{i, j, k};
          Tetrahedron tet{index(p)};
          for (int step = 0; step < 3; ++step) {
            ++p[axes[step]];
            tet[step + 1] = index(p);
          }
          if (signed_volume(vertices[tet[0]], vertices[tet[1]], vertices[tet[2]], vertices[tet[3]]) < 0.0) {
            std::swap(tet[2], tet[3]);
          }
          tetrahedra.push_back(tet);
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
    }
  }
  return mesh_of(std::move(vertices), std::move(tetrahedra));
}

}  // namespace atomesh::test
