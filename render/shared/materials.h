// What each lit mode feeds into Phong's model: the material of a surface polygon, of the surface and of an atom ball.
#pragma once

#include "core/parameters.h"
#include "render/shared/optics.h"

namespace atomesh::optics {

// Layer of mode volume_surface: `color` is the vertex colours interpolated at the crossing. Highlights are white.
inline PhongCoefficients layer_material(const VolumeSurfaceParameters& p, const Vec3f& color) {
  return {static_cast<float>(p.ambient) * color, static_cast<float>(p.diffuse) * color,
          Vec3f(static_cast<float>(p.specular)), Vec3f(0.0F), static_cast<float>(p.shininess)};
}

// Mode surface: one colour is both ambient and diffuse (B.6.3.2), in the shares of the default light model: what is not
// lit keeps 0.3 of it.
inline constexpr float ambient_share = 0.3F;
inline constexpr float diffuse_share = 0.7F;

inline PhongCoefficients surface_material(const SurfaceParameters& p) {
  return {ambient_share * p.color, diffuse_share * p.color, p.specular, p.emission, static_cast<float>(p.shininess)};
}

// Atom balls: the species' colour with a mild white highlight.
inline PhongCoefficients ball_material(const Vec3f& color) {
  return {ambient_share * color, diffuse_share * color, Vec3f(0.2F), Vec3f(0.0F), 30.0F};
}

}  // namespace atomesh::optics
