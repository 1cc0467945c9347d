#include "preprocess/stamp_pattern.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/circumsphere.h"

namespace atomesh {

namespace {

// Shares of the nearest-neighbour distance, and of the separation of heights, that an atom in place may be off.
constexpr double in_place_of_neighbour = 0.02;
constexpr double in_place_of_separation = 0.2;

double fatness(const std::array<Vec3, 4>& p) {
  double longest = 0.0;
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) longest = std::max(longest, glm::distance(p[i], p[j]));
  }
  return signed_volume(p[0], p[1], p[2], p[3]) / (longest * longest * longest);
}

// The least difference of the heights of two corners.
double separation(const std::vector<Vec3>& corners, const Vec3& direction) {
  std::vector<double> heights;
  for (const Vec3& p : corners) heights.push_back(glm::dot(p, direction));
  std::sort(heights.begin(), heights.end());
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < heights.size(); ++i) least = std::min(least, heights[i] - heights[i - 1]);
  return least;
}

}  // namespace

PatchPattern::PatchPattern(const LatticeTemplate& pattern, const LatticePatch& patch, const Vec3& direction)
    : matrix_(patch.matrix), origin_(patch.origin), direction_(direction) {
  if (!(std::abs(glm::determinant(matrix_)) > 0.0)) return;
  inverse_ = glm::inverse(matrix_);
  for (int k = 0; k < 3; ++k) {
    // Rows of the inverse are the reciprocal vectors.
    cells_per_length_[k] = glm::length(Vec3(inverse_[0][k], inverse_[1][k], inverse_[2][k]));
  }
  const Mat3 to_fraction = glm::inverse(pattern.cell.matrix());
  for (const BasisAtom& atom : pattern.cell.basis) fractional_.push_back(to_fraction * atom.position);
  in_place_ = in_place_of_neighbour * nearest_neighbour();

  around_.resize(fractional_.size());
  for (const TemplatePolytope& t : pattern.polytopes) {
    PatternPolytope polytope;
    polytope.corners = t.corners;
    std::vector<Vec3> corners;
    for (const SiteOffset& s : t.corners) corners.push_back(offset_position(s));
    polytope.whole = cut(polytope, ~std::uint64_t{0});
    if (corners.size() > 4) in_place_ = std::min(in_place_, in_place_of_separation * separation(corners, direction));
    for (std::size_t c = 0; c < t.corners.size(); ++c) {
      const auto& cell = t.corners[c].cell;
      around_[t.corners[c].basis].push_back(
          {static_cast<Index>(polytopes_.size()), {-cell[0], -cell[1], -cell[2]}, static_cast<std::uint8_t>(c)});
    }
    polytopes_.push_back(std::move(polytope));
  }
  usable_ = !polytopes_.empty() && in_place_ > 0.0 && place_spheres() && join_faces();
  if (usable_) find_close_sites();
}

double PatchPattern::certain(const PatternPolytope& polytope, double largest_radius, double tolerance) const {
  const double room = std::min({tolerance * polytope.radius - polytope.spread, largest_radius - polytope.radius,
                                0.5 * (polytope.gap - tolerance * polytope.radius), in_place_});
  return room > 0.0 ? 0.5 * room / polytope.steep : 0.0;
}

double PatchPattern::exact(double largest_radius, double tolerance) const {
  double least = 0.0;
  for (const PatternPolytope& polytope : polytopes_) {
    const double off = certain(polytope, largest_radius, tolerance);
    if (off > 0.0 && (least == 0.0 || off < least)) least = off;
  }
  return least;
}

double PatchPattern::nearest_neighbour() const {
  double nearest = glm::length(matrix_[0]);
  for (std::size_t a = 0; a < fractional_.size(); ++a) {
    for (std::size_t b = 0; b < fractional_.size(); ++b) {
      for (int n = 0; n < 27; ++n) {
        if (a == b && n == 13) continue;
        const Vec3 d = fractional_[b] - fractional_[a] + Vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
        nearest = std::min(nearest, glm::length(matrix_ * d));
      }
    }
  }
  return nearest;
}

PatternCut PatchPattern::cut(const PatternPolytope& polytope, std::uint64_t occupied) const {
  std::vector<std::uint8_t> kept;
  std::vector<Vec3> places;
  for (std::size_t c = 0; c < polytope.corners.size(); ++c) {
    if ((occupied >> c & 1) == 0) continue;
    kept.push_back(static_cast<std::uint8_t>(c));
    places.push_back(offset_position(polytope.corners[c]));
  }
  PatternCut result;
  double fattest = 0.0;
  std::map<std::array<std::uint8_t, 3>, std::vector<std::array<std::uint8_t, 3>>> triangles;
  for (const auto& local : cut_polytope(places, direction_)) {
    const std::array<std::uint8_t, 4> t{kept[local[0]], kept[local[1]], kept[local[2]], kept[local[3]]};
    result.tetrahedra.push_back(t);
    const double fat = fatness({places[local[0]], places[local[1]], places[local[2]], places[local[3]]});
    if (fat > fattest * (1.0 + 1e-6)) {
      fattest = fat;
      result.frame = t;
    }
    for (const auto& f : face_corners) {
      const std::array<std::uint8_t, 3> triangle{t[f[0]], t[f[1]], t[f[2]]};
      auto sorted = triangle;
      std::sort(sorted.begin(), sorted.end());
      triangles[sorted].push_back(triangle);
    }
  }
  for (const auto& [sorted, seen] : triangles) {
    if (seen.size() == 1) result.faces.push_back(seen[0]);  // otherwise between two tetrahedra
  }
  return result;
}

bool PatchPattern::place_spheres() {
  for (PatternPolytope& polytope : polytopes_) {
    if (polytope.whole.tetrahedra.empty()) return false;
    const auto corner = [&](std::size_t c) { return offset_position(polytope.corners[c]); };
    for (const auto& t : polytope.whole.tetrahedra) {
      if (!(fatness({corner(t[0]), corner(t[1]), corner(t[2]), corner(t[3])}) > 0.0)) return false;
    }
    const auto& f = polytope.whole.frame;
    const Sphere sphere = circumsphere(corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3]));
    polytope.center = sphere.center;
    polytope.center_fraction = inverse_ * sphere.center;
    polytope.radius = sphere.radius;
    // Distances to the centre that change by up to d move it by (edges)⁻¹ · (up to 2 d × radius each).
    const Mat3 edges =
        glm::transpose(Mat3(corner(f[1]) - corner(f[0]), corner(f[2]) - corner(f[0]), corner(f[3]) - corner(f[0])));
    const Mat3 inverse = glm::inverse(edges);
    const double norm = std::sqrt(glm::dot(inverse[0], inverse[0]) + glm::dot(inverse[1], inverse[1]) +
                                  glm::dot(inverse[2], inverse[2]));
    polytope.steep = 2.0 + 4.0 * std::sqrt(3.0) * norm * sphere.radius;
    for (std::size_t c = 0; c < polytope.corners.size(); ++c) {
      polytope.spread = std::max(polytope.spread, std::abs(glm::distance(corner(c), sphere.center) - sphere.radius));
    }
    largest_void_ = std::max(largest_void_, polytope.radius);
  }
  return true;
}

// Each triangle of the outside is, but for a translation, that of one other polytope (or of the same): the triangle's
// sites, sorted and counted from the cell of the first, tell which.
bool PatchPattern::join_faces() {
  using Name = std::array<std::array<int, 4>, 3>;
  struct Place {
    Index polytope;
    std::size_t face;
    std::array<int, 3> cell;
  };
  std::map<Name, std::vector<Place>> places;
  for (std::size_t p = 0; p < polytopes_.size(); ++p) {
    PatternPolytope& polytope = polytopes_[p];
    polytope.neighbours.resize(polytope.whole.faces.size());
    for (std::size_t f = 0; f < polytope.whole.faces.size(); ++f) {
      Name name;
      for (int i = 0; i < 3; ++i) {
        const SiteOffset& s = polytope.corners[polytope.whole.faces[f][i]];
        name[i] = {s.basis, s.cell[0], s.cell[1], s.cell[2]};
      }
      std::sort(name.begin(), name.end());
      const std::array<int, 3> cell{name[0][1], name[0][2], name[0][3]};
      for (auto& site : name) {
        for (int k = 0; k < 3; ++k) site[k + 1] -= cell[k];
      }
      places[name].push_back({static_cast<Index>(p), f, cell});
    }
  }
  for (const auto& [name, pair] : places) {
    if (pair.size() != 2) return false;
    for (int side = 0; side < 2; ++side) {
      const Place &here = pair[side], &there = pair[1 - side];
      PatternNeighbour& neighbour = polytopes_[here.polytope].neighbours[here.face];
      neighbour.polytope = there.polytope;
      for (int k = 0; k < 3; ++k) neighbour.cell[k] = here.cell[k] - there.cell[k];
    }
  }
  return true;
}

template <class Body>
void PatchPattern::for_cells(const Vec3& fraction, double radius, Body&& body) const {
  std::array<int, 3> low, high;
  for (int k = 0; k < 3; ++k) {
    low[k] = static_cast<int>(std::ceil(fraction[k] - radius * cells_per_length_[k]));
    high[k] = static_cast<int>(std::floor(fraction[k] + radius * cells_per_length_[k]));
  }
  std::array<int, 3> cell;
  for (cell[0] = low[0]; cell[0] <= high[0]; ++cell[0]) {
    for (cell[1] = low[1]; cell[1] <= high[1]; ++cell[1]) {
      for (cell[2] = low[2]; cell[2] <= high[2]; ++cell[2]) body(cell);
    }
  }
}

void PatchPattern::find_close_sites() {
  for (PatternPolytope& polytope : polytopes_) {
    const double reach = polytope.radius + close_slack * in_place_;
    polytope.gap = close_slack * in_place_;
    for (std::size_t b = 0; b < fractional_.size(); ++b) {
      for_cells(inverse_ * polytope.center - fractional_[b], reach, [&](const std::array<int, 3>& cell) {
        const Vec3 p = matrix_ * (Vec3(cell[0], cell[1], cell[2]) + fractional_[b]);
        if (glm::distance(p, polytope.center) >= reach) return;
        const SiteOffset s{
            {static_cast<std::int8_t>(cell[0]), static_cast<std::int8_t>(cell[1]), static_cast<std::int8_t>(cell[2])},
            static_cast<std::uint16_t>(b)};
        if (std::find(polytope.corners.begin(), polytope.corners.end(), s) == polytope.corners.end()) {
          polytope.gap = std::min(polytope.gap, glm::distance(p, polytope.center) - polytope.radius);
          polytope.close.push_back(s);
        }
      });
    }
  }
}

}  // namespace atomesh
