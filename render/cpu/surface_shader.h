// Colour of a surface polygon where a ray meets it, by Phong's model, for the layers of mode volume_surface and for
// mode surface.
#pragma once

#include <vector>

#include "core/camera.h"
#include "core/parameters.h"
#include "render/scene.h"
#include "render/shared/optics.h"

namespace atomesh {

class SurfaceShader {
 public:
  // Keeps references; the scene has a surface with normals.
  SurfaceShader(const Scene& scene, const Camera& camera, const Parameters& parameters);

  // Clamped RGB where the ray through image-plane point (x, y) meets the triangle at `depth`; `from_behind` turns the
  // normal round. Mode volume_surface takes its colour from the vertices, mode surface from the parameters.
  Vec3f shade(Index triangle, double x, double y, double depth, bool from_behind) const;

 private:
  const Scene& scene_;
  const Camera& camera_;
  const Parameters& parameters_;
  std::vector<optics::LightRay> lights_;
};

}  // namespace atomesh
