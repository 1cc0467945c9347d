#include "core/camera.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"

namespace atomesh {

namespace {

struct NamedView {
  std::string_view name;
  double azimuth;
  double elevation;
};

// The names and directions of OVITO and ParaView: z up, front looks along +y.
constexpr std::array<NamedView, 7> named_views{{{"front", 0, 0},
                                                {"back", 180, 0},
                                                {"left", -90, 0},
                                                {"right", 90, 0},
                                                {"top", 0, 90},
                                                {"bottom", 0, -90},
                                                {"iso", 30, 20}}};

bool parse_number(std::string_view text, double& value) {
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && rest == end && std::isfinite(value);
}

}  // namespace

Ray ray(const Camera& camera, double x, double y) {
  if (camera.projection == Projection::parallel) {
    return {camera.eye + x * camera.right + y * camera.up, camera.forward};
  }
  return {camera.eye, camera.forward + x * camera.right + y * camera.up};
}

Vec3 project(const Camera& camera, const Vec3& point) {
  const Vec3 p = point - camera.eye;
  const double depth = glm::dot(p, camera.forward);
  const double scale = camera.projection == Projection::perspective ? 1.0 / depth : 1.0;
  return {glm::dot(p, camera.right) * scale, glm::dot(p, camera.up) * scale, depth};
}

Camera make_camera(const Parameters& parameters, const Bounds& bounds, int width, int height) {
  const double degree = std::numbers::pi / 180.0;
  const double az = parameters.azimuth * degree;
  const double el = parameters.elevation * degree;
  const double roll = parameters.roll * degree;

  Camera camera;
  camera.projection = parameters.projection;
  camera.width = width;
  camera.height = height;
  // Azimuth turns the viewer counter-clockwise about +z seen from above; elevation lifts the viewer.
  camera.forward = Vec3(-std::sin(az) * std::cos(el), std::cos(az) * std::cos(el), -std::sin(el));
  const Vec3 right(std::cos(az), std::sin(az), 0.0);
  const Vec3 up = glm::cross(right, camera.forward);
  camera.right = std::cos(roll) * right - std::sin(roll) * up;
  camera.up = std::sin(roll) * right + std::cos(roll) * up;

  // A sample of one point (or none) still needs a picture of finite size. Any other is shown whole and as large as it
  // fits: a mesh may come in metres and be a thousandth of one.
  const double half_diagonal = 0.5 * bounds.diagonal();
  const double radius = half_diagonal > 0.0 ? half_diagonal : 1.0;
  const double half_angle = 0.5 * parameters.field_of_view * degree;
  const int shorter = std::max(1, std::min(width, height));
  const Vec3 target = bounds.center() + parameters.pan;
  if (parameters.projection == Projection::perspective) {
    // The sphere touches the cone of the field of view.
    camera.eye = target - camera.forward * (radius / std::sin(half_angle) / parameters.zoom);
    camera.pixel = 2.0 * std::tan(half_angle) / shorter;
  } else {
    camera.eye = target - camera.forward * (2.0 * radius);
    camera.pixel = 2.0 * radius / (shorter * parameters.zoom);
  }
  return camera;
}

Camera moved_beside(const Camera& camera, double columns, double rows) {
  Camera moved = camera;
  const double x = columns * camera.pixel;
  const double y = rows * camera.pixel;
  if (camera.projection == Projection::parallel) {
    moved.eye += x * camera.right + y * camera.up;
  } else {  // a turn by angles so small that they add up
    moved.forward = glm::normalize(camera.forward + x * camera.right + y * camera.up);
    moved.right = glm::normalize(camera.right - x * camera.forward);
    moved.up = glm::cross(moved.right, moved.forward);
  }
  return moved;
}

void set_view(Parameters& parameters, std::string_view view) {
  for (const NamedView& named : named_views) {
    if (named.name == view) {
      parameters.azimuth = named.azimuth;
      parameters.elevation = named.elevation;
      return;
    }
  }
  const std::size_t comma = view.find(',');
  double azimuth = 0.0;
  double elevation = 0.0;
  if (comma != std::string_view::npos && parse_number(view.substr(0, comma), azimuth) &&
      parse_number(view.substr(comma + 1), elevation) && std::abs(azimuth) <= 360.0 && std::abs(elevation) <= 90.0) {
    parameters.azimuth = azimuth;
    parameters.elevation = elevation;
    return;
  }
  std::vector<std::string_view> names;
  for (const NamedView& named : named_views) names.push_back(named.name);
  const std::string nearest = nearest_name(view, names);
  throw UsageError("view \"" + std::string(view) +
                   "\": expected front, back, left, right, top, bottom, iso or AZIMUTH,ELEVATION in degrees (-360 to "
                   "360, -90 to 90)" +
                   (nearest.empty() ? "" : "; did you mean " + nearest + "?"));
}

}  // namespace atomesh
