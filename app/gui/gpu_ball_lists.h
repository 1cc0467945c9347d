// Balls that are not opaque, all layers of them at once: by lists of each pixel's hits, which OpenGL 4.5 can keep.
#pragma once

#include <cstddef>

#include "app/gui/gpu_buffers.h"
#include "app/gui/gpu_drawing.h"

namespace atomesh::gui {

// Balls on the card, as a texture of their numbers (9 each, as in struct Ball).
struct GpuBallPart {
  unsigned buffer = 0;
  unsigned texture = 0;
  int first = 0;  // in the scene
  int count = 0;
};

inline constexpr int vertices_of_a_ball = 6;  // two triangles around its outline

// The hits of the whole picture, or of a band of it after the other where there is no room for them. (Peeling layer
// behind layer needs no lists, but draws all balls again for each.)
class GpuBallLists {
 public:
  GpuBallLists();

  // Whether the context can.
  static bool possible();
  // Composes into `light`, which is empty, what is seen of the balls that are not opaque before the nearest opaque ones
  // (`nearest_opaque`). `heads` is written over. False, with the light half done, where there is no room for the hits
  // of a single row.
  bool compose(vtkOpenGLRenderWindow& window, const GpuView& view, const GpuBallPart& balls, unsigned no_attributes,
               const GpuTarget& nearest_opaque, const GpuTarget& heads, const GpuTarget& light);
  // Bytes of hits that are kept at most.
  void set_room(std::size_t bytes) { most_bytes_ = bytes; }
  void release();

 private:
  struct Band {
    int bottom = 0;  // rows from below
    int height = 0;
  };
  // The band's hits into lists; returns how many there are, more perhaps than there is room for.
  std::size_t collect(vtkOpenGLRenderWindow& window, const GpuView& view, const GpuBallPart& balls,
                      const GpuTarget& nearest_opaque, const GpuTarget& heads, const GpuTarget& light,
                      const Band& band);
  // And composed; what was bound for collecting still is.
  void shade(vtkOpenGLRenderWindow& window, const GpuView& view);
  // Makes room for so many hits, or for as many as can be.
  void make_room(std::size_t hits);

  GpuProgram list_program_;
  GpuProgram shading_program_;
  std::size_t most_bytes_ = GpuLimits().list_bytes;
  std::size_t room_ = 0;  // hits
  unsigned hits_ = 0;     // a buffer
  unsigned used_ = 0;     // a counter
  int rows_ = 0;          // of a band, as it went last time
};

}  // namespace atomesh::gui
