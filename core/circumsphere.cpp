#include "core/circumsphere.h"

#include "core/double_double.h"

namespace atomesh {

namespace {

struct Fine3 {
  DoubleDouble x, y, z;
};

Fine3 difference(const Vec3& p, const Vec3& q) {
  return {double_double_difference(p.x, q.x), double_double_difference(p.y, q.y), double_double_difference(p.z, q.z)};
}

Fine3 cross(const Fine3& a, const Fine3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

DoubleDouble dot(const Fine3& a, const Fine3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// The centre relative to d, as numerator / (2 determinant): Σ |u|² (v × w) / (2 u·(v × w)), u = a - d and so on.
Sphere fine_circumsphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Fine3 u = difference(a, d);
  const Fine3 v = difference(b, d);
  const Fine3 w = difference(c, d);
  const Fine3 vw = cross(v, w);
  const Fine3 wu = cross(w, u);
  const Fine3 uv = cross(u, v);
  const DoubleDouble uu = dot(u, u), vv = dot(v, v), ww = dot(w, w);
  const double twice = 2.0 * dot(u, vw).high;
  if (twice == 0.0) return {a, std::numeric_limits<double>::infinity()};
  const Vec3 offset = Vec3((uu * vw.x + vv * wu.x + ww * uv.x).high, (uu * vw.y + vv * wu.y + ww * uv.y).high,
                           (uu * vw.z + vv * wu.z + ww * uv.z).high) /
                      twice;
  return {d + offset, glm::length(offset)};
}

}  // namespace

Sphere circumsphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = a - d;
  const Vec3 v = b - d;
  const Vec3 w = c - d;
  const Vec3 vw = glm::cross(v, w);
  const double determinant = glm::dot(u, vw);
  const double uu = glm::dot(u, u), vv = glm::dot(v, v), ww = glm::dot(w, w);
  // Half of the 53 bits must survive the cancellation, for the coordinates may have lost some before.
  constexpr double thin = 1e-7;
  if (determinant * determinant < thin * thin * uu * vv * ww) return fine_circumsphere(a, b, c, d);
  const Vec3 offset = (uu * vw + vv * glm::cross(w, u) + ww * glm::cross(u, v)) / (2.0 * determinant);
  return {d + offset, glm::length(offset)};
}

}  // namespace atomesh
