// Copper with a screw dislocation: the displacement field of isotropic elasticity (Volterra; Hirth and Lothe, Theory of
// Dislocations, eq. 3-1), Burgers vector a/2 [110]. A screw moves atoms along its line only, so the crystal keeps its
// density: no site is emptied and none is added. The split into partials of a real fcc core is left out.
#include <cmath>
#include <numbers>

#include "samples/crystal.h"
#include "samples/generators.h"

namespace atomesh {

namespace {

constexpr double edge = 3.615;                              // Å, of the cubic cell
constexpr double burgers = edge * std::numbers::sqrt2 / 2;  // Å

// fcc as a body-centred tetragonal lattice: x along [001], y along [1-10], z along [110].
UnitCell tetragonal_copper() {
  UnitCell cell;
  cell.primitive = {Vec3(edge, 0, 0), Vec3(0, burgers, 0), Vec3(0, 0, burgers)};
  cell.basis = {{"Cu", Vec3(0.0)}, {"Cu", 0.5 * Vec3(edge, burgers, burgers)}};
  return cell;
}

}  // namespace

Sample grow_cu_line_defect(std::size_t atoms, std::uint64_t /*seed*/, Progress& /*progress*/) {
  Sample sample;
  sample.unit_cell = tetragonal_copper();
  const BlockShape shape =
      choose_block(static_cast<double>(atoms) / 2.0, Vec3(edge, burgers, burgers), Vec3(1, 1, 1.2));
  sample.atoms = build_block(*sample.unit_cell, shape);

  // The line runs along z where three neighbouring columns of atoms, at (0, 0) and (a/2, ±b/2), are equally far (1.35
  // Å).
  const double from_column = edge / 4.0 + burgers * burgers / (4.0 * edge);
  const double line_x = std::floor(0.5 * static_cast<double>(shape.cells[0])) * edge + from_column;
  const double line_y = std::floor(0.5 * static_cast<double>(shape.cells[1])) * burgers;
  for (std::size_t i = 0; i < sample.atoms.size(); ++i) {
    Vec3& p = sample.atoms.positions[i];
    // In (-b/2, b/2]: sites along z repeat every b, so this is also the distance to the nearest site.
    const double shift = burgers * std::atan2(p.y - line_y, p.x - line_x) / (2.0 * std::numbers::pi);
    p.z += shift;
    if (std::abs(shift) > displaced_threshold) sample.truth.displaced.push_back(static_cast<Index>(i));
  }
  return sample;
}

}  // namespace atomesh
