// Light of a segment as a sum over the colour map's knots, so that a shader integrates it without looking anything up;
// without OpenGL.
//
// Between two knots extinction σ and colour c are linear in the scalar s, what shines, c σ, is quadratic. Counted from
// a knot k (x = s - k) a continuous map is the sum of one polynomial and, for each knot from there up, a ramp that
// begins at it: d max(0, x - k') of σ, d max(0, x - k') + e max(0, x - k')² of c σ. Along a ray the scalar goes
// linearly from one end of the segment to the other, so that integrals over the segment of length L are L / |s1 - s0|
// times those over s: polynomials of the ends (ramp_segment.glsl). What is left out is in which order the segment's
// parts shade one another: with optical depth m = ∫ σ its light is taken for ∫ c σ · (1 - e^-m) / m, which is off by
// about m² |Δc| / 12, Δc what the colour changes by. Cells are drawn so up to an optical depth by which that is little.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/color_map.h"
#include "core/geometry.h"
#include "render/gl/preintegration_map.h"
#include "render/scene.h"

namespace atomesh::gl {

// Pieces of the map that one row holds.
inline constexpr int pieces_per_row = 3;

// Segments of a cell are taken for a sum of ramps up to this optical depth, and up to this product of it and the
// change of colour: where all of a ray's segments are at these limits and their colours change the same way, its light
// is off by 4/255. Segments of scenes mostly are far from them.
inline constexpr double deepest_ramps = 1.0;
inline constexpr double most_ramps_change = 0.125;

// Up to three pieces of the map that follow one another without a jump, as ramp_cells.vert reads them; RGB times
// extinction first, then extinction, 1/Å. Divided by 2 and 3 are what x and x² are integrated with.
struct RampRow {
  Vec4f piece, piece_slope;  // at the knot; half of what x is multiplied by
  Vec3f piece_square;        // a third of what x² is
  float lowest;              // x from which on the row counts
  Vec4f knot;                // half of d, of the first knot, x = 0
  Vec3f knot_square;         // a third of e
  float highest;             // x up to which the row counts
  Vec4f next_knot;
  Vec3f next_knot_square;
  float next;  // x of the second knot
  Vec4f zero;  // scalar from which x is counted; nothing
};
static_assert(sizeof(RampRow) == 8 * sizeof(Vec4f));

// By which program a cell is drawn.
enum class CellKind : std::uint8_t {
  piece,   // a sum of ramps, all of whose scalars lie in the first piece of its row
  ramps,   // any sum of ramps
  segment  // not as a sum of ramps
};
inline constexpr std::size_t cell_kinds = 3;

// Rows of a map, and which of them each cell of a scene is drawn with.
class MapRamps {
 public:
  MapRamps(const Scene& scene, const ColorMap& color_map, double alpha_length);

  std::span<const RampRow> rows() const { return rows_; }

  // Å; longer segments of the cell are not to be taken for a sum of ramps. 0: none.
  float longest(Index cell) const { return cells_[cell].longest; }
  // How many cells are longer than that along half of an edge, as which most segments are shorter.
  std::size_t too_deep() const { return too_deep_; }
  // The rows that hold the cell's scalars between them, from the lowest scalars on: each is drawn by itself, and adds
  // what is seen of the segment where the scalar lies in its pieces. Rows without opacity are left out. Returns how
  // many are written, at most most_rows.
  static constexpr int most_rows = 33;
  int rows_of(Index cell, std::uint8_t* rows) const;
  // Not CellKind::segment. That of one piece only where it is that of most of the scene's cells.
  CellKind kind_of(Index cell) const;

 private:
  // From the lowest scalar's piece to the highest one's.
  struct Cell {
    float longest;
    std::uint8_t first, last;
  };
  static bool in_one_piece(const Cell& cell) { return cell.first == cell.last; }
  // A row from each piece, with or without an end to either side: where a cell has more below or above.
  static constexpr std::uint8_t cut_below = 1;
  static constexpr std::uint8_t cut_above = 2;

  void make_rows();
  Cell cell_of(float low, float high) const;
  int last_of_row(int first) const;

  std::vector<MapPiece> pieces_;
  std::vector<std::uint8_t> transparent_;  // of each piece: no opacity throughout
  std::vector<std::uint8_t> jumps_;        // of each piece: begins at another colour than the one before ends with
  std::vector<RampRow> rows_;              // four of each piece, by what is cut
  std::vector<Cell> cells_;
  std::size_t too_deep_ = 0;
  bool mostly_one_piece_ = false;
};

}  // namespace atomesh::gl
