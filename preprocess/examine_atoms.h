// One atom after the other against the perfect crystal: what its own neighbourhood makes certain.
#pragma once

#include <algorithm>
#include <vector>

#include "core/defects.h"
#include "preprocess/compare_features.h"
#include "preprocess/defect_sites.h"

namespace atomesh {

// How much of the sample is as the crystal would have it, in neighbours that count.
struct Census {
  std::size_t matched = 0;
  std::size_t absent = 0;  // missing inside the sample
  std::size_t strays = 0;  // of the cell's species, fitting no entry

  void add(const Census& other) {
    matched += other.matched;
    absent += other.absent;
    strays += other.strays;
  }
  double matched_share() const {
    const std::size_t all = matched + std::max(absent, strays);
    return all > 0 ? static_cast<double>(matched) / static_cast<double>(all) : 0.0;
  }
};

// What one range of atoms found; ranges are put together in order afterwards.
struct RangeResult {
  Misfits misfits;
  Census census;
};

// Compares atoms with the perfect crystal, one after the other. One per thread.
class Examiner {
 public:
  Examiner(const Atoms& atoms, const FeatureSet& features, const NeighbourGrid& grid, bool search_shifts)
      : atoms_(atoms), features_(features), grid_(grid), search_shifts_(search_shifts), comparer_(features) {}

  // Fills the atom's values with what is certain from its own neighbourhood; the rest goes to the misfits.
  void examine(Index slot, Defects& defects, std::vector<std::uint8_t>& reliable, RangeResult& result);
  // Whether most near neighbours of the atom are where the crystal has them.
  bool fits(Index slot);

 private:
  struct Pair {
    double distance2;
    std::uint32_t entry;
    Index neighbour;
  };
  void find_neighbours(Index slot, double radius);
  bool crowded(Index slot) const;
  bool settled(const Match& match) const;
  void pair_displaced(const Match& match);

  const Atoms& atoms_;
  const FeatureSet& features_;
  const NeighbourGrid& grid_;
  bool search_shifts_;
  FeatureComparer comparer_;
  std::vector<Index> slots_;
  std::vector<Neighbour> neighbours_;
  std::vector<Pair> pairs_;
  std::vector<int> occupant_;  // of each entry: its displaced occupant
  std::vector<int> home_;      // of each neighbour: the entry it was displaced from
};

}  // namespace atomesh
