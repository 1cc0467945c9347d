#include "render/cpu/map_intervals.h"

#include <algorithm>
#include <limits>

#include "render/shared/segment.h"

namespace atomesh::cell_projection {

MapIntervals::MapIntervals(const ColorMap& map) {
  const std::vector<ColorMapEntry>& entries = map.entries;
  const Vec4f constant(0.0F);
  // Scalars lie in [0,1]; the first interval reaches beyond so that rounding stays inside.
  if (entries.front().scalar > 0.0) add(-1.0, entries.front().color, constant, entries.front().color.a);
  for (std::size_t i = 0; i + 1 < entries.size(); ++i) {
    const double width = entries[i + 1].scalar - entries[i].scalar;
    if (!(width > 0.0)) continue;
    const glm::dvec4 rise = glm::dvec4(entries[i + 1].color) - glm::dvec4(entries[i].color);
    add(entries[i].scalar, entries[i].color, Vec4f(rise / width), std::max(entries[i].color.a, entries[i + 1].color.a));
  }
  add(entries.back().scalar, entries.back().color, constant, entries.back().color.a);
  intervals_.push_back({std::numeric_limits<float>::max(), 0.0F, {}, {}, 0.0F});
  std::uint16_t n = 0;
  for (int place = 0; place < map_grid_size; ++place) {
    while (static_cast<float>(place) / map_grid_size >= intervals_[n + 1U].begin) ++n;
    grid_.push_back(n);
  }
}

void MapIntervals::add(double begin, const Vec4f& first, const Vec4f& slope, float densest) {
  const auto rounded = static_cast<float>(begin);
  MapInterval interval{rounded, static_cast<float>(begin - static_cast<double>(rounded)), {}, {}, 0.0F};
  for (int k = 0; k < 4; ++k) {
    interval.first[k] = first[k];
    interval.slope[k] = slope[k];
  }
  // A little less than the quotient: rounding may add to what is absorbed.
  interval.thin_length = 0.999F * optics::thin_limit / std::max(densest, 1e-6F);
  intervals_.push_back(interval);
  const bool opaque = first.a > 0.0F || slope.a != 0.0F;
  opaque_before_.push_back(opaque_before_.back() + (opaque ? 1 : 0));
}

}  // namespace atomesh::cell_projection
