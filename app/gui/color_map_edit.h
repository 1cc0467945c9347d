// Changing a colour map entry by entry: functions on the map that keep its rules (core/color_map.h), so that whatever
// mouse and keys do, the map stays one that can be drawn.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/color_map.h"

namespace atomesh::gui {

inline constexpr std::size_t min_color_map_entries = 2;
inline constexpr std::size_t max_color_map_entries = 32;

// All indices are into ColorMap::entries; functions that take one throw UsageError where there is no such entry.

// Puts an entry with the map's own colour at `scalar` (clamped to [0,1]), behind those of the same scalar: the picture
// stays the same. Returns its index. Throws UsageError when there are 32 already.
std::size_t insert_entry(ColorMap& map, double scalar);
// The same with another opacity.
std::size_t insert_entry(ColorMap& map, double scalar, float opacity);
// Throws UsageError when there are but two.
void remove_entry(ColorMap& map, std::size_t index);

// As a handle is dragged: the entry stops at its neighbours, so that the order stays; at a neighbour's place the two
// make a jump. Opacity is clamped to [0,1].
void move_entry(ColorMap& map, std::size_t index, double scalar, float opacity);
// As a number is typed: the entry goes where the scalar puts it, behind those of the same scalar (an entry that has the
// scalar already stays). Returns the new index. Throws UsageError outside of [0,1].
std::size_t set_entry_scalar(ColorMap& map, std::size_t index, double scalar);
// Throw UsageError for components outside of [0,1].
void set_entry_color(ColorMap& map, std::size_t index, const Vec3f& color);
void set_entry_opacity(ColorMap& map, std::size_t index, float opacity);

// A map of any number of entries, two or more, as one of at most 32: without those between the first and the last
// without which it is the same to 1/4096, and then without those whose loss changes it least.
ColorMap fewer_entries(const ColorMap& map);

enum class ColorMapPart { all, color, opacity };

// Each scalar gets what 1 - scalar had. Of a part of the map, see combined_map().
void reverse_color_map(ColorMap& map, ColorMapPart part = ColorMapPart::all);
// What `source` has, or only its colours or its opacities, the rest staying as it is; see combined_map().
void apply_color_map(ColorMap& map, const ColorMap& source, ColorMapPart part);
// The colours of one map with the opacities of another: fewer_entries() of those of both.
ColorMap combined_map(const ColorMap& colors, const ColorMap& opacities);
// A map to take opacities from: "opaque" (1), "ramp" (the scalar), "square" (of the scalar), "threshold" (0, from the
// middle on 1), "upper-half" (0 up to the middle, from there a ramp). Throws UsageError for another name.
ColorMap opacity_curve(std::string_view name);
const std::vector<std::string>& opacity_curve_names();

// The preset that has these colours, at the entries of both to 1/4096; nothing for a map of its own.
std::optional<std::string> preset_of_colors(const ColorMap& map);

// The nearest multiple of `step`; the value itself where the step is not above 0.
double snapped(double value, double step);

// The entry drawn nearest to (x, y), in pixels right of scalar 0 and above opacity 0 on an area width × height, among
// those no further than `reach`; of several at one place, the one that can be moved: the last, or at 1 the first.
std::optional<std::size_t> entry_at(const ColorMap& map, double x, double y, double width, double height, double reach);

}  // namespace atomesh::gui
