// The lights of Parameters, which are fixed to the viewer, as points in the scene's space for optics::phong().
#pragma once

#include <algorithm>
#include <vector>

#include "core/camera.h"
#include "core/parameters.h"
#include "render/scene.h"
#include "render/shared/optics.h"

namespace atomesh::optics {

// Enabled lights only, in the order of Parameters::lights. A light's position is taken in the camera's axes (x right,
// y up, z towards the viewer) about the centre of the uncut sample, in units of its bounding radius (at least 1 Å, as
// make_camera() has it).
inline std::vector<LightRay> scene_lights(const Parameters& parameters, const Scene& scene, const Camera& camera) {
  const double radius = std::max(0.5 * (scene.bounds.empty() ? 0.0 : scene.bounds.diagonal()), 1.0);
  const Vec3 middle = scene.bounds.empty() ? Vec3(0.0) : scene.bounds.center() - scene.center;
  std::vector<LightRay> lights;
  for (const Light& light : parameters.lights) {
    if (!light.enabled) continue;
    const Vec3 p(light.position);
    const Vec3 position = middle + radius * (p.x * camera.right + p.y * camera.up - p.z * camera.forward);
    lights.push_back({Vec3f(position), light.color * light.intensity});
  }
  return lights;
}

// Unit vector from a point of the scene towards the viewer; with parallel projection the viewer is infinitely far.
inline Vec3f to_viewer(const Scene& scene, const Camera& camera, const Vec3f& point) {
  if (camera.projection == Projection::parallel) return Vec3f(-camera.forward);
  return Vec3f(glm::normalize(camera.eye - scene.center - Vec3(point)));
}

}  // namespace atomesh::optics
