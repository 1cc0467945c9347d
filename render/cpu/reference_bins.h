// Which primitives may touch which part of the picture, so that the judge need not try all for every pixel.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "core/parallel.h"
#include "core/progress.h"
#include "render/cpu/reference_sight.h"
#include "render/pixel_lattice.h"

namespace atomesh::reference {

// Square tiles of a window of the picture, each with the primitives whose conservative extent meets it, ascending.
class Bins {
 public:
  static constexpr int side = 4;  // pixels

  // extent_of(i) gives the Sight::Extent of primitive i; it is asked from several threads. Throws CancelledError.
  template <class ExtentOf>
  Bins(const PixelWindow& window, std::size_t count, const Progress& progress, ExtentOf extent_of)
      : window_(window), columns_((window.width + side - 1) / side), rows_((window.height + side - 1) / side) {
    begin_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
    std::vector<Sight::Extent> extents(count);
    parallel_for(count, 4096, [&](std::size_t begin, std::size_t end) {
      progress.check();
      for (std::size_t i = begin; i < end; ++i) extents[i] = within(extent_of(i));
    });
    for (const Sight::Extent& extent : extents) {
      for_each_tile(extent, [this](std::size_t tile) { ++begin_[tile + 1]; });
    }
    for (std::size_t tile = 1; tile < begin_.size(); ++tile) begin_[tile] += begin_[tile - 1];
    items_.resize(begin_.back());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t i = 0; i < count; ++i) {
      if (i % 65536 == 0) progress.check();
      for_each_tile(extents[i], [&](std::size_t tile) { items_[next[tile]++] = static_cast<Index>(i); });
    }
  }

  // Pixel of the picture, in the window.
  std::span<const Index> at(int column, int row) const {
    const std::size_t tile = index((column - window_.left) / side, (row - window_.top) / side);
    return {items_.data() + begin_[tile], begin_[tile + 1] - begin_[tile]};
  }

 private:
  // The part of an extent that lies in the window, counted from its corner.
  Sight::Extent within(const Sight::Extent& extent) const {
    return {std::max(extent.left - window_.left, 0), std::min(extent.right - window_.left, window_.width - 1),
            std::max(extent.top - window_.top, 0), std::min(extent.bottom - window_.top, window_.height - 1)};
  }
  std::size_t index(int tile_column, int tile_row) const {
    return static_cast<std::size_t>(tile_row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(tile_column);
  }
  template <class Visit>
  void for_each_tile(const Sight::Extent& extent, Visit visit) const {
    if (extent.left > extent.right || extent.top > extent.bottom) return;
    for (int row = extent.top / side; row <= extent.bottom / side; ++row) {
      for (int column = extent.left / side; column <= extent.right / side; ++column) visit(index(column, row));
    }
  }

  PixelWindow window_;
  int columns_;
  int rows_;
  std::vector<std::size_t> begin_;
  std::vector<Index> items_;
};

}  // namespace atomesh::reference
