#include "render/cpu/reference_sight.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/predicates.h"
#include "render/cpu/reference_exact.h"

namespace atomesh::reference {

namespace {

// Barycentric weights of a point (nearly) in the plane of a triangle with normal n = (b-a)×(c-a). Rounding can leave a
// point near an edge a hair outside; it is moved back.
std::array<double, 3> weights_at(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& n) {
  const double u = std::max(0.0, glm::dot(n, glm::cross(b - p, c - p)));
  const double v = std::max(0.0, glm::dot(n, glm::cross(c - p, a - p)));
  const double w = std::max(0.0, glm::dot(n, glm::cross(a - p, b - p)));
  const double sum = u + v + w;
  if (!(sum > 0.0)) return {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};
  return {u / sum, v / sum, w / sum};
}

// Faces that the ray meets at less than this angle (its sine) are located by their exact image instead of their plane.
constexpr double edge_on = 1e-4;

}  // namespace

Sight::Sight(const Scene& scene, const Camera& camera)
    : camera_(camera), perspective_(camera.projection == Projection::perspective), eye_(camera.eye - scene.center) {
  view_.reserve(scene.vertices.size());
  for (const Vec3f& v : scene.vertices) view_.push_back(to_view(Vec3(v)));
}

Vec3 Sight::to_view(const Vec3& scene_point) const {
  const Vec3 p = scene_point - eye_;
  return {glm::dot(p, camera_.right), glm::dot(p, camera_.up), glm::dot(p, camera_.forward)};
}

double Sight::stretch(const PixelRay& ray) const {
  return perspective_ ? std::sqrt(1.0 + ray.x * ray.x + ray.y * ray.y) : 1.0;
}

Vec3 Sight::point(const PixelRay& ray, double depth) const {
  const double scale = perspective_ ? depth : 1.0;
  return eye_ + ray.x * scale * camera_.right + ray.y * scale * camera_.up + depth * camera_.forward;
}

Vec3 Sight::to_viewer(const PixelRay& ray) const {
  if (!perspective_) return -camera_.forward;
  return -glm::normalize(camera_.forward + ray.x * camera_.right + ray.y * camera_.up);
}

// Edges are taken in one direction only, so that the two triangles at an edge get exactly opposite answers.
int Sight::side(const PixelRay& ray, Index a, Index b) const {
  if (a > b) return -side(ray, b, a);
  return side_of_line(ray.x, ray.y, image_point(view_[a]), image_point(view_[b]));
}

double Sight::image_area(const PixelRay& ray, const Vec3& p, const Vec3& q) const {
  return value_at_line(ray.x, ray.y, image_point(p), image_point(q));
}

// The corners are taken in ascending order, so that the two cells at a face get exactly the same depth.
Crossing Sight::locate(const PixelRay& ray, const Triangle& triangle, bool entering) const {
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&triangle](int i, int j) { return triangle[i] < triangle[j]; });
  const Vec3& a = view_[triangle[order[0]]];
  const Vec3& b = view_[triangle[order[1]]];
  const Vec3& c = view_[triangle[order[2]]];
  const Vec3 origin = perspective_ ? Vec3(0.0) : Vec3(ray.x, ray.y, 0.0);
  const Vec3 direction = perspective_ ? Vec3(ray.x, ray.y, 1.0) : Vec3(0.0, 0.0, 1.0);
  const Vec3 normal = glm::cross(b - a, c - a);
  const double slope = glm::dot(normal, direction);
  double depth = 0.0;
  std::array<double, 3> sorted{};
  if (std::abs(slope) > edge_on * glm::length(normal) * glm::length(direction)) {
    depth = glm::dot(normal, a - origin) / slope;
    sorted = weights_at(origin + depth * direction, a, b, c, normal);
  } else {
    // The plane tells little about the depth of a face seen (almost) edge-on; the areas of the three triangles it is
    // divided into in the picture do, taken without rounding.
    sorted = {std::abs(image_area(ray, b, c)), std::abs(image_area(ray, c, a)), std::abs(image_area(ray, a, b))};
    const double sum = sorted[0] + sorted[1] + sorted[2];
    for (double& weight : sorted) weight /= sum;
    depth = sorted[0] * a.z + sorted[1] * b.z + sorted[2] * c.z;
  }
  Crossing crossing;
  crossing.depth = depth;
  crossing.entering = entering;
  for (int i = 0; i < 3; ++i) crossing.weights[order[i]] = sorted[i];
  return crossing;
}

std::optional<Crossing> Sight::cross_triangle(const PixelRay& ray, const Triangle& triangle) const {
  const int first = side(ray, triangle[0], triangle[1]);
  if (first == 0 || side(ray, triangle[1], triangle[2]) != first || side(ray, triangle[2], triangle[0]) != first) {
    return std::nullopt;
  }
  // Right, up and forward are a left-handed system: a triangle that turns counter-clockwise towards the viewer has
  // positive sides here.
  return locate(ray, triangle, first > 0);
}

bool Sight::touches_eye(const Tetrahedron& cell, std::array<bool, 4>& in_plane) const {
  in_plane = {};
  if (!perspective_ || std::all_of(cell.begin(), cell.end(), [this](Index v) { return view_[v].z > 0.0; }))
    return false;
  bool touched = false;
  for (std::size_t f = 0; f < 4; ++f) {
    const auto& corners = face_corners[f];
    const Vec3& a = view_[cell[corners[0]]];
    const Vec3& b = view_[cell[corners[1]]];
    const Vec3& c = view_[cell[corners[2]]];
    const int side = orientation(a, b, c, Vec3(0.0));
    if (side != 0 && side != orientation(a, b, c, view_[cell[f]])) {  // outside
      in_plane = {};
      return false;
    }
    in_plane[f] = side == 0;
    touched = touched || in_plane[f];
  }
  return touched;
}

// The edges' planes are the face's own, or for edges that the eye is on none at all.
bool Sight::heads_inward(const PixelRay& ray, const Triangle& face) const {
  for (std::size_t i = 0; i < 3; ++i) {
    if (const int sign = side(ray, face[i], face[(i + 1) % 3]); sign != 0) return sign > 0;
  }
  return false;
}

std::array<double, 4> Sight::weights_of_eye(const Tetrahedron& cell) const {
  std::array<double, 4> weights{};
  double sum = 0.0;
  for (std::size_t f = 0; f < 4; ++f) {
    const auto& corners = face_corners[f];
    weights[f] =
        std::abs(glm::dot(view_[cell[corners[0]]], glm::cross(view_[cell[corners[1]]], view_[cell[corners[2]]])));
    sum += weights[f];
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

std::optional<CellSegment> Sight::cross_cell(const PixelRay& ray, const Tetrahedron& cell) const {
  CellSegment segment;
  bool found_near = false;
  bool found_far = false;
  // Faces through the eye are lines in the picture, and where the ray meets them is the eye itself.
  std::array<bool, 4> in_plane{};
  if (touches_eye(cell, in_plane)) {
    found_near = true;
    segment.near_depth = 0.0;
    segment.near_weights = weights_of_eye(cell);
  }
  for (std::size_t f = 0; f < 4; ++f) {
    const auto& corners = face_corners[f];
    const Triangle face{cell[corners[0]], cell[corners[1]], cell[corners[2]]};
    if (in_plane[f]) {
      if (!heads_inward(ray, face)) return std::nullopt;
      continue;
    }
    const auto crossing = cross_triangle(ray, face);
    if (!crossing) continue;
    std::array<double, 4> weights{};
    for (int i = 0; i < 3; ++i) weights[corners[i]] = crossing->weights[i];
    (crossing->entering ? found_near : found_far) = true;
    (crossing->entering ? segment.near_depth : segment.far_depth) = crossing->depth;
    (crossing->entering ? segment.near_weights : segment.far_weights) = weights;
  }
  if (!found_near || !found_far) return std::nullopt;
  return segment;
}

Sight::Extent Sight::extent_of_points(const Vec3* points, int count) const {
  double min_x = std::numeric_limits<double>::infinity();
  double min_y = min_x;
  double max_x = -min_x;
  double max_y = -min_x;
  for (int i = 0; i < count; ++i) {
    const Vec3& p = points[i];
    if (perspective_ && !(p.z > 0.0)) return {0, camera_.width - 1, 0, camera_.height - 1};
    const double scale = perspective_ ? 1.0 / p.z : 1.0;
    min_x = std::min(min_x, p.x * scale);
    max_x = std::max(max_x, p.x * scale);
    min_y = std::min(min_y, p.y * scale);
    max_y = std::max(max_y, p.y * scale);
  }
  // A pixel more on every side than the pixels whose centres are covered.
  const auto clamp_to = [](double value, int size) { return static_cast<int>(std::clamp(value, -1.0, size + 0.0)); };
  const double w = camera_.width;
  const double h = camera_.height;
  Extent extent;
  extent.left = std::max(0, clamp_to(std::floor(min_x / camera_.pixel + 0.5 * w) - 1.0, camera_.width));
  extent.right =
      std::min(camera_.width - 1, clamp_to(std::floor(max_x / camera_.pixel + 0.5 * w) + 1.0, camera_.width));
  extent.top = std::max(0, clamp_to(std::floor(0.5 * h - max_y / camera_.pixel) - 1.0, camera_.height));
  extent.bottom =
      std::min(camera_.height - 1, clamp_to(std::floor(0.5 * h - min_y / camera_.pixel) + 1.0, camera_.height));
  return extent;
}

Sight::Extent Sight::extent_of_vertices(const Index* vertices, int count) const {
  std::array<Vec3, 4> points{};
  for (int i = 0; i < count; ++i) points[i] = view_[vertices[i]];
  return extent_of_points(points.data(), count);
}

Sight::Extent Sight::extent_of_ball(const Ball& ball) const {
  const Vec3 center = to_view(Vec3(ball.center));
  const double r = ball.radius;
  std::array<Vec3, 8> corners{};
  for (int i = 0; i < 8; ++i) {
    corners[i] = center + Vec3((i & 1) != 0 ? r : -r, (i & 2) != 0 ? r : -r, (i & 4) != 0 ? r : -r);
  }
  return extent_of_points(corners.data(), 8);
}

}  // namespace atomesh::reference
