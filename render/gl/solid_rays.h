// What stands in a volume (Scene::solids) as the rays of the volume's picture meet it: drawn by the CPU renderer, as
// the renderer "havs" has it.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/parameters.h"
#include "core/progress.h"
#include "render/gl/beside.h"
#include "render/pixel_lattice.h"
#include "render/scene.h"

namespace atomesh::gl {

// Which rays, and all else that the solids' picture depends on.
struct SolidView {
  Camera camera;  // of rays
  Parameters parameters;
  PixelWindow window;
  PixelLattice lattice;
};

// Whether the same solids look the same in both: they know nothing of the volume's own parameters.
bool same_solids(const SolidView& a, const SolidView& b);

// Of the lattice's pixels in the window, row-major.
struct SolidRays {
  std::vector<Vec4f> colors;  // premultiplied RGB and coverage, 0 where the ray meets nothing
  std::vector<float> ends;    // depth of what it meets, infinity where nothing (Channels::ray_end)
  double setup_ms = 0.0;      // projecting and sorting what stands there
  double render_ms = 0.0;     // the rays
};

// Its end cancels what is drawn and waits for that.
class SolidDrawing {
 public:
  // Of a scene of mode atoms or surface. Returns when it is done. Throws CancelledError.
  SolidRays draw(const Scene& solids, const SolidView& view, Progress& progress);
  // The same for who has only so many milliseconds: nothing where it is not done by then; it goes on beside the caller,
  // who asks again. What is asked for another view, of solids or of draw() takes its place. Infinitely many draw at
  // once.
  std::optional<SolidRays> proceed(const std::shared_ptr<const Scene>& solids, const SolidView& view,
                                   double milliseconds, Progress& progress);
  // Gives up what goes on beside the caller, without waiting for its end.
  void cancel();
  // The same, and waits. Between pictures of few rays the memory for all of a window's is kept; this gives it back.
  void forget();

 private:
  // What goes on beside.
  struct Task {
    std::shared_ptr<const Scene> solids;
    SolidView view;
    SolidRays rays;  // when it is over
  };
  SolidRays draw_now(const Scene& solids, const SolidView& view, Progress& progress);

  Image image_;
  std::vector<float> depth_;
  Task task_;
  Beside beside_;  // goes first
};

}  // namespace atomesh::gl
