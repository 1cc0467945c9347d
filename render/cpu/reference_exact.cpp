#include "render/cpu/reference_exact.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace atomesh::reference {

namespace {

// A sum of doubles that do not overlap, in growing magnitude: the value is exact and its sign is that of the largest
// (Shewchuk 1997, "Adaptive precision floating-point arithmetic", Grow-Expansion).
template <std::size_t Capacity>
class ExactSum {
 public:
  void add(double value) {
    double carry = value;
    for (std::size_t i = 0; i < size_; ++i) {
      const double sum = carry + terms_[i];
      const double part = sum - carry;
      const double rest = (carry - (sum - part)) + (terms_[i] - part);
      terms_[i] = rest;
      carry = sum;
    }
    terms_[size_++] = carry;
  }
  // a · b and a · b · c without rounding.
  void add_product(double a, double b) {
    const double high = a * b;
    add(std::fma(a, b, -high));
    add(high);
  }
  void add_product(double a, double b, double c) {
    const double high = a * b;
    add_product(std::fma(a, b, -high), c);
    add_product(high, c);
  }
  int sign() const {
    for (std::size_t i = size_; i-- > 0;) {
      if (terms_[i] != 0.0) return terms_[i] > 0.0 ? 1 : -1;
    }
    return 0;
  }

 private:
  std::array<double, Capacity> terms_{};
  std::size_t size_ = 0;
};

int sign_of_minor(double a, double b, double c, double d) {  // a·b - c·d
  ExactSum<4> sum;
  sum.add_product(a, b);
  sum.add_product(-c, d);
  return sum.sign();
}

int exact_side(double x, double y, const Vec3& a, const Vec3& b) {
  ExactSum<20> sum;
  sum.add_product(x, a.y, b.z);
  sum.add_product(-x, a.z, b.y);
  sum.add_product(y, a.z, b.x);
  sum.add_product(-y, a.x, b.z);
  sum.add_product(a.x, b.y);
  sum.add_product(-a.y, b.x);
  if (const int sign = sum.sign(); sign != 0) return sign;
  if (const int sign = sign_of_minor(a.y, b.z, a.z, b.y); sign != 0) return sign;
  return sign_of_minor(a.z, b.x, a.x, b.z);
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

}  // namespace atomesh::reference
