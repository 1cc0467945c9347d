#include "core/surface.h"

#include <algorithm>
#include <cmath>

#include "core/compensated_sum.h"

namespace atomesh {

namespace {

// Twice the triangle's area along its outward normal.
Vec3 area_vector(const Triangle& t, std::span<const Vec3> vertices) {
  const Vec3& a = vertices[t[0]];
  return glm::cross(vertices[t[1]] - a, vertices[t[2]] - a);
}

Vec3 normalized_or_zero(const Vec3& v) {
  const double length = glm::length(v);
  return length > 0.0 ? v / length : Vec3(0.0);
}

}  // namespace

Surface extract_surface(const TetMesh& mesh) {
  Surface surface;
  const auto neighbours = face_neighbours(mesh);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const Tetrahedron& tet = mesh.tetrahedra[t];
    for (int f = 0; f < 4; ++f) {
      if (neighbours[t][f] != no_index) continue;
      surface.triangles.push_back({tet[face_corners[f][0]], tet[face_corners[f][1]], tet[face_corners[f][2]]});
      surface.tetrahedron.push_back(static_cast<Index>(t));
      surface.face.push_back(static_cast<std::uint8_t>(f));
    }
  }
  return surface;
}

std::vector<Vec3f> face_normals(const Surface& surface, std::span<const Vec3> vertices) {
  std::vector<Vec3f> normals;
  normals.reserve(surface.triangles.size());
  for (const Triangle& t : surface.triangles) normals.emplace_back(normalized_or_zero(area_vector(t, vertices)));
  return normals;
}

std::vector<Vec3f> vertex_normals(const Surface& surface, std::span<const Vec3> vertices) {
  std::vector<Vec3> sum(vertices.size(), Vec3(0.0));
  for (const Triangle& t : surface.triangles) {
    const Vec3 normal = normalized_or_zero(area_vector(t, vertices));
    for (int i = 0; i < 3; ++i) {
      const Vec3 u = vertices[t[(i + 1) % 3]] - vertices[t[i]];
      const Vec3 v = vertices[t[(i + 2) % 3]] - vertices[t[i]];
      sum[t[i]] += std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v)) * normal;
    }
  }
  std::vector<Vec3f> normals;
  normals.reserve(sum.size());
  for (const Vec3& s : sum) normals.emplace_back(normalized_or_zero(s));
  return normals;
}

double area(const Surface& surface, std::span<const Vec3> vertices) {
  CompensatedSum sum;
  for (const Triangle& t : surface.triangles) sum.add(0.5 * glm::length(area_vector(t, vertices)));
  return sum.value();
}

double enclosed_volume(const Surface& surface, std::span<const Vec3> vertices) {
  Bounds bounds;
  for (const Triangle& t : surface.triangles) {
    for (const Index v : t) bounds.add(vertices[v]);
  }
  const Vec3 centre = bounds.center();
  CompensatedSum sum;
  for (const Triangle& t : surface.triangles) {
    sum.add(-signed_volume(vertices[t[0]], vertices[t[1]], vertices[t[2]], centre));
  }
  return sum.value();
}

bool is_closed(const Surface& surface) {
  // Every directed edge, filed as (smaller, larger) with +1 for one sense and -1 for the other.
  std::vector<std::pair<std::uint64_t, int>> edges;
  edges.reserve(3 * surface.triangles.size());
  for (const Triangle& t : surface.triangles) {
    for (int i = 0; i < 3; ++i) {
      const std::uint64_t a = t[i];
      const std::uint64_t b = t[(i + 1) % 3];
      edges.emplace_back(std::min(a, b) << 32 | std::max(a, b), a < b ? 1 : -1);
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    int balance = 0;
    const std::uint64_t edge = edges[i].first;
    for (; i < edges.size() && edges[i].first == edge; ++i) balance += edges[i].second;
    if (balance != 0) return false;
  }
  return true;
}

std::vector<std::string> validate(const Surface& surface, const TetMesh& mesh, std::size_t limit) {
  std::vector<std::string> found;
  const auto complain = [&](std::string complaint) {
    if (found.size() < limit) found.push_back(std::move(complaint));
  };
  const std::size_t count = surface.triangles.size();
  if (surface.tetrahedron.size() != count || surface.face.size() != count) {
    complain("the surface's arrays differ in length");
    return found;
  }
  for (std::size_t i = 0; i < count && found.size() < limit; ++i) {
    const std::string triangle = "triangle " + std::to_string(i);
    const Index t = surface.tetrahedron[i];
    const int f = surface.face[i];
    if (t >= mesh.tetrahedra.size() || f > 3) {
      complain(triangle + " lies on face " + std::to_string(f) + " of tetrahedron " + std::to_string(t) +
               ", which the mesh does not have");
      continue;
    }
    Triangle corners = surface.triangles[i];
    const Tetrahedron& tet = mesh.tetrahedra[t];
    const Triangle expected{tet[face_corners[f][0]], tet[face_corners[f][1]], tet[face_corners[f][2]]};
    std::rotate(corners.begin(), std::find(corners.begin(), corners.end(), expected[0]), corners.end());
    if (corners == expected) continue;
    std::swap(corners[1], corners[2]);
    complain(triangle + (corners == expected ? " points inward" : " is not the face it names"));
  }
  if (!is_closed(surface)) complain("the surface is not closed");
  if (found.empty()) {
    const Surface boundary = extract_surface(mesh);
    std::vector<std::uint64_t> have, want;
    for (std::size_t i = 0; i < count; ++i) have.push_back(std::uint64_t{surface.tetrahedron[i]} * 4 + surface.face[i]);
    for (std::size_t i = 0; i < boundary.triangles.size(); ++i) {
      want.push_back(std::uint64_t{boundary.tetrahedron[i]} * 4 + boundary.face[i]);
    }
    std::sort(have.begin(), have.end());
    if (have != want) complain("the surface is not the boundary of the mesh");
  }
  return found;
}

}  // namespace atomesh
