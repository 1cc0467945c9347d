// Fewer atoms for volume rendering where nothing changes (seed 5.4): drop a species, thin out what is uniform.
#pragma once

#include <string>
#include <vector>

#include "core/atoms.h"
#include "core/progress.h"

namespace atomesh {

struct ReduceOptions {
  std::vector<std::string> mask;  // species dropped altogether
  // Thin out: keep atoms at the sample's boundary, every atom with an atom of another (unmasked) species within
  // `transition_distance`, and one of every `keep_every` of the rest (uniformly in space).
  std::size_t keep_every = 1;        // 1: no thinning
  double transition_distance = 0.0;  // Å; 0: 1.1 × the nearest-neighbour distance of the unmasked atoms
  // Å from the faces of the tightest parallelepiped round the unmasked atoms whose edges follow the file's box (the
  // axes, without a box); 0: like transition_distance.
  double boundary_distance = 0.0;
};

// masked + kept_boundary + kept_transition + kept_sample + dropped is the number of atoms; an atom is counted for the
// first reason in this order.
struct ReduceReport {
  std::size_t masked = 0;
  std::size_t kept_boundary = 0, kept_transition = 0, kept_sample = 0, dropped = 0;
};

// Atoms that are kept keep their order. The species table stays as it is. Linear in the number of atoms but for one
// sort. Throws UsageError for a masked species that the atoms do not have (naming the nearest), for keep_every 0, for a
// negative or infinite distance, and when every species is masked.
Atoms reduce_atoms(const Atoms& atoms, const ReduceOptions& options, ReduceReport& report,
                   Progress& progress = no_progress());

}  // namespace atomesh
