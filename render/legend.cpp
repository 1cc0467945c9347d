#include "render/legend.h"

#include <algorithm>
#include <cmath>

#include "core/axis_ticks.h"
#include "render/scene_parts.h"

namespace atomesh {

namespace {

// As lay_background() lays it under a pixel of this colour and opacity.
Vec4f over_background(const Vec3f& color, float opacity, const Vec4f& background) {
  const float below = background.a * (1.0F - opacity);
  const float coverage = opacity + below;
  if (coverage <= 0.0F) return Vec4f(0.0F);
  return {(color * opacity + Vec3f(background) * below) / coverage, coverage};
}

}  // namespace

Legend xray_legend(const XrayParameters& parameters, const Vec4f& background, double max_thickness, bool angstroms) {
  LegendScale scale;
  scale.max = max_thickness;
  scale.color = [parameters, background](double thickness) {
    const double opacity = std::clamp(parameters.alpha_length * thickness, 0.0, 1.0);
    return over_background(parameters.color, static_cast<float>(opacity), background);
  };
  if (parameters.alpha_length * max_thickness > 1.0) {
    scale.mark = 1.0 / parameters.alpha_length;
    scale.mark_text = rounded_text(*scale.mark, 3) + ": opaque";
  }
  return {angstroms ? "thickness, Å" : "thickness", scale};
}

Legend color_map_legend(const ColorMap& map, const ShownScalar& scalar) {
  LegendScale scale;
  scale.min = scalar.min;
  scale.max = scalar.max;
  scale.below = scalar.below;
  scale.above = scalar.above;
  scale.color = [map, scalar](double value) {
    // Halved, so that no range is too long for a double.
    const double range = 0.5 * scalar.max - 0.5 * scalar.min;
    const double s = range > 0.0 ? (0.5 * value - 0.5 * scalar.min) / range : 0.5;
    return Vec4f(Vec3f(map(std::clamp(s, 0.0, 1.0))), 1.0F);
  };
  return {scalar.name, scale};
}

Legend volume_surface_legend(const VolumeSurfaceParameters& parameters, bool defects) {
  Legend legend;
  legend.entries.push_back({"base", Vec3f(parameters.base_color)});
  const auto add = [&](const char* name, const Vec4f& color, double multiplier) {
    if (defects && multiplier > 0.0) legend.entries.push_back({name, Vec3f(color)});
  };
  add("positional defect", parameters.positional_color, parameters.positional_multiplier);
  add("extra atom", parameters.extra_color, parameters.extra_multiplier);
  add("vacancy", parameters.vacancy_color, parameters.vacancy_multiplier);
  return legend;
}

Legend atoms_legend(const Scene& scene, const Atoms& atoms) {
  std::vector<std::optional<Vec3f>> colors(atoms.species_table.size());
  for (const Ball& ball : scene.balls) colors[atoms.species[ball.atom]] = Vec3f(ball.color);
  Legend legend;
  legend.balls = true;
  for (std::size_t s = 0; s < colors.size(); ++s) {
    if (colors[s]) legend.entries.push_back({atoms.species_table[s].name, *colors[s]});
  }
  return legend;
}

std::optional<Legend> make_legend(const Scene& scene, const Material& material, const Parameters& parameters,
                                  double max_thickness) {
  if (scene.tetrahedra.empty() && scene.surface.empty() && scene.balls.empty()) return std::nullopt;
  if (scene.mode == Mode::volume || scene.mode == Mode::volume_surface) {
    if (const VertexField* field = shown_field(material, parameters.volume)) {
      const FieldRange range = field_range(*field, parameters.volume);
      return color_map_legend(parameters.volume.color_map,
                              {field->name, range.low, range.high, range.below, range.above});
    }
  }
  switch (scene.mode) {
    case Mode::volume_surface:
      return volume_surface_legend(parameters.volume_surface, material.defects.present());
    // The weighted sum of an atom's defect values, divided by the largest in the sample.
    case Mode::volume:
      return color_map_legend(parameters.volume.color_map, {"defects / largest"});
    case Mode::xray:
      if (!(max_thickness > 0.0)) return std::nullopt;
      return xray_legend(parameters.xray, parameters.background, max_thickness, material.atoms.size() > 0);
    case Mode::atoms:
      return atoms_legend(scene, material.atoms);
    case Mode::surface:
      break;
  }
  return std::nullopt;
}

std::optional<ScaleBar> make_scale_bar(const Camera& camera, const Vec3& center, bool angstroms) {
  double pixel = camera.pixel;  // Å
  const bool perspective = camera.projection == Projection::perspective;
  if (perspective) pixel *= project(camera, center).z;
  const double longest = 0.2 * camera.width * pixel;
  if (!(longest > 0.0) || !std::isfinite(longest)) return std::nullopt;

  const double power = std::pow(10.0, std::floor(std::log10(longest) + 1e-12));
  ScaleBar bar;
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power <= longest * (1.0 + 1e-12)) bar.length = digit * power;
  }
  bar.pixels = bar.length / pixel;
  const auto text = [&](double unit, const char* name) { return rounded_text(bar.length / unit, 3) + " " + name; };
  if (!angstroms) {
    bar.text = text(1.0, "units");
  } else {
    bar.text = bar.length < 99.0 ? text(1.0, "Å") : bar.length < 9999.0 ? text(10.0, "nm") : text(1e4, "µm");
  }
  if (perspective) bar.text += " at center";
  return bar;
}

}  // namespace atomesh
