// Which pixels of a picture: rectangles, and every so-many-th.
#pragma once

#include <algorithm>
#include <bit>
#include <vector>

#include "core/camera.h"

namespace atomesh {

// A rectangle of a picture's pixels.
struct PixelWindow {
  int left = 0;  // column of its first pixel in the picture
  int top = 0;   // row
  int width = 0;
  int height = 0;

  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  // Place of the picture's pixel (column, row), which lies in the window, in a row-major list of the window's pixels.
  std::size_t place(int column, int row) const {
    return static_cast<std::size_t>(row - top) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column - left);
  }
};
// All of the camera's picture.
inline PixelWindow whole_picture(const Camera& camera) {
  return {0, 0, camera.width, camera.height};
}

// Every so-many-th pixel of the picture: those with column ≡ column_phase (mod column_stride), and rows alike. Strides
// are 1, 2, 4 or 8; columns and rows count from the picture's first, not the window's.
struct PixelLattice {
  int column_stride = 1;
  int row_stride = 1;
  int column_phase = 0;
  int row_phase = 0;

  // The lattice's first column or row at or after this one.
  int column_from(int column) const { return column + ((column_phase - column) & (column_stride - 1)); }
  int row_from(int row) const { return row + ((row_phase - row) & (row_stride - 1)); }
};

// The lattice's pixels among columns [left, right) and rows [top, bottom), as a grid of their own: its pixel (i, j) is
// the picture's (column(i), row(j)).
class LatticeGrid {
 public:
  LatticeGrid(const PixelLattice& lattice, int left, int right, int top, int bottom)
      : first_column_(lattice.column_from(left)),
        first_row_(lattice.row_from(top)),
        column_shift_(std::countr_zero(static_cast<unsigned>(lattice.column_stride))),
        row_shift_(std::countr_zero(static_cast<unsigned>(lattice.row_stride))),
        columns_(first_column_ < right ? ((right - 1 - first_column_) >> column_shift_) + 1 : 0),
        rows_(first_row_ < bottom ? ((bottom - 1 - first_row_) >> row_shift_) + 1 : 0) {}
  LatticeGrid(const PixelLattice& lattice, const PixelWindow& window)
      : LatticeGrid(lattice, window.left, window.left + window.width, window.top, window.top + window.height) {}

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  bool empty() const { return columns_ == 0 || rows_ == 0; }
  std::size_t pixels() const { return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_); }
  int column(int i) const { return first_column_ + (i << column_shift_); }
  int row(int j) const { return first_row_ + (j << row_shift_); }
  // Of the picture's column or row, which is one of the grid's.
  int i_of(int column) const { return (column - first_column_) >> column_shift_; }
  int j_of(int row) const { return (row - first_row_) >> row_shift_; }
  // The grid's columns i of which the picture's are in [left, right]: first_i(left) … last_i(right); rows alike.
  int first_i(int left) const {
    return std::max(0, (left - first_column_ + (1 << column_shift_) - 1) >> column_shift_);
  }
  int last_i(int right) const { return std::min(columns_ - 1, (right - first_column_) >> column_shift_); }
  int first_j(int top) const { return std::max(0, (top - first_row_ + (1 << row_shift_) - 1) >> row_shift_); }
  int last_j(int bottom) const { return std::min(rows_ - 1, (bottom - first_row_) >> row_shift_); }

 private:
  int first_column_;
  int first_row_;
  int column_shift_;
  int row_shift_;
  int columns_;
  int rows_;
};

// Before a Frame draws into a channel: one that is not of the window's size yet gets it, filled with `nothing`. Null is
// a channel nobody asked for.
template <class T>
void size_channel(std::vector<T>* channel, const PixelWindow& window, const T& nothing) {
  if (channel != nullptr && channel->size() != window.pixels()) channel->assign(window.pixels(), nothing);
}

}  // namespace atomesh
