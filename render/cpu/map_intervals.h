// The colour map as cell projection integrates it: linear intervals side by side that cover every scalar.
#pragma once

#include <cstdint>
#include <vector>

#include "core/color_map.h"
#include "render/cpu/cell_projection_kernel.h"

namespace atomesh::cell_projection {

class MapIntervals {
 public:
  MapIntervals() = default;
  explicit MapIntervals(const ColorMap& map);

  const MapInterval* data() const { return intervals_.data(); }
  // The interval a scalar lies in; of two that meet there, the upper.
  std::uint16_t find(float scalar) const;
  // Whether no scalar from `low` to `high` has any opacity.
  bool transparent(float low, float high) const {
    return opaque_before_[std::size_t{find(high)} + 1] == opaque_before_[find(low)];
  }

 private:
  void add(float begin, float end, const Vec4f& first, const Vec4f& slope);

  std::vector<MapInterval> intervals_;
  std::vector<int> opaque_before_{0};  // how many intervals before each are not transparent throughout
};

}  // namespace atomesh::cell_projection
