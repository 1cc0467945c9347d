#include "app/gui/sight_line.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <tuple>

#include "core/parallel.h"
#include "render/cpu/triangle_raster.h"

namespace atomesh::gui {

namespace {

constexpr std::size_t items_per_range = 1 << 16;

constexpr std::uint8_t right_of_line = 1;
constexpr std::uint8_t left_of_line = 2;
constexpr std::uint8_t above_line = 4;
constexpr std::uint8_t below_line = 8;

// On which side of the edge from p to q the line goes by, which is (0, 0): the sign of twice the area of the triangle.
// Where that is zero the line is moved by (ε, ε²), so that it never meets an edge; exactly opposite for (q, p).
int side(const Vec3& p, const Vec3& q) {
  const double area = p.x * q.y - p.y * q.x;
  if (area != 0.0) return area > 0.0 ? 1 : -1;
  if (p.y != q.y) return p.y > q.y ? 1 : -1;
  return q.x > p.x ? 1 : q.x < p.x ? -1 : 0;
}

// Items for which `meet` finds something, from all threads.
template <class Found, class Meet>
std::vector<Found> collect(std::size_t count, const Progress& progress, Meet&& meet) {
  std::vector<Found> all;
  std::mutex mutex;
  parallel_for(count, items_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    std::vector<Found> here;
    for (std::size_t i = begin; i < end; ++i) meet(i, here);
    if (here.empty()) return;
    const std::scoped_lock lock(mutex);
    all.insert(all.end(), here.begin(), here.end());
  });
  return all;
}

}  // namespace

SightLine::SightLine(const Scene& scene, const Camera& camera, int column, int row)
    : scene_(scene),
      camera_(camera),
      eye_(camera.eye - scene.center),
      // As far beside the pixel's centre as the renderers' rays, so that it is the same triangle.
      x_(camera.x_of(column + surface_ray_shift)),
      y_(camera.y_of(row - surface_ray_shift * surface_ray_lift)),
      perspective_(camera.projection == Projection::perspective),
      stretch_(perspective_ ? std::sqrt(1.0 + x_ * x_ + y_ * y_) : 1.0),
      sides_(scene.vertices.size()) {
  parallel_for(sides_.size(), items_per_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Vec3 p = about_line(scene_.vertices[v]);
      sides_[v] = static_cast<std::uint8_t>((p.x > 0.0   ? right_of_line
                                             : p.x < 0.0 ? left_of_line
                                                         : 0) |
                                            (p.y > 0.0   ? above_line
                                             : p.y < 0.0 ? below_line
                                                         : 0));
    }
  });
}

Vec3 SightLine::about_line(const Vec3f& vertex) const {
  const Vec3 p = Vec3(vertex) - eye_;
  const double depth = glm::dot(p, camera_.forward);
  const double scale = perspective_ ? depth : 1.0;
  return {glm::dot(p, camera_.right) - x_ * scale, glm::dot(p, camera_.up) - y_ * scale, depth};
}

Vec3 SightLine::point(double depth) const {
  const double scale = perspective_ ? depth : 1.0;
  return eye_ + x_ * scale * camera_.right + y_ * scale * camera_.up + depth * camera_.forward;
}

std::optional<TriangleCrossing> SightLine::cross(const Vec3& a, const Vec3& b, const Vec3& c) const {
  const int first = side(a, b);
  if (first == 0 || side(b, c) != first || side(c, a) != first) return std::nullopt;
  TriangleCrossing crossing;
  crossing.entering = first > 0;
  crossing.weights = {std::abs(b.x * c.y - b.y * c.x), std::abs(c.x * a.y - c.y * a.x),
                      std::abs(a.x * b.y - a.y * b.x)};
  const double sum = crossing.weights[0] + crossing.weights[1] + crossing.weights[2];
  if (!(sum > 0.0)) return std::nullopt;  // edge-on: what is before and behind it is met all the same
  for (double& weight : crossing.weights) weight /= sum;
  crossing.depth = crossing.weights[0] * a.z + crossing.weights[1] * b.z + crossing.weights[2] * c.z;
  return crossing;
}

std::vector<TriangleCrossing> SightLine::triangles(std::span<const Triangle> triangles,
                                                   const Progress& progress) const {
  auto met = collect<TriangleCrossing>(triangles.size(), progress, [&](std::size_t t, auto& here) {
    const Triangle& corners = triangles[t];
    if ((sides_[corners[0]] & sides_[corners[1]] & sides_[corners[2]]) != 0) return;
    auto crossing = cross(about_line(scene_.vertices[corners[0]]), about_line(scene_.vertices[corners[1]]),
                          about_line(scene_.vertices[corners[2]]));
    if (!crossing || !(crossing->depth > 0.0)) return;
    crossing->triangle = static_cast<Index>(t);
    here.push_back(*crossing);
  });
  std::sort(met.begin(), met.end(), [](const TriangleCrossing& a, const TriangleCrossing& b) {
    return std::tie(a.depth, a.triangle) < std::tie(b.depth, b.triangle);
  });
  return met;
}

std::vector<CellCrossing> SightLine::cells(std::span<const Tetrahedron> cells, const Progress& progress) const {
  auto met = collect<CellCrossing>(cells.size(), progress, [&](std::size_t t, auto& here) {
    const Tetrahedron& cell = cells[t];
    if ((sides_[cell[0]] & sides_[cell[1]] & sides_[cell[2]] & sides_[cell[3]]) != 0) return;
    std::array<Vec3, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = about_line(scene_.vertices[cell[i]]);
    CellCrossing crossing;
    bool found_near = false;
    bool found_far = false;
    for (const auto& face : face_corners) {
      const auto through = cross(corners[face[0]], corners[face[1]], corners[face[2]]);
      if (!through) continue;
      (through->entering ? found_near : found_far) = true;
      (through->entering ? crossing.near_depth : crossing.far_depth) = through->depth;
      auto& weights = through->entering ? crossing.near_weights : crossing.far_weights;
      for (std::size_t i = 0; i < 3; ++i) weights[face[i]] = through->weights[i];
    }
    if (!found_near || !found_far || !(crossing.far_depth > 0.0)) return;
    if (crossing.near_depth < 0.0) {  // the eye is in it
      const double u = -crossing.near_depth / (crossing.far_depth - crossing.near_depth);
      for (std::size_t i = 0; i < 4; ++i) {
        crossing.near_weights[i] += u * (crossing.far_weights[i] - crossing.near_weights[i]);
      }
      crossing.near_depth = 0.0;
    }
    crossing.cell = static_cast<Index>(t);
    here.push_back(crossing);
  });
  std::sort(met.begin(), met.end(), [](const CellCrossing& a, const CellCrossing& b) {
    return std::tie(a.near_depth, a.far_depth, a.cell) < std::tie(b.near_depth, b.far_depth, b.cell);
  });
  return met;
}

}  // namespace atomesh::gui
