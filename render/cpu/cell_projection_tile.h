// The cells of one tile: their records, in order, and listed under the tile's blocks; and its rays' hits of the
// surface.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "render/cpu/cell_projection_kernel.h"
#include "render/cpu/surface_layers.h"

namespace atomesh::cell_projection {

// What a thread needs to draw a tile; grows to the largest tile it has seen.
class Tile {
 public:
  // Records for `count` cells with RGBA or with a scalar, to be filled by Kernel::setup().
  SetupOutput resize(std::size_t count, bool colored);

  std::vector<Index> cells;  // of the tile
  std::vector<CellPlanes> planes;
  std::vector<CellRefinement> refinements;
  std::vector<CellColors> colors;
  std::vector<ColorRange> ranges;
  std::vector<CellScalar> scalars;
  std::vector<double> keys;
  std::vector<BlockSet> blocks;
  TileLayers layers;

  // Puts the cells in ascending order of their keys, equal keys by their place in the tile; those without blocks are
  // left out. Then lists them, in this order, under their blocks.
  void list_blocks();
  std::span<const std::uint32_t> cells_of(int block) const {
    const auto b = static_cast<std::size_t>(block);
    return {cells_.data() + begin_[b], cells_.data() + begin_[b + 1]};
  }
  // Room for the longest of the blocks' lists.
  BlockScratch scratch();

 private:
  struct Entry {
    std::uint32_t key;
    std::uint32_t cell;
  };
  void sort();

  std::size_t count_ = 0;
  std::array<std::uint32_t, blocks_per_tile> per_block_{};
  std::vector<Entry> sorted_;
  std::vector<Entry> sorting_;
  std::vector<std::uint32_t> begin_;  // of each block in cells_
  std::vector<std::uint32_t> cells_;
  std::vector<float> floats_;
  std::vector<std::uint32_t> numbers_;
  std::vector<std::uint32_t> lanes_;
};

// Lends tiles to the threads that draw.
class TilePool {
 public:
  std::unique_ptr<Tile> take();
  void give_back(std::unique_ptr<Tile> tile);

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Tile>> free_;
};

}  // namespace atomesh::cell_projection
