// Vectors and the few geometric quantities every room needs. Lengths in Å, volumes in Å³, angles in radians.
#pragma once

#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <numbers>
#include <span>

namespace atomesh {

using Vec3 = glm::dvec3;  // positions in core and preprocess
using Vec3f = glm::vec3;  // renderers, about the scene's centre
using Vec4f = glm::vec4;  // RGBA
using Mat3 = glm::dmat3;  // columns are vectors: m[0] is the first column

using Index = std::uint32_t;
inline constexpr Index no_index = std::numeric_limits<Index>::max();

using Triangle = std::array<Index, 3>;
using Tetrahedron = std::array<Index, 4>;

// Axis-aligned box; empty (min > max) until something is added.
struct Bounds {
  Vec3 min{std::numeric_limits<double>::infinity()};
  Vec3 max{-std::numeric_limits<double>::infinity()};

  bool empty() const { return !(min.x <= max.x); }
  void add(const Vec3& p) {
    min = glm::min(min, p);
    max = glm::max(max, p);
  }
  Vec3 center() const { return empty() ? Vec3(0.0) : 0.5 * (min + max); }
  Vec3 extent() const { return empty() ? Vec3(0.0) : max - min; }
  double diagonal() const { return glm::length(extent()); }
};

inline Bounds bounds_of(std::span<const Vec3> points) {
  Bounds bounds;
  for (const Vec3& p : points) bounds.add(p);
  return bounds;
}

// Signed volume of the tetrahedron (a, b, c, d): positive when d lies on the side of the triangle abc towards
// which its normal (b-a)×(c-a) points. This is the orientation every tetrahedron of a TetMesh has.
inline double signed_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return glm::dot(glm::cross(b - a, c - a), d - a) / 6.0;
}

// Face f of a tetrahedron lies opposite its vertex f; its corners are tet[face_corners[f][0..2]], counter-clockwise
// seen from outside a positively oriented tetrahedron (normal outward).
inline constexpr std::array<std::array<int, 3>, 4> face_corners{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

}  // namespace atomesh
