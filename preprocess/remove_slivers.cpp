#include "preprocess/remove_slivers.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "core/circumsphere.h"
#include "core/compensated_sum.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/predicates.h"
#include "core/tet_mesh.h"
#include "preprocess/pull_polytope.h"

namespace atomesh {

namespace {

constexpr std::size_t tetrahedra_per_range = 1 << 14;

using Neighbours = std::vector<std::array<Index, 4>>;

bool is_sliver(const Tetrahedron& tet, std::span<const Vec3> points) {
  const Vec3 &a = points[tet[0]], &b = points[tet[1]], &c = points[tet[2]], &d = points[tet[3]];
  const double six_volumes = 6.0 * signed_volume(a, b, c, d);
  double longest = 0.0;
  double largest_face = 0.0;  // twice its area
  for (const auto& corner : face_corners) {
    const Vec3 u = points[tet[corner[1]]] - points[tet[corner[0]]];
    const Vec3 v = points[tet[corner[2]]] - points[tet[corner[0]]];
    longest = std::max({longest, glm::dot(u, u), glm::dot(v, v)});
    largest_face = std::max(largest_face, glm::length(glm::cross(u, v)));
  }
  // Thinner than a hair, or all four corners within a hair of one line.
  return six_volumes < sliver_thickness * std::sqrt(longest) * largest_face ||
         largest_face < sliver_thickness * longest;
}

// 1 for each sliver.
std::vector<std::uint8_t> find_slivers(std::span<const Tetrahedron> tetrahedra, std::span<const Vec3> points) {
  std::vector<std::uint8_t> sliver(tetrahedra.size());
  parallel_for(tetrahedra.size(), tetrahedra_per_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) sliver[t] = is_sliver(tetrahedra[t], points) ? 1 : 0;
  });
  return sliver;
}

bool same_sphere(const Sphere& a, const Sphere& b) {
  const double tolerance = sliver_sphere_tolerance * std::min(a.radius, b.radius);
  return std::abs(a.radius - b.radius) <= tolerance && glm::length(a.center - b.center) <= tolerance;
}

// Disjoint sets; the root of a set is its lowest member.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), Index{0}); }
  Index root(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(Index a, Index b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<Index> parent_;
};

// Joins what has one circumsphere and touches, face to face or with nothing but slivers between.
Sets gather_polytopes(const TetMesh& mesh, const Neighbours& neighbours, const std::vector<std::uint8_t>& sliver) {
  const std::size_t count = mesh.tetrahedra.size();
  std::vector<Sphere> spheres(count);
  parallel_for(count, tetrahedra_per_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto& [a, b, c, d] = mesh.tetrahedra[t];
      spheres[t] = circumsphere(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], mesh.vertices[d]);
    }
  });
  Sets sets(count);
  std::vector<std::uint8_t> seen(count, 0);
  for (std::size_t t = 0; t < count; ++t) {
    if (sliver[t] == 0) {
      for (const Index other : neighbours[t]) {
        if (other != no_index && other > t && sliver[other] == 0 && same_sphere(spheres[t], spheres[other])) {
          sets.join(static_cast<Index>(t), other);
        }
      }
      continue;
    }
    if (seen[t] != 0) continue;
    // All slivers that hang together, and the whole tetrahedra around them.
    std::vector<Index> slivers{static_cast<Index>(t)};
    std::vector<Index> around;
    seen[t] = 1;
    for (std::size_t i = 0; i < slivers.size(); ++i) {
      for (const Index other : neighbours[slivers[i]]) {
        if (other == no_index) continue;
        if (sliver[other] == 0) {
          around.push_back(other);
        } else if (seen[other] == 0) {
          seen[other] = 1;
          slivers.push_back(other);
        }
      }
    }
    // Sorted by radius, equal spheres stand close together.
    std::sort(around.begin(), around.end(), [&](Index a, Index b) { return spheres[a].radius < spheres[b].radius; });
    for (std::size_t i = 0; i < around.size(); ++i) {
      const double limit = spheres[around[i]].radius * (1.0 + sliver_sphere_tolerance);
      for (std::size_t j = i + 1; j < around.size() && spheres[around[j]].radius <= limit; ++j) {
        if (same_sphere(spheres[around[i]], spheres[around[j]])) sets.join(around[i], around[j]);
      }
    }
  }
  return sets;
}

std::vector<Index> ranks_by_position(std::span<const Vec3> points) {
  std::vector<Index> order(points.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    const Vec3 &p = points[a], &q = points[b];
    return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
  });
  std::vector<Index> rank(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = static_cast<Index>(i);
  return rank;
}

// Cuts every polytope of several tetrahedra anew. False when one of them defies it.
bool cut_polytopes(const TetMesh& mesh, const std::vector<std::uint8_t>& sliver, Sets& sets,
                   std::vector<Tetrahedron>& result) {
  std::vector<std::pair<Index, Index>> members;  // (root, tetrahedron)
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (sliver[t] == 0) members.emplace_back(sets.root(static_cast<Index>(t)), static_cast<Index>(t));
  }
  std::sort(members.begin(), members.end());
  const std::vector<Index> rank = ranks_by_position(mesh.vertices);
  std::vector<Index> corners;
  for (std::size_t i = 0; i < members.size();) {
    corners.clear();
    std::size_t j = i;
    for (; j < members.size() && members[j].first == members[i].first; ++j) {
      const Tetrahedron& tet = mesh.tetrahedra[members[j].second];
      corners.insert(corners.end(), tet.begin(), tet.end());
    }
    const Tetrahedron& first = mesh.tetrahedra[members[i].second];
    if (j - i == 1) {
      result.push_back(first);
    } else {
      std::sort(corners.begin(), corners.end());
      corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
      const auto& v = mesh.vertices;
      const double radius = circumsphere(v[first[0]], v[first[1]], v[first[2]], v[first[3]]).radius;
      if (!pull_polytope(corners, v, rank, sliver_sphere_tolerance * radius, result)) return false;
    }
    i = j;
  }
  return true;
}

// Twice the area of the faces with nothing behind them.
double outside_area(const TetMesh& mesh, const Neighbours& neighbours) {
  CompensatedSum sum;
  for (std::size_t t = 0; t < neighbours.size(); ++t) {
    const Tetrahedron& tet = mesh.tetrahedra[t];
    for (int f = 0; f < 4; ++f) {
      if (neighbours[t][f] != no_index) continue;
      const Vec3& a = mesh.vertices[tet[face_corners[f][0]]];
      sum.add(glm::length(
          glm::cross(mesh.vertices[tet[face_corners[f][1]]] - a, mesh.vertices[tet[face_corners[f][2]]] - a)));
    }
  }
  return sum.value();
}

bool all_positive(const TetMesh& mesh) {
  std::atomic<bool> positive{true};
  parallel_for(mesh.tetrahedra.size(), tetrahedra_per_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto& [a, b, c, d] = mesh.tetrahedra[t];
      if (orientation(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], mesh.vertices[d]) <= 0) positive = false;
    }
  });
  return positive;
}

// Whether `after` fills what `before` fills. Two polytopes that disagreed about a face would leave a slit, with the
// face twice on the outside.
bool fills_the_same(const TetMesh& before, const Neighbours& neighbours, const TetMesh& after) {
  constexpr double same = 1e-9;
  const double volume_before = volume(before);
  if (!all_positive(after) || std::abs(volume(after) - volume_before) > same * volume_before) return false;
  const double area_before = outside_area(before, neighbours);
  try {
    return std::abs(outside_area(after, face_neighbours(after)) - area_before) <= same * area_before;
  } catch (const Error&) {
    return false;  // a face of three
  }
}

}  // namespace

std::size_t remove_slivers(std::vector<Tetrahedron>& tetrahedra, std::span<const Vec3> points) {
  const std::vector<std::uint8_t> sliver = find_slivers(tetrahedra, points);
  const auto slivers = static_cast<std::size_t>(std::count(sliver.begin(), sliver.end(), 1));
  if (slivers == 0) return 0;

  TetMesh before;
  before.vertices.assign(points.begin(), points.end());
  before.tetrahedra = tetrahedra;
  const Neighbours neighbours = face_neighbours(before);
  Sets sets = gather_polytopes(before, neighbours, sliver);
  TetMesh after;
  after.vertices = before.vertices;
  if (!cut_polytopes(before, sliver, sets, after.tetrahedra)) return 0;
  if (!fills_the_same(before, neighbours, after)) return 0;
  tetrahedra = std::move(after.tetrahedra);
  return slivers;
}

}  // namespace atomesh
