#include <algorithm>

#include "core/elements.h"
#include "render/scene_parts.h"

namespace atomesh {

namespace {

struct SpeciesStyle {
  Vec3f color{0.0F};
  double radius = 0.0;  // Å, scaled
  bool visible = true;
};

template <class Map, class Value>
Value value_or(const Map& map, const std::string& name, Value fallback) {
  const auto found = map.find(name);
  return found == map.end() ? fallback : static_cast<Value>(found->second);
}

std::vector<SpeciesStyle> species_styles(const Atoms& atoms, const AtomsParameters& parameters) {
  std::vector<SpeciesStyle> styles;
  for (std::size_t s = 0; s < atoms.species_table.size(); ++s) {
    const Species& species = atoms.species_table[s];
    const auto bytes = default_species_color(species.name, s);
    const Vec3f standard = Vec3f(bytes[0], bytes[1], bytes[2]) / 255.0F;
    styles.push_back({value_or(parameters.colors, species.name, standard),
                      value_or(parameters.radii, species.name, species.radius) * parameters.scale,
                      value_or(parameters.visible, species.name, true)});
  }
  return styles;
}

}  // namespace

std::vector<Ball> make_balls(const Material& material, const Parameters& parameters, const Vec3& center) {
  const Atoms& atoms = material.atoms;
  const std::vector<SpeciesStyle> styles = species_styles(atoms, parameters.atoms);
  const auto regular = static_cast<float>(parameters.atoms.regular_opacity);
  const auto limit = static_cast<float>(parameters.atoms.regular_limit);
  const bool cut = any_cut(parameters);
  std::vector<Ball> balls;
  balls.reserve(atoms.size());
  for (std::size_t a = 0; a < atoms.size(); ++a) {
    const SpeciesStyle& style = styles[atoms.species[a]];
    // Opacity only asks for the defects where it depends on them: they need not have been read otherwise.
    const float opacity = regular >= 1.0F || material.defects.defective(a, limit) ? 1.0F : regular;
    if (!style.visible || style.radius <= 0.0 || opacity <= 0.0F) continue;
    if (cut && !survives_cuts(parameters, atoms.positions[a])) continue;
    balls.push_back({Vec3f(atoms.positions[a] - center), static_cast<float>(style.radius), Vec4f(style.color, opacity),
                     static_cast<Index>(a)});
  }
  return balls;
}

double largest_radius(const Atoms& atoms, const AtomsParameters& parameters) {
  const std::vector<SpeciesStyle> styles = species_styles(atoms, parameters);
  std::vector<bool> used(styles.size(), false);
  for (const std::uint16_t s : atoms.species) used[s] = true;
  double largest = 0.0;
  for (std::size_t s = 0; s < styles.size(); ++s) {
    if (used[s]) largest = std::max(largest, styles[s].radius);
  }
  return largest;
}

}  // namespace atomesh
