#include "app/gui/cut_handle.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/gui/overlay.h"
#include "render/canvas.h"
#include "render/legend_drawing.h"

namespace atomesh::gui {

namespace {

constexpr double arrow_ems = 4.5;
constexpr double head_ems = 1.1;
constexpr double grip_ems = 0.7;  // within which of the arrow the mouse grips it
// Of the sample's diagonal, how far a plane may be dragged out of it.
constexpr double beyond = 0.02;
// Sine of the angle between the arrow and the line of sight below which the mouse tells nothing along the arrow.
constexpr double end_on = 0.05;

const Vec4f plane_color(0.95F, 0.55F, 0.05F, 1.0F);
const Vec4f hot_color(1.0F, 0.85F, 0.1F, 1.0F);

// Rounded to a ten-thousandth of the power of ten below `size`: people read the number.
double rounded(double value, double size) {
  const double digits = 4.0 - std::floor(std::log10(size));
  if (!std::isfinite(digits)) return value;
  // By a whole number either way, so that what comes is the number that its digits say.
  const double scale = std::pow(10.0, std::abs(digits));
  return digits >= 0.0 ? std::round(value * scale) / scale : std::round(value / scale) * scale;
}

// The part of a convex polygon where dot(normal, p) <= distance (Sutherland and Hodgman).
std::vector<Vec3> clipped(const std::vector<Vec3>& polygon, const Vec3& normal, double distance) {
  std::vector<Vec3> left;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& a = polygon[i];
    const Vec3& b = polygon[(i + 1) % polygon.size()];
    const double from = glm::dot(normal, a) - distance;
    const double to = glm::dot(normal, b) - distance;
    if (from <= 0.0) left.push_back(a);
    if ((from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0)) left.push_back(a + from / (from - to) * (b - a));
  }
  return left;
}

struct UnitPlane {
  Vec3 normal;
  double distance;  // Å
};

UnitPlane unit_plane(const CutPlane& plane) {
  const double length = glm::length(plane.normal);
  return {plane.normal / length, plane.distance / length};
}

std::vector<Vec3> outline_of(const UnitPlane& plane, const Bounds& bounds) {
  const Vec3 middle = bounds.center() - (glm::dot(plane.normal, bounds.center()) - plane.distance) * plane.normal;
  const Vec3 n = glm::abs(plane.normal);
  const Vec3 axis = n.x <= n.y && n.x <= n.z ? Vec3(1, 0, 0) : n.y <= n.z ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
  const Vec3 u = bounds.diagonal() * glm::normalize(glm::cross(plane.normal, axis));
  const Vec3 v = glm::cross(plane.normal, u);
  std::vector<Vec3> polygon{middle + u + v, middle - u + v, middle - u - v, middle + u - v};
  for (int k = 0; k < 3; ++k) {
    Vec3 side(0.0);
    side[k] = 1.0;
    polygon = clipped(polygon, side, bounds.max[k]);
    polygon = clipped(polygon, -side, -bounds.min[k]);
  }
  return polygon.size() < 3 ? std::vector<Vec3>() : polygon;
}

// Centre of area of a convex polygon.
Vec3 middle_of(const std::vector<Vec3>& polygon) {
  Vec3 sum(0.0);
  double area = 0.0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const double part = glm::length(glm::cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]));
    sum += part * (polygon[0] + polygon[i] + polygon[i + 1]) / 3.0;
    area += part;
  }
  return area > 0.0 ? sum / area : polygon[0];
}

// Å that a pixel of the picture is wide where the point is.
double pixel_at(const Camera& camera, const Vec3& point) {
  const double depth = glm::dot(point - camera.eye, camera.forward);
  return camera.pixel * (camera.projection == Projection::perspective ? std::max(depth, 0.0) : 1.0);
}

Ray ray_at(const Camera& camera, const glm::dvec2& place) {
  return ray(camera, camera.x_of(place.x - 0.5), camera.y_of(place.y - 0.5));
}

// How far along the line from `origin` in direction of the unit vector `along` it comes nearest to the ray.
double nearest_along(const Vec3& origin, const Vec3& along, const Ray& line) {
  const Vec3 sight = glm::normalize(line.direction);
  const Vec3 between = line.origin - origin;
  const double cosine = glm::dot(along, sight);
  return (glm::dot(between, along) - cosine * glm::dot(between, sight)) / (1.0 - cosine * cosine);
}

double distance_to(const CanvasPoint& p, const CanvasPoint& a, const CanvasPoint& b) {
  const CanvasPoint along = b - a;
  const double square = glm::dot(along, along);
  const double t = square > 0.0 ? std::clamp(glm::dot(p - a, along) / square, 0.0, 1.0) : 0.0;
  return glm::length(p - a - t * along);
}

// The part of the edge in front of the eye, in the picture.
std::optional<std::array<CanvasPoint, 2>> visible_edge(const Camera& camera, Vec3 a, Vec3 b) {
  if (camera.projection == Projection::perspective) {
    const double near = 1e-3 * glm::length(a - b);
    const double from = glm::dot(a - camera.eye, camera.forward) - near;
    const double to = glm::dot(b - camera.eye, camera.forward) - near;
    if (from <= 0.0 && to <= 0.0) return std::nullopt;
    if (from <= 0.0) a += from / (from - to) * (b - a);
    if (to <= 0.0) b += to / (to - from) * (a - b);
  }
  const auto p = canvas_point(camera, a);
  const auto q = canvas_point(camera, b);
  if (!p || !q) return std::nullopt;
  return std::array<CanvasPoint, 2>{*p, *q};
}

}  // namespace

std::vector<CutHandle> cut_handles(const Parameters& parameters, const Bounds& bounds, const Camera& camera) {
  std::vector<CutHandle> handles;
  if (bounds.empty()) return handles;
  const double size = overlay_text_size(camera.width, camera.height);
  for (std::size_t i = 0; i < parameters.cut_planes.size(); ++i) {
    const CutPlane& plane = parameters.cut_planes[i];
    if (!plane.enabled || !(glm::length(plane.normal) > 0.0)) continue;
    const UnitPlane unit = unit_plane(plane);
    CutHandle handle;
    handle.plane = i;
    handle.outline = outline_of(unit, bounds);
    handle.foot = handle.outline.empty()
                      ? bounds.center() - (glm::dot(unit.normal, bounds.center()) - unit.distance) * unit.normal
                      : middle_of(handle.outline);
    const Vec3 outwards = plane.side == CutPlane::Side::less_equal ? unit.normal : -unit.normal;
    handle.tip = handle.foot + arrow_ems * size * pixel_at(camera, handle.foot) * outwards;
    handles.push_back(std::move(handle));
  }
  return handles;
}

std::optional<std::size_t> handle_at(const std::vector<CutHandle>& handles, const Camera& camera, double x, double y) {
  double least = grip_ems * overlay_text_size(camera.width, camera.height);
  std::optional<std::size_t> nearest;
  for (std::size_t i = 0; i < handles.size(); ++i) {
    const auto foot = canvas_point(camera, handles[i].foot);
    const auto tip = canvas_point(camera, handles[i].tip);
    if (!foot || !tip) continue;
    const double distance = distance_to({x, y}, *foot, *tip);
    if (distance > least) continue;
    least = distance;
    nearest = i;
  }
  return nearest;
}

CutPlane moved_plane(const CutPlane& plane, const CutHandle& handle, const Bounds& bounds, const Camera& camera,
                     const glm::dvec2& from, const glm::dvec2& to) {
  const UnitPlane unit = unit_plane(plane);
  const Vec3 arrow = glm::normalize(handle.tip - handle.foot);
  const Ray at_from = ray_at(camera, from);
  const double sine = glm::length(glm::cross(glm::normalize(at_from.direction), arrow));
  const double way =
      sine > end_on ? nearest_along(handle.foot, arrow, ray_at(camera, to)) - nearest_along(handle.foot, arrow, at_from)
                    : (from.y - to.y) * pixel_at(camera, handle.foot);
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (int n = 0; n < 8; ++n) {
    const Vec3 corner((n & 1) != 0 ? bounds.max.x : bounds.min.x, (n & 2) != 0 ? bounds.max.y : bounds.min.y,
                      (n & 4) != 0 ? bounds.max.z : bounds.min.z);
    least = std::min(least, glm::dot(unit.normal, corner));
    most = std::max(most, glm::dot(unit.normal, corner));
  }
  const double margin = beyond * bounds.diagonal();
  const double wanted = unit.distance + way * glm::dot(arrow, unit.normal);
  // A plane that was out of reach already is not pulled back by a drag that goes further.
  const double distance =
      std::clamp(wanted, std::min(least - margin, unit.distance), std::max(most + margin, unit.distance));
  const double length = glm::length(plane.normal);
  CutPlane moved = plane;
  moved.distance = rounded(distance * length, bounds.diagonal() * length);
  return moved;
}

CutPlane tilted_plane(const CutPlane& plane, const CutHandle& handle, const Bounds& bounds, const Camera& camera,
                      const glm::dvec2& from, const glm::dvec2& to) {
  const Vec3 arrow = handle.tip - handle.foot;
  const glm::dvec2 way = (to - from) * pixel_at(camera, handle.foot);
  const Vec3 turned = arrow + way.x * camera.right - way.y * camera.up;
  if (!(glm::length(turned) > 1e-6 * glm::length(arrow))) return plane;
  const double sense = plane.side == CutPlane::Side::less_equal ? 1.0 : -1.0;
  Vec3 normal = sense * glm::normalize(turned);
  for (int k = 0; k < 3; ++k) normal[k] = std::round(1e4 * normal[k]) / 1e4 + 0.0;
  CutPlane tilted = plane;
  const double length = glm::length(plane.normal);
  tilted.normal = std::abs(length - 1.0) < 1e-3 ? normal : length * normal;
  tilted.distance = rounded(glm::dot(tilted.normal, handle.foot), bounds.diagonal() * length);
  return tilted;
}

void draw_cut_handles(Image& image, int first_row, const Camera& camera, const Vec4f& background,
                      const std::vector<CutHandle>& handles, std::optional<std::size_t> hot_plane) {
  Canvas canvas(image, first_row);
  const double size = overlay_text_size(camera.width, camera.height);
  const Vec4f paper = overlay_colors(background).paper;
  for (std::size_t i = 0; i < handles.size(); ++i) {
    const CutHandle& handle = handles[i];
    const Vec4f color = hot_plane == handle.plane ? hot_color : plane_color;
    const double thin = std::max(1.0, 0.09 * size);
    const double thick = std::max(2.0, (hot_plane == handle.plane ? 0.28 : 0.2) * size);
    const double rim = std::max(1.0, 0.07 * size);
    for (const bool outer : {true, false}) {
      for (std::size_t k = 0; k < handle.outline.size(); ++k) {
        const auto edge = visible_edge(camera, handle.outline[k], handle.outline[(k + 1) % handle.outline.size()]);
        if (edge) canvas.stroke(*edge, false, thin + (outer ? 2.0 * rim : 0.0), outer ? paper : color);
      }
    }
    const auto foot = canvas_point(camera, handle.foot);
    const auto tip = canvas_point(camera, handle.tip);
    if (!foot || !tip) continue;
    const double length = glm::length(*tip - *foot);
    const CanvasPoint way = length > 0.0 ? (*tip - *foot) / length : CanvasPoint(0.0, -1.0);
    const CanvasPoint across(-way.y, way.x);
    const double head = std::min(head_ems * size, 0.6 * length);
    const CanvasPoint base = *tip - head * way;
    const std::array<CanvasPoint, 2> shaft{*foot, base};
    const std::array<CanvasPoint, 3> point{*tip, base + 0.45 * size * across, base - 0.45 * size * across};
    // The foot is a ball: seen along the arrow it is all there is to grip.
    const std::array<CanvasPoint, 1> ball{*foot};
    canvas.stroke(shaft, false, thick + 2.0 * rim, paper);
    canvas.stroke(point, true, 2.0 * rim, paper);
    canvas.stroke(ball, false, 0.8 * size + 2.0 * rim, paper);
    canvas.stroke(shaft, false, thick, color);
    canvas.fill_convex(point, color);
    canvas.stroke(ball, false, 0.8 * size, color);
  }
}

}  // namespace atomesh::gui
