#include "preprocess/stamp_fill.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "core/circumsphere.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/tet_mesh.h"
#include "preprocess/gather_polytopes.h"
#include "preprocess/tetrahedralize.h"

namespace atomesh {

namespace {

constexpr std::size_t items_per_range = 512;

// Points further off their common sphere than a stamped polytope's may be are still told to share it.
PolytopeTolerance tolerance_of(const StampedSample& sample) {
  return {sample.options().tolerance, 10.0 * sample.options().tolerance};
}

Tetrahedron global(const Tetrahedron& t, std::span<const Index> open) {
  return {open[t[0]], open[t[1]], open[t[2]], open[t[3]]};
}

// Keeps those of the open points' tetrahedra that may be missing: of radius up to the largest, empty of all points and
// not stamped; slivers between them too.
void keep_missing(const StampedSample& sample, std::span<const Index> open, std::span<const Vec3> places,
                  std::vector<Tetrahedron>& tetrahedra, Progress& progress) {
  const PolytopeTolerance tolerance = tolerance_of(sample);
  const double largest = sample.options().largest_radius;
  const std::vector<std::uint8_t> sliver = find_slivers(tetrahedra, places, tolerance);
  std::vector<std::uint8_t> keep(tetrahedra.size(), 0);
  parallel_for(tetrahedra.size(), items_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    std::vector<Index> slots;
    for (std::size_t n = begin; n < end; ++n) {
      const Tetrahedron& t = tetrahedra[n];
      const Vec3 &a = places[t[0]], &b = places[t[1]], &c = places[t[2]], &d = places[t[3]];
      if (sliver[n] != 0) {
        const double longest = std::max({glm::distance(a, b), glm::distance(a, c), glm::distance(a, d),
                                         glm::distance(b, c), glm::distance(b, d), glm::distance(c, d)});
        keep[n] = longest <= 2.0 * largest && !sample.in_one_polytope(global(t, open)) ? 1 : 0;
        continue;
      }
      const Sphere sphere = circumsphere(a, b, c, d);
      if (!(sphere.radius <= largest) || sample.in_one_polytope(global(t, open))) continue;
      const double inside = sphere.radius * (1.0 - tolerance.sphere);
      keep[n] = sample.each_in_ball(sphere.center, inside, slots, [](Index) { return false; }) ? 1 : 0;
    }
  });
  std::size_t kept = 0;
  for (std::size_t n = 0; n < tetrahedra.size(); ++n) {
    if (keep[n] != 0) tetrahedra[kept++] = tetrahedra[n];
  }
  tetrahedra.resize(kept);
}

std::vector<Index> ranks_by_height(std::span<const Vec3> points, const Vec3& direction) {
  std::vector<std::pair<double, Index>> heights;
  for (std::size_t i = 0; i < points.size(); ++i) {
    heights.emplace_back(glm::dot(points[i], direction), static_cast<Index>(i));
  }
  std::sort(heights.begin(), heights.end());
  std::vector<Index> rank(points.size());
  for (std::size_t i = 0; i < heights.size(); ++i) rank[heights[i].second] = static_cast<Index>(i);
  return rank;
}

// A triangle rotated so that its smallest corner is first: two that look the same way are equal.
Triangle rotated(const Triangle& t) {
  if (t[1] < t[0] && t[1] < t[2]) return {t[1], t[2], t[0]};
  if (t[2] < t[0] && t[2] < t[1]) return {t[2], t[0], t[1]};
  return t;
}

Triangle reversed(const Triangle& t) {
  return {t[0], t[2], t[1]};
}

// Stamped triangles with nothing stamped behind and all corners open, ascending. Those with a closed corner have
// nothing missing behind them.
std::vector<Triangle> stamped_seam(const StampedSample& sample, const LatticeSites& sites,
                                   std::span<const Index> open) {
  std::vector<Triangle> seam;
  const auto is_open = [&](Index v) { return std::binary_search(open.begin(), open.end(), v); };
  for (const Index v : open) {
    const StampedPatch* patch = sample.patch_of(v);
    if (patch == nullptr) continue;
    patch->each_outside_face(sites.of[v], [&](const Triangle& t) {
      if (*std::min_element(t.begin(), t.end()) == v && is_open(t[0]) && is_open(t[1]) && is_open(t[2])) {
        seam.push_back(rotated(t));
      }
      return true;
    });
  }
  std::sort(seam.begin(), seam.end());
  return seam;
}

// Whether a cell of at most the largest radius should lie behind a triangle (on the side its normal points to): some
// point there makes a sphere with it whose centre is low enough.
bool misses_cell(const StampedSample& sample, const Triangle& t, std::vector<Index>& slots) {
  const auto points = sample.points();
  const double largest = sample.options().largest_radius;
  const Vec3 &a = points[t[0]], u = points[t[1]] - a, v = points[t[2]] - a;
  const Vec3 normal = glm::cross(u, v);
  const double area2 = glm::dot(normal, normal);
  const Vec3 center = a + glm::cross(glm::dot(u, u) * v - glm::dot(v, v) * u, normal) * (0.5 / area2);
  const double radius2 = glm::dot(center - a, center - a);
  const double highest = std::sqrt(std::max(largest * largest - radius2, 0.0)) * (1.0 - 1e-6);
  const double flat = 10.0 * tolerance_of(sample).sphere * largest;
  return !sample.each_in_ball(a, 2.0 * largest, slots, [&](Index p) {
    const Vec3 d = points[p] - center;
    const double height = glm::dot(d, normal) / std::sqrt(area2);
    return height <= flat || (glm::dot(d, d) - radius2) / (2.0 * height) >= highest;
  });
}

// Whether filled and stamped cells meet without gap or overlap: no triangle is seen twice from one side, and behind
// each that is seen from one side only there is no cell to miss.
bool fits(const StampedSample& sample, const std::vector<Triangle>& seam, const std::vector<Tetrahedron>& filled,
          const std::vector<std::array<Index, 4>>& neighbours, Progress& progress) {
  std::vector<std::uint8_t> met(seam.size(), 0);
  std::vector<Triangle> alone;
  const auto find = [&](const Triangle& t) {
    const auto found = std::lower_bound(seam.begin(), seam.end(), t);
    return found != seam.end() && *found == t ? static_cast<std::size_t>(found - seam.begin()) : seam.size();
  };
  for (std::size_t n = 0; n < filled.size(); ++n) {
    for (int f = 0; f < 4; ++f) {
      const auto& c = face_corners[f];
      const Triangle t = rotated({filled[n][c[0]], filled[n][c[1]], filled[n][c[2]]});
      if (find(t) != seam.size()) return false;
      const std::size_t behind = find(reversed(t));
      if (behind != seam.size()) {
        if (neighbours[n][f] != no_index) return false;
        met[behind] = 1;
      } else if (neighbours[n][f] == no_index) {
        alone.push_back(t);
      }
    }
  }
  for (std::size_t s = 0; s < seam.size(); ++s) {
    if (met[s] == 0) alone.push_back(seam[s]);
  }
  std::atomic<bool> whole{true};
  parallel_for(alone.size(), items_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    std::vector<Index> slots;
    for (std::size_t n = begin; n < end && whole; ++n) {
      if (misses_cell(sample, alone[n], slots)) whole = false;
    }
  });
  return whole;
}

}  // namespace

std::optional<std::vector<Tetrahedron>> fill_open(const StampedSample& sample, const LatticeSites& sites,
                                                  std::span<const Index> open, Progress& progress) {
  TetMesh mesh;
  for (const Index i : open) mesh.vertices.push_back(sample.points()[i]);
  std::vector<Tetrahedron> filled;
  if (open.size() >= 4) mesh.tetrahedra = delaunay_cgal(mesh.vertices, progress);
  keep_missing(sample, open, mesh.vertices, mesh.tetrahedra, progress);

  const PolytopeTolerance tolerance = tolerance_of(sample);
  const auto sliver = find_slivers(mesh.tetrahedra, mesh.vertices, tolerance);
  const auto members = gather_polytopes(mesh.tetrahedra, mesh.vertices, face_neighbours(mesh), sliver, tolerance);
  progress.check();
  const std::vector<Index> rank = ranks_by_height(mesh.vertices, sample.direction());
  if (!cut_polytopes(mesh.tetrahedra, mesh.vertices, members, rank, tolerance, filled)) return std::nullopt;
  progress.check();
  mesh.tetrahedra = filled;
  std::vector<std::array<Index, 4>> neighbours;
  try {
    neighbours = face_neighbours(mesh);
  } catch (const Error&) {
    return std::nullopt;  // a face of three
  }
  for (Tetrahedron& t : filled) t = global(t, open);
  if (!fits(sample, stamped_seam(sample, sites, open), filled, neighbours, progress)) return std::nullopt;
  return filled;
}

}  // namespace atomesh
