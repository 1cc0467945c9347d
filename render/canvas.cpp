#include "render/canvas.h"

#include <algorithm>
#include <cmath>

namespace atomesh {

void Canvas::blend(int column, int row, const Vec4f& color, float coverage) {
  const CanvasBox here = clipped({column, row, column + 1, row + 1});
  if (here.width() <= 0 || here.height() <= 0) return;
  const float above = color.a * coverage;
  if (above <= 0.0F) return;
  Vec4f& pixel = image_.at(column, row - first_row_);
  const float below = pixel.a * (1.0F - above);
  const float opacity = above + below;
  pixel = Vec4f((Vec3f(color) * above + Vec3f(pixel) * below) / opacity, opacity);
}

void Canvas::set(int column, int row, const Vec4f& color) {
  const CanvasBox here = clipped({column, row, column + 1, row + 1});
  if (here.width() > 0 && here.height() > 0) image_.at(column, row - first_row_) = color;
}

CanvasBox Canvas::clipped(const CanvasBox& box) const {
  return {std::max(box.left, 0), std::max(box.top, first_row_), std::min(box.right, image_.width),
          std::min(box.bottom, first_row_ + image_.height)};
}

void Canvas::fill(const CanvasBox& box, const Vec4f& color) {
  fill_rounded(box, 0.0, color);
}

void Canvas::fill_rounded(const CanvasBox& box, double radius, const Vec4f& color) {
  const CanvasBox here = clipped(box);
  const double round = std::min(radius, 0.5 * std::min(box.width(), box.height()));
  // How far the pixel's centre lies within the straight part of the box, along one axis; below 0 in a corner.
  const auto beyond = [round](int pixel, int begin, int end) {
    const double from_edge = std::min(pixel + 0.5 - begin, end - (pixel + 0.5));
    return std::max(0.0, round - from_edge);
  };
  for (int row = here.top; row < here.bottom; ++row) {
    const double dy = beyond(row, box.top, box.bottom);
    for (int column = here.left; column < here.right; ++column) {
      const double dx = beyond(column, box.left, box.right);
      const double outside = round > 0.0 ? std::hypot(dx, dy) - round : -1.0;
      blend(column, row, color, static_cast<float>(std::clamp(0.5 - outside, 0.0, 1.0)));
    }
  }
}

void Canvas::frame(const CanvasBox& box, int thickness, const Vec4f& color) {
  const int t = thickness;
  fill({box.left - t, box.top - t, box.right + t, box.top}, color);
  fill({box.left - t, box.bottom, box.right + t, box.bottom + t}, color);
  fill({box.left - t, box.top, box.left, box.bottom}, color);
  fill({box.right, box.top, box.right + t, box.bottom}, color);
}

}  // namespace atomesh
