#include "preprocess/pull_polytope.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace atomesh {

namespace {

using Mask = std::uint64_t;  // bit i stands for corner i

constexpr Mask bit(std::size_t i) {
  return Mask{1} << i;
}

struct Face {
  Mask corners = 0;
  Vec3 normal{0.0};  // outward, any length
};

class Polytope {
 public:
  Polytope(std::span<const Index> corners, std::span<const Vec3> points, double tolerance) {
    for (const Index v : corners) corner_.push_back(points[v]);
    const std::size_t n = corner_.size();
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 1; j < n; ++j) {
        for (std::size_t k = j + 1; k < n; ++k) add_face(i, j, k, tolerance);
      }
    }
  }

  const std::vector<Face>& faces() const { return faces_; }

  // The corners of a face, counter-clockwise seen from outside.
  std::vector<std::size_t> polygon(const Face& face) const {
    std::vector<std::size_t> around;
    Vec3 centre(0.0);
    for (std::size_t i = 0; i < corner_.size(); ++i) {
      if ((face.corners & bit(i)) == 0) continue;
      around.push_back(i);
      centre += corner_[i];
    }
    centre /= static_cast<double>(around.size());
    const Vec3 x = corner_[around[0]] - centre;
    const Vec3 y = glm::cross(glm::normalize(face.normal), x);
    std::vector<double> angle(corner_.size());
    for (const std::size_t i : around) {
      angle[i] = std::atan2(glm::dot(corner_[i] - centre, y), glm::dot(corner_[i] - centre, x));
    }
    std::sort(around.begin(), around.end(), [&](std::size_t a, std::size_t b) { return angle[a] < angle[b]; });
    return around;
  }

 private:
  // The plane of three corners, when all others lie on one side of it.
  void add_face(std::size_t i, std::size_t j, std::size_t k, double tolerance) {
    const Mask triple = bit(i) | bit(j) | bit(k);
    for (const Face& face : faces_) {
      if ((face.corners & triple) == triple) return;
    }
    const Vec3 normal = glm::cross(corner_[j] - corner_[i], corner_[k] - corner_[i]);
    const double length = glm::length(normal);
    if (length == 0.0) return;
    Mask on = triple;
    bool above = false;
    bool below = false;
    for (std::size_t m = 0; m < corner_.size(); ++m) {
      if ((triple & bit(m)) != 0) continue;
      const double height = glm::dot(normal, corner_[m] - corner_[i]) / length;
      if (height > tolerance) above = true;
      if (height < -tolerance) below = true;
      if (above && below) return;
      if (std::abs(height) <= tolerance) on |= bit(m);
    }
    faces_.push_back({on, above ? -normal : normal});
  }

  std::vector<Vec3> corner_;
  std::vector<Face> faces_;
};

}  // namespace

bool pull_polytope(std::span<const Index> corners, std::span<const Vec3> points, std::span<const Index> rank,
                   double tolerance, std::vector<Tetrahedron>& tetrahedra) {
  if (corners.size() < 4 || corners.size() > pull_polytope_corners) return false;
  const Polytope polytope(corners, points, tolerance);
  const auto lower = [&](std::size_t a, std::size_t b) { return rank[corners[a]] < rank[corners[b]]; };
  std::size_t apex = 0;
  for (std::size_t i = 1; i < corners.size(); ++i) apex = lower(i, apex) ? i : apex;

  bool spans_volume = false;
  for (const Face& face : polytope.faces()) {
    if ((face.corners & bit(apex)) != 0) continue;
    spans_volume = true;
    std::vector<std::size_t> around = polytope.polygon(face);
    std::rotate(around.begin(), std::min_element(around.begin(), around.end(), lower), around.end());
    for (std::size_t i = 1; i + 1 < around.size(); ++i) {
      // The apex lies behind the triangle, so the triangle is passed the other way round.
      tetrahedra.push_back({corners[around[0]], corners[around[i + 1]], corners[around[i]], corners[apex]});
    }
  }
  return spans_volume;
}

}  // namespace atomesh
