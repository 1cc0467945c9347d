#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"
#include "core/parameter_text.h"
#include "render/scene_parts.h"

namespace atomesh {

namespace {

constexpr std::size_t vertices_per_piece = 16384;

}  // namespace

const VertexField* shown_field(const Material& material, const VolumeParameters& parameters) {
  const std::vector<VertexField>& fields = material.fields;
  for (const VertexField& field : fields) {
    if (field.values.size() == material.mesh.vertices.size()) continue;
    throw Error("field " + field.name + ": " + std::to_string(field.values.size()) + " values for " +
                std::to_string(material.mesh.vertices.size()) + " vertices");
  }
  if (parameters.field.empty()) {
    if (material.defects.present() || fields.empty()) return nullptr;
    const auto varies = [](const VertexField& field) {
      const auto [smallest, largest] = std::minmax_element(field.values.begin(), field.values.end());
      return !field.values.empty() && *smallest < *largest;
    };
    const auto first = std::find_if(fields.begin(), fields.end(), varies);
    return first == fields.end() ? &fields.front() : &*first;
  }
  const auto named = std::find_if(fields.begin(), fields.end(),
                                  [&](const VertexField& field) { return field.name == parameters.field; });
  if (named != fields.end()) return &*named;
  if (parameters.field == "defects") return nullptr;
  std::vector<std::string> names;
  for (const VertexField& field : fields) names.push_back(field.name);
  const std::string nearest = nearest_name(parameters.field, names);
  std::string advice = nearest.empty() ? "" : "; did you mean " + nearest + "?";
  if (nearest.empty()) {
    advice = fields.empty() ? "; it has none" : "; it has ";
    for (std::size_t i = 0; i < names.size() && i < 12; ++i) advice += (i > 0 ? ", " : "") + names[i];
    if (names.size() > 12) advice += ", …";
  }
  throw UsageError("volume.field: the material has no field \"" + parameters.field + "\"" + advice);
}

FieldRange field_range(const VertexField& field, const VolumeParameters& parameters) {
  if (field.values.empty()) return {};
  const auto [smallest, largest] = std::minmax_element(field.values.begin(), field.values.end());
  const double low = parameters.range_low.value_or(*smallest);
  const double high = parameters.range_high.value_or(*largest);
  if (low >= high && (parameters.range_low || parameters.range_high)) {
    throw UsageError("volume.range_low (" + real_text(low) + ") must be below volume.range_high (" + real_text(high) +
                     "); " + field.name + " goes from " + real_text(*smallest) + " to " + real_text(*largest));
  }
  return {low, high, *smallest<low, *largest> high};
}

std::vector<float> field_scalars(const VertexField& field, const VolumeParameters& parameters) {
  const FieldRange range = field_range(field, parameters);
  const double low = range.low;
  const double high = range.high;
  std::vector<float> scalars(field.values.size(), 0.5F);
  if (low >= high) return scalars;
  // Halved, so that no range is too long for a double.
  const double half = 0.5 * high - 0.5 * low;
  parallel_for(scalars.size(), vertices_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      scalars[v] = static_cast<float>(std::clamp((0.5 * field.values[v] - 0.5 * low) / half, 0.0, 1.0));
    }
  });
  return scalars;
}

std::vector<Vec4f> field_colors(const VertexField& field, const VolumeParameters& parameters) {
  const std::vector<float> scalars = field_scalars(field, parameters);
  std::vector<Vec4f> colors(scalars.size());
  parallel_for(colors.size(), vertices_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) colors[v] = parameters.color_map(scalars[v]);
  });
  return colors;
}

}  // namespace atomesh
