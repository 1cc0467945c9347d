#include "app/gui/moving_detail.h"

#include <algorithm>

namespace atomesh::gui {

namespace {

// Of a volume of which nothing is known: milliseconds to project and sort a cell, two cores.
constexpr double guessed_ms_per_cell = 2e-4;

}  // namespace

void MovingDetail::expect(double cells, double rays, bool solids) {
  if (known_ && cells_ > 0.0) whole_.cells *= cells / cells_;
  if (known_ && rays_ > 0.0) whole_.pixels *= rays / rays_;
  if (!solids) whole_.solids = 0.0;
  cells_ = cells;
  rays_ = rays;
}

void MovingDetail::gave_up_whole(double ms) {
  whole_.pixels = std::max(whole_.pixels, 2.0 * ms);
}

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
  Detail detail;
  if (!known_) {
    const double most = 0.5 * moving_budget / guessed_ms_per_cell;
    detail.stride = 8;
    if (cells_ > most) detail.cells = std::max(most / cells_, 1e-3);
    return detail;
  }
  if (whole_.cells + whole_.solids + whole_.pixels <= moving_budget) return {};
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
  if (detail.whole()) detail.stride = 2;  // all of it is too much
  return detail;
}

}  // namespace atomesh::gui
