// Cells prepared by the processor: projected and clipped (screen_mesh.h), put in order (cell_order.h), and their front
// faces sent to the card.
#pragma once

#include <epoxy/gl.h>

#include <memory>
#include <span>
#include <vector>

#include "render/gl/cell_order.h"
#include "render/gl/objects.h"
#include "render/gl/prepared_cells.h"

namespace atomesh::gl {

class ProcessorCells final : public PreparedCells {
 public:
  // Keeps a reference to the scene. `by_faces` as CellOrder has it. `software`: draws in portions that suit it.
  ProcessorCells(const Scene& scene, bool by_faces, bool software)
      : scene_(scene), by_faces_(by_faces), software_(software) {}

  // These two leave OpenGL alone: another thread may call them.
  void project(const Camera& camera, const PixelGrid& grid, const ColorMap& color_map,
               const Progress& progress) override;
  void order(const Camera& camera, Progress& progress) override;
  const ScreenView& view() const override { return mesh_->view(); }
  std::size_t places() const override { return parts_.size(); }
  bool make_slab(std::size_t begin) override;
  std::size_t draw(std::size_t begin, std::size_t most) override;
  void draw_marked(const MarkedTiles& tiles, const Progress& progress) override;
  std::size_t cells() const override { return cells_; }
  std::size_t triangles() const override;

 private:
  // Front faces of consecutive cells of the order, on the card.
  struct Slab {
    Buffer vertices;
    std::size_t cells = 0;
    // vertices of each thread's share of the cells
    std::vector<GLint> first;
    std::vector<GLsizei> count;
  };

  Slab& slab_at(std::size_t begin) { return slabs_[keep(parts_.size()) ? begin / cells_per_slab : 0]; }
  void fill(Slab& slab, std::span<const Index> parts) const;
  void draw_cells(const Slab& slab, std::size_t begin, std::size_t end) const;

  const Scene& scene_;
  bool by_faces_;
  bool software_;
  std::unique_ptr<CellOrder> order_;
  std::unique_ptr<ScreenMesh> mesh_;
  std::vector<Index> parts_;  // in order
  std::size_t cells_ = 0;
  std::vector<Slab> slabs_;                // all of the view's, or the one that is drawn
  std::vector<std::size_t> slab_numbers_;  // which of the view's each of them holds
  std::vector<std::size_t> triangles_;     // of each of the view's slabs
  Slab marked_;                            // of a repair
};

}  // namespace atomesh::gl
