#include <algorithm>

#include "core/parallel.h"
#include "core/vertex_defects.h"
#include "render/scene_parts.h"

namespace atomesh {

namespace {

constexpr std::size_t vertices_per_range = 1 << 14;

// What is brighter than 1 keeps its hue: clamping each component would turn the strongest defects white.
Vec4f saturate(const Vec4f& sum) {
  const Vec3f color = glm::max(Vec3f(sum), 0.0F);
  const float brightest = std::max({color.r, color.g, color.b, 1.0F});
  return {color / brightest, std::clamp(sum.a, 0.0F, 1.0F)};
}

double largest_of(const VertexDefects& defects, std::size_t vertices, const VolumeParameters& parameters) {
  std::vector<double> largest(vertices / vertices_per_range + 1, 0.0);
  parallel_for(vertices, vertices_per_range, [&](std::size_t begin, std::size_t end) {
    double& top = largest[begin / vertices_per_range];
    for (std::size_t v = begin; v < end; ++v) top = std::max(top, weighted_defects(defects[v], parameters));
  });
  return *std::max_element(largest.begin(), largest.end());
}

}  // namespace

std::vector<Vec4f> vertex_colors(const Material& material, const Parameters& all) {
  if (const VertexField* field = shown_field(material, all.volume)) return field_colors(*field, all.volume);
  const VolumeSurfaceParameters& parameters = all.volume_surface;
  const VertexDefects defects(material.mesh, material.atoms, material.defects);
  const Vec4f positional = parameters.positional_color * static_cast<float>(parameters.positional_multiplier);
  const Vec4f extra = parameters.extra_color * static_cast<float>(parameters.extra_multiplier);
  const Vec4f vacancy = parameters.vacancy_color * static_cast<float>(parameters.vacancy_multiplier);
  std::vector<Vec4f> colors(material.mesh.vertices.size());
  parallel_for(colors.size(), vertices_per_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const DefectValues d = defects[v];
      const Vec4f sum = parameters.base_color + d.positional * positional + d.extra * extra + d.vacancy * vacancy;
      colors[v] = saturate(sum);
    }
  });
  return colors;
}

double weighted_defects(const DefectValues& values, const VolumeParameters& parameters) {
  return static_cast<double>(values.positional) * parameters.positional_multiplier +
         static_cast<double>(values.extra) * parameters.extra_multiplier +
         static_cast<double>(values.vacancy) * parameters.vacancy_multiplier;
}

double largest_weighted_defects(const Material& material, const VolumeParameters& parameters) {
  return largest_of({material.mesh, material.atoms, material.defects}, material.mesh.vertices.size(), parameters);
}

std::vector<float> vertex_scalars(const Material& material, const VolumeParameters& parameters) {
  if (const VertexField* field = shown_field(material, parameters)) return field_scalars(*field, parameters);
  const VertexDefects defects(material.mesh, material.atoms, material.defects);
  std::vector<float> scalars(material.mesh.vertices.size(), 0.0F);
  const double top = largest_of(defects, scalars.size(), parameters);
  if (!(top > 0.0)) return scalars;
  parallel_for(scalars.size(), vertices_per_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      scalars[v] = static_cast<float>(std::clamp(weighted_defects(defects[v], parameters) / top, 0.0, 1.0));
    }
  });
  return scalars;
}

}  // namespace atomesh
