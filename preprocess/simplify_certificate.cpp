#include "preprocess/simplify_certificate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "core/predicates.h"
#include "preprocess/canonical_tetrahedra.h"

namespace atomesh {

namespace {

constexpr std::size_t points_per_range = 1 << 14;

bool any_defect(const Tetrahedron& tet, std::span<const DefectValues> defects) {
  return defects[tet[0]].any() || defects[tet[1]].any() || defects[tet[2]].any() || defects[tet[3]].any();
}

double difference(const DefectValues& a, const std::array<double, 3>& b) {
  return std::max({std::abs(static_cast<double>(a.positional) - b[0]), std::abs(static_cast<double>(a.extra) - b[1]),
                   std::abs(static_cast<double>(a.vacancy) - b[2])});
}

// The boxes of some tetrahedra on a regular grid: which of them may hold a point.
class TetrahedronGrid {
 public:
  TetrahedronGrid(const TetMesh& mesh, std::span<const Index> tetrahedra) {
    for (const Index t : tetrahedra) {
      for (const Index v : mesh.tetrahedra[t]) bounds_.add(mesh.vertices[v]);
    }
    // About one cell for each tetrahedron, as even as the box allows.
    const Vec3 extent = glm::max(bounds_.extent(), Vec3(1e-3 * bounds_.diagonal()));
    const double edge = std::cbrt(extent.x * extent.y * extent.z / static_cast<double>(tetrahedra.size()));
    for (int axis = 0; axis < 3; ++axis) {
      count_[axis] = static_cast<std::size_t>(std::clamp(extent[axis] / edge, 1.0, 1024.0));
      scale_[axis] = static_cast<double>(count_[axis]) / extent[axis];
    }
    first_.assign(count_[0] * count_[1] * count_[2] + 1, 0);
    for (const Index t : tetrahedra) {
      for_cells(mesh, t, [&](std::size_t cell) { ++first_[cell + 1]; });
    }
    for (std::size_t cell = 0; cell + 1 < first_.size(); ++cell) first_[cell + 1] += first_[cell];
    member_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (const Index t : tetrahedra) {
      for_cells(mesh, t, [&](std::size_t cell) { member_[next[cell]++] = t; });
    }
  }

  std::span<const Index> around(const Vec3& p) const {
    if (glm::any(glm::lessThan(p, bounds_.min)) || glm::any(glm::greaterThan(p, bounds_.max))) return {};
    const std::size_t cell = (place(p, 0) * count_[1] + place(p, 1)) * count_[2] + place(p, 2);
    return std::span(member_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
  }

 private:
  std::size_t place(const Vec3& p, int axis) const {
    return std::min(static_cast<std::size_t>((p[axis] - bounds_.min[axis]) * scale_[axis]), count_[axis] - 1);
  }
  template <class Body>
  void for_cells(const TetMesh& mesh, Index t, Body&& body) const {
    Bounds box;
    for (const Index v : mesh.tetrahedra[t]) box.add(mesh.vertices[v]);
    for (std::size_t i = place(box.min, 0); i <= place(box.max, 0); ++i) {
      for (std::size_t j = place(box.min, 1); j <= place(box.max, 1); ++j) {
        for (std::size_t k = place(box.min, 2); k <= place(box.max, 2); ++k) {
          body((i * count_[1] + j) * count_[2] + k);
        }
      }
    }
  }

  Bounds bounds_;
  std::array<std::size_t, 3> count_{1, 1, 1};
  Vec3 scale_{1.0};
  std::vector<std::size_t> first_;
  std::vector<Index> member_;
};

// Difference at p when the tetrahedron holds it, else none (negative).
double error_inside(const TetMesh& mesh, const Tetrahedron& tet, std::span<const DefectValues> defects, const Vec3& p,
                    const DefectValues& value) {
  for (const auto& c : face_corners) {
    const auto at = [&](int corner) -> const Vec3& { return mesh.vertices[tet[corner]]; };
    if (orientation(at(c[0]), at(c[1]), at(c[2]), p) > 0) return -1.0;
  }
  double whole = 0.0;
  std::array<double, 3> sum{};
  for (int f = 0; f < 4; ++f) {
    const auto& c = face_corners[f];
    const double weight =
        std::max(0.0, -signed_volume(mesh.vertices[tet[c[0]]], mesh.vertices[tet[c[1]]], mesh.vertices[tet[c[2]]], p));
    const DefectValues& corner = defects[tet[f]];
    whole += weight;
    sum[0] += weight * static_cast<double>(corner.positional);
    sum[1] += weight * static_cast<double>(corner.extra);
    sum[2] += weight * static_cast<double>(corner.vacancy);
  }
  for (double& s : sum) s = whole > 0.0 ? s / whole : 0.0;
  return difference(value, sum);
}

struct BorderEdge {
  std::uint64_t ends;  // smaller vertex << 32 | larger
  Index triangle;
  Index opposite;  // the triangle's third vertex
};

}  // namespace

std::vector<Triangle> sorted_triangles(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

std::vector<Tetrahedron> defect_tetrahedra(std::span<const Tetrahedron> tetrahedra,
                                           std::span<const DefectValues> defects) {
  std::vector<Tetrahedron> found;
  for (const Tetrahedron& tet : tetrahedra) {
    if (any_defect(tet, defects)) found.push_back(canonical(tet));
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::size_t least_tetrahedra(std::size_t kept, const std::vector<Triangle>& border, const std::vector<Vec3>& vertices) {
  std::vector<BorderEdge> edges;
  edges.reserve(3 * border.size());
  for (std::size_t t = 0; t < border.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const std::uint64_t a = border[t][i], b = border[t][(i + 1) % 3];
      edges.push_back({std::min(a, b) << 32U | std::max(a, b), static_cast<Index>(t), border[t][(i + 2) % 3]});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const BorderEdge& a, const BorderEdge& b) {
    return a.ends != b.ends ? a.ends < b.ends : a.triangle < b.triangle;
  });
  std::vector<std::pair<Index, Index>> partners;  // (triangle, apex of a tetrahedron that holds it and a neighbour)
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i;
    while (j < edges.size() && edges[j].ends == edges[i].ends) ++j;
    for (std::size_t a = i; a < j; ++a) {
      const auto& [p, q, r] = border[edges[a].triangle];
      for (std::size_t b = i; b < j; ++b) {
        const Index apex = edges[b].opposite;
        if (a == b || apex == edges[a].opposite) continue;
        if (orientation(vertices[p], vertices[q], vertices[r], vertices[apex]) < 0) {
          partners.emplace_back(edges[a].triangle, apex);
        }
      }
    }
    i = j;
  }
  std::sort(partners.begin(), partners.end());
  std::vector<std::uint8_t> shares(border.size(), 0);
  for (std::size_t i = 0; i < partners.size();) {
    std::size_t j = i;
    while (j < partners.size() && partners[j] == partners[i]) ++j;
    std::uint8_t& most = shares[partners[i].first];
    most = static_cast<std::uint8_t>(std::max<std::size_t>(most, std::min<std::size_t>(j - i, 3)));
    i = j;
  }
  std::size_t twelfths = 0;
  for (const std::uint8_t s : shares) twelfths += 12U / (1U + s);
  return kept + (twelfths + 11) / 12;
}

double interpolation_error(const TetMesh& mesh, std::span<const DefectValues> defects, std::span<const Vec3> points,
                           std::span<const DefectValues> values, Progress& progress) {
  std::vector<Index> defective;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (any_defect(mesh.tetrahedra[t], defects)) defective.push_back(static_cast<Index>(t));
  }
  if (points.empty()) return 0.0;
  if (defective.empty()) {
    double largest = 0.0;
    for (const DefectValues& value : values) largest = std::max(largest, difference(value, {}));
    return largest;
  }
  const TetrahedronGrid grid(mesh, defective);
  std::vector<double> range_error((points.size() + points_per_range - 1) / points_per_range, 0.0);
  parallel_for(points.size(), points_per_range, [&](std::size_t begin, std::size_t end) {
    double& largest = range_error[begin / points_per_range];
    for (std::size_t i = begin; i < end; ++i) {
      if (i % 256 == 0) progress.check();
      double error = -1.0;
      for (const Index t : grid.around(points[i])) {
        error = std::max(error, error_inside(mesh, mesh.tetrahedra[t], defects, points[i], values[i]));
      }
      largest = std::max(largest, error < 0.0 ? difference(values[i], {}) : error);
    }
  });
  return *std::max_element(range_error.begin(), range_error.end());
}

}  // namespace atomesh
