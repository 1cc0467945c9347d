#include "render/gl/coarse_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/geometry.h"

namespace atomesh::gl {

namespace {

// Of a mesh with many vertices.
constexpr double cells_per_vertex = 6.0;

// Boxes of equal sides over the vertices.
class Grid {
 public:
  Grid(const std::vector<Vec3f>& vertices, double boxes) : low_(vertices.front()) {
    Vec3f high = low_;
    for (const Vec3f& p : vertices) {
      low_ = glm::min(low_, p);
      high = glm::max(high, p);
    }
    middle_ = 0.5F * (low_ + high);
    const Vec3 extent(high - low_);
    // What is flat has one layer of boxes.
    const double thinnest = 1e-3 * std::max({extent.x, extent.y, extent.z, 1e-6});
    const Vec3 sides = glm::max(extent, Vec3(thinnest));
    over_side_ = std::cbrt(boxes / (sides.x * sides.y * sides.z));
    for (int k = 0; k < 3; ++k) {
      const double wanted = std::ceil(extent[k] * over_side_ - 1e-6);
      counts_[k] = std::max<std::size_t>(1, static_cast<std::size_t>(std::max(wanted, 0.0)));
    }
  }

  Vec3f middle() const { return middle_; }
  std::size_t boxes() const { return counts_[0] * counts_[1] * counts_[2]; }
  std::size_t box_of(const Vec3f& p) const {
    std::array<std::size_t, 3> at{};
    for (int k = 0; k < 3; ++k) {
      const double place = static_cast<double>(p[k] - low_[k]) * over_side_;
      at[k] = std::min(static_cast<std::size_t>(std::max(place, 0.0)), counts_[k] - 1);
    }
    return (at[2] * counts_[1] + at[1]) * counts_[0] + at[0];
  }

 private:
  Vec3f low_;
  Vec3f middle_{0.0F};
  double over_side_ = 1.0;
  std::array<std::size_t, 3> counts_{};
};

// Of each vertex the one it becomes.
std::vector<Index> clusters(const Scene& volume, double boxes) {
  const Grid grid(volume.vertices, boxes);
  std::vector<Index> of_box(grid.boxes(), no_index);
  std::vector<Index> of_vertex(volume.vertices.size());
  const auto count = static_cast<Index>(volume.vertices.size());
  const auto rank = [&](Index v) {
    const Vec3f outward = volume.vertices[v] - grid.middle();
    return std::pair(volume.scalars[v], glm::dot(outward, outward));
  };
  for (Index v = 0; v < count; ++v) {
    Index& chosen = of_box[grid.box_of(volume.vertices[v])];
    if (chosen == no_index || rank(v) > rank(chosen)) chosen = v;
  }
  for (Index v = 0; v < count; ++v) of_vertex[v] = of_box[grid.box_of(volume.vertices[v])];
  return of_vertex;
}

// Corners in ascending order, and whether that is an even permutation of the cell's.
struct Cell {
  Tetrahedron corners;
  bool even;
};

Cell sorted(Tetrahedron corners) {
  bool even = true;
  for (std::size_t end = 3; end > 0; --end) {
    for (std::size_t i = 0; i < end; ++i) {
      if (corners[i] <= corners[i + 1]) continue;
      std::swap(corners[i], corners[i + 1]);
      even = !even;
    }
  }
  return {corners, even};
}

}  // namespace

Scene coarse_volume(const Scene& volume, std::size_t cells, Progress& progress) {
  Scene coarse;
  coarse.mode = volume.mode;
  coarse.center = volume.center;
  coarse.bounds = volume.bounds;
  if (volume.vertices.empty()) return coarse;
  const std::vector<Index> becomes = clusters(volume, std::max(1.0, static_cast<double>(cells) / cells_per_vertex));
  progress.check();

  std::vector<Cell> left;
  for (const Tetrahedron& t : volume.tetrahedra) {
    const Cell cell = sorted({becomes[t[0]], becomes[t[1]], becomes[t[2]], becomes[t[3]]});
    const Tetrahedron& c = cell.corners;
    if (c[0] != c[1] && c[1] != c[2] && c[2] != c[3]) left.push_back(cell);
  }
  progress.check();
  std::sort(left.begin(), left.end(), [](const Cell& a, const Cell& b) { return a.corners < b.corners; });
  progress.check();

  // Moving vertices turns some cells inside out. Each point is still covered once, when cells that are inside out count
  // as negative ones; of equal cells the sum stays.
  std::vector<Index> place(volume.vertices.size(), no_index);
  std::vector<Tetrahedron> kept;
  for (auto first = left.begin(); first != left.end();) {
    const Tetrahedron& c = first->corners;
    int sum = 0;
    auto next = first;
    for (; next != left.end() && next->corners == c; ++next) sum += next->even ? 1 : -1;
    first = next;
    if (sum == 0) continue;
    const double size = signed_volume(Vec3(volume.vertices[c[0]]), Vec3(volume.vertices[c[1]]),
                                      Vec3(volume.vertices[c[2]]), Vec3(volume.vertices[c[3]]));
    if (size * sum <= 0.0) continue;
    Tetrahedron corners{};
    for (std::size_t k = 0; k < 4; ++k) {
      Index& v = place[c[k]];
      if (v == no_index) {
        v = static_cast<Index>(coarse.vertices.size());
        coarse.vertices.push_back(volume.vertices[c[k]]);
        coarse.scalars.push_back(volume.scalars[c[k]]);
      }
      corners[k] = v;
    }
    if (size < 0.0) std::swap(corners[2], corners[3]);
    kept.push_back(corners);
  }
  coarse.tetrahedra = Borrowable<Tetrahedron>(std::move(kept));
  return coarse;
}

}  // namespace atomesh::gl
