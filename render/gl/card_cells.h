// Cells prepared by the card alone: from frame to frame nothing but the camera is sent, and nothing waits for the card.
//
// Vertices are projected and snapped (as ScreenMesh does, in double), the cells that are not transparent put in order
// by their keys (CardOrder; those that share a sphere by their faces, cell_clusters.h), and the front faces of
// consecutive ones written as vertices, with the commands that draw them. Whatever decides is computed in the same
// steps as on the processor; signs of areas are exact. Cells beside the picture have no faces. For views in which some
// cell has to be clipped there is ProcessorCells.
//
// Bytes on the card, V vertices and N cells: 32 V + 52 N (28 N more where all cells are of clusters), and 288 N of
// faces, for up to kept_bytes of them. Read and written for a new view: 32 V projecting; 32 N putting clusters in
// order; 28 N of keys, 24 × 8 N sorting them; 88 N gathered and 192 N (two faces each on average) written for faces,
// and as much read to draw them. Of a million cells and 170,000 vertices 0.73 GB: 1.5 ms at 500 GB/s; what fills pixels
// comes on top. 300 operations in double a cell: 2 ms on cards that do 150 G/s.
#pragma once

#include <epoxy/gl.h>

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/color_map.h"
#include "render/gl/cell_clusters.h"
#include "render/gl/objects.h"
#include "render/gl/prepared_cells.h"
#include "render/gl/radix_sort.h"

namespace atomesh::gl {

class CardCells final : public PreparedCells {
 public:
  // Keeps a reference to the scene, which has cells. `guard` as ScreenView has it; slabs are kept up to `kept` bytes.
  // Throws UnavailableError when the driver does not take a shader or has not the memory.
  CardCells(const Scene& scene, int guard, std::size_t kept = kept_bytes);

  // Whether nothing has to be clipped: every vertex is before ScreenView::near and within the guard.
  bool fits(const Camera& camera, const PixelGrid& grid) const;

  void project(const Camera& camera, const PixelGrid& grid, const ColorMap& color_map,
               const Progress& progress) override;
  void order(const Camera& camera, Progress& progress) override;
  const ScreenView& view() const override { return view_; }
  // Those of the cells that are not transparent.
  std::size_t places() const override { return places_; }
  bool make_slab(std::size_t begin) override;
  std::size_t draw(std::size_t begin, std::size_t most, const UseProgram& use) override;
  void draw_marked(const MarkedTiles& tiles, const Progress& progress) override;
  std::size_t cells() const override { return read_totals().cells; }
  std::size_t triangles() const override { return read_totals().triangles; }

  // What is on the card: ScreenVertex of each vertex, KeyedCell of each place.
  const Buffer& projected() const { return projected_; }
  const Buffer& keyed() const { return order_->order(); }
  // Vertices of the slab with this place, group after group; it has been made.
  std::vector<FaceVertex> faces(std::size_t begin) const;

 private:
  // Of front_faces.comp: the parameters of glMultiDrawArraysIndirect, and what is counted beside.
  struct Command {
    GLuint count, instances, first, first_instance;
    GLuint cells;  // that meet a pixel
  };
  struct Totals {
    std::size_t cells, triangles;
  };

  std::array<Vec3, 8> box_before_eye(const Camera& camera) const;
  void find_candidates(const ColorMap& color_map, const Progress& progress);
  void order_clusters(const Camera& camera) const;
  void reserve_slabs();
  const Buffer& slab_at(std::size_t begin) const;
  void make_faces(const Program& program, std::size_t begin, std::size_t end, const Buffer& faces,
                  const Buffer& commands, std::size_t first_command) const;
  static void draw_commands(const Buffer& faces, const Buffer& commands, std::size_t first, std::size_t count);
  Totals read_totals() const;

  const Scene& scene_;
  const int guard_;
  const std::size_t kept_;
  std::size_t largest_storage_ = 0;  // bytes that a storage buffer may have
  Bounds bounds_;                    // of the vertices, about Scene::center
  Program project_;
  Program faces_;
  Program marked_faces_;
  Program cluster_order_;
  std::optional<CardOrder> order_;
  CellClusters clusters_;
  std::vector<std::uint8_t> clustered_;  // whether a cell is of one
  Buffer cluster_starts_, cluster_cells_, cluster_planes_, cluster_pairs_;
  Buffer blocks_;  // where each cluster's cells are among the candidates, and which of them
  Buffer vertices_;
  Buffer tetrahedra_;
  Buffer projected_;
  std::optional<ColorMap> color_map_;  // of which the candidates are
  Buffer candidates_;                  // cells that are not transparent: those of a cluster one behind another
  std::size_t places_ = 0;
  ScreenView view_;
  std::vector<Buffer> slabs_;              // all of the view's, or two in turn
  std::vector<std::size_t> slab_numbers_;  // which of the view's each of them holds
  Buffer commands_;                        // of the view
  mutable std::optional<Totals> totals_;   // of the view, once they were asked for
  Buffer tiles_;                           // of a repair, and what is drawn for it
  std::array<Buffer, 2> marked_;
  Buffer marked_commands_;
};

}  // namespace atomesh::gl
