#include "preprocess/gather_polytopes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/circumsphere.h"
#include "core/parallel.h"
#include "preprocess/pull_polytope.h"

namespace atomesh {

namespace {

constexpr std::size_t tetrahedra_per_range = 1 << 14;

bool is_sliver(const Tetrahedron& tet, std::span<const Vec3> points, double thickness) {
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
  return six_volumes < thickness * std::sqrt(longest) * largest_face || largest_face < thickness * longest;
}

bool same_sphere(const Sphere& a, const Sphere& b, double share) {
  const double tolerance = share * std::min(a.radius, b.radius);
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

}  // namespace

std::vector<std::uint8_t> find_slivers(std::span<const Tetrahedron> tetrahedra, std::span<const Vec3> points,
                                       const PolytopeTolerance& tolerance, const Progress& progress) {
  std::vector<std::uint8_t> sliver(tetrahedra.size());
  parallel_for(tetrahedra.size(), tetrahedra_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t t = begin; t < end; ++t) sliver[t] = is_sliver(tetrahedra[t], points, tolerance.thickness) ? 1 : 0;
  });
  return sliver;
}

std::vector<std::pair<Index, Index>> gather_polytopes(std::span<const Tetrahedron> tetrahedra,
                                                      std::span<const Vec3> points,
                                                      std::span<const std::array<Index, 4>> neighbours,
                                                      const std::vector<std::uint8_t>& sliver,
                                                      const PolytopeTolerance& tolerance, const Progress& progress) {
  const std::size_t count = tetrahedra.size();
  std::vector<Sphere> spheres(count);
  parallel_for(count, tetrahedra_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t t = begin; t < end; ++t) {
      const auto& [a, b, c, d] = tetrahedra[t];
      spheres[t] = circumsphere(points[a], points[b], points[c], points[d]);
    }
  });
  Sets sets(count);
  std::vector<std::uint8_t> seen(count, 0);
  for (std::size_t t = 0; t < count; ++t) {
    if (t % tetrahedra_per_range == 0) progress.check();
    if (sliver[t] == 0) {
      for (const Index other : neighbours[t]) {
        if (other != no_index && other > t && sliver[other] == 0 &&
            same_sphere(spheres[t], spheres[other], tolerance.sphere)) {
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
      const double limit = spheres[around[i]].radius * (1.0 + tolerance.sphere);
      for (std::size_t j = i + 1; j < around.size() && spheres[around[j]].radius <= limit; ++j) {
        if (same_sphere(spheres[around[i]], spheres[around[j]], tolerance.sphere)) sets.join(around[i], around[j]);
      }
    }
  }
  std::vector<std::pair<Index, Index>> members;
  for (std::size_t t = 0; t < count; ++t) {
    if (sliver[t] == 0) members.emplace_back(sets.root(static_cast<Index>(t)), static_cast<Index>(t));
  }
  std::size_t compared = 0;
  std::sort(members.begin(), members.end(), [&](const auto& a, const auto& b) {
    if (++compared % (1 << 20) == 0) progress.check();
    return a < b;
  });
  return members;
}

bool cut_polytopes(std::span<const Tetrahedron> tetrahedra, std::span<const Vec3> points,
                   std::span<const std::pair<Index, Index>> members, std::span<const Index> rank,
                   const PolytopeTolerance& tolerance, std::vector<Tetrahedron>& result, const Progress& progress) {
  std::vector<Index> corners;
  std::size_t polytopes = 0;
  for (std::size_t i = 0; i < members.size();) {
    if (polytopes++ % 1024 == 0) progress.check();
    corners.clear();
    std::size_t j = i;
    for (; j < members.size() && members[j].first == members[i].first; ++j) {
      const Tetrahedron& tet = tetrahedra[members[j].second];
      corners.insert(corners.end(), tet.begin(), tet.end());
    }
    const Tetrahedron& first = tetrahedra[members[i].second];
    if (j - i == 1) {
      result.push_back(first);
    } else {
      std::sort(corners.begin(), corners.end());
      corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
      const double radius = circumsphere(points[first[0]], points[first[1]], points[first[2]], points[first[3]]).radius;
      if (!pull_polytope(corners, points, rank, tolerance.sphere * radius, result)) return false;
    }
    i = j;
  }
  return true;
}

}  // namespace atomesh
