#include "core/color_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/error.h"

namespace atomesh {

namespace {

using Stop = std::array<float, 4>;  // scalar, R, G, B

// Every sixteenth of the 256 published colours, and one more where the curve bends. Linear interpolation between them
// stays within 0.01 of the full table. Viridis by S. van der Walt and N. Smith (CC0).
constexpr std::array<Stop, 18> viridis{{{0.0F, 0.2670F, 0.0049F, 0.3294F},
                                        {0.0627F, 0.2823F, 0.0950F, 0.4173F},
                                        {0.1255F, 0.2788F, 0.1755F, 0.4834F},
                                        {0.1882F, 0.2590F, 0.2515F, 0.5247F},
                                        {0.2510F, 0.2297F, 0.3224F, 0.5457F},
                                        {0.3137F, 0.1994F, 0.3876F, 0.5546F},
                                        {0.3765F, 0.1727F, 0.4488F, 0.5579F},
                                        {0.4392F, 0.1490F, 0.5081F, 0.5573F},
                                        {0.5020F, 0.1276F, 0.5669F, 0.5506F},
                                        {0.5647F, 0.1206F, 0.6258F, 0.5335F},
                                        {0.6275F, 0.1579F, 0.6838F, 0.5017F},
                                        {0.6902F, 0.2461F, 0.7389F, 0.4520F},
                                        {0.7529F, 0.3692F, 0.7889F, 0.3829F},
                                        {0.8157F, 0.5160F, 0.8312F, 0.2943F},
                                        {0.8784F, 0.6785F, 0.8637F, 0.1895F},
                                        {0.9412F, 0.8456F, 0.8873F, 0.0997F},
                                        {0.9725F, 0.9261F, 0.8973F, 0.1041F},
                                        {1.0F, 0.9932F, 0.9062F, 0.1439F}}};

// Cividis: Nuñez, Anderton and Renslow, PLOS ONE 13 (2018) e0199239; readable with every common colour blindness.
constexpr std::array<Stop, 18> cividis{{{0.0F, 0.0F, 0.1351F, 0.3048F},
                                        {0.0627F, 0.0F, 0.1788F, 0.4148F},
                                        {0.0941F, 0.0179F, 0.1985F, 0.4412F},
                                        {0.1255F, 0.1034F, 0.2204F, 0.4358F},
                                        {0.1882F, 0.1951F, 0.2644F, 0.4259F},
                                        {0.2510F, 0.2637F, 0.3078F, 0.4228F},
                                        {0.3137F, 0.3242F, 0.3513F, 0.4263F},
                                        {0.3765F, 0.3808F, 0.3952F, 0.4357F},
                                        {0.4392F, 0.4352F, 0.4398F, 0.4511F},
                                        {0.5020F, 0.4887F, 0.4853F, 0.4710F},
                                        {0.5647F, 0.5478F, 0.5319F, 0.4717F},
                                        {0.6275F, 0.6091F, 0.5798F, 0.4636F},
                                        {0.6902F, 0.6720F, 0.6293F, 0.4480F},
                                        {0.7529F, 0.7365F, 0.6806F, 0.4240F},
                                        {0.8157F, 0.8027F, 0.7340F, 0.3902F},
                                        {0.8784F, 0.8707F, 0.7896F, 0.3433F},
                                        {0.9412F, 0.9411F, 0.8475F, 0.2758F},
                                        {1.0F, 0.9957F, 0.9093F, 0.2178F}}};

constexpr std::array<Stop, 2> gray{{{0.0F, 0.0F, 0.0F, 0.0F}, {1.0F, 1.0F, 1.0F, 1.0F}}};

constexpr std::array<Stop, 3> blue_white_red{
    {{0.0F, 0.230F, 0.299F, 0.754F}, {0.5F, 0.95F, 0.95F, 0.95F}, {1.0F, 0.706F, 0.016F, 0.150F}}};

// The seed's figure 5.8 in words (5.3.2): five entries, most of the colours spent on [0.4, 0.6].
constexpr std::array<Stop, 5> seed_figure_5_8{{{0.0F, 0.0F, 0.0F, 1.0F},
                                               {0.4F, 0.0F, 1.0F, 1.0F},
                                               {0.5F, 0.0F, 1.0F, 0.0F},
                                               {0.6F, 1.0F, 1.0F, 0.0F},
                                               {1.0F, 1.0F, 0.0F, 0.0F}}};

struct Preset {
  const char* name;
  std::span<const Stop> stops;
};

constexpr std::array<Preset, 5> presets{{{"viridis", viridis},
                                         {"cividis", cividis},
                                         {"gray", gray},
                                         {"blue-white-red", blue_white_red},
                                         {"seed-figure-5.8", seed_figure_5_8}}};

}  // namespace

Vec4f ColorMap::operator()(double scalar) const {
  if (entries.empty()) return Vec4f(0.0F);
  // The first entry beyond the scalar: at a jump that is past both entries, so the later one holds.
  const auto next = std::upper_bound(entries.begin(), entries.end(), scalar,
                                     [](double s, const ColorMapEntry& entry) { return s < entry.scalar; });
  if (next == entries.begin()) return next->color;
  const ColorMapEntry& before = *(next - 1);
  if (next == entries.end()) return before.color;
  const double t = (scalar - before.scalar) / (next->scalar - before.scalar);
  return before.color + (next->color - before.color) * static_cast<float>(t);
}

void check_color_map(const ColorMap& map) {
  const std::size_t count = map.entries.size();
  if (count < 2 || count > 32) {
    throw UsageError("a color map has 2 to 32 entries, not " + std::to_string(count));
  }
  double previous = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const ColorMapEntry& entry = map.entries[i];
    const std::string where = "color map entry " + std::to_string(i + 1) + ": ";
    if (!(entry.scalar >= 0.0 && entry.scalar <= 1.0)) throw UsageError(where + "the scalar must be from 0 to 1");
    if (entry.scalar < previous)
      throw UsageError(where + "its scalar is smaller than the one before; list them upwards");
    previous = entry.scalar;
    for (int c = 0; c < 4; ++c) {
      if (!(entry.color[c] >= 0.0F && entry.color[c] <= 1.0F)) {
        throw UsageError(where + "color components must be from 0 to 1");
      }
    }
  }
}

ColorMap preset_color_map(const std::string& name) {
  for (const Preset& preset : presets) {
    if (name != preset.name) continue;
    ColorMap map;
    for (const Stop& stop : preset.stops) {
      map.entries.push_back({static_cast<double>(stop[0]), Vec4f(stop[1], stop[2], stop[3], stop[0])});
    }
    return map;
  }
  const std::vector<std::string> names = preset_color_map_names();
  const std::string nearest = nearest_name(name, names);
  std::string message = "there is no color map \"" + name + "\"";
  if (!nearest.empty()) {
    message += "; did you mean " + nearest + "?";
  } else {
    message += "; there are";
    for (const std::string& known : names) message += " " + known;
  }
  throw UsageError(message);
}

std::vector<std::string> preset_color_map_names() {
  std::vector<std::string> names;
  for (const Preset& preset : presets) names.emplace_back(preset.name);
  return names;
}

}  // namespace atomesh
