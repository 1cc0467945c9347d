// Crystal-defect values: how each atom's neighbourhood differs from the perfect crystal's.
#pragma once

#include <vector>

#include "core/geometry.h"

namespace atomesh {

// A site of the crystal that holds no atom of its species.
struct VacancySite {
  Vec3 position;          // Å
  std::uint16_t species;  // index into Atoms::species_table of what is missing
  Index votes;            // neighbours that miss an atom there, first shells included where the radius is shorter
};

// An atom that sits on no site of its species.
struct ExtraAtom {
  Index atom;   // index into Atoms
  Index votes;  // atoms in the first shells to whom it is one too many; 0 is possible for a foreign species
};

// An atom of another species on a site of the crystal: one vacancy and one extra atom that belong together.
struct Substitution {
  Index atom;              // index into Atoms; one of Defects::extras
  std::uint16_t expected;  // index into Atoms::species_table of what the crystal has there
  Index vacancy;           // index into Defects::vacancies: the site that it took
};

struct Defects {
  // One value per atom each; all three empty when no unit cell is known and no scalar was chosen.
  std::vector<float>
      positional;  // Σ squared displacement of matched neighbours, in units of the squared nearest-neighbour distance
  std::vector<float> vacancy;  // neighbours the perfect crystal has and the sample lacks
  std::vector<float> extra;    // neighbours the sample has and the perfect crystal lacks
  std::vector<VacancySite> vacancies;
  std::vector<ExtraAtom> extras;
  std::vector<Substitution> substitutions;  // ascending atoms; their vacancies and extra atoms stand in the lists above

  bool present() const { return !positional.empty(); }
  // True where any of the three values is above `limit`.
  bool defective(std::size_t atom, float limit = 0.0F) const {
    return present() && (positional[atom] > limit || vacancy[atom] > limit || extra[atom] > limit);
  }
};

}  // namespace atomesh
