// Keating's valence force field for tetrahedrally bonded crystals (Phys. Rev. 145, 637 (1966)), and its minimisation.
//
//   E = Σ_bonds 3α/(8d²) (r² - d²)²  +  Σ_angles 3β/(8 d₁d₂) (r₁·r₂ + d₁d₂/3)²
//
// d: natural length of the bond; an angle is two bonds of one atom, whose β is the geometric mean where the bonds
// differ. For one compound (Martin, Phys. Rev. B 1, 4005 (1970)) the bulk modulus is √3 (3α+β) / (12 d).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry.h"
#include "core/progress.h"
#include "samples/crystal.h"

namespace atomesh {

struct KeatingBond {
  double length;  // Å
  double alpha;   // eV/Å²
  double beta;    // eV/Å²
};

// Martin's force constants (41.19 and 8.95 N/m; 35.18 and 5.50 N/m); the bond is √3/4 of the lattice constant.
inline constexpr double newton_per_metre = 0.06241509074;  // eV/Å²
inline constexpr double gaas_edge = 5.6533;                // Å
inline constexpr double inas_edge = 6.0583;                // Å
inline constexpr KeatingBond gaas_bond{0.4330127018922193 * gaas_edge, 41.19 * newton_per_metre,
                                       8.95 * newton_per_metre};
inline constexpr KeatingBond inas_bond{0.4330127018922193 * inas_edge, 35.18 * newton_per_metre,
                                       5.50 * newton_per_metre};

// Who is bonded to whom; at most four bonds an atom.
struct KeatingNetwork {
  std::vector<KeatingBond> kinds;
  std::vector<std::array<Index, 4>> neighbours;      // no_index past the last bond
  std::vector<std::array<std::uint8_t, 4>> reverse;  // neighbours[neighbours[i][s]][reverse[i][s]] == i
  std::vector<std::array<std::uint8_t, 4>> kind;     // of each bond, index into kinds
};

// The bonds of a block that build_block() made of a zinc_blende_cell(). `cation_kind` holds one entry per atom, the
// kind of all bonds of that cation; entries of anions are ignored.
KeatingNetwork zinc_blende_network(const BlockShape& shape, const std::vector<std::uint8_t>& cation_kind,
                                   std::vector<KeatingBond> kinds);

// eV; `gradient` (eV/Å, one per atom) is overwritten. Same bits at any number of threads.
double keating_energy(const KeatingNetwork& network, const std::vector<Vec3>& positions, std::vector<Vec3>& gradient);

struct RelaxOptions {
  double largest_force = 2e-3;  // eV/Å; done when no free atom feels more
  int steps = 2000;             // gives up (converged stays false) after so many
};

struct RelaxReport {
  double energy_before = 0.0, energy_after = 0.0;  // eV
  double largest_force = 0.0;                      // eV/Å, on a free atom
  int steps = 0;
  bool converged = false;
};

// Moves the atoms that are not `held` to the minimum of the energy nearest downhill: nonlinear conjugate gradients
// (Polak-Ribière), each line minimised exactly, as the energy along a line is a polynomial of degree four.
RelaxReport relax(const KeatingNetwork& network, const std::vector<bool>& held, std::vector<Vec3>& positions,
                  const RelaxOptions& options = {}, Progress& progress = no_progress());

}  // namespace atomesh
