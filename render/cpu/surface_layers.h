// The lit layers of mode volume_surface: which faces of which cells are on the surface, and their colour where a ray
// enters by them.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "render/cpu/cell_projection_kernel.h"
#include "render/cpu/surface_shader.h"

namespace atomesh::cell_projection {

class SurfaceLayers {
 public:
  // Keeps references.
  SurfaceLayers(const Scene& scene, const Camera& camera, const Parameters& parameters, const View& view);

  // Per tetrahedron, bit f set where face f is on the surface.
  const std::uint8_t* faces() const { return faces_.data(); }
  Shader shader() const { return {shade, this}; }

 private:
  static void shade(const void* layers, Index cell, int face, double column, double row, double u, float* rgb);
  static std::uint64_t key(Index cell, unsigned face) { return std::uint64_t{cell} * 4 + face; }

  const View& view_;
  SurfaceShader shader_;
  std::vector<std::uint8_t> faces_;
  std::vector<std::pair<std::uint64_t, Index>> triangles_;  // key of cell and face, triangle; ascending
};

}  // namespace atomesh::cell_projection
