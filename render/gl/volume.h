// Mode volume on OpenGL: every ray's segment in every cell as a fragment, front to back, composed by blending.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/parameters.h"
#include "core/progress.h"
#include "render/gl/cell_order.h"
#include "render/gl/context.h"
#include "render/gl/objects.h"
#include "render/gl/order_repair.h"
#include "render/gl/preintegration_table.h"
#include "render/gl/screen_mesh.h"
#include "render/pixel_lattice.h"
#include "render/renderer.h"
#include "render/scene.h"

namespace atomesh::gl {

// What the last picture was made of.
struct VolumeStats {
  std::size_t cells = 0;      // drawn: not transparent, not beside the picture
  std::size_t triangles = 0;  // front faces of theirs
  double project_ms = 0.0;    // vertices, which cells
  double order_ms = 0.0;
  double faces_ms = 0.0;  // front faces, handed to OpenGL
  double draw_ms = 0.0;   // OpenGL
  RepairStats repair;     // of pixels whose cells came in a wrong order
};

// Of one context, which is current whenever anything of it is called, the destructor included.
// OpenGL's state is left as it was found.
class Volume {
 public:
  // Throws UnavailableError unless the driver is sufficient and takes the shaders.
  Volume();

  // What is drawn from now on: a scene of mode volume. Keeps a reference; what was prepared for another is dropped.
  void set_scene(const Scene& scene);

  // Before set_scene(): whether cells are put in order by the faces they share; else by their keys alone, which is what
  // repairs are measured on. By itself it does what is faster on the driver.
  void set_order_by_faces(bool by_faces) { by_faces_ = by_faces; }

  // Draws the lattice's pixels of the window, as a picture of their own; neither side more than largest_side(). What
  // was found for the same view is used again: the cells are not projected and sorted anew when nothing but colours
  // changes. Adds to `stats`; waits for OpenGL to finish. Throws CancelledError, UnavailableError (no memory, a lost
  // context). `ray_ends`: of each of these pixels the depth where its ray ends (Channels::ray_end); empty where none
  // does.
  void draw(const Camera& camera, const Parameters& parameters, const PixelWindow& window, const PixelLattice& lattice,
            RenderStats& stats, Progress& progress, std::span<const float> ray_ends = {});

  int largest_side() const { return largest_side_; }
  const VolumeStats& last() const { return last_; }
  const PreintegrationTable::Stats& table() const { return table_.stats(); }
  // What was drawn last: RGBA32F, premultiplied RGB and coverage, the picture's upper row first (at texture coordinate
  // 0). The texture may be larger than the picture, which begins at (0, 0).
  const Texture& texture() const { return color_; }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  Image read() const;

 private:
  // Everything that depends on where cells are seen.
  struct View {
    Camera camera;
    PixelGrid grid;
    ColorMap color_map;  // transparent cells are left out
  };
  // Front faces of consecutive cells of the order, on the card.
  struct Slab {
    Buffer vertices;
    std::vector<GLint> first;
    std::vector<GLsizei> count;
  };

  // The same for both projections.
  struct Programs {
    Program perspective;
    Program parallel;
  };

  bool same_view(const Camera& camera, const PixelGrid& grid, const Parameters& parameters) const;
  void find_cells(const Camera& camera, const PixelGrid& grid, const Parameters& parameters, const Progress& progress);
  Programs make_programs(std::string_view fragment_file, std::vector<std::string> defines) const;
  // Whether the table is to be used, which is then ready.
  bool make_table(const Parameters& parameters);
  void choose_programs(bool table, bool rays_end);
  void make_repair(const HavsParameters& parameters);
  void end_rays(std::span<const float> ray_ends);
  void fill(Slab& slab, std::span<const Index> parts);
  void resize(int columns, int rows);
  void clear_picture() const;
  static void set_blending(bool check_order);
  void use(const Programs& programs) const;
  void draw_slab(const Slab& slab) const;
  // Calls after(n of all) after each slab.
  template <class After>
  void draw_slabs(After&& after);
  void draw_marked(const Progress& progress);

  Driver driver_;
  int largest_side_ = 0;
  int viewport_side_ = 0;
  const Scene* scene_ = nullptr;
  std::optional<bool> by_faces_;
  std::optional<View> view_;
  std::unique_ptr<CellOrder> order_;
  std::unique_ptr<ScreenMesh> mesh_;
  PreintegrationTable table_;
  std::vector<Index> parts_;  // in order
  std::vector<Slab> slabs_;
  bool slabs_kept_ = false;       // slabs_ hold all parts
  Slab marked_;                   // of a repair
  double longest_segment_ = 0.0;  // Å; of the scene, 0 while unknown
  Texture ray_ends_;
  // The programs look segments up in the table; ask for where rays end.
  bool with_table_ = false;
  bool with_ray_ends_ = false;
  Programs blend_;
  std::unique_ptr<OrderRepair> repair_;
  Programs gather_;  // of repair_
  VertexArray vertex_array_;
  Framebuffer framebuffer_;
  Texture color_;
  Texture depth_;
  int columns_ = 0;
  int rows_ = 0;
  VolumeStats last_;
};

}  // namespace atomesh::gl
