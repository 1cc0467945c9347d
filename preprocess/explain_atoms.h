// How much of a sample a cell explains: every atom asked whether it sits on a site.
#pragma once

#include <map>
#include <unordered_map>
#include <vector>

#include "core/progress.h"
#include "preprocess/crystal.h"
#include "preprocess/fitted_cell.h"

namespace atomesh {

// The atoms sorted into cubic blocks small enough that strain hardly adds up within one. Memory: 4 bytes an atom and a
// few for each block that holds atoms.
class StrainBlocks {
 public:
  // `edge` Å, about.
  StrainBlocks(const Atoms& atoms, double edge);

  std::size_t size() const { return places_.size(); }
  // Ascending x, then y, z: the same for any order of the atoms.
  std::span<const Index> atoms(std::size_t block) const {
    return {order_.data() + start_[block], start_[block + 1] - start_[block]};
  }
  // The blocks around one (not itself) that hold atoms, in a fixed order.
  void neighbours(std::size_t block, std::vector<std::size_t>& around) const;

 private:
  using Place = std::array<std::int32_t, 3>;
  static std::uint64_t key_of(const Place& place);

  std::vector<Index> order_;
  std::vector<std::size_t> start_;
  std::vector<Place> places_;
  std::unordered_map<std::uint64_t, std::size_t> block_at_;
};

// What one cell explains.
struct Explained {
  std::size_t atoms = 0;    // on a site, whatever their species
  std::size_t foreign = 0;  // of them, of another species than the site's
  double squares = 0.0;     // Å², sum of the squared distances from the sites
  double closeness = 0.0;   // sum of 1 - (distance/limit)²: what a cell is preferred for that fits better
  std::vector<std::map<std::uint16_t, std::size_t>> at_site;  // atoms of each species on each site of the cell

  void add(const Explained& other);
};

struct Claims {
  std::vector<std::uint8_t> on_site;  // of each atom: it sits on a site
  std::vector<std::uint8_t> filled;   // of each block: nearly all its atoms do
  // Of each block: whether its own atoms gave an origin, and where that is, Å from the cell's.
  std::vector<std::uint8_t> has_origin;
  std::vector<Vec3> origin;
  Explained sum;
};

// In each block the crystal may lie a little shifted (strain, a slid layer, the far side of a crack). A block finds its
// origin from its own atoms, and has one where three quarters of them sit within a quarter of the distance between
// sites of a site; atoms that this leaves, and blocks that have none, go with the origins of the blocks beside them.
// Species that the cell lacks have no say. Blocks that `other` marks (empty: none) belong to another grain: only their
// atoms that are no_grain in `grain_of` are asked, by the origins beside.
Claims explain_atoms(const Atoms& atoms, const StrainBlocks& blocks, const FittedCell& cell,
                     const std::vector<std::uint8_t>& other, const std::vector<std::uint16_t>& grain_of,
                     Progress& progress);

}  // namespace atomesh
