// Which primitives may touch which part of the picture, so that the judge need not try all for every pixel.
#pragma once

#include <span>
#include <vector>

#include "render/cpu/reference_sight.h"

namespace atomesh::reference {

// Square tiles of the picture, each with the primitives whose conservative extent meets it, ascending.
class Bins {
 public:
  static constexpr int side = 4;  // pixels

  // extent_of(i) gives the Sight::Extent of primitive i.
  template <class ExtentOf>
  Bins(const Camera& camera, std::size_t count, ExtentOf extent_of)
      : columns_((camera.width + side - 1) / side), rows_((camera.height + side - 1) / side) {
    begin_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
    std::vector<Sight::Extent> extents(count);
    for (std::size_t i = 0; i < count; ++i) {
      extents[i] = extent_of(i);
      for_each_tile(extents[i], [this](std::size_t tile) { ++begin_[tile + 1]; });
    }
    for (std::size_t tile = 1; tile < begin_.size(); ++tile) begin_[tile] += begin_[tile - 1];
    items_.resize(begin_.back());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t i = 0; i < count; ++i) {
      for_each_tile(extents[i], [&](std::size_t tile) { items_[next[tile]++] = static_cast<Index>(i); });
    }
  }

  std::span<const Index> at(int column, int row) const {
    const std::size_t tile = index(column / side, row / side);
    return {items_.data() + begin_[tile], begin_[tile + 1] - begin_[tile]};
  }

 private:
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

  int columns_;
  int rows_;
  std::vector<std::size_t> begin_;
  std::vector<Index> items_;
};

}  // namespace atomesh::reference
