// Sorting cells by 32-bit keys on the graphics card, in compute shaders of OpenGL 4.3 alone.
//
// Eight passes from the lowest digit of four bits: counts of each digit in tiles of 2,048 cells, their sums, and each
// cell to its place (Satish, Harris, Garland 2009, "Designing efficient sorting algorithms for manycore GPUs").
#pragma once

#include <span>

#include "render/gl/cell_order.h"
#include "render/gl/objects.h"

namespace atomesh::gl {

class RadixSort {
 public:
  // Throws UnavailableError when the driver does not take a shader.
  RadixSort();
  // Puts the first `count` KeyedCell in `cells` in ascending order of their keys, equal keys as they stood: what
  // sort_by_key() makes of them. Storage buffers 0 to 2 are taken. Shaders may read `cells` afterwards; whoever reads
  // it otherwise needs a barrier.
  void sort(Buffer& cells, std::size_t count);

 private:
  Program count_;
  Program scan_;
  Program scatter_;
  Buffer scratch_;
  Buffer places_;
};

// CellOrder without faces on the card.
class CardOrder {
 public:
  // `points` as CellOrder::points() has them: 16 bytes a tetrahedron on the card.
  explicit CardOrder(std::span<const OrderPoint> points);
  // `cells`: `count` indices (Index) into the points. Afterwards order() has KeyedCell front to back, the same to the
  // rounding of keys as CellOrder::sort() gives. Storage buffers 0 to 2 are taken.
  void sort(const KeyScale& scale, const Buffer& cells, std::size_t count);
  const Buffer& order() const { return keyed_; }

 private:
  Program keys_;
  RadixSort sort_;
  Buffer points_;
  Buffer keyed_;
};

}  // namespace atomesh::gl
