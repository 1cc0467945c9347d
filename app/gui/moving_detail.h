// How much of the volume the card draws while the view moves: as much as is done in time; at rest, all.
#pragma once

#include "render/gl/volume_picture.h"

namespace atomesh::gui {

// Milliseconds for a picture of a view that moves; who takes no longer is drawn whole.
inline constexpr double moving_budget = 33.0;

class MovingDetail {
 public:
  // Another scene, size or number of rays: nothing is known of how long a picture takes.
  void forget() { known_ = false; }
  // A whole picture took so long, of n × n rays a pixel.
  void drew_whole(const gl::VolumePicture::Times& times, int n);
  // For the next picture of a view that moves.
  gl::PictureDetail next() const;

 private:
  bool known_ = false;
  gl::VolumePicture::Times whole_;
  int n_ = 1;
};

}  // namespace atomesh::gui
