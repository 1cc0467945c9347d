#include "app/gui/overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "render/legend_drawing.h"
#include "render/scene_parts.h"
#include "render/text_raster.h"
#include "render/tripod.h"

namespace atomesh::gui {

namespace {

const Vec4f pick_color(1.0F, 0.6F, 0.0F, 1.0F);

// Draws over a picture whose text is `size` pixels high.
class Pen {
 public:
  Pen(Canvas& canvas, const Camera& camera, const Vec4f& background)
      : canvas_(canvas),
        camera_(camera),
        size_(overlay_text_size(camera.width, camera.height)),
        colors_(overlay_colors(background)) {}

  void draw(const OverlayParts& parts) {
    for (const MeasuredLine& measured : parts.lines) line(measured);
    for (const Mark& one : parts.marks) mark(one);
    // Marks have few places for their texts, lines more.
    std::rotate(texts_.begin(), texts_.begin() + static_cast<std::ptrdiff_t>(lines_), texts_.end());
    // Over all lines, and beside one another where there is room.
    for (const Text& one : texts_) text(one);
  }

 private:
  struct Box {
    CanvasPoint low;
    CanvasPoint high;
    double shared(const Box& other) const {
      const CanvasPoint size = glm::min(high, other.high) - glm::max(low, other.low);
      return size.x > 0.0 && size.y > 0.0 ? size.x * size.y : 0.0;
    }
  };
  struct Text {
    std::string text;
    std::vector<CanvasPoint> places;  // where it may begin, on its baseline: the best first
    Vec4f color;
  };

  void mark(const Mark& mark) {
    const auto middle = canvas_point(camera_, mark.position);
    if (!middle) return;
    const double cross = 0.7 * size_;
    const std::vector<CanvasPoint> outline =
        mark.radius > 0.0 ? sphere_outline(camera_, mark.position, mark.radius) : std::vector<CanvasPoint>();
    double reach = 0.0;  // to the right
    for (const CanvasPoint& p : outline) reach = std::max(reach, p.x - middle->x);
    // A ring that is hardly larger than its line is a cross.
    if (reach > 0.3 * size_) {
      stroke(outline, true, mark.color);
    } else {
      reach = cross;
      for (const CanvasPoint& way : {CanvasPoint(1, 0), CanvasPoint(0, 1), CanvasPoint(-1, 0), CanvasPoint(0, -1)}) {
        const std::array<CanvasPoint, 2> arm{*middle + 0.3 * cross * way, *middle + cross * way};
        stroke(arm, false, mark.color);
      }
    }
    taken_.push_back({*middle - reach, *middle + reach});
    if (mark.text.empty()) return;
    const double beside = reach + 0.4 * size_;
    const double width = width_of(mark.text);
    const CanvasPoint level(middle->x, middle->y + 0.36 * size_);
    texts_.push_back({mark.text,
                      {level + CanvasPoint(beside, 0.0), level - CanvasPoint(beside + width, 0.0),
                       level + CanvasPoint(-0.5 * width, beside + 0.5 * size_),
                       level - CanvasPoint(0.5 * width, beside + 0.5 * size_)},
                      mark.color});
  }

  void line(const MeasuredLine& measured) {
    const auto from = canvas_point(camera_, measured.from);
    const auto to = canvas_point(camera_, measured.to);
    if (!from || !to) return;
    const std::array<CanvasPoint, 2> ends{*from, *to};
    stroke(ends, false, pick_color);
    const CanvasPoint middle = 0.5 * (*from + *to) - CanvasPoint(0.5 * width_of(measured.text), 0.0);
    std::vector<CanvasPoint> places;
    for (const double lines : {0.7, 1.7, 2.9, 4.1}) {
      places.push_back(middle - CanvasPoint(0.0, lines * size_));
      places.push_back(middle + CanvasPoint(0.0, (lines + 0.7) * size_));
    }
    texts_.push_back({measured.text, places, pick_color});
    ++lines_;
  }

  void stroke(std::span<const CanvasPoint> points, bool closed, const Vec4f& color) const {
    const double width = std::max(1.5, 0.13 * size_);
    canvas_.stroke(points, closed, width + 2.0 * std::max(1.0, 0.07 * size_), colors_.paper);
    canvas_.stroke(points, closed, width, color);
  }

  double width_of(const std::string& text) const { return measure_text(text, size_).width; }

  // Wholly in the picture where it has room, and at the first of its places that hides least of what stands there. In
  // the ink's colour with a line of the mark's below: letters in orange on white are hard to read.
  void text(const Text& text) {
    const double width = width_of(text.text);
    double least = std::numeric_limits<double>::infinity();
    Box best{};
    for (CanvasPoint at : text.places) {
      at.x = std::max(std::min(at.x, camera_.width - width - 0.3 * size_), 0.3 * size_);
      at.y = std::max(std::min(at.y, camera_.height - 0.5 * size_), 1.1 * size_);
      const Box box{at - CanvasPoint(0.1 * size_, 0.85 * size_), at + CanvasPoint(width + 0.1 * size_, 0.45 * size_)};
      double hidden = 0.0;
      for (const Box& other : taken_) hidden += box.shared(other);
      if (hidden >= least) continue;
      least = hidden;
      best = box;
    }
    taken_.push_back(best);
    const CanvasPoint at = best.low + CanvasPoint(0.1 * size_, 0.85 * size_);
    draw_text_with_rim(canvas_, text.text, at.x, at.y, size_, colors_.ink, colors_.paper);
    const std::array<CanvasPoint, 2> under{CanvasPoint(at.x, at.y + 0.32 * size_),
                                           CanvasPoint(at.x + width, at.y + 0.32 * size_)};
    canvas_.stroke(under, false, std::max(1.0, 0.08 * size_), text.color);
  }

  Canvas& canvas_;
  const Camera& camera_;
  double size_;
  OverlayColors colors_;
  std::vector<Text> texts_;
  std::size_t lines_ = 0;   // the first of them, that belong to lines
  std::vector<Box> taken_;  // by rings, crosses and texts
};

// Radius of the atom's ball as mode atoms draws it, hidden or not.
double ball_radius(const Material& material, const AtomsParameters& parameters, Index atom) {
  const Species& species = material.atoms.species_table[material.atoms.species[atom]];
  const auto set = parameters.radii.find(species.name);
  return (set == parameters.radii.end() ? species.radius : set->second) * parameters.scale;
}

}  // namespace

std::optional<CanvasPoint> canvas_point(const Camera& camera, const Vec3& point) {
  const Vec3 p = project(camera, point);
  const CanvasPoint at(p.x / camera.pixel + 0.5 * camera.width, 0.5 * camera.height - p.y / camera.pixel);
  if (!(p.z > 0.0) || !std::isfinite(at.x) || !std::isfinite(at.y)) return std::nullopt;
  return at;
}

std::vector<CanvasPoint> sphere_outline(const Camera& camera, const Vec3& center, double radius, int points) {
  // The circle along which lines of sight touch the sphere.
  const Vec3 to_center = center - camera.eye;
  Vec3 middle = center;
  Vec3 axis = camera.forward;
  if (camera.projection == Projection::perspective) {
    const double distance = glm::length(to_center);
    if (!(distance > radius)) return {};
    axis = to_center / distance;
    const double sine = radius / distance;
    middle -= radius * sine * axis;
    radius *= std::sqrt(1.0 - sine * sine);
  }
  const Vec3 first =
      glm::normalize(glm::cross(axis, std::abs(glm::dot(axis, camera.up)) < 0.9 ? camera.up : camera.right));
  const Vec3 second = glm::cross(axis, first);
  std::vector<CanvasPoint> outline;
  for (int i = 0; i < points; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / points;
    const auto at = canvas_point(camera, middle + radius * (std::cos(angle) * first + std::sin(angle) * second));
    if (!at) return {};
    outline.push_back(*at);
  }
  return outline;
}

void draw_overlay(Image& image, int first_row, const Camera& camera, const Material& material, const Vec4f& background,
                  const OverlayParts& parts) {
  Canvas canvas(image, first_row);
  Pen(canvas, camera, background).draw(parts);
  const LegendDrawing legend(camera.width, camera.height, background, parts.legend, parts.scale_bar);
  legend.draw(canvas);
  if (!parts.tripod) return;
  const auto& bar = legend.scale_bar_box();
  TripodDrawing(camera, background, make_tripods(material.unit_cell), bar ? bar->top : camera.height).draw(canvas);
}

OverlayParts overlay_parts(const ViewOptions& options, const Scene& scene, const Material& material,
                           const Parameters& parameters, const Camera& camera, double max_thickness,
                           std::vector<Mark> marks) {
  OverlayParts parts;
  if (options.legend) parts.legend = make_legend(scene, material, parameters, max_thickness);
  if (options.scale_bar) parts.scale_bar = make_scale_bar(camera, scene.bounds.center(), material.atoms.size() > 0);
  parts.tripod = options.tripod;
  parts.marks = std::move(marks);
  return parts;
}

void add_picks(OverlayParts& parts, const std::vector<Pick>& picks, const Material& material,
               const Parameters& parameters) {
  for (std::size_t i = 0; i < picks.size(); ++i) {
    const Pick& pick = picks[i];
    Mark mark;
    mark.position = pick.position;
    mark.color = pick_color;
    if (pick.atom != no_index && pick.atom < material.atoms.size()) {
      mark.position = material.atoms.positions[pick.atom];
      mark.radius = ball_radius(material, parameters.atoms, pick.atom);
      mark.text = material.atoms.species_name(pick.atom);
    }
    if (picks.size() > 1) mark.text += fmt::format("{}{}", mark.text.empty() ? "" : " ", i + 1);
    parts.marks.push_back(mark);
  }
  if (picks.size() != 2) return;
  const Vec3 from = picks[0].position;
  const Vec3 way = shortest_way(material.atoms.box, from, picks[1].position);
  const bool straight = glm::length(from + way - picks[1].position) < 1e-6 * (1.0 + glm::length(way));
  parts.lines.push_back({from, from + way,
                         fmt::format("{:.3f}{}{}", glm::length(way), material.atoms.size() > 0 ? " Å" : "",
                                     straight ? "" : " through the boundary")});
}

}  // namespace atomesh::gui
