// The colour map as cell projection integrates it: linear intervals side by side that cover every scalar.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/color_map.h"
#include "render/cpu/cell_projection_kernel.h"

namespace atomesh::cell_projection {

class MapIntervals {
 public:
  MapIntervals() = default;
  explicit MapIntervals(const ColorMap& map);

  // size() intervals and one more, that no scalar reaches.
  const MapInterval* data() const { return intervals_.data(); }
  std::size_t size() const { return intervals_.size() - 1; }
  // For each n the interval of n / map_grid_size, from which find() looks on.
  const std::uint16_t* grid() const { return grid_.data(); }
  // The interval a scalar lies in; of two that meet there, the upper.
  std::uint16_t find(float scalar) const {
    const float place = std::clamp(scalar * map_grid_size, 0.0F, map_grid_size - 1.0F);
    return find(scalar, grid_[static_cast<std::size_t>(place)]);
  }
  // The same, from one of those below it or its own on.
  std::uint16_t find(float scalar, std::uint16_t from) const {
    std::size_t n = from;
    while (scalar >= intervals_[n + 1].begin) ++n;
    return static_cast<std::uint16_t>(n);
  }
  // Of those from `first` to `last` the least thin_length.
  float thin_length(std::uint16_t first, std::uint16_t last) const {
    // Most cells touch one or two.
    float least = std::min(intervals_[first].thin_length, intervals_[last].thin_length);
    for (std::size_t n = first + std::size_t{1}; n < last; ++n) least = std::min(least, intervals_[n].thin_length);
    return least;
  }
  // Whether some intervals have no opacity throughout.
  bool any_transparent() const { return opaque_before_.back() != static_cast<int>(size()); }
  // Whether no scalar from `low` to `high` has any opacity.
  bool transparent(float low, float high) const {
    return opaque_before_[std::size_t{find(high)} + 1] == opaque_before_[find(low)];
  }

 private:
  // `densest`: the largest opacity in it.
  void add(double begin, const Vec4f& first, const Vec4f& slope, float densest);

  std::vector<MapInterval> intervals_;
  std::vector<std::uint16_t> grid_;
  std::vector<int> opaque_before_{0};  // how many intervals before each are not transparent throughout
};

}  // namespace atomesh::cell_projection
