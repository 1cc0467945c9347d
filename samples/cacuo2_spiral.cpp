// A cylinder of infinite-layer CaCuO2 with a helical channel bored through it from end to end.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "samples/crystal.h"
#include "samples/generators.h"

namespace atomesh {

namespace {

constexpr double lattice_a = 3.86;   // Å
constexpr double lattice_c = 3.20;   // Å
constexpr double slenderness = 1.5;  // height / diameter

UnitCell cacuo2() {
  UnitCell cell;
  cell.primitive = {Vec3(lattice_a, 0, 0), Vec3(0, lattice_a, 0), Vec3(0, 0, lattice_c)};
  cell.basis = {{"Cu", Vec3(0.0)},
                {"O", Vec3(0.5 * lattice_a, 0, 0)},
                {"O", Vec3(0, 0.5 * lattice_a, 0)},
                {"Ca", 0.5 * Vec3(lattice_a, lattice_a, lattice_c)}};
  return cell;
}

// A tube of circular cross-section about the helix (radius cos φ, radius sin φ, pitch φ/2π).
struct Channel {
  double helix_radius, tube_radius, pitch;

  bool holds(const Vec3& p) const {
    const double r = std::hypot(p.x, p.y);
    if (std::abs(r - helix_radius) > tube_radius) return false;
    // The squared distance to the turn whose height at the point's own angle is nearest is convex within a quarter turn
    // of that angle, so its slope has one zero there.
    const double rise = pitch / (2.0 * std::numbers::pi);  // Å per radian
    const double angle = std::atan2(p.y, p.x);
    const double turn = std::round((p.z / rise - angle) / (2.0 * std::numbers::pi));
    const double own_height = rise * angle + pitch * turn - p.z;
    double low = -0.5 * std::numbers::pi;
    double high = 0.5 * std::numbers::pi;
    for (int step = 0; step < 40; ++step) {
      const double t = 0.5 * (low + high);
      (r * helix_radius * std::sin(t) + rise * (own_height + rise * t) < 0.0 ? low : high) = t;
    }
    const double height = own_height + rise * low;
    const double squared =
        r * r + helix_radius * helix_radius - 2.0 * r * helix_radius * std::cos(low) + height * height;
    return squared < tube_radius * tube_radius;
  }
};

// Whole formula units, so the cylinder keeps its stoichiometry.
struct Unit {
  int i, j, k;
  double radius;  // of its middle, Å from the cylinder's axis
};

}  // namespace

Sample grow_cacuo2_spiral(std::size_t atoms, std::uint64_t /*seed*/, Progress& progress) {
  Sample sample;
  sample.unit_cell = cacuo2();
  const double wanted = static_cast<double>(atoms) / 4.0;  // formula units
  const double wanted_volume = wanted * sample.unit_cell->volume();

  // The channel takes about a twelfth of the solid cylinder. This radius sets its size; which units are inside the
  // cylinder then follows from the number asked for.
  const double radius = std::cbrt(wanted_volume * 1.09 / (2.0 * std::numbers::pi * slenderness));
  const double height = 2.0 * slenderness * radius;
  const Channel channel{0.55 * radius, std::max(6.5, 0.16 * radius), 0.9 * radius};
  const int layers = std::max(1, static_cast<int>(std::lround(height / lattice_c)));

  std::vector<Unit> units;
  const int reach = static_cast<int>(1.15 * radius / lattice_a) + 1;
  for (int k = 0; k < layers; ++k) {
    progress.update(static_cast<double>(k) / layers);
    for (int j = -reach; j <= reach; ++j) {
      for (int i = -reach; i <= reach; ++i) {
        const Vec3 middle = Vec3(lattice_a * (i + 0.25), lattice_a * (j + 0.25), lattice_c * (k + 0.125));
        const double r = std::hypot(middle.x, middle.y);
        if (r <= 1.15 * radius && !channel.holds(middle)) units.push_back({i, j, k, r});
      }
    }
  }

  // The units nearest to the axis; the last column of them may end part of the way up, a step on the rim.
  const auto kept = std::min(static_cast<std::size_t>(std::llround(wanted)), units.size());
  std::stable_sort(units.begin(), units.end(), [](const Unit& a, const Unit& b) { return a.radius < b.radius; });
  units.resize(kept);

  std::vector<std::uint16_t> species;
  for (const BasisAtom& site : sample.unit_cell->basis) species.push_back(sample.atoms.add_species(site.species));
  for (const Unit& unit : units) {
    const Vec3 corner(lattice_a * unit.i, lattice_a * unit.j, lattice_c * unit.k);
    for (std::size_t b = 0; b < species.size(); ++b) {
      sample.atoms.positions.push_back(corner + sample.unit_cell->basis[b].position);
      sample.atoms.species.push_back(species[b]);
    }
  }
  return sample;
}

}  // namespace atomesh
