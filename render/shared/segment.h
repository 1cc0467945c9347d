// Light and transmittance of a ray's segment along which colour and extinction are linear: the closed form that every
// renderer evaluates, written once for a float and for a register of them.
//
// With optical density τ(u) = τ0 + (τ1-τ0) u over u in [0,1] and T(u) = exp(-∫τ), integration by parts of ∫ c τ T du
// gives
//   light = c0 · (1 - T1) + (c1 - c0) · (ψ - T1),   ψ = ∫₀¹ T(u) du
// for each colour channel (the identity behind partial pre-integration: Moreland & Angel 2004, "A fast high accuracy
// volume renderer for unstructured data"). With mean m = (τ0+τ1)/2 and D = (τ1-τ0)/2, |D| <= m, the exponent is
// -m u + D u (1-u), and about the middle of the segment
//   ψ = e^{-m/2} Σ_{k,j} (D/4)^k / k! · (m/2)^{2j} / (2j)! · B(j+1/2, k+1) / 2,   B Euler's beta function.
// Cut off as below the error is at most 3e-7 for m <= 1. Denser segments are cut into pieces of m <= 1.
#pragma once

#include <cmath>

namespace atomesh::optics {

// Largest mean optical depth integrate_piece() is made for.
inline constexpr float piece_limit = 1.0F;

// A segment that lets no more light through than this is not followed further.
inline constexpr float nothing_left = 1e-7F;

template <class F>
struct Piece {
  F opacity;  // 1 - T1: weight of the first colour
  F ramp;     // ψ - T1: weight of the difference of the colours
};

inline float multiply_add(float a, float b, float c) {
  return a * b + c;
}

// e^{-x} for 0 <= x <= 0.5, absolute error 1e-7: Taylor's series.
template <class F>
inline F exp_minus_half(F x) {
  F e = multiply_add(x, F(-1.0F / 5040.0F), F(1.0F / 720.0F));
  e = multiply_add(x, e, F(-1.0F / 120.0F));
  e = multiply_add(x, e, F(1.0F / 24.0F));
  e = multiply_add(x, e, F(-1.0F / 6.0F));
  e = multiply_add(x, e, F(0.5F));
  e = multiply_add(x, e, F(-1.0F));
  return multiply_add(x, e, F(1.0F));
}

// 0 <= mean <= piece_limit, |half_difference| <= mean.
template <class F>
inline Piece<F> integrate_piece(F mean, F half_difference) {
  const F half = mean * F(0.5F);
  const F x = half * half;
  const F y = half_difference * F(0.25F);
  // The coefficients are B(j+1/2, k+1) / (2 k! (2j)!), rows of k from the innermost.
  F s = multiply_add(y, F(3.07840308e-3F), multiply_add(x, F(7.69600770e-4F), F(1.69312169e-2F)));
  s = multiply_add(y, s, multiply_add(x, F(4.23280423e-3F), F(7.61904762e-2F)));
  s = multiply_add(y, s, multiply_add(x, multiply_add(x, F(5.29100529e-4F), F(1.90476190e-2F)), F(2.66666667e-1F)));
  s = multiply_add(y, s, multiply_add(x, multiply_add(x, F(2.38095238e-3F), F(6.66666667e-2F)), F(6.66666667e-1F)));
  const F even = multiply_add(x, multiply_add(x, F(1.98412698e-4F), F(8.33333333e-3F)), F(1.66666667e-1F));
  s = multiply_add(y, s, multiply_add(x, even, F(1.0F)));
  const F root = exp_minus_half(half);
  const F through = root * root;
  return {F(1.0F) - through, multiply_add(root, s, F(0.0F) - through)};
}

// Largest mean optical depth integrate_thin_piece() is made for.
inline constexpr float thin_limit = 1.0F / 16.0F;

// The same to 1e-7 for 0 <= mean <= thin_limit, |half_difference| <= mean: T(u) expanded to the third power of the
// optical depth, with the two largest terms of the fourth, and integrated. Fine meshes are made of such pieces.
template <class F>
inline Piece<F> integrate_thin_piece(F mean, F half_difference) {
  F opacity = multiply_add(mean, F(-1.0F / 24.0F), F(1.0F / 6.0F));
  opacity = multiply_add(mean, opacity, F(-0.5F));
  opacity = multiply_add(mean, opacity, F(1.0F)) * mean;
  F even = multiply_add(mean, F(-1.0F / 30.0F), F(1.0F / 8.0F));
  even = multiply_add(mean, even, F(-1.0F / 3.0F));
  even = multiply_add(mean, even, F(0.5F)) * mean;
  const F square =
      multiply_add(half_difference, F(1.0F / 840.0F), multiply_add(mean, F(-1.0F / 120.0F), F(1.0F / 60.0F)));
  F linear = multiply_add(mean, F(-1.0F / 180.0F), F(1.0F / 40.0F));
  linear = multiply_add(mean, linear, F(-1.0F / 12.0F));
  linear = multiply_add(mean, linear, F(1.0F / 6.0F));
  return {opacity, multiply_add(half_difference, multiply_add(half_difference, square, linear), even)};
}

// A piece's light from the colours' mean and half their difference, far minus near: opacity · mean + skew · half.
template <class F>
struct CenteredPiece {
  F opacity;  // 1 - T1
  F skew;     // 2 (ψ - T1) - (1 - T1)
};

template <class F>
inline CenteredPiece<F> centered(const Piece<F>& piece) {
  return {piece.opacity, multiply_add(piece.ramp, F(2.0F), F(0.0F) - piece.opacity)};
}

// integrate_thin_piece() of what centered() makes of it; weights of the two ends' colours are right to 1e-7, too.
template <class F>
inline CenteredPiece<F> integrate_thin_centered(F mean, F half_difference) {
  F opacity = multiply_add(mean, F(-1.0F / 24.0F), F(1.0F / 6.0F));
  opacity = multiply_add(mean, opacity, F(-0.5F));
  opacity = multiply_add(mean, opacity, F(1.0F)) * mean;
  F even = multiply_add(mean, F(-1.0F / 40.0F), F(1.0F / 12.0F));
  even = multiply_add(mean, even, F(-1.0F / 6.0F)) * (mean * mean);
  const F square =
      multiply_add(half_difference, F(1.0F / 420.0F), multiply_add(mean, F(-1.0F / 60.0F), F(1.0F / 30.0F)));
  F linear = multiply_add(mean, F(-1.0F / 90.0F), F(1.0F / 20.0F));
  linear = multiply_add(mean, linear, F(-1.0F / 6.0F));
  linear = multiply_add(mean, linear, F(1.0F / 3.0F));
  return {opacity, multiply_add(half_difference, multiply_add(half_difference, square, linear), even)};
}

// How far a piece of optical depth 1 reaches from a point of density `density` (per unit of u) whose density grows by
// 2·half_difference per unit of u: the root h of density·h + half_difference·h² = 1. Only asked where what is left of
// the segment is denser than 1, so that the root exists.
inline float piece_length(float density, float half_difference) {
  return 2.0F / (density + std::sqrt(std::fmax(0.0F, density * density + 4.0F * half_difference)));
}

// The whole segment, for any τ0, τ1 >= 0: weights of the colours at its two ends in `light` and what is let through.
struct SegmentLight {
  float near_weight;  // of the colour where the ray enters
  float far_weight;   // of the colour where it leaves
  float transmittance;
};

inline SegmentLight integrate_segment(float density_near, float density_far) {
  const float half_difference = 0.5F * (density_far - density_near);
  SegmentLight sum{0.0F, 0.0F, 1.0F};
  float u = 0.0F;
  while (u < 1.0F && sum.transmittance > nothing_left) {
    const float density = density_near + 2.0F * half_difference * u;
    const float rest = 1.0F - u;
    float h = rest;
    if (0.5F * rest * (density + density_far) > piece_limit) {
      h = std::fmin(rest, piece_length(density, half_difference));
    }
    const float d = half_difference * h * h;
    const Piece<float> piece = integrate_piece(std::fmin(density * h + d, piece_limit), d);
    const float ramp = piece.ramp * h;  // colours differ by h times the whole difference
    const float far_weight = sum.transmittance * (u * piece.opacity + ramp);
    sum.far_weight += far_weight;
    sum.near_weight += sum.transmittance * piece.opacity - far_weight;
    sum.transmittance -= sum.transmittance * piece.opacity;
    u = h == rest ? 1.0F : u + h;
  }
  return sum;
}

}  // namespace atomesh::optics
