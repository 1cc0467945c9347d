#include <algorithm>
#include <bit>
#include <unordered_map>

#include "core/parallel.h"
#include "render/scene_parts.h"

namespace atomesh {

namespace {

struct DefectValues {
  float positional = 0.0F;
  float extra = 0.0F;
  float vacancy = 0.0F;
};

DefectValues values_of(const Defects& defects, std::size_t atom) {
  return {defects.positional[atom], defects.extra[atom], defects.vacancy[atom]};
}

DefectValues largest(const DefectValues& a, const DefectValues& b) {
  return {std::max(a.positional, b.positional), std::max(a.extra, b.extra), std::max(a.vacancy, b.vacancy)};
}

struct PositionHash {
  std::size_t operator()(const Vec3& p) const {
    std::uint64_t h = 0;
    // Adding zero makes -0 and +0, which compare equal, hash equal.
    for (const double c : {p.x, p.y, p.z}) h = (h ^ std::bit_cast<std::uint64_t>(c + 0.0)) * 0x9E3779B97F4A7C15U;
    return static_cast<std::size_t>(h ^ (h >> 32U));
  }
};

// The mesh names only the first of the atoms at one exact position; a defect that only a later one has must still be
// seen.
void take_in_merged_atoms(const Material& material, std::vector<DefectValues>& values) {
  const TetMesh& mesh = material.mesh;
  const Atoms& atoms = material.atoms;
  if (mesh.vertices.size() >= atoms.size()) return;
  std::vector<bool> named(atoms.size(), false);
  std::unordered_map<Vec3, Index, PositionHash> vertex_at;
  vertex_at.reserve(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (mesh.vertex_atom[v] == no_index) continue;
    named[mesh.vertex_atom[v]] = true;
    vertex_at.emplace(mesh.vertices[v], static_cast<Index>(v));
  }
  for (std::size_t a = 0; a < atoms.size(); ++a) {
    if (named[a]) continue;
    const auto found = vertex_at.find(atoms.positions[a]);
    if (found == vertex_at.end()) continue;
    values[found->second] = largest(values[found->second], values_of(material.defects, a));
  }
}

std::vector<DefectValues> vertex_defects(const Material& material) {
  const TetMesh& mesh = material.mesh;
  std::vector<DefectValues> values(mesh.vertices.size());
  if (!material.defects.present()) return values;
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (mesh.vertex_atom[v] != no_index) values[v] = values_of(material.defects, mesh.vertex_atom[v]);
  }
  take_in_merged_atoms(material, values);
  return values;
}

// What is brighter than 1 keeps its hue: clamping each component would turn the strongest defects white.
Vec4f saturate(const Vec4f& sum) {
  const Vec3f color = glm::max(Vec3f(sum), 0.0F);
  const float brightest = std::max({color.r, color.g, color.b, 1.0F});
  return {color / brightest, std::clamp(sum.a, 0.0F, 1.0F)};
}

}  // namespace

std::vector<Vec4f> vertex_colors(const Material& material, const VolumeSurfaceParameters& parameters) {
  const std::vector<DefectValues> defects = vertex_defects(material);
  const Vec4f positional = parameters.positional_color * static_cast<float>(parameters.positional_multiplier);
  const Vec4f extra = parameters.extra_color * static_cast<float>(parameters.extra_multiplier);
  const Vec4f vacancy = parameters.vacancy_color * static_cast<float>(parameters.vacancy_multiplier);
  std::vector<Vec4f> colors(defects.size());
  parallel_for(colors.size(), 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const DefectValues& d = defects[v];
      const Vec4f sum = parameters.base_color + d.positional * positional + d.extra * extra + d.vacancy * vacancy;
      colors[v] = saturate(sum);
    }
  });
  return colors;
}

std::vector<float> vertex_scalars(const Material& material, const VolumeParameters& parameters) {
  const std::vector<DefectValues> defects = vertex_defects(material);
  std::vector<double> sums(defects.size());
  double top = 0.0;
  for (std::size_t v = 0; v < sums.size(); ++v) {
    const DefectValues& d = defects[v];
    sums[v] = static_cast<double>(d.positional) * parameters.positional_multiplier +
              static_cast<double>(d.extra) * parameters.extra_multiplier +
              static_cast<double>(d.vacancy) * parameters.vacancy_multiplier;
    top = std::max(top, sums[v]);
  }
  std::vector<float> scalars(sums.size(), 0.0F);
  if (top > 0.0) {
    for (std::size_t v = 0; v < sums.size(); ++v) scalars[v] = static_cast<float>(std::clamp(sums[v] / top, 0.0, 1.0));
  }
  return scalars;
}

}  // namespace atomesh
