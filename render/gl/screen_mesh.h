// A mesh on the grid of the rasterizer: vertices in whole 256ths of a pixel, so that the processor's decisions (which
// faces of a cell are seen, which cells meet no pixel) and the card's agree exactly, and cells that share a vertex
// share its place. Depths are those of the unmoved vertices; a cell is thereby moved by at most 1/512 pixel sideways,
// together with its neighbours: no ray meets a gap or an overlap.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/geometry.h"
#include "core/progress.h"
#include "render/cpu/map_intervals.h"
#include "render/pixel_lattice.h"
#include "render/scene.h"

namespace atomesh::gl {

// Pixels to draw, evenly spaced on the image plane: pixel (i, j), i from the left, j from the top, has its centre at
// (x + i · dx, y - j · dy).
struct PixelGrid {
  double x = 0.0, y = 0.0;
  double dx = 1.0, dy = 1.0;
  int columns = 0, rows = 0;
  bool operator==(const PixelGrid&) const = default;
};
// The lattice's pixels in the window.
PixelGrid pixel_grid(const Camera& camera, const PixelWindow& window, const PixelLattice& lattice = {});

inline constexpr int subpixel_bits = 8;
inline constexpr int subpixels = 1 << subpixel_bits;
// Vertices up to so many pixels from the grid's middle (the corner between pixels columns/2 - 1 and columns/2) are
// drawn as they are (OpenGL's own clipping would round once more); so the grid may have twice as many at most.
inline constexpr int guard_pixels = 8192;

// Depths are linear on the screen: w = z - reference of parallel, w = -reference / z of perspective projection, with z
// the depth along Camera::forward. The scalar s, too, is carried as what is linear on the screen along each face:
// u = s, or s · reference / z = -s w. Both at the place of the vertex or of the ray.
struct ScreenVertex {
  std::int32_t column, row;  // in 1/256 pixel from the grid's middle, down
  float w;
  float u;
};

// Columns and rows of a grid, both ends included.
struct GridBox {
  int left, right, top, bottom;
  bool empty() const { return left > right || top > bottom; }
};

// The pixels of the grid whose centres lie within the box of these vertices.
template <std::size_t N>
GridBox pixels_between(const std::array<ScreenVertex, N>& corners, const PixelGrid& grid) {
  const auto first = [](std::int32_t low, int count) {
    return std::max((low + count / 2 * subpixels + subpixels / 2 - 1) >> subpixel_bits, 0);
  };
  const auto last = [](std::int32_t high, int count) {
    return std::min((high + count / 2 * subpixels - subpixels / 2) >> subpixel_bits, count - 1);
  };
  std::int32_t left = corners[0].column, right = left, top = corners[0].row, bottom = top;
  for (std::size_t k = 1; k < N; ++k) {
    left = std::min(left, corners[k].column);
    right = std::max(right, corners[k].column);
    top = std::min(top, corners[k].row);
    bottom = std::max(bottom, corners[k].row);
  }
  return {first(left, grid.columns), last(right, grid.columns), first(top, grid.rows), last(bottom, grid.rows)};
}
template <std::size_t N>
bool meets_pixel(const std::array<ScreenVertex, N>& corners, const PixelGrid& grid) {
  return !pixels_between(corners, grid).empty();
}

// What all cells of a picture have in common.
struct ScreenView {
  bool perspective = false;
  double reference = 1.0;  // Å; the sample's depth
  // Nearest depth that is drawn, Å: of perspective projection a two-thousandth of the sample's radius, as floats cannot
  // hold the reciprocals of both smaller ones and the sample's. 0 of parallel projection.
  double near = 0.0;
  PixelGrid grid;
  int guard = guard_pixels;             // vertices lie so many pixels from the grid's middle at most
  float first_w = 0.0F, last_w = 1.0F;  // of everything that is drawn
};

// Where the camera sees the scene, all of whose vertices may be up to `guard` pixels from the grid's middle. first_w
// and last_w are not found yet.
ScreenView screen_view(const Scene& scene, const Camera& camera, const PixelGrid& grid, int guard);
// Along the camera's axes from its eye: a point `offset` (Scene::center from the eye) is added to.
Vec3 before_eye(const Vec3& p, const Vec3& offset, const Camera& camera);
// Column and row (ScreenVertex) of a point before the eye, not rounded.
glm::dvec2 subpixel_place(const ScreenView& view, const Vec3& p);
// Its w.
double screen_w(const ScreenView& view, const Vec3& p);

class ScreenMesh {
 public:
  // Projects the vertices, and finds the cells to draw: those that meet a pixel's centre and hold a scalar that is not
  // transparent. Cells that reach nearer than `near` or beyond the guard are replaced by the pieces that do not. Keeps
  // a reference to the scene; 16 bytes a vertex and 4 a cell to draw. Throws CancelledError.
  ScreenMesh(const Scene& scene, const Camera& camera, const PixelGrid& grid, const cell_projection::MapIntervals& map,
             const Progress& progress);

  const ScreenView& view() const { return view_; }
  // Indices into Scene::tetrahedra, ascending.
  std::span<const Index> cells() const { return cells_; }
  // The cells, put into some order, as what is drawn: cells that were clipped are replaced by their pieces, of one cell
  // from the nearest on, which have numbers from Scene::tetrahedra.size() on.
  std::vector<Index> parts(std::span<const Index> order) const;
  // Of a corner: its place is none, for it is nearer than `near` or beyond the guard.
  static bool is_clipped(const ScreenVertex& vertex) { return vertex.column == clipped; }
  // Parts from here on are pieces.
  std::size_t cells_of_scene() const { return scene_.tetrahedra.size(); }
  std::size_t parts_end() const { return cells_of_scene() + pieces_.size(); }
  // Corners of a part, oriented like those of the cell.
  std::array<ScreenVertex, 4> corners(Index part) const {
    if (part >= scene_.tetrahedra.size()) return pieces_[part - scene_.tetrahedra.size()];
    const Tetrahedron& t = scene_.tetrahedra[part];
    return {vertices_[t[0]], vertices_[t[1]], vertices_[t[2]], vertices_[t[3]]};
  }

 private:
  static constexpr std::int32_t clipped = std::numeric_limits<std::int32_t>::min();  // as a column

  ScreenVertex on_screen(const Vec3& p, float scalar) const;
  void project(const Camera& camera);
  void find_cells(const cell_projection::MapIntervals& map, const Progress& progress);
  void clip_cells(const Camera& camera);

  const Scene& scene_;
  ScreenView view_;
  std::vector<ScreenVertex> vertices_;
  std::vector<Index> cells_;
  struct Clipped {
    Index cell;
    std::uint32_t first, count;  // of pieces_
  };
  std::vector<Clipped> clipped_;  // ascending in cell
  std::vector<std::array<ScreenVertex, 4>> pieces_;
};

}  // namespace atomesh::gl
