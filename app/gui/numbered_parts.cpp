#include "app/gui/numbered_parts.h"

#include <algorithm>
#include <array>

#include "core/error.h"

namespace atomesh::gui {

namespace {

template <class Part, std::size_t Size>
int count_of(const std::array<Part, Size>& parts) {
  int count = 0;
  for (std::size_t i = 0; i < Size; ++i) {
    if (!(parts[i] == Part{})) count = static_cast<int>(i) + 1;
  }
  return count;
}

void check_number(int n, int from, int to, const char* what) {
  if (n < from || n > to) {
    throw UsageError(std::string(what) + ": expected a whole number from " + std::to_string(from) + " to " +
                     std::to_string(to));
  }
}

template <class Part, std::size_t Size>
void remove_part(std::array<Part, Size>& parts, int n) {
  const auto at = parts.begin() + (n - 1);
  std::move(at + 1, parts.end(), at);
  parts.back() = Part{};
}

// Right, above, left, below, and the four between, all somewhat from the front.
constexpr std::array<std::array<float, 2>, max_lights> places{{{-1.5F, 2.0F},
                                                               {2.5F, 0.0F},
                                                               {0.0F, -2.5F},
                                                               {-2.5F, 0.0F},
                                                               {2.0F, 2.0F},
                                                               {2.0F, -2.0F},
                                                               {-2.0F, -2.0F},
                                                               {0, 2.5F}}};

}  // namespace

int light_count(const Parameters& parameters) {
  return std::max(1, count_of(parameters.lights));
}

int cut_plane_count(const Parameters& parameters) {
  return count_of(parameters.cut_planes);
}

void set_light_count(Parameters& parameters, int count) {
  check_number(count, 1, max_lights, "number of lights");
  for (int i = light_count(parameters); i < count; ++i) {
    const auto n = static_cast<std::size_t>(i);
    parameters.lights[n] = {true, {places[n][0], places[n][1], 2.0F}, Vec3f(1.0F), 0.35F};
  }
  std::fill(parameters.lights.begin() + count, parameters.lights.end(), Light{});
}

void set_cut_plane_count(Parameters& parameters, int count, const Bounds& bounds) {
  check_number(count, 0, max_cut_planes, "number of cut planes");
  for (int i = cut_plane_count(parameters); i < count; ++i) {
    CutPlane plane;
    plane.enabled = true;
    plane.normal = Vec3(0.0);
    plane.normal[i % 3] = 1.0;
    plane.distance = glm::dot(plane.normal, bounds.center());
    parameters.cut_planes[static_cast<std::size_t>(i)] = plane;
  }
  std::fill(parameters.cut_planes.begin() + count, parameters.cut_planes.end(), CutPlane{});
}

void remove_light(Parameters& parameters, int n) {
  check_number(n, 1, light_count(parameters), "light");
  remove_part(parameters.lights, n);
}

void remove_cut_plane(Parameters& parameters, int n) {
  check_number(n, 1, cut_plane_count(parameters), "cut plane");
  remove_part(parameters.cut_planes, n);
}

void flip_cut_plane(Parameters& parameters, int n) {
  check_number(n, 1, max_cut_planes, "cut plane");
  CutPlane& plane = parameters.cut_planes[static_cast<std::size_t>(n - 1)];
  plane.side = plane.side == CutPlane::Side::less_equal ? CutPlane::Side::greater_equal : CutPlane::Side::less_equal;
}

}  // namespace atomesh::gui
