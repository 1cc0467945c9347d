#include "app/gui/color_map_edit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/error.h"

namespace atomesh::gui {

namespace {

// What is not seen: an eighth of a step of 8 bits and less.
constexpr float straight = 1.0F / 4096.0F;

ColorMapEntry& entry(ColorMap& map, std::size_t index) {
  if (index >= map.entries.size()) {
    throw UsageError("the color map has " + std::to_string(map.entries.size()) + " entries; there is no entry " +
                     std::to_string(index + 1));
  }
  return map.entries[index];
}

void check_component(float value) {
  if (!(value >= 0.0F && value <= 1.0F)) throw UsageError("colors and opacities are from 0 to 1");
}

float clamped(float value) {
  return std::isfinite(value) ? std::clamp(value, 0.0F, 1.0F) : 0.0F;
}

// Behind the entries of the same scalar.
std::size_t place_of(const ColorMap& map, double scalar) {
  const auto next = std::upper_bound(map.entries.begin(), map.entries.end(), scalar,
                                     [](double s, const ColorMapEntry& e) { return s < e.scalar; });
  return static_cast<std::size_t>(next - map.entries.begin());
}

// Of a map at a scalar, from the left: at a jump the earlier entry.
Vec4f left_limit(const ColorMap& map, double scalar) {
  const auto first = std::lower_bound(map.entries.begin(), map.entries.end(), scalar,
                                      [](const ColorMapEntry& e, double s) { return e.scalar < s; });
  const bool here = first != map.entries.end() && first->scalar == scalar;
  return here ? first->color : map(scalar);
}

// How much the map changes where entries first + 1 to last - 1 are left out: the largest difference of a component.
float loss(const std::vector<ColorMapEntry>& entries, std::size_t first, std::size_t last) {
  const ColorMapEntry& a = entries[first];
  const ColorMapEntry& b = entries[last];
  if (a.scalar == b.scalar) return 0.0F;  // hidden between the sides of a jump
  float largest = 0.0F;
  for (std::size_t i = first + 1; i < last; ++i) {
    const auto t = static_cast<float>((entries[i].scalar - a.scalar) / (b.scalar - a.scalar));
    const Vec4f d = glm::abs(entries[i].color - (a.color + (b.color - a.color) * t));
    largest = std::max({largest, d.r, d.g, d.b, d.a});
  }
  return largest;
}

// Without the entries that say nothing, and then without the least until there are few enough. The ends stay.
std::vector<ColorMapEntry> thinned(const std::vector<ColorMapEntry>& entries) {
  std::vector<std::size_t> kept(entries.size());
  std::iota(kept.begin(), kept.end(), 0);
  while (kept.size() > min_color_map_entries) {
    std::size_t least = 1;
    float smallest = std::numeric_limits<float>::infinity();
    for (std::size_t k = 1; k + 1 < kept.size(); ++k) {
      const float l = loss(entries, kept[k - 1], kept[k + 1]);
      if (l < smallest) {
        smallest = l;
        least = k;
      }
    }
    if (smallest > straight && kept.size() <= max_color_map_entries) break;
    kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(least));
  }
  std::vector<ColorMapEntry> fewer;
  for (const std::size_t k : kept) fewer.push_back(entries[k]);
  return fewer;
}

ColorMap reversed(const ColorMap& map) {
  ColorMap back;
  for (auto e = map.entries.rbegin(); e != map.entries.rend(); ++e) back.entries.push_back({1.0 - e->scalar, e->color});
  return back;
}

}  // namespace

std::size_t insert_entry(ColorMap& map, double scalar) {
  if (map.entries.size() >= max_color_map_entries) {
    throw UsageError("a color map has at most 32 entries; remove one first");
  }
  scalar = std::isfinite(scalar) ? std::clamp(scalar, 0.0, 1.0) : 0.0;
  const Vec4f color = map(scalar);
  const std::size_t index = place_of(map, scalar);
  map.entries.insert(map.entries.begin() + static_cast<std::ptrdiff_t>(index), {scalar, color});
  return index;
}

std::size_t insert_entry(ColorMap& map, double scalar, float opacity) {
  const std::size_t index = insert_entry(map, scalar);
  map.entries[index].color.a = clamped(opacity);
  return index;
}

void remove_entry(ColorMap& map, std::size_t index) {
  entry(map, index);
  if (map.entries.size() <= min_color_map_entries) throw UsageError("a color map has at least 2 entries");
  map.entries.erase(map.entries.begin() + static_cast<std::ptrdiff_t>(index));
}

void move_entry(ColorMap& map, std::size_t index, double scalar, float opacity) {
  ColorMapEntry& moved = entry(map, index);
  const double lowest = index > 0 ? map.entries[index - 1].scalar : 0.0;
  const double highest = index + 1 < map.entries.size() ? map.entries[index + 1].scalar : 1.0;
  if (std::isfinite(scalar)) moved.scalar = std::clamp(scalar, lowest, highest);
  moved.color.a = clamped(opacity);
}

std::size_t set_entry_scalar(ColorMap& map, std::size_t index, double scalar) {
  ColorMapEntry moved = entry(map, index);
  if (!(scalar >= 0.0 && scalar <= 1.0)) throw UsageError("the scalar of a color map's entry is from 0 to 1");
  if (moved.scalar == scalar) return index;
  moved.scalar = scalar;
  map.entries.erase(map.entries.begin() + static_cast<std::ptrdiff_t>(index));
  const std::size_t to = place_of(map, scalar);
  map.entries.insert(map.entries.begin() + static_cast<std::ptrdiff_t>(to), moved);
  return to;
}

void set_entry_color(ColorMap& map, std::size_t index, const Vec3f& color) {
  ColorMapEntry& changed = entry(map, index);
  for (int c = 0; c < 3; ++c) check_component(color[c]);
  changed.color = Vec4f(color, changed.color.a);
}

void set_entry_opacity(ColorMap& map, std::size_t index, float opacity) {
  ColorMapEntry& changed = entry(map, index);
  check_component(opacity);
  changed.color.a = opacity;
}

ColorMap fewer_entries(const ColorMap& map) {
  return {thinned(map.entries)};
}

ColorMap combined_map(const ColorMap& colors, const ColorMap& opacities) {
  std::vector<double> places;
  for (const ColorMap* map : {&colors, &opacities}) {
    for (const ColorMapEntry& e : map->entries) places.push_back(e.scalar);
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  ColorMap combined;
  for (const double s : places) {
    const Vec4f left{Vec3f(left_limit(colors, s)), left_limit(opacities, s).a};
    const Vec4f right{Vec3f(colors(s)), opacities(s).a};
    combined.entries.push_back({s, left});
    if (right != left) combined.entries.push_back({s, right});
  }
  if (combined.entries.size() == 1) combined.entries.push_back(combined.entries.front());
  return fewer_entries(combined);
}

void apply_color_map(ColorMap& map, const ColorMap& source, ColorMapPart part) {
  switch (part) {
    case ColorMapPart::all:
      map = source;
      break;
    case ColorMapPart::color:
      map = combined_map(source, map);
      break;
    case ColorMapPart::opacity:
      map = combined_map(map, source);
      break;
  }
}

void reverse_color_map(ColorMap& map, ColorMapPart part) {
  apply_color_map(map, reversed(map), part);
}

const std::vector<std::string>& opacity_curve_names() {
  static const std::vector<std::string> names{"opaque", "ramp", "square", "threshold", "upper-half"};
  return names;
}

ColorMap opacity_curve(std::string_view name) {
  ColorMap curve;
  const auto add = [&](double scalar, double opacity) {
    curve.entries.push_back({scalar, Vec4f(0.0F, 0.0F, 0.0F, static_cast<float>(opacity))});
  };
  if (name == "opaque") {
    add(0.0, 1.0);
    add(1.0, 1.0);
  } else if (name == "ramp") {
    add(0.0, 0.0);
    add(1.0, 1.0);
  } else if (name == "square") {
    constexpr int pieces = 8;  // the curve is nowhere further than 1/256 from its chords
    for (int i = 0; i <= pieces; ++i) add(i / 8.0, i * i / 64.0);
  } else if (name == "threshold") {
    add(0.0, 0.0);
    add(0.5, 0.0);
    add(0.5, 1.0);
    add(1.0, 1.0);
  } else if (name == "upper-half") {
    add(0.0, 0.0);
    add(0.5, 0.0);
    add(1.0, 1.0);
  } else {
    const std::string nearest = nearest_name(name, opacity_curve_names());
    throw UsageError("there is no opacity curve \"" + std::string(name) + "\"" +
                     (nearest.empty() ? "" : "; did you mean " + nearest + "?"));
  }
  return curve;
}

std::optional<std::string> preset_of_colors(const ColorMap& map) {
  const auto near = [&](const ColorMap& preset, double s) {
    const Vec3f d = glm::abs(Vec3f(preset(s)) - Vec3f(map(s)));
    return std::max({d.r, d.g, d.b}) <= straight;
  };
  for (const std::string& name : preset_color_map_names()) {
    const ColorMap preset = preset_color_map(name);
    const auto everywhere = [&](const std::vector<ColorMapEntry>& entries) {
      return std::all_of(entries.begin(), entries.end(),
                         [&](const ColorMapEntry& e) { return near(preset, e.scalar); });
    };
    // Both are straight between the entries of both; a jump in the map shows just left of it.
    const bool jumps_not = std::all_of(map.entries.begin(), map.entries.end(), [&](const ColorMapEntry& e) {
      const Vec3f d = glm::abs(Vec3f(left_limit(map, e.scalar)) - Vec3f(map(e.scalar)));
      return std::max({d.r, d.g, d.b}) <= straight;
    });
    if (jumps_not && everywhere(map.entries) && everywhere(preset.entries)) return name;
  }
  return std::nullopt;
}

double snapped(double value, double step) {
  return step > 0.0 ? std::round(value / step) * step : value;
}

std::optional<std::size_t> entry_at(const ColorMap& map, double x, double y, double width, double height,
                                    double reach) {
  std::optional<std::size_t> nearest;
  double smallest = 0.0;
  for (std::size_t i = 0; i < map.entries.size(); ++i) {
    const double dx = map.entries[i].scalar * width - x;
    const double dy = static_cast<double>(map.entries[i].color.a) * height - y;
    const double d = dx * dx + dy * dy;
    if (d > reach * reach) continue;
    // Of several at one place the last, which can go upwards; at 1 the first, which can go downwards.
    const bool behind = d == smallest && nearest && map.entries[i].scalar == map.entries[*nearest].scalar;
    if (nearest && d >= smallest && !(behind && map.entries[i].scalar < 1.0)) continue;
    smallest = d;
    nearest = i;
  }
  return nearest;
}

}  // namespace atomesh::gui
