// The sample as the comparison with the crystal sees it.
#pragma once

#include <cstdint>
#include <span>

#include "core/atoms.h"
#include "preprocess/crystal.h"
#include "preprocess/feature_vectors.h"
#include "preprocess/neighbour_grid.h"

namespace atomesh {

struct SampleView {
  const Atoms& atoms;
  const FeatureSet& features;
  const NeighbourGrid& grid;
  std::span<const std::uint16_t> grain_of;  // of each atom, or no_grain; empty: all belong to grain 0

  std::uint16_t species(Index slot) const { return atoms.species[grid.point(slot)]; }
  std::uint16_t grain(Index slot) const { return grain_of.empty() ? std::uint16_t{0} : grain_of[grid.point(slot)]; }
  bool several_grains() const { return !grain_of.empty(); }
};

}  // namespace atomesh
