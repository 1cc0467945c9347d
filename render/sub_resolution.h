// The order in which pictures are drawn progressively (seed 4.2.2, figure 4.2): the pixels of each sub-window of 4×4 or
// 8×8, so that 1, 2, 4, … of them stand for all on the way.
#pragma once

#include <vector>

#include "render/pixel_lattice.h"

namespace atomesh {

// How much of each sub-window is drawn: rows × columns of its pixels, 1×1, 2×1, 2×2, 4×2, … up to all. Each stands for
// a block of pixels, itself among them: where rows == columns for those right of and below it, and with twice as many
// rows as columns in every second row of blocks for the block in whose middle column it stands. (The seed counts a
// sub-window's rows from below, we from the top.)
struct SubResolution {
  int sub_window = 1;  // pixels along its side
  int rows = 1;
  int columns = 1;

  bool complete() const { return columns == sub_window; }
  int block_width() const { return sub_window / columns; }
  int block_height() const { return sub_window / rows; }

  struct Pixel {
    int column;
    int row;
  };
  // The drawn pixel that stands for this one in a picture of that width. Where that would lie beyond the right edge,
  // the pixel keeps the one of the sub-resolution before.
  Pixel source(int column, int row, int picture_width) const {
    const int width = block_width();
    const int height = block_height();
    Pixel from{column & -width, row & -height};
    if (height < width && (row & height) != 0) {
      from.column += width / 2;
      if (from.column >= picture_width) from = {column & -width, row & -width};
    }
    return from;
  }
};

// Of a sub-window of 4 or 8 pixels: each sub-resolution with the lattices that are drawn for it and were not before.
struct SubResolutionStep {
  SubResolution reached;
  std::vector<PixelLattice> lattices;
};
inline std::vector<SubResolutionStep> sub_resolution_steps(int sub_window) {
  std::vector<SubResolutionStep> steps{{{sub_window, 1, 1}, {{sub_window, sub_window, 0, 0}}}};
  for (int side = sub_window; side > 1; side /= 2) {  // of the blocks that one pixel stood for so far
    const int half = side / 2;
    const int columns = sub_window / side;
    steps.push_back({{sub_window, 2 * columns, columns}, {{side, side, half, half}}});
    steps.push_back({{sub_window, 2 * columns, 2 * columns}, {{side, side, half, 0}, {side, side, 0, half}}});
  }
  return steps;
}

}  // namespace atomesh
