#include "app/gui/moving_detail.h"

#include <algorithm>

namespace atomesh::gui {

void MovingDetail::drew_whole(const gl::VolumePicture::Times& times, int n) {
  // Of a view that was there before only the pixels are drawn anew.
  const auto last = [this](double gl::VolumePicture::Times::*part) { return known_ ? whole_.*part : 0.0; };
  whole_ = {times.cells > 0.0 ? times.cells : last(&gl::VolumePicture::Times::cells),
            times.solids > 0.0 ? times.solids : last(&gl::VolumePicture::Times::solids), times.pixels};
  if (n != n_ || !known_) stride_ = 0;
  n_ = n;
  known_ = true;
}

void MovingDetail::drew_moving(const gl::VolumePicture::Times& times, const Detail& detail) {
  stride_ = detail.stride;
  const double but_pixels = times.cells + times.solids;
  if (but_pixels + times.pixels > moving_budget) {
    stride_ = std::min(2 * stride_, 8);
  } else if (stride_ > 1) {
    // Half the stride is four times the rays; none left out, n × n times.
    const double more = stride_ == 2 ? 4.0 * n_ * n_ : 4.0;
    if (but_pixels + more * times.pixels <= moving_budget) stride_ /= 2;
  }
}

Detail MovingDetail::next() const {
  if (!known_ || whole_.cells + whole_.solids + whole_.pixels <= moving_budget) return {};
  Detail detail;
  // Solids are there always; but where they take all of the time, the others have half of it all the same.
  const double budget = std::max(0.5 * moving_budget, moving_budget - whole_.solids);
  // Half of the time is the cells', half the pixels'; what one does not need the other has.
  const double for_cells = std::max(0.5 * budget, budget - whole_.pixels);
  if (whole_.cells > for_cells) detail.cells = std::max(for_cells / whole_.cells, 1e-3);
  const double for_pixels = budget - std::min(whole_.cells, for_cells);
  if (stride_ > 0) {
    detail.stride = stride_;
    return detail;
  }
  double pixels = whole_.pixels;
  while (pixels > for_pixels && detail.stride < 8) {
    detail.stride *= 2;
    pixels = whole_.pixels / (n_ * n_ * detail.stride * detail.stride);
  }
  return detail;
}

}  // namespace atomesh::gui
