// The walk over a crystal, block by block.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/progress.h"
#include "preprocess/atom_blocks.h"
#include "preprocess/crystal.h"
#include "preprocess/lattice_sites.h"
#include "preprocess/site_finder.h"

namespace atomesh {

// What the walk knows of one pattern.
struct WalkPattern {
  SiteFinder finder;
  UnitCell cell;           // the template's
  double tolerance = 0.0;  // Å
};

// Gives each atom its site. The walk goes over blocks of some eighty atoms, a breadth-first wave at a time: a block's
// frame is predicted from the frames of the blocks around it that the walk has done, the block's atoms take the sites
// they are nearest to in it, and the frame is then fitted to those atoms, so that strain may add up from block to block
// while noise does not. Blocks of one wave see only the waves before it and write only their own atoms: the threads
// have no say in the result.
class LatticeWalk {
 public:
  LatticeWalk(const Atoms& atoms, const Crystal& crystal, std::span<const WalkPattern> patterns,
              std::size_t smallest_patch, std::vector<LatticeSite>& of, const Progress& progress = no_progress());

  struct Patch {
    std::uint16_t pattern = 0;
    std::size_t seams = 0;
  };
  // Labels everything; patches in the order they were begun. Two atoms may have been given one site.
  std::vector<Patch> run(Progress& progress);
  // Å², of each atom with a site: how far it is from where its neighbours predict the site.
  const std::vector<float>& squared() const { return squared_; }

 private:
  struct BlockFrame {
    Index block;
    Index next;  // the block's frame in another patch
    std::uint16_t patch;
    Index atoms;  // matched
    LatticeFrame frame;
  };
  struct Outcome {
    LatticeFrame frame;
    Index free = 0, matched = 0, of_species = 0;
    double mean_squared = 0.0;  // Å², of the matched atoms from their sites
  };
  const BlockFrame* frame_in(std::size_t block, std::uint16_t patch) const;
  bool predict(std::size_t block, std::uint16_t patch, int shell, LatticeFrame& frame) const;
  struct Placed {
    Index atom;
    SiteFinder::Found found;
  };
  Outcome match(std::size_t block, const WalkPattern& pattern, const LatticeFrame& frame,
                std::vector<Placed>* placed = nullptr) const;
  Outcome settle(std::size_t block, const WalkPattern& pattern, const LatticeFrame& predicted,
                 std::vector<Placed>& placed) const;
  void take(std::size_t block, std::uint16_t patch, const std::vector<Placed>& placed);
  void accept(std::size_t block, std::uint16_t patch, const Outcome& outcome);

  struct Seed {
    std::size_t block = 0;
    std::uint16_t pattern = 0;
    Outcome outcome;
    double score = -1.0;
  };
  Seed try_seed(std::size_t block) const;
  Seed find_seed(std::vector<bool>& failed, std::size_t& failures, Progress& progress) const;
  void grow(std::uint16_t patch, std::vector<Index> frontier, Progress& progress);
  std::vector<Index> advance(std::uint16_t patch, const std::vector<Index>& frontier, int shell, Progress& progress);
  std::vector<Index> beyond_gaps(std::uint16_t patch) const;
  struct Renumbering {
    std::uint16_t into = no_patch;  // no_patch: the patch keeps its numbers
    std::vector<LatticeSite> of;    // of basis atom b in cell 0: its site in the other patch's numbers
  };
  Renumbering common_numbers(const BlockFrame& from, const BlockFrame& to) const;
  void merge_patches(Progress& progress);
  void settle_leftovers(Progress& progress);
  std::size_t count_seams(std::uint16_t patch) const;

  const Atoms& atoms_;
  const Crystal& crystal_;
  std::span<const WalkPattern> patterns_;
  std::size_t smallest_patch_;
  std::vector<LatticeSite>& of_;
  std::vector<float> squared_;
  AtomBlocks blocks_;
  std::vector<Patch> patches_;
  std::vector<BlockFrame> frames_;
  std::vector<Index> first_frame_;                     // of each block, into frames_
  std::vector<Index> free_;                            // of each block: atoms without a site
  std::vector<std::vector<std::uint8_t>> species_ok_;  // [pattern][basis · species + s]: s sits on basis
  bool species_known_ = false;                         // the cells' species are among the atoms'
};

}  // namespace atomesh
