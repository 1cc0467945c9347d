#include "render/canvas.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace atomesh {

namespace {

// Pixels whose centres are from `low` to `high`, within [begin, end).
std::pair<int, int> pixels_between(double low, double high, int begin, int end) {
  const double first = std::clamp(std::ceil(low - 0.5), 1.0 * begin, 1.0 * end);
  const double last = std::clamp(std::floor(high - 0.5) + 1.0, 1.0 * begin, 1.0 * end);
  return {static_cast<int>(first), static_cast<int>(last)};
}

double distance_to_segment(const CanvasPoint& p, const CanvasPoint& a, const CanvasPoint& b) {
  const CanvasPoint along = b - a;
  const double square = glm::dot(along, along);
  const double t = square > 0.0 ? std::clamp(glm::dot(p - a, along) / square, 0.0, 1.0) : 0.0;
  return glm::length(p - a - t * along);
}

bool finite(const CanvasPoint& p) {
  return std::isfinite(p.x) && std::isfinite(p.y);
}

}  // namespace

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

void Canvas::stroke(std::span<const CanvasPoint> points, bool closed, double width, const Vec4f& color) {
  if (points.empty() || !std::all_of(points.begin(), points.end(), finite)) return;
  const double reach = 0.5 * width + 0.5;  // where the coverage has come down to 0
  const CanvasBox all = clipped({0, 0, image_.width, first_row_ + image_.height});
  double top = std::numeric_limits<double>::infinity();
  double bottom = -top;
  for (const CanvasPoint& p : points) {
    top = std::min(top, p.y);
    bottom = std::max(bottom, p.y);
  }
  const auto [first_row, last_row] = pixels_between(top - reach, bottom + reach, all.top, all.bottom);
  const std::size_t segments = closed || points.size() == 1 ? points.size() : points.size() - 1;
  std::vector<double> distance(static_cast<std::size_t>(image_.width));
  for (int row = first_row; row < last_row; ++row) {
    int from = image_.width;  // columns that a segment comes near to
    int to = 0;
    const double y = row + 0.5;
    for (std::size_t s = 0; s < segments; ++s) {
      const CanvasPoint& a = points[s];
      const CanvasPoint& b = points[(s + 1) % points.size()];
      if (std::min(a.y, b.y) - reach > y || std::max(a.y, b.y) + reach < y) continue;
      // Of the segment, the part that is within reach of the row, and as far to its sides.
      double begin = 0.0;
      double end = 1.0;
      if (a.y != b.y) {
        const double t = (y - reach - a.y) / (b.y - a.y);
        const double u = (y + reach - a.y) / (b.y - a.y);
        begin = std::clamp(std::min(t, u), 0.0, 1.0);
        end = std::clamp(std::max(t, u), 0.0, 1.0);
      }
      const double p = a.x + begin * (b.x - a.x);
      const double q = a.x + end * (b.x - a.x);
      const auto [first, last] = pixels_between(std::min(p, q) - reach, std::max(p, q) + reach, 0, image_.width);
      if (first >= last) continue;
      // What lies between two stretches is covered by neither.
      const auto infinite = std::numeric_limits<double>::infinity();
      for (int column = first; column < std::min(from, last); ++column) distance[column] = infinite;
      for (int column = std::max(to, first); column < last; ++column) distance[column] = infinite;
      if (from < to) {
        for (int column = last; column < from; ++column) distance[column] = infinite;
        for (int column = to; column < first; ++column) distance[column] = infinite;
      }
      from = std::min(from, first);
      to = std::max(to, last);
      for (int column = first; column < last; ++column) {
        distance[column] = std::min(distance[column], distance_to_segment({column + 0.5, y}, a, b));
      }
    }
    for (int column = from; column < to; ++column) {
      const double covered = std::clamp(0.5 * width - distance[column] + 0.5, 0.0, 1.0);
      // Lines thinner than a pixel are fainter.
      if (covered > 0.0) blend(column, row, color, static_cast<float>(covered * std::min(1.0, width)));
    }
  }
}

void Canvas::fill_convex(std::span<const CanvasPoint> corners, const Vec4f& color) {
  if (corners.size() < 3 || !std::all_of(corners.begin(), corners.end(), finite)) return;
  CanvasPoint low = corners[0];
  CanvasPoint high = corners[0];
  double area = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const CanvasPoint& a = corners[i];
    const CanvasPoint& b = corners[(i + 1) % corners.size()];
    low = glm::min(low, a);
    high = glm::max(high, a);
    area += 0.5 * (a.x * b.y - a.y * b.x);
  }
  const double sense = area < 0.0 ? -1.0 : 1.0;
  const CanvasBox all = clipped({0, 0, image_.width, first_row_ + image_.height});
  const auto [top, bottom] = pixels_between(low.y - 0.5, high.y + 0.5, all.top, all.bottom);
  const auto [left, right] = pixels_between(low.x - 0.5, high.x + 0.5, all.left, all.right);
  for (int row = top; row < bottom; ++row) {
    for (int column = left; column < right; ++column) {
      const CanvasPoint p(column + 0.5, row + 0.5);
      double inside = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const CanvasPoint& a = corners[i];
        const CanvasPoint edge = corners[(i + 1) % corners.size()] - a;
        const double length = glm::length(edge);
        if (length > 0.0) inside = std::min(inside, sense * (edge.x * (p.y - a.y) - edge.y * (p.x - a.x)) / length);
      }
      if (inside > -0.5) blend(column, row, color, static_cast<float>(std::clamp(inside + 0.5, 0.0, 1.0)));
    }
  }
}

}  // namespace atomesh
