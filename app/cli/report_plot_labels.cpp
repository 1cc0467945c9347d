#include "app/cli/report_plot_labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/utf8.h"

namespace atomesh::cli {

double text_width(std::string_view text, double size) {
  return 0.62 * size * count_characters(text);
}

bool clip_line(const PlotBox& box, PlotPixel& from, PlotPixel& to) {
  const double dx = to.x - from.x;
  const double dy = to.y - from.y;
  double enter = 0.0;
  double leave = 1.0;
  // Inside of a side are the parameters t with t · along <= room.
  for (const auto& [along, room] : std::array<std::pair<double, double>, 4>{
           {{-dx, from.x - box.left}, {dx, box.right - from.x}, {-dy, from.y - box.top}, {dy, box.bottom - from.y}}}) {
    if (along == 0.0) {
      if (room < 0.0) return false;
    } else if (along < 0.0) {
      enter = std::max(enter, room / along);
    } else {
      leave = std::min(leave, room / along);
    }
  }
  if (enter > leave) return false;
  to = {from.x + leave * dx, from.y + leave * dy};
  from = {from.x + enter * dx, from.y + enter * dy};
  return true;
}

void LabelPlacer::avoid_line(const PlotPixel& from, const PlotPixel& to) {
  const double dx = to.x - from.x;
  const double dy = to.y - from.y;
  const int pieces = static_cast<int>(std::hypot(dx, dy) / 5.0) + 1;
  for (int i = 0; i <= pieces; ++i) points_.push_back({from.x + dx * i / pieces, from.y + dy * i / pieces});
}

double LabelPlacer::covered(const PlotBox& box) const {
  double sum = 0.0;
  for (const PlotBox& other : boxes_) {
    const double width = std::min(box.right, other.right) - std::max(box.left, other.left);
    const double height = std::min(box.bottom, other.bottom) - std::max(box.top, other.top);
    if (width > 0.0 && height > 0.0) sum += width * height;
  }
  // Text over a line is read more easily than over a marker or another text.
  for (const PlotPixel& point : points_) sum += box.holds(point) ? 8.0 : 0.0;
  return sum;
}

PlotBox LabelPlacer::place(const PlotPixel& point, double width, double height) {
  constexpr double gap = 7.0;
  const double beside = 0.5 * height;
  struct Place {
    double left, top;
  };
  // To the right, the left, above and below; those of one side stand in rows that do not touch.
  const std::array<Place, 8> places{{{gap, -beside},
                                     {gap - 2.0, -beside - height},
                                     {gap - 2.0, beside},
                                     {-0.5 * width, -gap - height},
                                     {-0.5 * width, gap},
                                     {-gap - width, -beside},
                                     {2.0 - gap - width, -beside - height},
                                     {2.0 - gap - width, beside}}};
  PlotBox best;
  double least = std::numeric_limits<double>::infinity();
  for (const Place& place : places) {
    PlotBox box{point.x + place.left, point.y + place.top, point.x + place.left + width, point.y + place.top + height};
    // Pushed back into the area; far from its point it is no longer read as the point's.
    const double right = std::max(0.0, box.right - area_.right) - std::max(0.0, area_.left - box.left);
    const double down = std::max(0.0, box.bottom - area_.bottom) - std::max(0.0, area_.top - box.top);
    box = {box.left - right, box.top - down, box.right - right, box.bottom - down};
    const double cost = covered(box) + 4.0 * (std::abs(right) + std::abs(down));
    if (cost >= least) continue;
    least = cost;
    best = box;
  }
  boxes_.push_back(best);
  return best;
}

}  // namespace atomesh::cli
