#include "render/cpu/surface_layers.h"

#include <algorithm>

namespace atomesh::cell_projection {

SurfaceLayers::SurfaceLayers(const Scene& scene, const Camera& camera, const Parameters& parameters, const View& view)
    : view_(view), shader_(scene, camera, parameters), faces_(scene.tetrahedra.size(), 0) {
  triangles_.reserve(scene.surface.size());
  for (std::size_t t = 0; t < scene.surface.size(); ++t) {
    const Index cell = scene.surface_tetrahedron[t];
    const unsigned face = scene.surface_face[t];
    faces_[cell] = static_cast<std::uint8_t>(faces_[cell] | (1U << face));
    triangles_.push_back({key(cell, face), static_cast<Index>(t)});
  }
  // extract_surface() leaves them in this order.
  if (!std::is_sorted(triangles_.begin(), triangles_.end())) std::sort(triangles_.begin(), triangles_.end());
}

void SurfaceLayers::shade(const void* layers, Index cell, int face, double column, double row, double u, float* rgb) {
  const SurfaceLayers& self = *static_cast<const SurfaceLayers*>(layers);
  const View& view = self.view_;
  const auto found = std::lower_bound(self.triangles_.begin(), self.triangles_.end(),
                                      std::pair<std::uint64_t, Index>{key(cell, static_cast<unsigned>(face)), 0});
  const double depth = view.perspective ? view.reference / (1.0 - u) : u + view.reference;
  const Vec3f color =
      self.shader_.shade(found->second, view.left + column * view.pixel, view.top - row * view.pixel, depth, false);
  for (int k = 0; k < 3; ++k) rgb[k] = color[k];
}

}  // namespace atomesh::cell_projection
