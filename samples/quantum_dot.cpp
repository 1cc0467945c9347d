// A self-assembled quantum dot: a lens of InAs on a wetting layer one monolayer thick, buried in GaAs and relaxed by
// Keating's force field. The atoms start on the sites of GaAs; the sides and the bottom are held there, as more GaAs
// would, and the top is free.
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "samples/crystal.h"
#include "samples/generators.h"
#include "samples/keating.h"
#include "samples/random.h"

namespace atomesh {

namespace {

constexpr Vec3 proportions(1.0, 1.0, 0.4);

// A spherical cap on the plane z = base, over a wetting layer in that plane. Lengths in Å.
struct Lens {
  Vec3 centre;  // of the base
  double base_radius, height;

  bool holds(const Vec3& p) const {
    constexpr double tolerance = 1e-6;
    const double above = p.z - centre.z;
    if (std::abs(above) < tolerance) return true;  // the wetting layer: one plane of cations
    const double sphere = (base_radius * base_radius + height * height) / (2.0 * height);
    return above > 0.0 && glm::distance(p, centre + Vec3(0, 0, height - sphere)) <= sphere;
  }
};

Lens lens_in(const Vec3& size) {
  Lens lens{};
  const double plane = std::round(0.3 * size.z / (0.5 * gaas_edge));  // planes of cations are half an edge apart
  lens.centre = Vec3(0.5 * size.x, 0.5 * size.y, 0.5 * gaas_edge * plane);
  lens.base_radius = 0.3 * std::min(size.x, size.y);
  lens.height = std::min(0.35 * size.z, 0.6 * lens.base_radius);
  return lens;
}

Sample grow(std::size_t atoms, double indium_share, std::uint64_t seed, Progress& progress) {
  Sample sample;
  sample.unit_cell = zinc_blende_cell("Ga", "As", gaas_edge);
  const BlockShape shape = choose_block(static_cast<double>(atoms) / 8.0, Vec3(gaas_edge), proportions);
  sample.atoms = build_block(*sample.unit_cell, shape);
  const std::uint16_t gallium = sample.atoms.add_species("Ga");
  const std::uint16_t indium = sample.atoms.add_species("In");

  const Vec3 size = gaas_edge * Vec3(static_cast<double>(shape.cells[0]), static_cast<double>(shape.cells[1]),
                                     static_cast<double>(shape.cells[2]));
  const Lens lens = lens_in(size);
  const std::vector<Vec3> sites = sample.atoms.positions;
  Column is_indium{"indium", std::vector<double>(sites.size(), 0.0)};
  std::vector<std::uint8_t> bond_kind(sites.size(), 0);
  std::vector<bool> held(sites.size(), false);
  const Vec3 inset(0.1 * gaas_edge);
  const Bounds bounds = bounds_of(sites);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Vec3& p = sites[i];
    if (sample.atoms.species[i] == gallium && lens.holds(p) && Random::uniform_of(seed, i) < indium_share) {
      sample.atoms.species[i] = indium;
      is_indium.values[i] = 1.0;
      bond_kind[i] = 1;
    }
    held[i] =
        glm::any(glm::lessThan(p, bounds.min + inset)) || p.x > bounds.max.x - inset.x || p.y > bounds.max.y - inset.y;
  }
  sample.atoms.columns.push_back(std::move(is_indium));

  progress.stage("relax");
  const KeatingNetwork network = zinc_blende_network(shape, bond_kind, {gaas_bond, inas_bond});
  const RelaxReport report = relax(network, held, sample.atoms.positions, {}, progress);
  if (!report.converged) {
    throw Error("the quantum dot did not relax: after " + std::to_string(report.steps) + " steps an atom still feels " +
                std::to_string(report.largest_force) + " eV/Å");
  }
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Vec3& p = sample.atoms.positions[i];
    if (sample.atoms.species[i] == indium) {
      // A foreign atom on a gallium site, which has moved with it.
      sample.truth.extras.push_back(static_cast<Index>(i));
      sample.truth.substitutions.push_back({static_cast<Index>(i), static_cast<Index>(sample.truth.vacancies.size())});
      sample.truth.vacancies.push_back({p, "Ga"});
    } else if (glm::distance(p, sites[i]) > displaced_threshold) {
      sample.truth.displaced.push_back(static_cast<Index>(i));
    }
  }
  return sample;
}

}  // namespace

Sample grow_quantum_dot(std::size_t atoms, std::uint64_t seed, Progress& progress) {
  return grow(atoms, 1.0, seed, progress);
}

Sample grow_quantum_dot_alloyed(std::size_t atoms, std::uint64_t seed, Progress& progress) {
  return grow(atoms, 0.2, seed, progress);
}

}  // namespace atomesh
