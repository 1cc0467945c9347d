// Rock salt with a half-elliptical crack that enters from one face along a {100} cleavage plane.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "samples/crystal.h"
#include "samples/generators.h"

namespace atomesh {

namespace {

constexpr double edge = 5.64;  // Å
// Each side is pulled by at most a quarter of the nearest-neighbour distance: even at the mouth two atoms that face
// each other part by less than half of it, so which atom belongs to which site is never in doubt.
constexpr double widest_pull = 0.7;  // Å

// Crack in the plane y = plane, mouth on the face x = 0, front half an ellipse about (0, ·, centre_z).
struct Crack {
  double plane, depth, centre_z, half_width, reach;

  // Displacement along y of the site at p: opening profile of an elliptical crack, fading smoothly to nothing at
  // `reach` from the plane.
  double pull(const Vec3& p) const {
    const double u = p.x / depth;
    const double v = (p.z - centre_z) / half_width;
    const double distance = std::abs(p.y - plane) / reach;
    const double inside = 1.0 - u * u - v * v;
    if (inside <= 0.0 || distance >= 1.0) return 0.0;
    const double fade = std::cos(0.5 * std::numbers::pi * distance);
    return std::copysign(widest_pull * std::sqrt(inside) * fade * fade, p.y - plane);
  }
};

}  // namespace

Sample grow_nacl_cracked(std::size_t atoms, std::uint64_t /*seed*/, Progress& /*progress*/) {
  Sample sample;
  sample.unit_cell = rock_salt_cell("Na", "Cl", edge);
  const std::uint16_t sodium = sample.atoms.add_species("Na");
  const std::uint16_t chlorine = sample.atoms.add_species("Cl");

  // The sites are a simple cubic grid of alternating ions, so the block may end on any plane: 35×35×21 is the seed's.
  constexpr double spacing = 0.5 * edge;
  const auto [nx, ny, nz] = choose_block(static_cast<double>(atoms), Vec3(spacing), Vec3(35, 35, 21)).cells;
  const Vec3 size =
      spacing * Vec3(static_cast<double>(nx - 1), static_cast<double>(ny - 1), static_cast<double>(nz - 1));
  Crack crack{};
  crack.plane = (std::floor(0.5 * static_cast<double>(ny - 1)) + 0.5) * spacing;  // between two layers
  crack.depth = 0.7 * size.x;
  crack.centre_z = 0.5 * size.z;
  crack.half_width = 0.6 * size.z;  // beyond half: the crack also opens on the faces z = 0 and z = size.z
  crack.reach = std::clamp(0.4 * size.y, 4.0 * spacing, 30.0);

  for (std::size_t k = 0; k < nz; ++k) {
    for (std::size_t j = 0; j < ny; ++j) {
      for (std::size_t i = 0; i < nx; ++i) {
        Vec3 p = spacing * Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
        const double pull = crack.pull(p);
        p.y += pull;
        if (std::abs(pull) > displaced_threshold) {
          sample.truth.displaced.push_back(static_cast<Index>(sample.atoms.size()));
        }
        sample.atoms.positions.push_back(p);
        sample.atoms.species.push_back((i + j + k) % 2 == 0 ? sodium : chlorine);
      }
    }
  }
  return sample;
}

}  // namespace atomesh
