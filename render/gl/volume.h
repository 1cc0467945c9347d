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
#include "render/gl/beside.h"
#include "render/gl/card_cells.h"
#include "render/gl/context.h"
#include "render/gl/objects.h"
#include "render/gl/order_repair.h"
#include "render/gl/preintegration_table.h"
#include "render/gl/processor_cells.h"
#include "render/pixel_lattice.h"
#include "render/renderer.h"
#include "render/scene.h"

namespace atomesh::gl {

// What the last picture was made of.
struct VolumeStats {
  std::size_t cells = 0;           // drawn: not transparent, not beside the picture
  std::size_t triangles = 0;       // front faces of theirs
  std::size_t ramp_triangles = 0;  // of these, what is drawn as a sum of ramps (map_ramps.h)
  double project_ms = 0.0;         // vertices, which cells
  double order_ms = 0.0;
  double faces_ms = 0.0;  // front faces, handed to OpenGL; software's are part of the next
  double draw_ms = 0.0;   // OpenGL
  RepairStats repair;     // of pixels whose cells came in a wrong order
  // Prepared by the card; the first three times are then of what is asked of it, and the fourth has its work.
  bool on_card = false;
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

  // Before set_scene(): whether the card prepares cells by itself (card_cells.h) where it can: where none has to be
  // clipped, and its memory suffices. They are ordered by their keys alone then. By itself all drivers but software do,
  // unless order by faces is asked for.
  void set_prepare_on_card(bool on_card) { prepare_on_card_ = on_card; }

  // For measuring: whether OpenGL is waited for after each step, so that VolumeStats' times are what the step takes and
  // not how long it takes to ask a graphics card for it.
  void set_timed_steps(bool timed) { timed_steps_ = timed; }

  // Draws the lattice's pixels of the window, as a picture of their own; neither side more than largest_side(). What
  // was found for the same view is used again: the cells are not projected and sorted anew when nothing but colours
  // changes. Adds to `stats`; waits for OpenGL to finish. Throws CancelledError, UnavailableError (no memory, a lost
  // context). `ray_ends`: of each of these pixels the depth where its ray ends (Channels::ray_end); empty where none
  // does.
  void draw(const Camera& camera, const Parameters& parameters, const PixelWindow& window, const PixelLattice& lattice,
            RenderStats& stats, Progress& progress, std::span<const float> ray_ends = {});

  // The same a little at a time, with the same bits: begin(), and proceed() until it returns true. Between the calls
  // OpenGL may be used for anything else. What was begun and not finished is dropped by the next begin(), draw() or
  // set_scene(), and by what is thrown. begin() keeps copies of what it is given, and leaves OpenGL and texture()
  // alone.
  void begin(const Camera& camera, const Parameters& parameters, const PixelWindow& window, const PixelLattice& lattice,
             std::span<const float> ray_ends = {});
  // Goes on for about so many milliseconds, at least by one step, and waits for OpenGL; whether the picture is finished
  // (also where none is begun). Cells are drawn in portions that fit the time; where the processor projects them and
  // puts them in order, a thread of its own does; repairing is a step that is not divided. Until then texture() has the
  // cells in front, or what it had before.
  bool proceed(double milliseconds, RenderStats& stats, Progress& progress);
  // Drops what was begun and not finished; leaves OpenGL alone.
  void give_up();

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
  // A picture that is begun.
  struct Begun {
    Camera camera;
    Parameters parameters;
    PixelGrid grid;
    std::vector<float> ray_ends;
    // what comes next
    enum class Step { project, order, clear, draw, check, repair, done } step = Step::project;
    bool beside = false;         // a thread of its own projects cells and puts them in order
    std::size_t drawn = 0;       // places of the order
    double places_per_ms = 0.0;  // of the last portion; 0: none yet
    double drawing_ms = 0.0;
  };
  struct Pace;

  // The same for both projections.
  struct Programs {
    Program perspective;
    Program parallel;
  };

  bool same_view(const Camera& camera, const PixelGrid& grid, const Parameters& parameters) const;
  void step(Begun& begun, const Pace& pace, Progress& progress);
  // Whether there is anything to draw.
  bool project(Begun& begun, const Pace& pace, const Progress& progress);
  bool project_on_card(const Begun& begun, const Progress& progress);
  // Whether it is done.
  bool order(const Begun& begun, const Pace& pace, Progress& progress);
  void clear(const Begun& begun);
  void draw_portion(Begun& begun, const Pace& pace, Progress& progress);
  void wait_if_timed() const;
  void check_outside();
  void repair(const Progress& progress);
  Programs make_programs(std::string_view vertex_file, std::string_view fragment_file,
                         std::vector<std::string> defines) const;
  // Whether cells that suit it are drawn as sums of ramps (map_ramps.h).
  bool by_ramps(const Parameters& parameters) const;
  // Whether the table is to be used, which is then ready.
  bool make_table(const Parameters& parameters);
  void choose_programs(bool table, bool rays_end);
  void make_repair(const HavsParameters& parameters);
  void end_rays(std::span<const float> ray_ends);
  void resize(int columns, int rows);
  void bind_picture() const;
  static void set_blending();
  static void set_order_check(bool on);
  Programs& blend(CellKind kind) { return blend_[static_cast<std::size_t>(kind)]; }
  void use(const Programs& programs) const;

  Driver driver_;
  int largest_side_ = 0;
  int viewport_side_ = 0;
  const Scene* scene_ = nullptr;
  std::optional<bool> by_faces_;
  bool timed_steps_ = false;
  std::optional<bool> prepare_on_card_;
  std::optional<View> view_;
  std::unique_ptr<ProcessorCells> processor_cells_;  // of the scene, once it is needed
  std::unique_ptr<CardCells> card_cells_;            // of the scene
  bool card_fails_ = false;                          // for this scene
  PreparedCells* cells_ = nullptr;                   // those of the view
  PreintegrationTable table_;
  double longest_segment_ = 0.0;  // Å; of the scene, 0 while unknown
  Texture ray_ends_;
  // The programs look segments up in the table; ask for where rays end.
  bool with_table_ = false;
  bool with_ray_ends_ = false;
  std::array<Programs, cell_kinds> blend_;  // those of sums of ramps once they are needed
  Programs outside_;                        // depths alone
  std::unique_ptr<OrderRepair> repair_;
  Programs gather_;  // of repair_
  VertexArray vertex_array_;
  Framebuffer framebuffer_;
  Texture color_;
  Texture depth_;
  int columns_ = 0;
  int rows_ = 0;
  VolumeStats last_;
  std::optional<Begun> begun_;
  struct Prepared {
    double project_ms = 0.0;
    double order_ms = 0.0;
  } prepared_;
  Beside preparing_;  // processor_cells_ and prepared_; goes first
};

}  // namespace atomesh::gl
