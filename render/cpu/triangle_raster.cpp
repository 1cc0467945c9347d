#include "render/cpu/triangle_raster.h"

namespace atomesh {

TriangleRaster::TriangleRaster(const ProjectedVertices& vertices, const Triangle& corners, bool perspective) {
  std::array<Vec3, 3> h;
  for (std::size_t k = 0; k < 3; ++k) {
    const ProjectedVertex& p = vertices[corners[k]];
    depths_[k] = p.z;
    h[k] = {p.x, p.y, perspective ? p.z : 1.0};
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 edge = glm::cross(h[(k + 1) % 3], h[(k + 2) % 3]);
    edges_[k] = {edge.x, edge.y, edge.z, (edge.x != 0.0 ? edge.x > 0.0 : edge.y > 0.0) ? 1 : 0};
  }
}

}  // namespace atomesh
