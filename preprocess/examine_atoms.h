// One atom after the other against the perfect crystal: what its own neighbourhood makes certain.
#pragma once

#include <algorithm>
#include <vector>

#include "core/defects.h"
#include "preprocess/compare_features.h"
#include "preprocess/defect_sites.h"
#include "preprocess/glance.h"

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
  // Without `search_shifts` no atom is looked for off its site, and misfits are not kept.
  Examiner(const SampleView& sample, const GlanceTables& tables, bool search_shifts)
      : sample_(sample), search_shifts_(search_shifts), glance_(sample, tables), comparer_(sample.features) {}

  // Fills the atom's values with what is certain from its own neighbourhood; the rest goes to the misfits. `standing`
  // becomes the grain (0 with one grain) that most of its near neighbours are in place of, or no_grain. An atom of
  // no_grain is compared with every grain around it and takes the one that explains its neighbours best.
  void examine(Index slot, Defects& defects, std::uint16_t& standing, RangeResult& result);
  // The atom's neighbours within the search radius matched as they are; nullptr where nothing can be (a foreign atom,
  // a crowd). neighbours() and slots() belong to it.
  const Match* match(Index slot);
  const std::vector<Neighbour>& neighbours() const { return neighbours_; }
  const std::vector<Index>& slots() const { return slots_; }

 private:
  struct Pair {
    double distance2;
    std::uint32_t entry;
    Index neighbour;
  };
  std::span<const std::uint16_t> kinds_for(Index slot);
  void find_neighbours(Index slot, double radius);
  bool crowded(Index slot, std::span<const std::uint16_t> kinds) const;
  void pair_displaced(const Match& match);
  void keep_misfit(Index slot, const Match& match, Defects& defects, RangeResult& result);

  const SampleView& sample_;
  bool search_shifts_;
  Glance glance_;
  FeatureComparer comparer_;
  std::vector<std::uint16_t> grains_;
  std::vector<std::uint16_t> kinds_;
  std::vector<Index> slots_;
  std::vector<Neighbour> neighbours_;
  std::vector<Pair> pairs_;
  std::vector<int> occupant_;  // of each entry: its displaced occupant
  std::vector<int> home_;      // of each neighbour: the entry it was displaced from
};

}  // namespace atomesh
