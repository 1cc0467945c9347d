#include "core/surface.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "core/compensated_sum.h"
#include "core/parallel.h"
#include "core/shared_faces.h"

namespace atomesh {

namespace {

constexpr std::size_t items_per_check = 1 << 14;

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

Surface extract_surface(const TetMesh& mesh, Progress& progress) {
  const std::size_t count = mesh.tetrahedra.size();
  std::vector<std::uint8_t> outside(count, 0);  // bit f: no tetrahedron beyond face f
  {
    const SharedFaces faces(mesh, progress);
    progress.update(0.3);
    faces.for_each(
        [&](std::size_t, Index v, std::span<const FaceEntry> sharing) {
          require_at_most_two(v, sharing);
          if (sharing.size() == 2) return;
          // The tetrahedron's other faces may be in another thread's hands.
          std::atomic_ref(outside[sharing[0].tetrahedron])
              .fetch_or(static_cast<std::uint8_t>(1U << sharing[0].face), std::memory_order_relaxed);
        },
        progress);
  }
  progress.update(0.9);
  std::size_t triangles = 0;
  for (const std::uint8_t bits : outside) triangles += static_cast<std::size_t>(std::popcount(bits));
  Surface surface;
  surface.triangles.reserve(triangles);
  surface.tetrahedron.reserve(triangles);
  surface.face.reserve(triangles);
  for (std::size_t t = 0; t < count; ++t) {
    if (t % items_per_check == 0) progress.check();
    if (outside[t] == 0) continue;
    const Tetrahedron& tet = mesh.tetrahedra[t];
    for (int f = 0; f < 4; ++f) {
      if ((outside[t] >> f & 1) == 0) continue;
      surface.triangles.push_back({tet[face_corners[f][0]], tet[face_corners[f][1]], tet[face_corners[f][2]]});
      surface.tetrahedron.push_back(static_cast<Index>(t));
      surface.face.push_back(static_cast<std::uint8_t>(f));
    }
  }
  return surface;
}

std::vector<Vec3f> face_normals(std::span<const Triangle> triangles, std::span<const Vec3> vertices) {
  std::vector<Vec3f> normals(triangles.size());
  parallel_for(triangles.size(), items_per_check, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      normals[t] = Vec3f(normalized_or_zero(area_vector(triangles[t], vertices)));
    }
  });
  return normals;
}

std::vector<Vec3f> vertex_normals(std::span<const Triangle> triangles, std::span<const Vec3> vertices) {
  std::vector<Vec3> sums(vertices.size(), Vec3(0.0));
  // What triangles add is found in parallel, a stretch at a time, and added in their order: sums of doubles depend on
  // it.
  constexpr std::size_t stretch = 1 << 16;
  std::vector<std::array<Vec3, 3>> shares(std::min(stretch, triangles.size()));
  for (std::size_t first = 0; first < triangles.size(); first += stretch) {
    const std::span<const Triangle> some = triangles.subspan(first, std::min(stretch, triangles.size() - first));
    parallel_for(some.size(), 1 << 12, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) {
        const Triangle& t = some[n];
        const Vec3 normal = normalized_or_zero(area_vector(t, vertices));
        for (std::size_t i = 0; i < 3; ++i) {
          const Vec3 u = vertices[t[(i + 1) % 3]] - vertices[t[i]];
          const Vec3 v = vertices[t[(i + 2) % 3]] - vertices[t[i]];
          shares[n][i] = std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v)) * normal;
        }
      }
    });
    for (std::size_t n = 0; n < some.size(); ++n) {
      for (std::size_t i = 0; i < 3; ++i) sums[some[n][i]] += shares[n][i];
    }
  }
  std::vector<Vec3f> normals(vertices.size());
  parallel_for(normals.size(), items_per_check, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) normals[v] = Vec3f(normalized_or_zero(sums[v]));
  });
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

bool is_closed(const Surface& surface, Progress& progress) {
  // Every directed edge, filed under its smaller vertex as twice the larger one, and one more for the sense from large
  // to small.
  Index largest = 0;
  for (const Triangle& t : surface.triangles) largest = std::max({largest, t[0], t[1], t[2]});
  const auto for_each_edge = [&](auto&& visit) {
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
      if (i % items_per_check == 0) progress.check();
      const Triangle& t = surface.triangles[i];
      for (std::size_t k = 0; k < 3; ++k) {
        const Index a = t[k];
        const Index b = t[(k + 1) % 3];
        visit(std::min(a, b), 2 * std::uint64_t{std::max(a, b)} + (a > b ? 1 : 0));
      }
    }
  };
  std::vector<std::uint64_t> first(std::size_t{largest} + 3, 0);
  for_each_edge([&](Index smaller, std::uint64_t) { ++first[std::size_t{smaller} + 2]; });
  for (std::size_t v = 2; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<std::uint64_t> edges(3 * surface.triangles.size());
  for_each_edge([&](Index smaller, std::uint64_t edge) { edges[first[std::size_t{smaller} + 1]++] = edge; });

  std::atomic<bool> closed{true};
  parallel_for(std::size_t{largest} + 1, items_per_check, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t v = begin; v < end; ++v) {
      const auto from = edges.begin() + static_cast<std::ptrdiff_t>(first[v]);
      const auto to = edges.begin() + static_cast<std::ptrdiff_t>(first[v + 1]);
      std::sort(from, to);
      for (auto i = from; i != to;) {
        const std::uint64_t other = *i / 2;
        int balance = 0;
        for (; i != to && *i / 2 == other; ++i) balance += *i % 2 == 0 ? 1 : -1;
        if (balance != 0) closed = false;
      }
    }
  });
  return closed;
}

std::vector<std::string> validate(const Surface& surface, const TetMesh& mesh, std::size_t limit, Progress& progress) {
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
    if (i % items_per_check == 0) progress.check();
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
  if (!is_closed(surface, progress)) complain("the surface is not closed");
  if (found.empty()) {
    const Surface boundary = extract_surface(mesh, progress);
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
