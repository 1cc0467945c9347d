#include "preprocess/remove_flat.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/predicates.h"
#include "core/tet_mesh.h"

namespace atomesh {

namespace {

bool is_flat(const Tetrahedron& t, std::span<const Vec3> p) {
  return orientation(p[t[0]], p[t[1]], p[t[2]], p[t[3]]) == 0;
}

// The side of the common plane that each face of a flat tetrahedron looks to, as the sign of the orientation of its
// corners with a point off the plane; 0 for a face whose corners are on a line. Nothing for four points on a line.
std::optional<std::array<int, 4>> sides(const Tetrahedron& tet, std::span<const Vec3> p) {
  Bounds bounds;
  for (const Index v : tet) bounds.add(p[v]);
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 off = p[tet[0]];
    off[axis] += 1.0 + bounds.diagonal();
    std::array<int, 4> side{};
    for (int f = 0; f < 4; ++f) {
      const auto& corner = face_corners[f];
      side[f] = orientation(p[tet[corner[0]]], p[tet[corner[1]]], p[tet[corner[2]]], off);
    }
    if (side != std::array<int, 4>{}) return side;
  }
  return std::nullopt;
}

// True when all faces that look to one side lie outside.
bool removable(const std::array<Index, 4>& neighbours, const std::array<int, 4>& side) {
  for (const int looking : {-1, 1}) {
    bool outside = false;
    bool covered = false;
    for (int f = 0; f < 4; ++f) {
      if (side[f] != looking) continue;
      (neighbours[f] == no_index ? outside : covered) = true;
    }
    if (outside && !covered) return true;
  }
  return false;
}

}  // namespace

std::size_t remove_flat_outside(std::vector<Tetrahedron>& tetrahedra, std::span<const Vec3> points) {
  if (count_flat(tetrahedra, points) == 0) return 0;
  const std::size_t before = tetrahedra.size();
  for (bool changed = true; changed;) {
    TetMesh mesh;
    mesh.vertices.assign(points.begin(), points.end());
    mesh.tetrahedra = tetrahedra;
    const auto neighbours = face_neighbours(mesh);
    std::vector<Tetrahedron> kept;
    for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
      const auto side = is_flat(tetrahedra[t], points) ? sides(tetrahedra[t], points) : std::nullopt;
      if (!side || !removable(neighbours[t], *side)) kept.push_back(tetrahedra[t]);
    }
    changed = kept.size() < tetrahedra.size();
    tetrahedra = std::move(kept);
  }
  return before - tetrahedra.size();
}

std::size_t count_flat(std::span<const Tetrahedron> tetrahedra, std::span<const Vec3> points) {
  return static_cast<std::size_t>(
      std::count_if(tetrahedra.begin(), tetrahedra.end(), [&](const Tetrahedron& t) { return is_flat(t, points); }));
}

}  // namespace atomesh
