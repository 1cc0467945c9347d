#include "render/tripod.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/legend_drawing.h"
#include "render/text_raster.h"

namespace atomesh {

namespace {

// Of arrows of length 1: letters stand beyond their ends.
constexpr double arrow_ems = 2.6;
constexpr double letter_ems = 0.8;
constexpr double head_half = 0.3;  // half the head's width, ems
constexpr double head_part = 0.3;  // of the arrow's length
// Sine of an angle that nobody sees.
constexpr double same_direction = 0.005;

const std::array<Vec3f, 3> axis_colors{Vec3f(0.86F, 0.16F, 0.14F), Vec3f(0.13F, 0.58F, 0.18F),
                                       Vec3f(0.18F, 0.40F, 0.90F)};

// Towards the ink, so that blue is read on black too.
Vec3f on_paper(const Vec3f& color, const OverlayColors& colors) {
  return colors.paper.r < 0.5F ? glm::mix(color, Vec3f(colors.ink), 0.3F) : color;
}

}  // namespace

std::vector<std::vector<TripodArrow>> make_tripods(const std::optional<UnitCell>& cell) {
  std::vector<TripodArrow> axes;
  std::vector<TripodArrow> vectors;
  bool differ = false;
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3 axis(0.0);
    axis[static_cast<int>(k)] = 1.0;
    axes.push_back({std::string(1, "xyz"[k]), axis, axis_colors[k]});
    if (!cell || !(glm::length(cell->primitive[k]) > 0.0)) continue;
    const Vec3 direction = glm::normalize(cell->primitive[k]);
    vectors.push_back({std::string(1, "abc"[k]), direction, axis_colors[k]});
    differ = differ || glm::length(direction - axis) > same_direction;
  }
  if (!differ) return {axes};
  return {axes, vectors};
}

TripodDrawing::TripodDrawing(const Camera& camera, const Vec4f& background,
                             const std::vector<std::vector<TripodArrow>>& tripods, int bottom)
    : size_(overlay_text_size(camera.width, camera.height)) {
  const OverlayColors colors = overlay_colors(background);
  paper_ = colors.paper;
  const double margin = 0.8 * size_;
  const double reach = (arrow_ems + 1.6 * letter_ems) * size_;  // from a tripod's middle, with its letters
  const double width = 2.0 * reach * static_cast<double>(tripods.size());
  const auto whole = [](double value) { return static_cast<int>(std::ceil(value)); };
  const CanvasBox box{whole(margin), bottom - whole(margin) - whole(2.0 * reach), whole(margin + width),
                      bottom - whole(margin)};
  // Not more than half of the picture either way.
  if (tripods.empty() || 2 * box.right > camera.width || 2 * box.height() > camera.height || box.top < 0) return;
  box_ = box;
  CanvasPoint middle(box.left + reach, box.top + reach);
  for (const std::vector<TripodArrow>& tripod : tripods) {
    for (const TripodArrow& arrow : tripod) {
      const CanvasPoint way(glm::dot(arrow.direction, camera.right), -glm::dot(arrow.direction, camera.up));
      arrows_.push_back({middle, middle + arrow_ems * size_ * way, -glm::dot(arrow.direction, camera.forward),
                         arrow.name, Vec4f(on_paper(arrow.color, colors), 1.0F)});
    }
    middle.x += 2.0 * reach;
  }
  std::stable_sort(arrows_.begin(), arrows_.end(), [](const Arrow& a, const Arrow& b) { return a.toward < b.toward; });
}

void TripodDrawing::draw_arrow(Canvas& canvas, const Arrow& arrow) const {
  const CanvasPoint along = arrow.to - arrow.from;
  const double length = glm::length(along);
  const double thick = std::max(1.5, 0.17 * size_);
  const double rim = std::max(1.0, 0.09 * size_);
  const CanvasPoint way = length > 1e-9 ? along / length : CanvasPoint(1.0, 0.0);
  const CanvasPoint across(-way.y, way.x);
  // The head is a cone: a circle seen aslant and the triangle from its apex.
  const double half = head_half * size_;
  const CanvasPoint base = arrow.from + (1.0 - head_part) * along;
  const std::array<CanvasPoint, 3> sides{arrow.to, base + half * across, base - half * across};
  std::array<CanvasPoint, 24> circle;
  for (std::size_t i = 0; i < circle.size(); ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(circle.size());
    circle[i] = base + half * (std::cos(angle) * across + std::sin(angle) * arrow.toward * way);
  }
  const std::array<CanvasPoint, 2> shaft{arrow.from, base};
  canvas.stroke(shaft, false, thick + 2.0 * rim, paper_);
  canvas.stroke(sides, true, 2.0 * rim, paper_);
  canvas.stroke(circle, true, 2.0 * rim, paper_);
  // The foot is nearer to the viewer than the head, or behind it.
  const bool away = arrow.toward < 0.0;
  const Vec4f darker(0.72F * Vec3f(arrow.color), 1.0F);
  if (!away) canvas.stroke(shaft, false, thick, arrow.color);
  canvas.fill_convex(sides, arrow.color);
  canvas.fill_convex(circle, away ? darker : arrow.color);
  if (away) canvas.stroke(shaft, false, thick, arrow.color);
}

void TripodDrawing::draw_letter(Canvas& canvas, const Arrow& arrow) const {
  const CanvasPoint along = arrow.to - arrow.from;
  const double length = glm::length(along);
  const CanvasPoint way = length > 1e-9 ? along / length : CanvasPoint(1.0, 0.0);
  // An arrow nearly along the line of sight has its letter not over its dot.
  const CanvasPoint aside(std::sqrt(0.5), -std::sqrt(0.5));
  const double slanted = std::clamp(length / (0.8 * size_), 0.0, 1.0);
  const CanvasPoint beyond = glm::normalize(glm::mix(aside, way, slanted) + 1e-6 * aside);
  const CanvasPoint letter = arrow.to + letter_ems * size_ * beyond;
  const double width = measure_text(arrow.name, size_).width;
  draw_text_with_rim(canvas, arrow.name, letter.x - 0.5 * width, letter.y + 0.3 * size_, size_, arrow.color, paper_);
}

void TripodDrawing::draw(Canvas& canvas) const {
  for (const Arrow& arrow : arrows_) draw_arrow(canvas, arrow);
  // Over all arrows: none hides another's letter.
  for (const Arrow& arrow : arrows_) draw_letter(canvas, arrow);
}

}  // namespace atomesh
