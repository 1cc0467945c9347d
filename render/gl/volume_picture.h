// Mode volume as a finished picture in somebody else's framebuffer: what render() gives, on the card.
#pragma once

#include <memory>
#include <optional>

#include "core/camera.h"
#include "core/parameters.h"
#include "core/progress.h"
#include "render/scene.h"

namespace atomesh::gl {

// How much of a picture is drawn.
struct PictureDetail {
  // One ray for so many × so many pixels, 1, 2, 4 or 8; those between are interpolated. Above 1 nothing is
  // supersampled.
  int stride = 1;
  bool operator==(const PictureDetail&) const = default;
};

// Throws UnavailableError where the context that is current was lost: the card was reset. Only contexts that were made
// to notify of it tell.
void require_living_context();

// Of one context, which is current whenever anything of it is called, the destructor included. OpenGL's state is left
// as it was found.
class VolumePicture {
 public:
  // Larger pictures are drawn in parts of at most so many rays along a side (and at most Volume::largest_side()).
  // Throws UnavailableError unless the driver is sufficient and takes the shaders.
  explicit VolumePicture(int part_side = 4096);
  ~VolumePicture();
  VolumePicture(const VolumePicture&) = delete;
  VolumePicture& operator=(const VolumePicture&) = delete;

  // What is drawn from now on: a scene of mode volume (UsageError for another). Its solids are drawn by the CPU
  // renderer, at the picture's own rays; those of a view that is drawn again are kept, as far as they take no more than
  // 512 MB.
  void set_scene(std::shared_ptr<const Scene> scene);
  const std::shared_ptr<const Scene>& scene() const { return scene_; }

  // Into the framebuffer that is bound, camera.width × camera.height pixels from its corner, background included:
  // colours premultiplied by their coverage, n × n rays a pixel (Parameters::supersampling) averaged. Waits for OpenGL
  // to finish. Throws as Volume::draw() does, and UnavailableError for a lost context; what is then in the framebuffer
  // is of no use, nor is this object.
  void draw(const Camera& camera, const Parameters& parameters, const PictureDetail& detail = {},
            Progress& progress = no_progress());

  // The same a little at a time, with the same bits: begin(), and proceed() until it returns true. Between the calls
  // OpenGL may be used for anything else. What was begun and not finished is dropped by the next begin(), draw() or
  // set_scene(), and by what is thrown. begin() throws UsageError where the picture cannot be, and leaves OpenGL alone.
  void begin(const Camera& camera, const Parameters& parameters, const PictureDetail& detail = {});
  // Goes on for about so many milliseconds, at least by one step, and waits for OpenGL; whether the picture is finished
  // (also where none is begun). Only then, or part by part where it has several, is it put into the framebuffer that is
  // bound, which has to be the same in all calls. Solids are drawn beside, by a thread
  // of their own, and so are cells projected and put in order where the processor does that; to repair is a step that
  // is not divided: 50 ms for a million cells.
  bool proceed(double milliseconds, Progress& progress = no_progress());

  // Drops what was begun and not finished; leaves OpenGL alone.
  void give_up();

  // Milliseconds of the picture that was begun last.
  struct Times {
    double cells = 0.0;   // projecting, sorting and sending them; 0 where the view was the one before
    double solids = 0.0;  // projecting and sorting what stands in the volume; 0 where it was kept
    double pixels = 0.0;  // OpenGL's, and the rays of what stands in the volume
  };
  const Times& last() const { return last_; }

 private:
  class Pipeline;  // OpenGL's own, whose header does not go with that of windows
  std::unique_ptr<Pipeline> pipeline_;
  // What is begun: the parts from `top` and `left` on are not finished.
  struct Begun {
    Camera camera;
    Parameters parameters;
    PictureDetail detail;
    int left = 0;
    int top = 0;
    std::size_t number = 0;  // of the first of them
    bool in_part = false;    // the first of them is begun
  };
  struct Layout;
  bool begin_part(const Begun& begun, const Layout& layout, double milliseconds, Progress& progress);
  void finish_part(const Begun& begun, const Layout& layout, unsigned target);

  std::shared_ptr<const Scene> scene_;
  std::optional<Begun> begun_;
  Times last_;
};

}  // namespace atomesh::gl
