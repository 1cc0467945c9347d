#include "app/cli/inner_walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace atomesh::cli {

namespace {

constexpr std::size_t most_around_a_vertex = 256;
constexpr double flat = 1e-4;  // radians

// A triangle at one of its corners: the unit edges that leave it, counter-clockwise about the unit normal.
struct Sector {
  Vec3 normal;
  Vec3 first;
  Vec3 second;
};

Vec3 unit(const Vec3& v) {
  const double length = glm::length(v);
  return length > 0.0 ? v / length : Vec3(0.0);
}

Sector sector_at(const Triangle& triangle, std::size_t corner, std::span<const Vec3> vertices) {
  const Vec3& at = vertices[triangle[corner]];
  const Vec3 first = unit(vertices[triangle[(corner + 1) % 3]] - at);
  const Vec3 second = unit(vertices[triangle[(corner + 2) % 3]] - at);
  return {unit(glm::cross(first, second)), first, second};
}

// Whether some direction lies within both of two sectors of one plane.
bool overlap(const Sector& a, const Sector& b) {
  // Strictly inside: directions of a common edge are not.
  const auto inside = [](const Sector& s, const Vec3& d) {
    return glm::dot(glm::cross(s.first, d), s.normal) > flat && glm::dot(glm::cross(d, s.second), s.normal) > flat;
  };
  // Sectors are convex: the middle of one, an edge of one, or the middle of the other lies in the other.
  return inside(a, unit(b.first + b.second)) || inside(b, unit(a.first + a.second)) || inside(a, b.first) ||
         inside(a, b.second) || inside(b, a.first) || inside(b, a.second);
}

}  // namespace

std::uint64_t count_inner_walls(const Surface& surface, std::span<const Vec3> vertices) {
  const std::size_t triangles = surface.triangles.size();
  // The corners at each vertex, as 3 * triangle + corner.
  std::vector<std::size_t> first(vertices.size() + 1, 0);
  for (const Triangle& t : surface.triangles) {
    for (const Index v : t) ++first[v + 1];
  }
  for (std::size_t v = 0; v < vertices.size(); ++v) first[v + 1] += first[v];
  std::vector<std::size_t> corners(3 * triangles);
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (std::size_t t = 0; t < triangles; ++t) {
    for (std::size_t c = 0; c < 3; ++c) corners[next[surface.triangles[t][c]]++] = 3 * t + c;
  }
  std::vector<bool> wall(triangles, false);
  std::vector<Sector> sectors;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const std::span<const std::size_t> around = std::span(corners).subspan(first[v], first[v + 1] - first[v]);
    if (around.size() > most_around_a_vertex) continue;
    sectors.clear();
    for (const std::size_t c : around) sectors.push_back(sector_at(surface.triangles[c / 3], c % 3, vertices));
    for (std::size_t a = 0; a < around.size(); ++a) {
      for (std::size_t b = a + 1; b < around.size(); ++b) {
        if (glm::dot(sectors[a].normal, sectors[b].normal) > -1.0 + 0.5 * flat * flat) continue;
        if (!overlap(sectors[a], sectors[b])) continue;
        wall[around[a] / 3] = true;
        wall[around[b] / 3] = true;
      }
    }
  }
  return static_cast<std::uint64_t>(std::count(wall.begin(), wall.end(), true));
}

}  // namespace atomesh::cli
