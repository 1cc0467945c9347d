#include "render/gl/cell_batch.h"

#include <algorithm>

namespace atomesh::gl {

namespace {

constexpr auto segments = static_cast<std::size_t>(CellKind::segment);

}  // namespace

CellBatch::CellBatch(int columns, int rows) {
  while ((std::max(columns, rows) - 1) >> shift_ >= side) ++shift_;
}

bool CellBatch::add(const GridBox& box, CellKind kind, std::span<const FaceVertex> faces, const RampVertex* ramps) {
  const auto own = static_cast<std::size_t>(kind);
  std::size_t list = segments;
  while (list > own && !marked(list, box)) --list;
  if (list == segments && own != segments) return false;
  if (list > 0) mark(list, box);
  lists_[list].faces.insert(lists_[list].faces.end(), faces.begin(), faces.end());
  if (list != segments) lists_[list].ramps.insert(lists_[list].ramps.end(), ramps, ramps + faces.size());
  ++cells_;
  vertices_ += faces.size();
  return true;
}

void CellBatch::clear() {
  cells_ = vertices_ = 0;
  for (List& list : lists_) {
    list.faces.clear();
    list.ramps.clear();
  }
  for (Marks& marks : marks_) {
    if (marks.any) marks = {};
  }
}

// Calls `function` with the row, the word of it and its bits for the box's squares, until it returns true.
template <class Function>
bool CellBatch::any_word(const GridBox& box, const Function& function) const {
  const auto left = static_cast<unsigned>(box.left >> shift_);
  const auto right = static_cast<unsigned>(box.right >> shift_);
  const std::uint64_t first = ~std::uint64_t{0} << left % 64;
  const std::uint64_t last = ~std::uint64_t{0} >> (63 - right % 64);
  for (int row = box.top >> shift_; row <= box.bottom >> shift_; ++row) {
    for (unsigned word = left / 64; word <= right / 64; ++word) {
      const std::uint64_t bits =
          (word == left / 64 ? first : ~std::uint64_t{0}) & (word == right / 64 ? last : ~std::uint64_t{0});
      if (function(static_cast<std::size_t>(row), word, bits)) return true;
    }
  }
  return false;
}

bool CellBatch::marked(std::size_t list, const GridBox& box) const {
  const Marks& marks = marks_[list];
  return marks.any && any_word(box, [&](std::size_t row, unsigned word, std::uint64_t bits) {
           return (marks.rows[row][word] & bits) != 0;
         });
}

void CellBatch::mark(std::size_t list, const GridBox& box) {
  Marks& marks = marks_[list];
  marks.any = true;
  any_word(box, [&](std::size_t row, unsigned word, std::uint64_t bits) {
    marks.rows[row][word] |= bits;
    return false;
  });
}

}  // namespace atomesh::gl
