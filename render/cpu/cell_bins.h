// Which cells lie under which tile of a picture's window.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/geometry.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "render/cpu/cell_projection_kernel.h"
#include "render/cpu/tile_bins.h"
#include "render/pixel_lattice.h"

namespace atomesh::cell_projection {

// The tiles of the picture that a window touches. They stand where the picture's pixels are, wherever the window
// begins; tile t is in column t % columns, row t / columns.
struct TileGrid {
  int first_column = 0;  // in tiles, from the picture's first
  int first_row = 0;
  int columns = 0;
  int rows = 0;

  TileGrid() = default;
  explicit TileGrid(const PixelWindow& window)
      : first_column(window.left / tile_side),
        first_row(window.top / tile_side),
        columns((window.left + window.width - 1) / tile_side - first_column + 1),
        rows((window.top + window.height - 1) / tile_side - first_row + 1) {}
  std::size_t tiles() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  // First pixel of a tile in the picture.
  int pixel_column(std::size_t tile) const {
    return (first_column + static_cast<int>(tile % static_cast<std::size_t>(columns))) * tile_side;
  }
  int pixel_row(std::size_t tile) const {
    return (first_row + static_cast<int>(tile / static_cast<std::size_t>(columns))) * tile_side;
  }
};

// Holds 4 bytes for each tile that a cell touches, and in at most 64 parts 8 bytes a tile.
class CellBins {
 public:
  CellBins() = default;
  // `box(i)` is the box of cell i in the picture's pixels; it is asked once for each, in parallel. Whichever window the
  // grid is of, a tile gets the same cells. Throws CancelledError.
  template <class Box>
  CellBins(std::size_t count, const TileGrid& grid, const Progress& progress, Box&& box);

  bool any_in(std::size_t tile) const {
    return std::any_of(parts_.begin(), parts_.end(),
                       [tile](const Part& part) { return part.begin[tile] != part.begin[tile + 1]; });
  }
  // The tile's cells, ascending.
  void gather(std::size_t tile, std::vector<Index>& cells) const;

 private:
  // Of consecutive cells: those of tile t are items[begin[t]] … items[begin[t + 1] - 1].
  struct Part {
    std::vector<std::size_t> begin;
    std::unique_ptr<Index[]> items;
  };
  // Tiles under a cell within the grid, ends included.
  struct Range {
    Index cell;
    std::uint16_t first_column, last_column, first_row, last_row;
  };
  static bool find_range(const TileGrid& grid, const PixelBox& box, Range& range);
  static void fill(const TileGrid& grid, std::span<const Range> ranges, Part& part);

  std::vector<Part> parts_;
};

inline bool CellBins::find_range(const TileGrid& grid, const PixelBox& box, Range& range) {
  if (box.empty()) return false;
  const int first_column = std::max(box.first_column / tile_side - grid.first_column, 0);
  const int last_column = std::min(box.last_column / tile_side - grid.first_column, grid.columns - 1);
  const int first_row = std::max(box.first_row / tile_side - grid.first_row, 0);
  const int last_row = std::min(box.last_row / tile_side - grid.first_row, grid.rows - 1);
  if (first_column > last_column || first_row > last_row) return false;
  range.first_column = static_cast<std::uint16_t>(first_column);
  range.last_column = static_cast<std::uint16_t>(last_column);
  range.first_row = static_cast<std::uint16_t>(first_row);
  range.last_row = static_cast<std::uint16_t>(last_row);
  return true;
}

// The boxes of one part at a time are kept from the counting to the filling.
template <class Box>
CellBins::CellBins(std::size_t count, const TileGrid& grid, const Progress& progress, Box&& box)
    : parts_(std::clamp<std::size_t>(count / 4096, 1, 64)) {
  parallel_for(parts_.size(), 1, [&](std::size_t part, std::size_t) {
    progress.check();
    const std::size_t end = count * (part + 1) / parts_.size();
    const std::size_t begin = count * part / parts_.size();
    const auto ranges = std::make_unique_for_overwrite<Range[]>(end - begin);
    std::size_t found = 0;
    for (std::size_t i = begin; i < end; ++i) {
      Range& range = ranges[found];
      range.cell = static_cast<Index>(i);
      found += find_range(grid, box(i), range) ? 1U : 0U;
    }
    fill(grid, {ranges.get(), found}, parts_[part]);
  });
}

// Clips a cell that reaches behind the eye (at least one corner before it, perspective only) at a depth next to zero.
// What it may cover of the picture; the whole width or height where it passes the eye.
PixelBox clipped_box(const ProjectedVertices& vertices, const Tetrahedron& corners, const Camera& camera);

}  // namespace atomesh::cell_projection
