// The lit layers of mode volume_surface: where rays enter the surface, and its colour there. Found from the surface
// alone by its watertight raster, as in mode surface, so that every entry counts exactly once, however rounding shares
// out the volume behind an edge among its cells.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/cpu/cell_bins.h"
#include "render/cpu/cell_projection_kernel.h"
#include "render/cpu/surface_shader.h"
#include "render/cpu/tile_bins.h"

namespace atomesh::cell_projection {

// The hits of one tile's rays; lent to a thread with the tile's cells.
class TileLayers {
 public:
  void clear();
  // Triangles ascending. Pixel of the lattice's grid in the tile.
  void add(int column, int row, const LayerHit& hit);
  // Puts what was added under its rays, nearest first; of two at the same depth the triangle added first.
  void sort();

  const LayerHit* hits() const { return hits_.data(); }
  // Of a block's rays: those of ray i are hits()[begin[i]] … hits()[begin[i + 1] - 1].
  const std::uint32_t* begin_of(int block) const { return &begin_[static_cast<std::size_t>(block * block_pixels)]; }
  bool any_in(int block) const { return begin_of(block)[0] != begin_of(block)[block_pixels]; }

 private:
  struct Added {
    LayerHit hit;
    std::uint32_t ray;  // block by block
  };
  std::vector<Added> added_;
  std::vector<LayerHit> hits_;
  std::array<std::uint32_t, tile_side * tile_side + 1> begin_{};
};

class SurfaceLayers {
 public:
  // Keeps references. `exits` says whether it is also wanted where rays leave the surface. Throws CancelledError.
  SurfaceLayers(const Scene& scene, const Camera& camera, const Parameters& parameters, const View& view,
                const ProjectedVertices& vertices, const TileGrid& grid, bool exits, const Progress& progress);

  bool any_in(std::size_t tile) const { return !bins_.of(tile).empty(); }
  // The hits in front of the eye, of the lattice's pixels.
  void find(std::size_t tile, const PixelLattice& lattice, TileLayers& layers) const;
  Shader shader() const { return {shade, this}; }

 private:
  // The u of a layer at `depth`, so that no cell behind it seems to begin before it: it goes by where the cells' ray,
  // which passes a hair beside, meets the triangle's plane, and by more nearer than floats can be off.
  float place(double depth, double beside) const;
  float u_of(double depth) const;
  static void shade(const void* layers, const LayerHit& hit, int column, int row, float* rgb);

  const Scene& scene_;
  const Camera& camera_;
  const View& view_;
  const ProjectedVertices& vertices_;
  SurfaceShader shader_;
  double margin_;  // Å
  TileGrid grid_;
  bool exits_;
  TileBins bins_;  // of the surface's triangles; where exits are not wanted, without those that surely no ray enters by
};

}  // namespace atomesh::cell_projection
