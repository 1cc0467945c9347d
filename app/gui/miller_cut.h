// Cut planes by the Miller indices of the crystal's own cell.
#pragma once

#include <optional>

#include "core/geometry.h"
#include "core/parameters.h"
#include "core/unit_cell.h"

namespace atomesh::gui {

struct MillerCut {
  Vec3 hkl{1.0, 0.0, 0.0};  // of UnitCell::primitive; whole numbers as a rule, any direction will do
  // From the point `from` along the plane's normal, in Å, or in distances between neighbouring planes (hkl).
  enum class Unit { angstrom, planes } unit = Unit::angstrom;
  double offset = 0.0;
  CutPlane::Side side = CutPlane::Side::less_equal;
};

// The enabled plane, its normal of length 1, so that its distance is in Å. Throws UsageError for 0 0 0.
CutPlane miller_cut(const UnitCell& cell, const Vec3& from, const MillerCut& cut);

// The indices of the planes with this normal (of any length): the smallest whole numbers, none beyond `largest`, that
// make its direction to within 1e-6; nothing where there are none.
std::optional<Vec3> miller_indices(const UnitCell& cell, const Vec3& normal, int largest = 12);

}  // namespace atomesh::gui
