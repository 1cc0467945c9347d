#include "render/cpu/map_intervals.h"

namespace atomesh::cell_projection {

MapIntervals::MapIntervals(const ColorMap& map) {
  const std::vector<ColorMapEntry>& entries = map.entries;
  const auto scalar = [&](std::size_t i) { return static_cast<float>(entries[i].scalar); };
  const Vec4f constant(0.0F);
  // Scalars lie in [0,1]; the outer intervals reach beyond so that rounding stays inside.
  if (scalar(0) > 0.0F) add(-1.0F, scalar(0), entries.front().color, constant);
  for (std::size_t i = 0; i + 1 < entries.size(); ++i) {
    const float width = scalar(i + 1) - scalar(i);
    if (width > 0.0F)
      add(scalar(i), scalar(i + 1), entries[i].color, (entries[i + 1].color - entries[i].color) / width);
  }
  add(scalar(entries.size() - 1), 2.0F, entries.back().color, constant);
  std::uint16_t n = 0;
  for (int place = 0; place < map_grid_size; ++place) {
    while (n + 1U < intervals_.size() && static_cast<float>(place) / map_grid_size >= intervals_[n + 1U].begin) ++n;
    grid_.push_back(n);
  }
}

void MapIntervals::add(float begin, float end, const Vec4f& first, const Vec4f& slope) {
  MapInterval interval{begin, end, {}, {}};
  for (int k = 0; k < 4; ++k) {
    interval.first[k] = first[k];
    interval.slope[k] = slope[k];
  }
  intervals_.push_back(interval);
  const bool opaque = first.a > 0.0F || slope.a != 0.0F;
  opaque_before_.push_back(opaque_before_.back() + (opaque ? 1 : 0));
}

}  // namespace atomesh::cell_projection
