// The ten data sets of the seed's table 5.1 as generators, each with the truth about what was planted.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/atoms.h"
#include "core/progress.h"
#include "core/unit_cell.h"

namespace atomesh {

struct SampleOptions {
  std::size_t atoms = 0;   // aimed at, as nearly as the lattice allows; 0: the seed's count
  std::uint64_t seed = 1;  // of every random choice
};

// What was planted, and where. Positions in Å, in the coordinates of the file. Perfect sites are exact sums of the unit
// cell's vectors and basis from the origin, so what is not listed is on its site to rounding.
struct SampleTruth {
  struct Site {
    Vec3 position;
    std::string species;
  };
  // Lattice sites of the crystal inside the sample that hold no atom of their species: empty, or taken by a foreign
  // one (then where that one is: in a strained crystal the site has moved with it).
  std::vector<Site> vacancies;
  // Atoms on no site of their species (interstitials, substituted atoms), index into the atoms, ascending.
  std::vector<Index> extras;
  // Atoms on a site of their species but more than 0.01 Å from it, ascending.
  std::vector<Index> displaced;
  // The foreign atoms on sites: each is one of `extras`, its site one of `vacancies`. Ascending by atom.
  struct Substitution {
    Index atom;
    Index site;  // index into `vacancies`
  };
  std::vector<Substitution> substitutions;
};

struct Sample {
  Atoms atoms;
  std::optional<UnitCell> unit_cell;  // absent for the sponge
  SampleTruth truth;
};

struct SampleInfo {
  std::string_view name;   // "nacl-cracked"
  std::string_view title;  // "NaCl cracked"
  std::size_t seed_atoms;  // the seed's count, table 5.1
  std::string_view description;
  // The seed's milliseconds, table 5.1: preprocessing, volume+surface, volume, surface, xray, atom balls.
  std::array<double, 6> seed_ms;
};

const std::vector<SampleInfo>& sample_table();

// Throws UsageError for an unknown name (naming the nearest) or an atom count too small for the sample.
Sample make_sample(std::string_view name, const SampleOptions& options = {}, Progress& progress = no_progress());

}  // namespace atomesh
