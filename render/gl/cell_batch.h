// Cells that are drawn one after another, by the programs that draw them: going from one program to another takes
// software about as long as ten cells.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/gl/cell_faces.h"
#include "render/gl/front_faces.h"
#include "render/gl/map_ramps.h"
#include "render/gl/screen_mesh.h"

namespace atomesh::gl {

// A list of triangles for each kind, to be drawn in the kinds' order. What shows the same pixel is drawn in the order
// in which it was added: a cell goes to a later list than its own where it may lie on one of that list's cells.
class CellBatch {
 public:
  // Of pictures of so many pixels.
  CellBatch(int columns, int rows);

  // A cell that is drawn after all that were added, whose triangles lie in the box: returns false, and adds nothing,
  // where it lies on one that is not drawn as a sum of ramps as it is itself; then those added have to be drawn first.
  // `ramps` is read of sums of ramps alone.
  bool add(const GridBox& box, CellKind kind, std::span<const FaceVertex> faces, const RampVertex* ramps);
  void clear();

  std::size_t cells() const { return cells_; }
  std::size_t vertices() const { return vertices_; }
  struct List {
    std::vector<FaceVertex> faces;
    std::vector<RampVertex> ramps;  // as many; none of segments
  };
  const List& list(CellKind kind) const { return lists_[static_cast<std::size_t>(kind)]; }

 private:
  // Squares of the picture in which there may be a cell.
  static constexpr int side = 256;
  struct Marks {
    bool any = false;
    std::array<std::array<std::uint64_t, side / 64>, side> rows{};
  };
  template <class Function>
  bool any_word(const GridBox& box, const Function& function) const;
  bool marked(std::size_t list, const GridBox& box) const;
  void mark(std::size_t list, const GridBox& box);

  int shift_ = 0;  // of pixels to squares
  std::size_t cells_ = 0;
  std::size_t vertices_ = 0;
  std::array<List, cell_kinds> lists_;
  std::array<Marks, cell_kinds> marks_;  // not of the first, before which nothing has to be drawn
};

}  // namespace atomesh::gl
