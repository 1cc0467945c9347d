// Cells prepared by the processor: projected and clipped (screen_mesh.h), put in order (cell_order.h), and their front
// faces sent to the card.
#pragma once

#include <epoxy/gl.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "render/gl/cell_batch.h"
#include "render/gl/cell_faces.h"
#include "render/gl/cell_order.h"
#include "render/gl/draw_ahead.h"
#include "render/gl/map_ramps.h"
#include "render/gl/objects.h"
#include "render/gl/prepared_cells.h"

namespace atomesh::gl {

class ProcessorCells final : public PreparedCells {
 public:
  // Keeps a reference to the scene. `by_faces` as CellOrder has it. `software`: the driver is one. It gets the cells in
  // small portions, and there are no slabs; only there cells are drawn as sums of ramps.
  ProcessorCells(const Scene& scene, bool by_faces, bool software)
      : scene_(scene), by_faces_(by_faces), software_(software) {}

  // These two leave OpenGL alone: another thread may call them.
  void project(const Camera& camera, const PixelGrid& grid, const ColorMap& color_map,
               const Progress& progress) override;
  void order(const Camera& camera, Progress& progress) override;
  const ScreenView& view() const override { return mesh_->view(); }
  std::size_t places() const override { return parts_.size(); }
  bool make_slab(std::size_t begin) override;
  std::size_t draw(std::size_t begin, std::size_t most, const UseProgram& use) override;
  void use_ramps(const ColorMap& color_map, double alpha_length, bool rays_end) override;
  void use_no_ramps() override;
  bool outside_shows_order() const override { return !outside_.empty(); }
  void draw_outside() override;
  void draw_marked(const MarkedTiles& tiles, const Progress& progress) override;
  std::size_t cells() const override { return cells_; }
  std::size_t triangles() const override;
  std::size_t ramp_triangles() const override { return ramp_triangles_; }

 private:
  // A thread's share of a slab's cells, whose triangles follow one another from the room of the first cell on.
  struct Share {
    std::size_t cells = 0;
    std::size_t triangles = 0;
  };
  // Front faces of consecutive cells of the order, on the card.
  struct Slab {
    Buffer vertices;
    std::vector<Share> shares;
  };
  // Of the cells that software draws next.
  struct Portion {
    Buffer vertices;
    Buffer ramps;  // RampVertex
  };

  bool keep_slabs() const { return keep(parts_.size()); }
  Slab& slab_at(std::size_t begin) { return slabs_[keep_slabs() ? begin / cells_per_slab : 0]; }
  void find_outside();
  void fill(Slab& slab, std::span<const Index> parts) const;
  static void draw_slab(const Slab& slab, std::size_t begin, std::size_t end);
  void draw_portions(std::span<const Index> parts, const UseProgram& use);
  void send_portion(const CellBatch& batch);

  const Scene& scene_;
  bool by_faces_;
  bool software_;
  std::unique_ptr<CellOrder> order_;
  std::unique_ptr<ScreenMesh> mesh_;
  std::vector<Index> parts_;  // in order
  std::size_t cells_ = 0;
  std::vector<Slab> slabs_;                  // all of the view's, or the one that is drawn
  std::vector<std::size_t> slab_numbers_;    // which of the view's each of them holds
  std::vector<std::size_t> slab_triangles_;  // of each of the view's slabs
  Portion portion_;
  DrawAhead ahead_;
  std::size_t triangles_ = 0;  // in portions
  std::size_t ramp_triangles_ = 0;
  Slab marked_;                      // of a repair
  std::vector<std::uint8_t> marks_;  // of each part, whether it is in it
  std::vector<Vec4f> outside_;       // column, row and w of ScreenVertex; nothing
  bool outside_sent_ = false;
  Buffer outside_buffer_;
  std::unique_ptr<MapRamps> ramps_;  // none: cells are integrated as the program does
  bool ramps_suit_ = false;          // enough of the cells
  bool rays_end_ = false;
  ColorMap ramps_map_;
  double ramps_alpha_length_ = 0.0;
  BufferTexture ramp_rows_;
};

}  // namespace atomesh::gl
