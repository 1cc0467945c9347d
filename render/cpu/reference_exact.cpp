#include "render/cpu/reference_exact.h"

#include <cmath>

#include "core/expansion.h"

namespace atomesh::reference {

namespace {

// a.first · b.second - a.second · b.first without rounding.
Expansion<4> exact_minor(double a_first, double a_second, double b_first, double b_second) {
  return as_expansion(a_first) * as_expansion(b_second) - as_expansion(a_second) * as_expansion(b_first);
}

// The cross product a × b, componentwise exact.
struct Line {
  Expansion<4> x, y, z;

  Line(const Vec3& a, const Vec3& b)
      : x(exact_minor(a.y, a.z, b.y, b.z)), y(exact_minor(a.z, a.x, b.z, b.x)), z(exact_minor(a.x, a.y, b.x, b.y)) {}
  Expansion<20> at(double px, double py) const { return scale(x, px) + scale(y, py) + z; }
};

int exact_side(double x, double y, const Vec3& a, const Vec3& b) {
  const Line line(a, b);
  if (const int sign = line.at(x, y).sign(); sign != 0) return sign;
  // (x+ε, y+ε²): the first of the two that is not zero outweighs what comes after it.
  if (const int sign = line.x.sign(); sign != 0) return sign;
  return line.y.sign();
}

}  // namespace

int side_of_line(double x, double y, const Vec3& a, const Vec3& b) {
  const double ax = a.y * b.z;
  const double bx = a.z * b.y;
  const double ay = a.z * b.x;
  const double by = a.x * b.z;
  const double az = a.x * b.y;
  const double bz = a.y * b.x;
  const double value = x * (ax - bx) + y * (ay - by) + (az - bz);
  const double size = std::abs(x) * (std::abs(ax) + std::abs(bx)) + std::abs(y) * (std::abs(ay) + std::abs(by)) +
                      std::abs(az) + std::abs(bz);
  // Each of the six terms carries at most five roundings of 2^-53.
  if (std::abs(value) > 8.0 * 0x1p-53 * size) return value > 0.0 ? 1 : -1;
  return exact_side(x, y, a, b);
}

double value_at_line(double x, double y, const Vec3& a, const Vec3& b) {
  const Expansion<20> value = Line(a, b).at(x, y);
  double sum = 0.0;
  for (int i = 0; i < value.size; ++i) sum += value.component[i];
  return sum;
}

}  // namespace atomesh::reference
