// Piecewise-linear map from a scalar in [0,1] to RGBA.
#pragma once

#include <string>
#include <vector>

#include "core/geometry.h"

namespace atomesh {

struct ColorMapEntry {
  double scalar = 0.0;      // [0,1]
  Vec4f color{0, 0, 0, 0};  // RGB in [0,1], not premultiplied; A is the opacity coefficient in [0,1]
  bool operator==(const ColorMapEntry&) const = default;
};

// 2 to 32 entries, ascending in scalar; constant before the first and after the last. Two entries of equal scalar make
// a jump: the later one holds from there on.
struct ColorMap {
  std::vector<ColorMapEntry> entries;

  bool operator==(const ColorMap&) const = default;
  Vec4f operator()(double scalar) const;
};

// Throws UsageError naming the entry: fewer than 2 or more than 32, scalars that descend or leave [0,1], a colour
// component outside [0,1].
void check_color_map(const ColorMap& map);

// "viridis", "cividis", "gray", "blue-white-red", "seed-figure-5.8"; opacity rises linearly with the scalar (from 0).
// Throws UsageError naming the nearest preset.
ColorMap preset_color_map(const std::string& name);
std::vector<std::string> preset_color_map_names();

}  // namespace atomesh
