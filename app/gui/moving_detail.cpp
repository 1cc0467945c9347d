#include "app/gui/moving_detail.h"

#include <algorithm>

namespace atomesh::gui {

void MovingDetail::drew_whole(const gl::VolumePicture::Times& times, int n) {
  // Of a view that was there before only the pixels are drawn anew.
  const double cells = times.cells > 0.0 ? times.cells : known_ ? whole_.cells : 0.0;
  whole_ = {cells, times.pixels};
  n_ = n;
  known_ = true;
}

gl::PictureDetail MovingDetail::next() const {
  if (!known_ || whole_.cells + whole_.pixels <= moving_budget) return {};
  // Beyond what the cells leave it nothing is gained by ever fewer pixels.
  const double left = std::max(moving_budget - whole_.cells, 0.25 * moving_budget);
  for (const int stride : {2, 4}) {
    if (whole_.pixels / (n_ * n_ * stride * stride) <= left) return {.stride = stride};
  }
  return {.stride = 8};
}

}  // namespace atomesh::gui
