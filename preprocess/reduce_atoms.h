// Fewer atoms for volume rendering where nothing changes (seed 5.4): drop a species, thin out what is uniform.
#pragma once

#include <string>
#include <vector>

#include "core/atoms.h"
#include "core/progress.h"

namespace atomesh {

struct ReduceOptions {
  std::vector<std::string> mask;  // species dropped altogether
  // Thin out: keep atoms at the sample's boundary, one of every `keep_every` of the others (uniformly in space), and
  // every atom with an atom of another (unmasked) species within `transition_distance`.
  std::size_t keep_every = 1;        // 1: no thinning
  double transition_distance = 0.0;  // Å; 0: 1.1 × the nearest-neighbour distance of the unmasked atoms
  double boundary_distance = 0.0;    // Å from the box (or bounding box); 0: like transition_distance
};

struct ReduceReport {
  std::size_t masked = 0;
  std::size_t kept_boundary = 0, kept_transition = 0, kept_sample = 0, dropped = 0;
};

// Throws UsageError for a masked species that the atoms do not have (naming the nearest).
Atoms reduce_atoms(const Atoms& atoms, const ReduceOptions& options, ReduceReport& report,
                   Progress& progress = no_progress());

}  // namespace atomesh
