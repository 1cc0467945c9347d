// Which translations map a crystal onto itself, from its atoms.
#pragma once

#include <optional>
#include <vector>

#include "preprocess/local_cluster.h"

namespace atomesh {

// A translation that holds: for nearly every atom p there is one of the same species at p + vector.
struct Translation {
  Vec3 vector{0.0};    // Å, mean over the pairs it was seen in
  double holds = 0.0;  // share of the atoms, of those that have anything where it leads
  double width = 0.0;  // Å, rms per axis of the pairs from the mean: thermal noise times √2, or more where the
                       // translation only nearly holds
};

struct TranslationOptions {
  double reach = 0.0;        // Å, longest translation looked for
  Box box;                   // the sample's: its own translations prove nothing
  bool tell_species = true;  // false: any atom may stand for any other (an alloy of many species)
  std::size_t seeds = 400;   // atoms that are asked, nearest to the cluster's centre
};

struct TranslationSearch {
  std::vector<Translation> found;  // ascending length; of t and -t one
  double best = 0.0;               // the highest share any translation held for
};

// Candidates are the differences between an atom and the others of its species within reach. A translation is good when
// it holds as well as the best ones do for each species on its own: the translation that maps the sublattices of
// fluorite's anions, or the two layers of graphite, onto each other only in part is none. What leads out of the sample
// counts neither way. The cluster should reach `reach` beyond the seeds.
TranslationSearch find_translations(const LocalCluster& cluster, const NeighbourGrid& grid, const LocalScale& scale,
                                    const TranslationOptions& options);

// The lattice they generate, reduced, columns; nothing when they lie in a plane or only partly agree with a lattice.
std::optional<Mat3> lattice_of(const std::vector<Translation>& translations, const LocalScale& scale);

}  // namespace atomesh
