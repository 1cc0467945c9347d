// The judge's optics: the model of render/shared/optics.h written a second time, in double and without approximation.
#pragma once

#include <vector>

#include "core/color_map.h"
#include "core/geometry.h"
#include "core/parameters.h"
#include "render/shared/optics.h"

namespace atomesh::reference {

using Vec4 = glm::dvec4;

// What a stretch of a ray adds, and the share of the light from behind that it lets through.
struct Contribution {
  Vec3 color{0.0};  // premultiplied
  double transmittance = 1.0;
};

inline void compose(Contribution& front, const Contribution& behind) {
  front.color += front.transmittance * behind.color;
  front.transmittance *= behind.transmittance;
}

// A segment of `length` Å along which RGBA goes linearly from `near` to `far`, extinction alpha_length · A (1/Å):
//   ∫ c(s) σ(s) exp(-∫₀ˢ σ) ds  over [0, length],  by Gauss–Legendre with 16 points on pieces of optical depth at
//   most 1.
// The integrand g continues to the whole complex plane, and on the Bernstein ellipse ρ = 8 of a piece |g| < 3·10⁵ (the
// linear factors grow at most 4.07-fold, the exponent stays below 10.3), so the error of a piece is below
// 64/15 · 3·10⁵ · ρ⁻³² / (1-ρ⁻²) < 2·10⁻²³ (Trefethen 2008, theorem 4.5): nothing beside the rounding of double.
Contribution integrate_linear(const Vec4& near, const Vec4& far, double alpha_length, double length);

// The same for a scalar that goes linearly from `near` to `far` and is coloured by the map at every point: split where
// it crosses an entry, linear between.
Contribution integrate_mapped(const ColorMap& map, double near, double far, double alpha_length, double length);

// Phong's model, see optics::phong.
Vec3 phong(const optics::PhongCoefficients& k, const Vec3& point, const Vec3& normal, const Vec3& to_eye,
           const std::vector<optics::LightRay>& lights);

}  // namespace atomesh::reference
