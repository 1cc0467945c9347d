// The cells of a scene as a view needs them: which are drawn, in which order, and the triangles OpenGL draws of them
// (front_faces.h), slab by slab, so that memory stays bounded. Slabs are kept for views that stay, if they fit.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

#include "core/camera.h"
#include "core/color_map.h"
#include "core/progress.h"
#include "render/gl/front_faces.h"
#include "render/gl/map_ramps.h"
#include "render/gl/marked_tiles.h"
#include "render/gl/objects.h"
#include "render/gl/screen_mesh.h"

namespace atomesh::gl {

// A slab: 19 MB of vertices.
inline constexpr std::size_t cells_per_slab = 65536;
inline constexpr std::size_t vertices_per_cell = 3 * most_faces;
inline constexpr std::size_t slab_bytes = cells_per_slab * vertices_per_cell * sizeof(FaceVertex);
// Slabs of a view are kept up to so many bytes.
inline constexpr std::size_t kept_bytes = std::size_t{512} << 20;

// Of one scene and one context, which is current whenever anything of it is called, the destructor included. Places
// are those of the view's order, front to back.
class PreparedCells {
 public:
  PreparedCells() = default;
  virtual ~PreparedCells() = default;
  PreparedCells(const PreparedCells&) = delete;
  PreparedCells& operator=(const PreparedCells&) = delete;

  // A new view, in two steps: where the vertices are and which cells are drawn; their order. Throw CancelledError,
  // UnavailableError (no memory).
  virtual void project(const Camera& camera, const PixelGrid& grid, const ColorMap& color_map,
                       const Progress& progress) = 0;
  virtual void order(const Camera& camera, Progress& progress) = 0;
  virtual const ScreenView& view() const = 0;

  // Places of the order; there may be fewer cells.
  virtual std::size_t places() const = 0;
  // The slab with the place `begin`: its triangles are made; false where they are there already, or made by draw().
  // Then draws it, or of it some places from `begin` on; a vertex array is bound whose attributes 0 to 2 are the
  // cells', and `use` makes the program of a kind current: cells.vert's, or ramp_cells.vert's.
  virtual bool make_slab(std::size_t begin) = 0;
  // Returns how many: about `most`, at least one, not beyond the slab.
  using UseProgram = std::function<void(CellKind kind)>;
  virtual std::size_t draw(std::size_t begin, std::size_t most, const UseProgram& use) = 0;
  static std::size_t slab_end(std::size_t begin, std::size_t places) {
    return std::min(begin - begin % cells_per_slab + cells_per_slab, places);
  }
  // Before make_slab(): whether cells are drawn as sums of ramps of this map where they suit it; `rays_end`: something
  // opaque may end rays within cells. Only cells that the processor prepares for software are.
  virtual void use_ramps(const ColorMap& /*color_map*/, double /*alpha_length*/, bool /*rays_end*/) {}
  virtual void use_no_ramps() {}
  // Whether draw_outside() shows all there is to see of a wrong order: faces of which each has to lie behind the one
  // before, as far as the order is right. A vertex array is bound whose attribute 0 is theirs, for cells.vert.
  virtual bool outside_shows_order() const { return false; }
  virtual void draw_outside() {}
  // Draws at least the cells that lie where `tiles` are marked, by the program in use: cells.vert's.
  virtual void draw_marked(const MarkedTiles& tiles, const Progress& progress) = 0;

  // Of the view, once all of it was drawn; waits for OpenGL.
  virtual std::size_t cells() const = 0;
  virtual std::size_t triangles() const = 0;
  virtual std::size_t ramp_triangles() const { return 0; }

 protected:
  // FaceVertex, as the attributes of the vertex array that is bound.
  static void bind_vertices(const Buffer& vertices);
  // Whether the slabs of so many places are kept.
  static bool keep(std::size_t places, std::size_t kept = kept_bytes) {
    return (places + cells_per_slab - 1) / cells_per_slab * slab_bytes <= kept;
  }
};

}  // namespace atomesh::gl
