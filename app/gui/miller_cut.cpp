#include "app/gui/miller_cut.h"

#include <algorithm>
#include <cmath>

#include "app/gui/navigation.h"

namespace atomesh::gui {

CutPlane miller_cut(const UnitCell& cell, const Vec3& from, const MillerCut& cut) {
  CutPlane plane;
  plane.enabled = true;
  plane.side = cut.side;
  plane.normal = plane_normal(cell, cut.hkl);
  const double step = cut.unit == MillerCut::Unit::planes ? plane_spacing(cell, cut.hkl) : 1.0;
  plane.distance = glm::dot(plane.normal, from) + cut.offset * step;
  return plane;
}

std::optional<Vec3> miller_indices(const UnitCell& cell, const Vec3& normal, int largest) {
  const double length = glm::length(normal);
  if (!(length > 0.0)) return {};
  // (hkl) is h a* + k b* + l c*, and a·a* = 1, a·b* = 0: the normal's products with the cell's vectors are as h : k :
  // l.
  Vec3 ratio;
  for (int i = 0; i < 3; ++i) ratio[i] = glm::dot(normal, cell.primitive[static_cast<std::size_t>(i)]);
  const Vec3 sizes = glm::abs(ratio);
  const double most = std::max({sizes.x, sizes.y, sizes.z});
  if (!(most > 0.0)) return {};
  for (int n = 1; n <= largest; ++n) {
    const Vec3 hkl = glm::round(ratio * (n / most));
    if (glm::length(plane_normal(cell, hkl) - normal / length) < 1e-6) return hkl + Vec3(0.0);  // no minus zero
  }
  return {};
}

}  // namespace atomesh::gui
