// Where pixels are marked, in tiles: so that little is drawn again where few are.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace atomesh::gl {

class MarkedTiles {
 public:
  // Pixels of a window, rows of `width` from the bottom (OpenGL's row 0); marked where any of `bits` is set.
  MarkedTiles(std::span<const std::uint8_t> pixels, int width, int height, std::uint8_t bits);

  // From now on only what lies in this rectangle counts.
  void look_at(int left, int bottom, int width, int height) {
    left_ = left;
    bottom_ = bottom;
    right_ = left + width - 1;
    top_ = bottom + height - 1;
  }

  // The same for shaders: the rectangle, both ends included, and of each corner of tiles of 2^shift pixels a side, row
  // by row of line() corners, how many marked tiles lie left of and below it.
  struct Window {
    int left, right, bottom, top;
  };
  Window window() const { return {left_, right_, bottom_, top_}; }
  std::span<const std::uint32_t> sums() const { return sums_; }
  int line() const { return columns_ + 1; }
  static constexpr int shift = 3;  // tiles of 8 × 8 pixels

  // Whether a tile that these pixels (both ends included, may reach beyond the window) touch has a marked one.
  bool meets(int left, int right, int bottom, int top) const {
    left = std::max(left, left_);
    right = std::min(right, right_);
    bottom = std::max(bottom, bottom_);
    top = std::min(top, top_);
    if (left > right || bottom > top) return false;
    left >>= shift;
    bottom >>= shift;
    right = (right >> shift) + 1;
    top = (top >> shift) + 1;
    return sum(right, top) + sum(left, bottom) != sum(left, top) + sum(right, bottom);
  }

 private:
  // Marked tiles left of and below a tile's corner.
  std::uint32_t sum(int column, int row) const {
    return sums_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_ + 1) +
                 static_cast<std::size_t>(column)];
  }

  int columns_;
  int left_, bottom_, right_, top_;
  std::vector<std::uint32_t> sums_;
};

}  // namespace atomesh::gl
