#include "app/cli/extinction_note.h"

#include <fmt/format.h>

#include <cmath>

namespace atomesh::cli {

namespace {

// Of the opacity coefficient, over the vertices.
double mean_coefficient(const Scene& scene, const Parameters& parameters) {
  double sum = 0.0;
  std::size_t count = 0;
  if (scene.mode == Mode::volume) {
    for (const float s : scene.scalars) sum += static_cast<double>(parameters.volume.color_map(s).a);
    count = scene.scalars.size();
  } else {
    for (const Vec4f& color : scene.colors) sum += static_cast<double>(color.a);
    count = scene.colors.size();
  }
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

// To one digit, as a person would set it.
double rounded(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)));
  return std::round(value / unit) * unit;
}

}  // namespace

std::string extinction_note(const Scene& scene, const Parameters& parameters) {
  const double across = scene.bounds.diagonal();
  double alpha_length = 0.0;
  double coefficient = 1.0;
  double wanted = 2.0;  // optical depth across: what lies behind still shows through
  std::string key;
  if (scene.mode == Mode::volume) {
    key = "volume.alpha_length";
    alpha_length = parameters.volume.alpha_length;
    coefficient = mean_coefficient(scene, parameters);
  } else if (scene.mode == Mode::volume_surface) {
    key = "volume_surface.alpha_length";
    alpha_length = parameters.volume_surface.alpha_length;
    coefficient = mean_coefficient(scene, parameters);
  } else if (scene.mode == Mode::xray) {
    key = "xray.alpha_length";
    alpha_length = parameters.xray.alpha_length;
    wanted = 0.8;  // opacity itself, where a ray is longest
  } else {
    return "";
  }
  const double depth = alpha_length * coefficient * across;
  if (alpha_length <= 0.0 || !(depth > 0.0) || !std::isfinite(depth) || (depth >= 0.05 && depth <= 100.0)) return "";
  const double proposed = rounded(wanted / (coefficient * across));
  return fmt::format(
      "the picture is {}: {} = {:.3g} is meant for samples in Å; this mesh is {:.3g} across, try --set {}={:.3g}",
      depth < 0.05 ? "nearly transparent" : "all opaque", key, alpha_length, across, key, proposed);
}

}  // namespace atomesh::cli
