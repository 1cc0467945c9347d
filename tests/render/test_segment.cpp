// The closed form of a segment's light against quadrature in long double.
#include <gtest/gtest.h>

#include <cmath>

#include "render/shared/segment.h"

namespace atomesh::optics {
namespace {

struct Exact {
  long double through;
  long double psi;  // ∫ T(u) du
};

// Simpson's rule in pieces that follow the transmittance down.
Exact quadrature(double near_density, double far_density) {
  const long double a = near_density;
  const long double b = far_density;
  const auto transmittance = [&](long double u) { return std::exp(-(a * u + (b - a) * u * u / 2)); };
  // Beyond 50 mean free paths nothing is left; the mean free path is at most 1 / density where the density is largest.
  long double sum = 0;
  const int pieces = 4000;
  for (int i = 0; i < pieces; ++i) {
    // Quadratic spacing towards both ends, where a dense segment has its light.
    const auto at = [&](int n) {
      const long double t = static_cast<long double>(n) / pieces;
      return t * t * t * (10 + t * (-15 + 6 * t));
    };
    const long double u0 = at(i);
    const long double u1 = at(i + 1);
    sum += (u1 - u0) / 6 * (transmittance(u0) + 4 * transmittance((u0 + u1) / 2) + transmittance(u1));
  }
  return {transmittance(1), sum};
}

TEST(Segment, PieceIsWithinThreeTenMillionthsOfQuadrature) {
  double worst = 0.0;
  for (int m = 0; m <= 20; ++m) {
    for (int d = -10; d <= 10; ++d) {
      const double mean = m / 20.0;
      const double half_difference = mean * d / 10.0;
      const Exact exact = quadrature(mean - half_difference, mean + half_difference);
      const Piece<float> piece = integrate_piece(static_cast<float>(mean), static_cast<float>(half_difference));
      const double opacity = static_cast<double>(1 - exact.through);
      const double ramp = static_cast<double>(exact.psi - exact.through);
      worst = std::max({worst, std::abs(static_cast<double>(piece.opacity) - opacity),
                        std::abs(static_cast<double>(piece.ramp) - ramp)});
    }
  }
  EXPECT_LE(worst, 5e-7);  // the series' 3e-7 and the rounding of float
}

TEST(Segment, ThinPieceIsWithinATenMillionthOfQuadrature) {
  double worst = 0.0;
  for (int m = 0; m <= 20; ++m) {
    for (int d = -10; d <= 10; ++d) {
      const double mean = m / 20.0 * static_cast<double>(thin_limit);
      const double half_difference = mean * d / 10.0;
      const Exact exact = quadrature(mean - half_difference, mean + half_difference);
      const Piece<float> piece = integrate_thin_piece(static_cast<float>(mean), static_cast<float>(half_difference));
      worst = std::max({worst, std::abs(static_cast<double>(piece.opacity - (1 - exact.through))),
                        std::abs(static_cast<double>(piece.ramp - (exact.psi - exact.through)))});
    }
  }
  EXPECT_LE(worst, 1e-7);
}

TEST(Segment, ThinCenteredPieceIsWithinATenMillionthOfQuadrature) {
  double worst = 0.0;
  for (int m = 0; m <= 20; ++m) {
    for (int d = -10; d <= 10; ++d) {
      const double mean = m / 20.0 * static_cast<double>(thin_limit);
      const double half_difference = mean * d / 10.0;
      const Exact exact = quadrature(mean - half_difference, mean + half_difference);
      const CenteredPiece<float> piece =
          integrate_thin_centered(static_cast<float>(mean), static_cast<float>(half_difference));
      const double near_weight = 0.5 * (static_cast<double>(piece.opacity) - static_cast<double>(piece.skew));
      const double far_weight = 0.5 * (static_cast<double>(piece.opacity) + static_cast<double>(piece.skew));
      worst = std::max({worst, std::abs(static_cast<double>(piece.opacity - (1 - exact.through))),
                        std::abs(near_weight - static_cast<double>(1 - exact.psi)),
                        std::abs(far_weight - static_cast<double>(exact.psi - exact.through))});
    }
  }
  EXPECT_LE(worst, 1e-7);
}

TEST(Segment, CenteredIsTheSamePiece) {
  const Piece<float> piece = integrate_piece(0.7F, -0.3F);
  const CenteredPiece<float> same = centered(piece);
  EXPECT_FLOAT_EQ(same.opacity, piece.opacity);
  EXPECT_NEAR(0.5F * (same.opacity + same.skew), piece.ramp, 1e-7F);
}

TEST(Segment, AnyDensityIsWithinAMillionth) {
  for (const double near_density : {0.0, 1e-6, 1e-3, 0.3, 1.0, 2.5, 7.0, 30.0, 400.0}) {
    for (const double far_density : {0.0, 1e-6, 1e-3, 0.3, 1.0, 2.5, 7.0, 30.0, 400.0}) {
      const Exact exact = quadrature(near_density, far_density);
      const SegmentLight light = integrate_segment(static_cast<float>(near_density), static_cast<float>(far_density));
      const double far_weight = static_cast<double>(exact.psi - exact.through);
      const double near_weight = static_cast<double>(1 - exact.psi);
      EXPECT_NEAR(light.transmittance, static_cast<double>(exact.through), 1e-6) << near_density << ' ' << far_density;
      EXPECT_NEAR(light.far_weight, far_weight, 1e-6) << near_density << ' ' << far_density;
      EXPECT_NEAR(light.near_weight, near_weight, 1e-6) << near_density << ' ' << far_density;
    }
  }
}

TEST(Segment, AnOpaqueSegmentShowsItsNearEnd) {
  const SegmentLight light = integrate_segment(1e6F, 1e6F);
  EXPECT_NEAR(light.near_weight, 1.0F, 2e-6F);
  EXPECT_NEAR(light.transmittance, 0.0F, 1e-7F);
}

TEST(Segment, NothingInTheWayLetsEverythingThrough) {
  const SegmentLight light = integrate_segment(0.0F, 0.0F);
  EXPECT_EQ(light.transmittance, 1.0F);
  EXPECT_EQ(light.near_weight, 0.0F);
  EXPECT_EQ(light.far_weight, 0.0F);
}

}  // namespace
}  // namespace atomesh::optics
