// The exact predicates against known answers, against their own symmetries and against CGAL's.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/circumsphere.h"
#include "core/expansion.h"
#include "core/predicates.h"
#include "tests/support/lattices.h"

namespace atomesh {
namespace {

using Points = std::array<Vec3, 5>;

int parity(std::array<int, 4> order) {
  int sign = 1;
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) sign = order[i] > order[j] ? -sign : sign;
  }
  return sign;
}

// x moved by so many units in the last place; 0 stays, for its neighbours are too small for products.
double step(double x, int ulps) {
  if (x == 0.0) return x;
  for (; ulps > 0; --ulps) x = std::nextafter(x, 1e300);
  for (; ulps < 0; ++ulps) x = std::nextafter(x, -1e300);
  return x;
}

// Quintuples from hopeless to easy: on lattices, some turned, a few ulps off, far from the origin, of mixed scales.
std::vector<Points> hard_points() {
  std::mt19937_64 random(7);
  const auto uniform = [&] { return std::uniform_real_distribution<double>(-1.0, 1.0)(random); };
  const auto small = [&](int n) { return static_cast<int>(random() % static_cast<std::uint64_t>(2 * n + 1)) - n; };
  std::vector<Points> all;
  for (int kind = 0; kind < 7; ++kind) {
    for (int repeat = 0; repeat < 3000; ++repeat) {
      Points points;
      for (Vec3& p : points) {
        p = Vec3(small(2), small(2), small(1));
        if (kind == 1) p *= 2.82;
        if (kind == 2) p = test::odd_rotation() * (2.82 * p);
        if (kind == 3) p = Vec3(step(0.705 * p.x, small(2)), step(0.705 * p.y, small(2)), step(0.705 * p.z, small(2)));
        if (kind == 4) p = 1e6 + 2.82 * p;
        if (kind == 5) p = 1e-3 * p + Vec3(1.0 / 3.0, 1e5 / 7.0, -12.7);
        if (kind == 6) p = Vec3(uniform(), uniform(), uniform()) * std::pow(10.0, small(6));
      }
      all.push_back(points);
    }
  }
  return all;
}

TEST(Expansion, SumsAndProductsOfIntegersAreThoseOf128Bits) {
  std::mt19937_64 random(3);
  for (int repeat = 0; repeat < 2000; ++repeat) {
    const auto integer = [&] { return static_cast<std::int64_t>(random() >> 12) - (std::int64_t{1} << 51); };
    const std::int64_t a = integer(), b = integer(), c = integer(), d = integer();
    const auto expansion = as_expansion(static_cast<double>(a)) * as_expansion(static_cast<double>(b)) -
                           as_expansion(static_cast<double>(c)) * as_expansion(static_cast<double>(d));
    __extension__ using Wide = __int128;
    Wide sum = 0;
    for (int i = 0; i < expansion.size; ++i) sum += static_cast<Wide>(expansion.component[i]);
    EXPECT_TRUE(sum == static_cast<Wide>(a) * b - static_cast<Wide>(c) * d);
  }
}

TEST(Expansion, ProductOfDifferencesKeepsEveryBit) {
  // (1 + 2^-80)(1 - 2^-80) - 1 = -2^-160.
  const double tiny = std::ldexp(1.0, -80);
  const auto result = exact_difference(1.0, -tiny) * exact_difference(1.0, tiny) - as_expansion(1.0);
  ASSERT_EQ(result.size, 1);
  EXPECT_EQ(result.component[0], -tiny * tiny);
}

TEST(Orientation, KnownAnswers) {
  const Vec3 o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  EXPECT_EQ(orientation(o, x, y, z), 1);
  EXPECT_EQ(orientation(o, y, x, z), -1);
  EXPECT_EQ(orientation(o, x, y, x + y), 0);
  EXPECT_EQ(orientation(o, o, y, z), 0);
  EXPECT_GT(signed_volume(o, x, y, z), 0.0);
  // A hair off the plane, far away.
  const Vec3 far(1e6, 1e6, 1e6);
  EXPECT_EQ(orientation(far, far + x, far + y, Vec3(1e6, 1e6, step(1e6, 1))), 1);
  EXPECT_EQ(orientation(far, far + x, far + y, Vec3(1e6, 1e6, step(1e6, -1))), -1);
}

TEST(InSphere, KnownAnswers) {
  const Vec3 o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  EXPECT_EQ(in_sphere(o, x, y, z, Vec3(0.5)), 1);
  EXPECT_EQ(in_sphere(o, x, y, z, Vec3(1.0)), 0);
  EXPECT_EQ(in_sphere(o, x, y, z, Vec3(1.0, 1.0, step(1.0, 1))), -1);
  EXPECT_EQ(in_sphere(o, x, y, z, Vec3(1.0, 1.0, step(1.0, -1))), 1);
  EXPECT_EQ(in_sphere(x, o, y, z, Vec3(0.5)), -1);
  EXPECT_EQ(in_sphere(o, x, y, z, z), 0);
}

TEST(Predicates, PermutationsOnlyTurnTheSign) {
  for (const Points& p : hard_points()) {
    const int volume = orientation(p[0], p[1], p[2], p[3]);
    const int inside = in_sphere(p[0], p[1], p[2], p[3], p[4]);
    std::array<int, 4> order{0, 1, 2, 3};
    while (std::next_permutation(order.begin(), order.end())) {
      const int sign = parity(order);
      ASSERT_EQ(orientation(p[order[0]], p[order[1]], p[order[2]], p[order[3]]), sign * volume);
      ASSERT_EQ(in_sphere(p[order[0]], p[order[1]], p[order[2]], p[order[3]], p[4]), sign * inside);
    }
  }
}

TEST(Predicates, AgreeWithCgal) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  const auto point = [](const Vec3& p) { return Kernel::Point_3(p.x, p.y, p.z); };
  std::array<int, 3> seen{};  // every answer must have been asked for
  for (const Points& p : hard_points()) {
    const auto a = point(p[0]), b = point(p[1]), c = point(p[2]), d = point(p[3]), e = point(p[4]);
    ASSERT_EQ(orientation(p[0], p[1], p[2], p[3]), static_cast<int>(CGAL::orientation(a, b, c, d)));
    const int inside = in_sphere(p[0], p[1], p[2], p[3], p[4]);
    ASSERT_EQ(inside, static_cast<int>(CGAL::side_of_oriented_sphere(a, b, c, d, e)));
    ++seen[inside + 1];
  }
  EXPECT_GT(*std::min_element(seen.begin(), seen.end()), 1000);
}

TEST(Circumsphere, KnownAnswers) {
  const Sphere corner = circumsphere({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2});
  EXPECT_NEAR(glm::length(corner.center - Vec3(1.0)), 0.0, 1e-15);
  EXPECT_NEAR(corner.radius, std::sqrt(3.0), 1e-15);
  EXPECT_TRUE(std::isinf(circumsphere({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}).radius));
}

TEST(Circumsphere, HoldsForSlivers) {
  // Four points of one circle of a sphere of radius 5, one of them lifted along the sphere by less than a double shows.
  for (const double lift : {1e-3, 1e-6, 1e-9, 1e-12}) {
    const double polar = std::asin(0.6) + lift;
    const Vec3 a(3, 0, 4), b(0, 3, 4), c(-3, 0, 4), d(0, -5 * std::sin(polar), 5 * std::cos(polar));
    const Sphere sphere = circumsphere(a, b, c, d);
    // The rounding of d itself moves the sphere by about 1e-15 / lift.
    EXPECT_NEAR(sphere.radius, 5.0, 1e-13 + 1e-14 / lift) << lift;
    for (const Vec3& p : {a, b, c, d}) EXPECT_NEAR(glm::length(p - sphere.center), sphere.radius, 1e-12);
  }
}

}  // namespace
}  // namespace atomesh
