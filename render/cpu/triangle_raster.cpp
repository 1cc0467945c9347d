#include "render/cpu/triangle_raster.h"

#include <utility>

namespace atomesh {

TriangleRaster::TriangleRaster(const ProjectedVertices& vertices, const Triangle& corners, bool perspective) {
  const auto position = [&](Index v) {
    const double* p = &vertices.camera[3 * static_cast<std::size_t>(v)];
    return Vec3(p[0], p[1], p[2]);
  };
  for (std::size_t k = 0; k < 3; ++k) {
    depths_[k] = position(corners[k]).z;
    Index i = corners[(k + 1) % 3];
    Index j = corners[(k + 2) % 3];
    const double sign = i < j ? 1.0 : -1.0;
    if (j < i) std::swap(i, j);
    Vec3 hi = position(i);
    Vec3 hj = position(j);
    if (!perspective) hi.z = hj.z = 1.0;
    const Vec3 edge = sign * glm::cross(hi, hj);
    edges_[k] = {edge.x, edge.y, edge.z, edge.x != 0.0 ? edge.x > 0.0 : edge.y > 0.0};
  }
}

TriangleRaster::Row TriangleRaster::row(double y) const {
  Row row;
  for (std::size_t k = 0; k < 3; ++k) row.constant[k] = edges_[k].y * y + edges_[k].constant;
  return row;
}

}  // namespace atomesh
