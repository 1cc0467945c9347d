// How much of the volume the card draws while the view moves: as much as is done in time; at rest, all.
#pragma once

#include "render/gl/volume_picture.h"

namespace atomesh::gui {

// Milliseconds for a picture of a view that moves; who takes no longer is drawn whole.
inline constexpr double moving_budget = 33.0;

struct Detail {
  int stride = 1;      // gl::PictureDetail::stride
  double cells = 1.0;  // so large a part of them (gl::coarse_volume())
  bool whole() const { return stride == 1 && cells == 1.0; }
  bool operator==(const Detail&) const = default;
};

class MovingDetail {
 public:
  // The next pictures are of a volume of so many cells, whole with so many rays, with or without something in it. Of
  // one of which nothing is known little is drawn; what is known of another is taken to hold for each cell and ray.
  void expect(double cells, double rays, bool solids);
  // A whole picture was not done after so many milliseconds.
  void gave_up_whole(double ms);
  // A picture of a view that moves took so long: the next may have more rays, or fewer.
  void drew_moving(const gl::VolumePicture::Times& times, const Detail& detail);
  // A whole picture took so long, of n × n rays a pixel.
  void drew_whole(const gl::VolumePicture::Times& times, int n);
  // For the next picture of a view that moves.
  Detail next() const;

 private:
  bool known_ = false;
  double cells_ = 0.0;
  double rays_ = 0.0;
  gl::VolumePicture::Times whole_;
  int n_ = 1;
  int stride_ = 0;  // as drew_moving() found; 0 where it was not called since
};

}  // namespace atomesh::gui
