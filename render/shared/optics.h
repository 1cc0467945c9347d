// The optical model in one place: what every renderer computes, on whatever hardware.
//
// Volume. At a point with (linearly interpolated) colour c and opacity coefficient a, extinction is σ = alpha_length ·
// a and emission per length is σ · c. Along a ray, with transmittance T(s) = exp(-∫σ), the light reaching the eye from
// a segment is ∫ c σ T ds (Max 1995, "Optical models for direct volume rendering"). Segments compose front to back:
//   C ← C + T · C_segment,  T ← T · T_segment.
// Mode volume_surface interpolates RGBA linearly in each tetrahedron. Mode volume interpolates the scalar linearly and
// maps it through the colour map at every point (post-classification), so within a cell RGBA is piecewise linear with a
// knot wherever the scalar crosses a map entry.
//
// Surface crossings (volume_surface): where the ray enters the sample through a front-facing surface triangle, a layer
// of opacity face_alpha and colour phong(vertex colours interpolated on the face) lies in front of what follows. Back
// faces contribute nothing. An eye inside the sample starts inside and meets no layer there.
//
// Mode surface: the nearest triangle in front of the eye, opaque; seen from behind (by an eye inside the sample) its
// normal is turned round. Mode xray: thickness = Σ over crossings in front of the eye, depth at exits minus depth at
// entries, in Å along the ray; opacity min(1, alpha_length · thickness). Mode atoms: the front hits of the balls whose
// hit lies in front of the eye (an eye inside a ball does not see it), composed by depth, each a layer of the ball's
// opacity and colour phong(). Materials: materials.h. A ray that meets an edge or a vertex exactly goes by it on the
// right and, where that decides nothing, above it, in the picture's axes.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/geometry.h"
#include "core/parameters.h"

namespace atomesh::optics {

struct PhongCoefficients {
  Vec3f ambient;  // already multiplied with the material's colour
  Vec3f diffuse;
  Vec3f specular;
  Vec3f emission;
  float shininess;
};

// Phong's model as the manual has it (B.6.3.1): ambient + Σ lights (diffuse · max(0, n·l) + specular · max(0,
// r·v)^shininess) × light colour × intensity, clamped to [0,1]. n, l, v unit vectors; r is l mirrored at n. The
// specular term counts only where n·l > 0. All vectors in one space. `lights` holds direction-to-light and colour ×
// intensity of the enabled ones.
struct LightRay {
  Vec3f position;  // scene space (about Scene::center)
  Vec3f color;     // colour × intensity
};

inline Vec3f phong(const PhongCoefficients& k, const Vec3f& point, const Vec3f& normal, const Vec3f& to_eye,
                   const LightRay* lights, int light_count) {
  Vec3f color = k.emission + k.ambient;
  for (int i = 0; i < light_count; ++i) {
    const Vec3f to_light = glm::normalize(lights[i].position - point);
    const float cosine = glm::dot(normal, to_light);
    if (cosine <= 0.0F) continue;
    color += k.diffuse * lights[i].color * cosine;
    const Vec3f mirrored = 2.0F * cosine * normal - to_light;
    const float along = glm::dot(mirrored, to_eye);
    if (along > 0.0F) color += k.specular * lights[i].color * std::pow(along, k.shininess);
  }
  return glm::clamp(color, 0.0F, 1.0F);
}

}  // namespace atomesh::optics
