#include "core/predicates.h"

#include "core/double_double.h"
#include "core/expansion.h"

namespace atomesh {

namespace {

// Each sign is found by the first of three evaluations whose error bound decides: doubles (nearly always),
// double-double (crystals turned or rounded, where the determinant is small but not zero), expansions (exact: where it
// is zero).

constexpr double epsilon = std::numeric_limits<double>::epsilon() / 2;  // 2^-53, half an ulp of 1
// Error bounds of the rounded determinants relative to their permanents: Shewchuk 1997, section 4.3 (orient3d, bound A)
// and 4.4 (insphere, bound A).
constexpr double orientation_bound = (7.0 + 56.0 * epsilon) * epsilon;
constexpr double in_sphere_bound = (16.0 + 224.0 * epsilon) * epsilon;
// No term of either determinant passes more than 11 roundings of at most 7 epsilon² each; the rest is margin, for the
// permanent is itself rounded.
constexpr double double_double_bound = 256.0 * epsilon * epsilon;

int sign_of(double value) {
  return (value > 0.0) - (value < 0.0);
}

// True when every coordinate of v is the exact difference p - q, as it is for most neighbours in a crystal (Sterbenz).
bool exact(const Vec3& p, const Vec3& q, const Vec3& v) {
  const auto tail_free = [](double a, double b, double difference) {
    const double b_virtual = a - difference;
    return (a - (difference + b_virtual)) + (b_virtual - b) == 0.0;
  };
  return tail_free(p.x, q.x, v.x) && tail_free(p.y, q.y, v.y) && tail_free(p.z, q.z, v.z);
}

// A vector of numbers of type T: DoubleDouble, Expansion<1> or Expansion<2>.
template <class T>
struct VectorOf {
  T x, y, z;
};

VectorOf<Expansion<1>> expanded(const Vec3& v) {
  return {as_expansion(v.x), as_expansion(v.y), as_expansion(v.z)};
}

VectorOf<Expansion<2>> expanded_difference(const Vec3& p, const Vec3& q) {
  return {exact_difference(p.x, q.x), exact_difference(p.y, q.y), exact_difference(p.z, q.z)};
}

VectorOf<DoubleDouble> difference(const Vec3& p, const Vec3& q) {
  return {double_double_difference(p.x, q.x), double_double_difference(p.y, q.y), double_double_difference(p.z, q.z)};
}

template <class T>
auto minor(const VectorOf<T>& p, const VectorOf<T>& q) {
  return p.x * q.y - p.y * q.x;
}

template <class T>
auto squared_length(const VectorOf<T>& a) {
  return (a.x * a.x + a.y * a.y) + a.z * a.z;
}

template <class T>
auto orientation_determinant(const VectorOf<T>& a, const VectorOf<T>& b, const VectorOf<T>& c) {
  return (minor(b, c) * a.z + minor(c, a) * b.z) + minor(a, b) * c.z;
}

template <class T>
auto in_sphere_determinant(const VectorOf<T>& a, const VectorOf<T>& b, const VectorOf<T>& c, const VectorOf<T>& d) {
  const auto ab = minor(a, b), ac = minor(a, c), ad = minor(a, d);
  const auto bc = minor(b, c), bd = minor(b, d), cd = minor(c, d);
  const auto abc = (bc * a.z - ac * b.z) + ab * c.z;
  const auto abd = (bd * a.z - ad * b.z) + ab * d.z;
  const auto acd = (cd * a.z - ad * c.z) + ac * d.z;
  const auto bcd = (cd * b.z - bd * c.z) + bc * d.z;
  return (bcd * squared_length(a) - acd * squared_length(b)) + (abd * squared_length(c) - abc * squared_length(d));
}

// Kept out of line: hundreds of kilobytes of stack, for the few quintuples whose differences do not fit a double.
[[gnu::noinline]] int exact_in_sphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e) {
  return in_sphere_determinant(expanded_difference(a, e), expanded_difference(b, e), expanded_difference(c, e),
                               expanded_difference(d, e))
      .sign();
}

// True when the five numbers take at most two values.
bool two_values(double a, double b, double c, double d, double e) {
  const double other = a != e ? a : b != e ? b : c != e ? c : d;
  return (a == e || a == other) && (b == e || b == other) && (c == e || c == other) && (d == e || d == other);
}

}  // namespace

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a;
  const Vec3 v = c - a;
  const Vec3 w = d - a;
  const double vw1 = v.x * w.y;
  const double vw2 = v.y * w.x;
  const double wu1 = w.x * u.y;
  const double wu2 = w.y * u.x;
  const double uv1 = u.x * v.y;
  const double uv2 = u.y * v.x;
  const double determinant = u.z * (vw1 - vw2) + v.z * (wu1 - wu2) + w.z * (uv1 - uv2);
  const double permanent = std::abs(u.z) * (std::abs(vw1) + std::abs(vw2)) +
                           std::abs(v.z) * (std::abs(wu1) + std::abs(wu2)) +
                           std::abs(w.z) * (std::abs(uv1) + std::abs(uv2));
  if (std::abs(determinant) > orientation_bound * permanent) return sign_of(determinant);
  if (exact(b, a, u) && exact(c, a, v) && exact(d, a, w)) {
    return orientation_determinant(expanded(u), expanded(v), expanded(w)).sign();
  }
  const double finer = orientation_determinant(difference(b, a), difference(c, a), difference(d, a)).high;
  if (std::abs(finer) > double_double_bound * permanent) return sign_of(finer);
  return orientation_determinant(expanded_difference(b, a), expanded_difference(c, a), expanded_difference(d, a))
      .sign();
}

int in_sphere(const Vec3& pa, const Vec3& pb, const Vec3& pc, const Vec3& pd, const Vec3& pe) {
  const Vec3 a = pa - pe;
  const Vec3 b = pb - pe;
  const Vec3 c = pc - pe;
  const Vec3 d = pd - pe;
  const auto product = [](const Vec3& p, const Vec3& q) { return p.x * q.y - p.y * q.x; };
  const auto bound = [](const Vec3& p, const Vec3& q) { return std::abs(p.x * q.y) + std::abs(p.y * q.x); };
  const double ab = product(a, b), ac = product(a, c), ad = product(a, d);
  const double bc = product(b, c), bd = product(b, d), cd = product(c, d);
  const double aa = glm::dot(a, a), bb = glm::dot(b, b), cc = glm::dot(c, c), dd = glm::dot(d, d);
  const double abc = a.z * bc - b.z * ac + c.z * ab;
  const double abd = a.z * bd - b.z * ad + d.z * ab;
  const double acd = a.z * cd - c.z * ad + d.z * ac;
  const double bcd = b.z * cd - c.z * bd + d.z * bc;
  const double determinant = (aa * bcd - bb * acd) + (cc * abd - dd * abc);

  const double az = std::abs(a.z), bz = std::abs(b.z), cz = std::abs(c.z), dz = std::abs(d.z);
  const double ab_bound = bound(a, b), ac_bound = bound(a, c), ad_bound = bound(a, d);
  const double bc_bound = bound(b, c), bd_bound = bound(b, d), cd_bound = bound(c, d);
  const double permanent =
      aa * (bz * cd_bound + cz * bd_bound + dz * bc_bound) + bb * (az * cd_bound + cz * ad_bound + dz * ac_bound) +
      cc * (az * bd_bound + bz * ad_bound + dz * ab_bound) + dd * (az * bc_bound + bz * ac_bound + cz * ab_bound);
  if (std::abs(determinant) > in_sphere_bound * permanent) return sign_of(determinant);

  // Corners of one box are cospherical whatever its edges: the commonest zero in a crystal, seen without arithmetic.
  if (two_values(pa.x, pb.x, pc.x, pd.x, pe.x) && two_values(pa.y, pb.y, pc.y, pd.y, pe.y) &&
      two_values(pa.z, pb.z, pc.z, pd.z, pe.z)) {
    return 0;
  }
  const double finer =
      in_sphere_determinant(difference(pa, pe), difference(pb, pe), difference(pc, pe), difference(pd, pe)).high;
  if (std::abs(finer) > double_double_bound * permanent) return sign_of(finer);
  if (exact(pa, pe, a) && exact(pb, pe, b) && exact(pc, pe, c) && exact(pd, pe, d)) {
    return in_sphere_determinant(expanded(a), expanded(b), expanded(c), expanded(d)).sign();
  }
  return exact_in_sphere(pa, pb, pc, pd, pe);
}

}  // namespace atomesh
