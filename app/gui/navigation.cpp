#include "app/gui/navigation.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace atomesh::gui {

namespace {

constexpr double degree = std::numbers::pi / 180.0;
// What a mouse that crosses the shorter side of the picture turns by.
constexpr double degrees_per_side = 180.0;
// Nearer to a pole than this (sine) the azimuth is lost in rounding.
constexpr double pole = 1e-9;
// Vectors whose angle's sine is below this are taken for parallel.
constexpr double parallel = 1e-6;
// How much of the picture's shorter side fly_to() fills.
constexpr double fly_fill = 0.5;

// Within ±180, and what is a whole number but for rounding is one: people read these numbers.
double tidy_degrees(double angle) {
  const double wrapped = std::remainder(angle, 360.0);
  const double whole = std::round(wrapped);
  return std::abs(wrapped - whole) < 1e-10 ? whole + 0.0 : wrapped;
}

double within_row(double value, const char* key) {
  const ParameterRow& row = parameter_row(key);
  return std::clamp(value, row.min, row.max);
}

// v turned about the unit vector `axis` (Rodrigues).
Vec3 turned(const Vec3& v, const Vec3& axis, double angle) {
  return std::cos(angle) * v + std::sin(angle) * glm::cross(axis, v) +
         (1.0 - std::cos(angle)) * glm::dot(axis, v) * axis;
}

Vec3 point_looked_at(const Parameters& parameters, const Bounds& bounds) {
  return bounds.center() + parameters.pan;
}

// The axes and the eye; the picture's size does not matter to them.
Camera camera_of(const Parameters& parameters, const Bounds& bounds) {
  return make_camera(parameters, bounds, 1, 1);
}

void set_pan(Parameters& parameters, const Bounds& bounds, const Vec3& pan) {
  parameters.pan = pan;
  if (parameters.projection == Projection::parallel) {
    // Along the line of sight pan changes nothing in the picture, until the eye, from which depths count, has come
    // into the sample.
    const Camera camera = camera_of(parameters, bounds);
    const double most = 0.45 * glm::dot(point_looked_at(parameters, bounds) - camera.eye, camera.forward);
    const double along = glm::dot(pan, camera.forward);
    parameters.pan += (std::clamp(along, -most, most) - along) * camera.forward;
  }
  for (int k = 0; k < 3; ++k) parameters.pan[k] = within_row(parameters.pan[k], "view.pan");
}

// Where a point is in the camera's axes.
Vec3 in_view(const Camera& camera, const Vec3& point) {
  const Vec3 p = point - camera.eye;
  return {glm::dot(p, camera.right), glm::dot(p, camera.up), glm::dot(p, camera.forward)};
}

// After the view has turned: pan such that the pivot is where it was in the camera's axes.
void bring_back(Parameters& parameters, const Bounds& bounds, const Vec3& pivot, const Vec3& was) {
  const Camera now = camera_of(parameters, bounds);
  const Vec3 eye = pivot - was.x * now.right - was.y * now.up - was.z * now.forward;
  set_pan(parameters, bounds, parameters.pan + (eye - now.eye));
}

// Of the pivot, or where that is not in front of the eye, of the point looked at.
double depth_of(const Parameters& parameters, const Bounds& bounds, const Camera& camera, const Vec3& pivot) {
  const double depth = in_view(camera, pivot).z;
  if (depth > 0.0 && std::isfinite(depth)) return depth;
  return in_view(camera, point_looked_at(parameters, bounds)).z;
}

// Å in the picture's plane at this depth for one unit of the image plane's coordinates.
double scale_at(const Camera& camera, double depth) {
  return camera.projection == Projection::perspective ? depth : 1.0;
}

bool nearly_parallel(const Vec3& a, const Vec3& b) {
  return glm::length(glm::cross(a, b)) <= parallel * glm::length(a) * glm::length(b);
}

Vec3 reciprocal(const UnitCell& cell, const Vec3& hkl) {
  const auto& [a, b, c] = cell.primitive;
  if (!(glm::length(hkl) > 0.0)) throw UsageError("lattice plane (0 0 0): give at least one index that is not zero");
  const Vec3 sum = hkl.x * glm::cross(b, c) + hkl.y * glm::cross(c, a) + hkl.z * glm::cross(a, b);
  return sum / glm::dot(a, glm::cross(b, c));
}

Vec3 crystal_up(const UnitCell& cell, const Vec3& direction) {
  return nearly_parallel(direction, cell.primitive[2]) ? cell.primitive[1] : cell.primitive[2];
}

}  // namespace

void rotate_view(Parameters& parameters, const Bounds& bounds, const Vec3& pivot, double right, double down,
                 bool upright) {
  const Camera before = camera_of(parameters, bounds);
  const Vec3 was = in_view(before, pivot);
  if (upright) {
    // The mouse's way in the picture before it was rolled.
    const double roll = parameters.roll * degree;
    const double along = right * std::cos(roll) - down * std::sin(roll);
    const double across = right * std::sin(roll) + down * std::cos(roll);
    parameters.azimuth = tidy_degrees(parameters.azimuth - degrees_per_side * along);
    parameters.elevation = std::clamp(parameters.elevation + degrees_per_side * across, -90.0, 90.0);
  } else {
    // The sample turns about up with a mouse that goes right and about right with one that goes down; the viewer the
    // other way.
    const Vec3 turn = degrees_per_side * degree * (right * before.up + down * before.right);
    const double angle = glm::length(turn);
    if (!(angle > 0.0)) return;
    set_orientation(parameters, turned(before.forward, turn / angle, -angle), turned(before.up, turn / angle, -angle));
  }
  bring_back(parameters, bounds, pivot, was);
}

void roll_view(Parameters& parameters, const Bounds& bounds, const Vec3& pivot, double degrees) {
  const Vec3 was = in_view(camera_of(parameters, bounds), pivot);
  parameters.roll = tidy_degrees(parameters.roll + degrees);
  // In the picture the pivot stays, so in the camera's axes too.
  bring_back(parameters, bounds, pivot, was);
}

void pan_view(Parameters& parameters, const Bounds& bounds, const Vec3& pivot, double right, double down, int width,
              int height) {
  const Camera camera = make_camera(parameters, bounds, width, height);
  const double step = camera.pixel * scale_at(camera, depth_of(parameters, bounds, camera, pivot));
  set_pan(parameters, bounds, parameters.pan - step * (right * camera.right - down * camera.up));
}

void zoom_view(Parameters& parameters, const Bounds& bounds, const Vec3& pivot, double factor, double column,
               double row, int width, int height) {
  const Camera camera = make_camera(parameters, bounds, width, height);
  const double zoom = within_row(parameters.zoom * factor, "view.zoom");
  const double left = parameters.zoom / zoom;  // of the distance to the point, or of the picture's extent
  const double x = camera.x_of(column);
  const double y = camera.y_of(row);
  const double depth = depth_of(parameters, bounds, camera, pivot);
  const double scale = scale_at(camera, depth);
  const double distance = glm::dot(point_looked_at(parameters, bounds) - camera.eye, camera.forward);
  parameters.zoom = zoom;
  Vec3 pan = parameters.pan + (1.0 - left) * scale * (x * camera.right + y * camera.up);
  // The eye comes nearer to the point under the mouse by as much as to the point looked at, which is at `distance`.
  if (camera.projection == Projection::perspective) pan += (1.0 - left) * (depth - distance) * camera.forward;
  set_pan(parameters, bounds, pan);
}

void set_orientation(Parameters& parameters, const Vec3& forward, const Vec3& up) {
  const double level = std::hypot(forward.x, forward.y);
  if (level < pole) {
    const Vec3 right = glm::cross(forward, up);
    parameters.azimuth = tidy_degrees(std::atan2(right.y, right.x) / degree);
    parameters.elevation = forward.z < 0.0 ? 90.0 : -90.0;
    parameters.roll = 0.0;
    return;
  }
  const double azimuth = std::atan2(-forward.x, forward.y);
  const Vec3 level_right(std::cos(azimuth), std::sin(azimuth), 0.0);
  const Vec3 level_up = glm::cross(level_right, forward);
  parameters.azimuth = tidy_degrees(azimuth / degree);
  parameters.elevation = std::clamp(tidy_degrees(std::atan2(-forward.z, level) / degree), -90.0, 90.0);
  parameters.roll = tidy_degrees(std::atan2(glm::dot(up, level_right), glm::dot(up, level_up)) / degree);
}

void look_along(Parameters& parameters, const Vec3& direction, const Vec3& up) {
  const double length = glm::length(direction);
  if (!(length > 0.0) || !std::isfinite(length)) {
    throw UsageError("viewing direction: expected three numbers that are not all zero");
  }
  const Vec3 forward = direction / length;
  Vec3 upwards = up;
  if (nearly_parallel(forward, upwards)) {
    upwards = Vec3(0, 0, 1);
    for (const Vec3& axis : {Vec3(0, 1, 0), Vec3(1, 0, 0)}) {
      if (std::abs(glm::dot(axis, forward)) < std::abs(glm::dot(upwards, forward))) upwards = axis;
    }
  }
  upwards /= glm::length(upwards);
  set_orientation(parameters, forward, glm::normalize(upwards - glm::dot(upwards, forward) * forward));
}

void look_along_crystal(Parameters& parameters, const UnitCell& cell, const Vec3& uvw) {
  if (!(glm::length(uvw) > 0.0)) throw UsageError("direction [0 0 0]: give at least one index that is not zero");
  const Vec3 direction = cell.matrix() * uvw;
  look_along(parameters, direction, crystal_up(cell, direction));
}

void look_at_plane(Parameters& parameters, const UnitCell& cell, const Vec3& hkl) {
  const Vec3 direction = -plane_normal(cell, hkl);
  look_along(parameters, direction, crystal_up(cell, direction));
}

Vec3 plane_normal(const UnitCell& cell, const Vec3& hkl) {
  return glm::normalize(reciprocal(cell, hkl));
}

double plane_spacing(const UnitCell& cell, const Vec3& hkl) {
  return 1.0 / glm::length(reciprocal(cell, hkl));
}

void fly_to(Parameters& parameters, const Bounds& bounds, const Vec3& center, double radius) {
  if (radius > 0.0) {
    const double half_diagonal = 0.5 * bounds.diagonal();
    const double whole = half_diagonal > 0.0 ? half_diagonal : 1.0;  // as make_camera() has it
    parameters.zoom = within_row(fly_fill * whole / radius, "view.zoom");
  }
  set_pan(parameters, bounds, center - bounds.center());
}

void reset_orientation(Parameters& parameters) {
  const Parameters defaults;
  parameters.azimuth = defaults.azimuth;
  parameters.elevation = defaults.elevation;
  parameters.roll = defaults.roll;
  parameters.zoom = defaults.zoom;
  parameters.pan = defaults.pan;
}

}  // namespace atomesh::gui
