#include "preprocess/cavity.h"

#include <algorithm>
#include <cmath>

namespace atomesh {

namespace {

// Beyond its star; more than a few flips' worth helps no one.
constexpr std::size_t most_taken_in = 10;

}  // namespace

double shape_of(double six_volumes, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  double longest = 0.0;
  const auto edge = [&](const Vec3& p, const Vec3& q) { longest = std::max(longest, glm::dot(p - q, p - q)); };
  edge(a, b);
  edge(b, c);
  edge(c, a);
  edge(d, a);
  edge(d, b);
  edge(d, c);
  return std::numbers::sqrt2 * six_volumes / (longest * std::sqrt(longest));
}

double Cavity::shape(Corner face, Index apex) const {
  const Tetrahedron& tet = mesh_->tetrahedron(face);
  const auto& corner = face_corners[face % 4];
  const Vec3& a = mesh_->position(tet[corner[0]]);
  const Vec3& b = mesh_->position(tet[corner[1]]);
  const Vec3& c = mesh_->position(tet[corner[2]]);
  const Vec3& d = mesh_->position(apex);
  return shape_of(-6.0 * signed_volume(a, b, c, d), a, b, c, d);
}

double Cavity::grow(const Star& star, Index apex, double floor, double beat) {
  cells_.clear();
  for (const Corner corner : star.corners) cells_.push_back(corner / 4);
  const auto inside = [&](Index cell) {
    const Tetrahedron& tet = mesh_->tetrahedron(4 * cell);
    return std::find(tet.begin(), tet.end(), star.vertex) != tet.end() ||
           std::find(cells_.begin() + static_cast<std::ptrdiff_t>(star.corners.size()), cells_.end(), cell) !=
               cells_.end();
  };
  const auto has = [](const Tetrahedron& tet, Index v) { return std::find(tet.begin(), tet.end(), v) != tet.end(); };
  const auto on_apex = [&](Corner face) {
    const Tetrahedron& tet = mesh_->tetrahedron(face);
    return tet[face % 4] != apex && has(tet, apex);
  };

  faces_ = star.corners;
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    if (on_apex(faces_[i])) continue;
    const double seen = shape(faces_[i], apex);
    if (seen >= floor) {
      if (seen <= beat) return 0.0;
      continue;
    }
    const Corner beyond = mesh_->behind(faces_[i]);
    if (beyond == no_index) return 0.0;
    if (inside(beyond / 4)) continue;
    const Tetrahedron& taken = mesh_->tetrahedron(beyond);
    const auto keep = [&](Index v) { return (*kept_)[v] != 0; };
    if (cells_.size() == star.corners.size() + most_taken_in || std::any_of(taken.begin(), taken.end(), keep))
      return 0.0;
    cells_.push_back(beyond / 4);
    for (Index f = 0; f < 4; ++f) {
      if (f != beyond % 4) faces_.push_back(beyond - beyond % 4 + f);
    }
  }
  if (cells_.size() > star.corners.size()) {
    std::erase_if(faces_, [&](Corner face) {
      const Corner beyond = mesh_->behind(face);
      return beyond != no_index && inside(beyond / 4);
    });
    if (swallows(star.vertex)) return 0.0;
  } else {
    border_ = star.link;
  }

  double worst = 1.0;
  fill_.clear();
  for (const Corner face : faces_) {
    if (on_apex(face)) continue;
    worst = std::min(worst, shape(face, apex));
    const Tetrahedron& tet = mesh_->tetrahedron(face);
    const auto& corner = face_corners[face % 4];
    fill_.push_back({tet[corner[0]], tet[corner[2]], tet[corner[1]], apex});
  }
  return worst;
}

// True when a vertex of the cells other than `vertex` is not on the border.
bool Cavity::swallows(Index vertex) {
  border_.clear();
  for (const Corner face : faces_) {
    const Tetrahedron& tet = mesh_->tetrahedron(face);
    for (const int corner : face_corners[face % 4]) border_.push_back(tet[corner]);
  }
  std::sort(border_.begin(), border_.end());
  border_.erase(std::unique(border_.begin(), border_.end()), border_.end());
  for (const Index cell : cells_) {
    for (const Index v : mesh_->tetrahedron(4 * cell)) {
      if (v != vertex && !std::binary_search(border_.begin(), border_.end(), v)) return true;
    }
  }
  return false;
}

}  // namespace atomesh
