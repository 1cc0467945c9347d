#include "app/cli/report_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/cli/report_markup.h"
#include "app/cli/report_plot_labels.h"
#include "core/axis_ticks.h"
#include "core/error.h"

namespace atomesh::cli {

namespace {

// Okabe and Ito (2008), "Color universal design"; without their yellow, which is hardly seen on white.
constexpr std::array<const char*, 7> colors{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                            "#E69F00", "#56B4E9", "#000000"};
// The same darkened, for text.
constexpr std::array<const char*, 7> text_colors{"#005383", "#9C4500", "#00664A", "#8A4A6E",
                                                 "#8A5F00", "#2B6A93", "#000000"};

// Markers: a circle, and polygons by their corners' number, the direction of the first (degrees, down is 90) and size.
struct Shape {
  int corners;
  double first;
  double size;
};
// One fewer than colours: no pair of both comes back before the 43rd series.
constexpr std::array<Shape, 6> shapes{
    {{0, 0, 1.0}, {4, 45, 1.2}, {3, -90, 1.35}, {4, 0, 1.3}, {3, 90, 1.35}, {5, -90, 1.2}}};
constexpr double marker_radius = 4.2;

constexpr double tick_size = 12.0;
constexpr double title_size = 13.0;
constexpr double heading_size = 15.0;
constexpr double margin = 16.0;

// From values to pixels.
struct Axis {
  AxisScale scale;
  bool whole;
  double low = 0.0, high = 1.0;
  double first = 0.0, last = 1.0;  // pixels of low and high

  bool logarithmic() const { return scale == AxisScale::logarithmic; }
  double along(double value) const { return logarithmic() ? std::log10(value) : value; }
  double at(double value) const {
    return first + (last - first) * (along(value) - along(low)) / (along(high) - along(low));
  }
  // A value the scale has no place for, which stands at the lower end.
  bool below_all(double value) const { return logarithmic() && value <= 0.0; }
  bool holds(double value) const {
    const double slack = 1e-9 * (along(high) - along(low));
    return below_all(value) || (along(value) >= along(low) - slack && along(value) <= along(high) + slack);
  }
};

bool drawable(const PlotPoint& point) {
  return std::isfinite(point.x) && std::isfinite(point.y);
}

template <class Visit>
void for_each_value(const Plot& plot, bool horizontal_axis, Visit visit) {
  for (const PlotSeries& series : plot.series) {
    for (const PlotPoint& point : series.points) {
      if (drawable(point)) visit(horizontal_axis ? point.x : point.y);
    }
  }
  for (const PlotGuide& guide : plot.guides) {
    if (guide.horizontal != horizontal_axis && std::isfinite(guide.value)) visit(guide.value);
  }
}

Axis make_axis(const Plot& plot, bool horizontal_axis) {
  const PlotAxis& wanted = horizontal_axis ? plot.x : plot.y;
  Axis axis{wanted.scale, wanted.whole};
  for (const std::optional<double>& end : {wanted.min, wanted.max}) {
    if (end && (!std::isfinite(*end) || (axis.logarithmic() && *end <= 0.0))) {
      throw UsageError(fmt::format("plot \"{}\": an axis cannot end at {}", plot.name, *end));
    }
  }
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for_each_value(plot, horizontal_axis, [&](double value) {
    if (axis.below_all(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  });
  if (low > high) {
    low = wanted.min.value_or(axis.logarithmic() ? 0.1 : 0.0);
    high = wanted.max.value_or(low + 1.0);
  }
  // Room around the outermost points.
  if (axis.logarithmic()) {
    const double room = std::max(0.05 * std::log10(high / low), 0.1);
    axis.low = low * std::pow(10.0, -room);
    axis.high = high * std::pow(10.0, room);
  } else {
    const double room = high > low ? 0.05 * (high - low) : std::max(0.1 * std::abs(high), 1e-9);
    axis.low = low >= 0.0 ? std::max(0.0, low - room) : low - room;
    axis.high = high <= 0.0 && low < high ? std::min(0.0, high + room) : high + room;
  }
  axis.low = wanted.min.value_or(axis.low);
  axis.high = wanted.max.value_or(axis.high);
  if (!(axis.along(axis.high) > axis.along(axis.low))) {
    throw UsageError(fmt::format("plot \"{}\": an axis from {} to {} has no length", plot.name, axis.low, axis.high));
  }
  return axis;
}

std::vector<AxisTick> ticks_of(const Axis& axis, double room) {
  int at_most = std::max(2, static_cast<int>(std::abs(axis.last - axis.first) / room));
  // As many ticks as there are whole numbers: none between them.
  if (axis.whole)
    at_most = static_cast<int>(std::min(1.0 * at_most, std::floor(axis.high) - std::ceil(axis.low) + 1.0));
  return axis.logarithmic() ? logarithmic_ticks(axis.low, axis.high, at_most)
                            : linear_ticks(axis.low, axis.high, at_most);
}

class Drawing {
 public:
  explicit Drawing(const Plot& plot) : plot_(plot), x_(make_axis(plot, true)), y_(make_axis(plot, false)) {}
  std::string svg();

 private:
  void text(double x, double y, double size, std::string_view what, std::string_view attributes = {});
  void label(const PlotBox& box, std::string_view what, const char* color, bool to_the_right);
  void line(double x1, double y1, double x2, double y2, std::string_view attributes);
  void marker(const PlotPixel& at, std::size_t series, bool hollow);
  double legend(double top, bool draw);
  void axes(const std::vector<AxisTick>& across, const std::vector<AxisTick>& up);
  void minor_grid(const Axis& axis, bool horizontal_axis);
  void guides();
  void series();
  void labels();

  PlotPixel pixel(const PlotPoint& point) const {
    return {x_.below_all(point.x) ? x_.first : x_.at(point.x), y_.below_all(point.y) ? y_.first : y_.at(point.y)};
  }
  bool shown(const PlotPoint& point) const { return drawable(point) && x_.holds(point.x) && y_.holds(point.y); }
  bool hollow(const PlotPoint& point) const { return x_.below_all(point.x) || y_.below_all(point.y); }

  const Plot& plot_;
  Axis x_, y_;
  PlotBox area_;
  LabelPlacer placer_;
  std::string out_;
};

void Drawing::text(double x, double y, double size, std::string_view what, std::string_view attributes) {
  out_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{:.0f}\"{}{}>{}</text>\n", x, y, size,
                      attributes.empty() ? "" : " ", attributes, escape_markup(what));
}

// With a white rim, to be read over lines. Drawn twice: not everything that shows SVG can paint strokes first.
void Drawing::label(const PlotBox& box, std::string_view what, const char* color, bool to_the_right) {
  const char* anchor = to_the_right ? " text-anchor=\"end\"" : "";
  const double x = to_the_right ? box.right : box.left;
  const double y = box.bottom - 3.0;
  text(x, y, tick_size, what,
       fmt::format("fill=\"none\" stroke=\"#ffffff\" stroke-width=\"3\" stroke-linejoin=\"round\"{}", anchor));
  text(x, y, tick_size, what, fmt::format("fill=\"{}\"{}", color, anchor));
}

void Drawing::line(double x1, double y1, double x2, double y2, std::string_view attributes) {
  out_ +=
      fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x1, y1, x2, y2, attributes);
}

void Drawing::marker(const PlotPixel& at, std::size_t series, bool hollow) {
  const Shape& shape = shapes[series % shapes.size()];
  const char* color = colors[series % colors.size()];
  const std::string paint =
      fmt::format("fill=\"{}\" stroke=\"{}\" stroke-width=\"1.5\"", hollow ? "#ffffff" : color, color);
  const double radius = marker_radius * shape.size;
  if (shape.corners == 0) {
    out_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" {}/>\n", at.x, at.y, radius, paint);
    return;
  }
  out_ += "<polygon points=\"";
  for (int corner = 0; corner < shape.corners; ++corner) {
    const double angle = (shape.first + 360.0 * corner / shape.corners) * std::acos(-1.0) / 180.0;
    out_ += fmt::format("{}{:.1f},{:.1f}", corner > 0 ? " " : "", at.x + radius * std::cos(angle),
                        at.y + radius * std::sin(angle));
  }
  out_ += fmt::format("\" {}/>\n", paint);
}

// The names of the series in rows from `top` on; returns where they end.
double Drawing::legend(double top, bool draw) {
  constexpr double sample = 30.0;  // the piece of line beside a name
  const double right = plot_.width - margin;
  double x = margin;
  double y = top;
  for (std::size_t s = 0; s < plot_.series.size(); ++s) {
    const PlotSeries& series = plot_.series[s];
    if (series.name.empty()) continue;
    const double width = sample + 6.0 + text_width(series.name, tick_size) + 18.0;
    if (x > margin && x + width - 18.0 > right) {
      x = margin;
      y += 19.0;
    }
    if (draw) {
      const double middle = y + 10.0;
      if (series.line) {
        line(x, middle, x + sample, middle,
             fmt::format("stroke=\"{}\" stroke-width=\"2\"{}", colors[s % colors.size()],
                         series.dashed ? " stroke-dasharray=\"6 4\"" : ""));
      }
      marker({x + 0.5 * sample, middle}, s, false);
      text(x + sample + 6.0, middle + 4.0, tick_size, series.name);
    }
    x += width;
  }
  return x > margin ? y + 19.0 : y;
}

void Drawing::minor_grid(const Axis& axis, bool horizontal_axis) {
  if (!axis.logarithmic() || axis.along(axis.high) - axis.along(axis.low) > 10.0) return;
  for (double power = std::pow(10.0, std::floor(std::log10(axis.low))); power < axis.high; power *= 10.0) {
    for (int digit = 2; digit <= 9; ++digit) {
      const double value = power * digit;
      if (value < axis.low || value > axis.high) continue;
      const double at = axis.at(value);
      constexpr const char* faint = "stroke=\"#f0f0f0\" stroke-width=\"1\"";
      if (horizontal_axis) {
        line(at, area_.top, at, area_.bottom, faint);
      } else {
        line(area_.left, at, area_.right, at, faint);
      }
    }
  }
}

void Drawing::axes(const std::vector<AxisTick>& across, const std::vector<AxisTick>& up) {
  minor_grid(x_, true);
  minor_grid(y_, false);
  constexpr const char* grid = "stroke=\"#d6d6d6\" stroke-width=\"1\"";
  for (const AxisTick& tick : across) {
    const double at = x_.at(tick.value);
    line(at, area_.top, at, area_.bottom + 4.0, grid);
    text(at, area_.bottom + 18.0, tick_size, tick.text, "text-anchor=\"middle\"");
  }
  for (const AxisTick& tick : up) {
    const double at = y_.at(tick.value);
    line(area_.left - 4.0, at, area_.right, at, grid);
    text(area_.left - 8.0, at + 4.0, tick_size, tick.text, "text-anchor=\"end\"");
  }
  line(area_.left, area_.bottom, area_.right, area_.bottom, "stroke=\"#444444\" stroke-width=\"1.2\"");
  line(area_.left, area_.top, area_.left, area_.bottom, "stroke=\"#444444\" stroke-width=\"1.2\"");
  const double middle_x = 0.5 * (area_.left + area_.right);
  const double middle_y = 0.5 * (area_.top + area_.bottom);
  text(middle_x, area_.bottom + 40.0, title_size, plot_.x.title, "text-anchor=\"middle\"");
  text(margin + 10.0, middle_y, title_size, plot_.y.title,
       fmt::format("text-anchor=\"middle\" transform=\"rotate(-90 {:.1f} {:.1f})\"", margin + 10.0, middle_y));
}

void Drawing::guides() {
  for (const PlotGuide& guide : plot_.guides) {
    const Axis& axis = guide.horizontal ? y_ : x_;
    if (!std::isfinite(guide.value) || axis.below_all(guide.value) || !axis.holds(guide.value)) continue;
    const double at = axis.at(guide.value);
    constexpr const char* style = "stroke=\"#666666\" stroke-width=\"1.4\" stroke-dasharray=\"2 3\"";
    const double width = text_width(guide.label, tick_size);
    PlotBox box;
    bool to_the_right = true;
    if (guide.horizontal) {
      line(area_.left, at, area_.right, at, style);
      const double bottom = at - 2.0 < area_.top + tick_size ? at + tick_size + 6.0 : at - 2.0;
      box = {area_.right - 4.0 - width, bottom - tick_size, area_.right - 4.0, bottom};
    } else {
      line(at, area_.top, at, area_.bottom, style);
      to_the_right = at + 5.0 + width > area_.right;
      const double left = to_the_right ? at - 5.0 - width : at + 5.0;
      box = {left, area_.top + 5.0, left + width, area_.top + 5.0 + tick_size};
    }
    if (guide.label.empty()) continue;
    label(box, guide.label, "#555555", to_the_right);
    placer_.avoid(box);
  }
}

void Drawing::series() {
  for (std::size_t s = 0; s < plot_.series.size(); ++s) {
    const PlotSeries& series = plot_.series[s];
    for (std::size_t i = 1; series.line && i < series.points.size(); ++i) {
      if (!drawable(series.points[i - 1]) || !drawable(series.points[i])) continue;
      PlotPixel from = pixel(series.points[i - 1]);
      PlotPixel to = pixel(series.points[i]);
      if (!clip_line(area_, from, to)) continue;
      line(from.x, from.y, to.x, to.y,
           fmt::format("stroke=\"{}\" stroke-width=\"2\" stroke-linecap=\"round\"{}", colors[s % colors.size()],
                       series.dashed ? " stroke-dasharray=\"6 4\"" : ""));
      placer_.avoid_line(from, to);
    }
  }
  // Above every line.
  for (std::size_t s = 0; s < plot_.series.size(); ++s) {
    for (const PlotPoint& point : plot_.series[s].points) {
      if (!shown(point)) continue;
      const PlotPixel at = pixel(point);
      marker(at, s, hollow(point));
      placer_.avoid({at.x - 6.0, at.y - 6.0, at.x + 6.0, at.y + 6.0});
    }
  }
}

void Drawing::labels() {
  for (std::size_t s = 0; s < plot_.series.size(); ++s) {
    for (const PlotPoint& point : plot_.series[s].points) {
      if (point.label.empty() || !shown(point)) continue;
      const PlotPixel at = pixel(point);
      const PlotBox box = placer_.place(at, text_width(point.label, tick_size), tick_size);
      label(box, point.label, text_colors[s % text_colors.size()], box.right < at.x);
    }
  }
}

std::string Drawing::svg() {
  const std::string heading = plot_.title.empty() ? plot_.name : plot_.title;
  out_ = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" role=\"img\" "
      "font-family=\"'DejaVu Sans', Verdana, 'Helvetica Neue', Arial, sans-serif\" fill=\"#222222\">\n"
      "<title>{2}</title>\n"
      "<rect x=\"0\" y=\"0\" width=\"{0}\" height=\"{1}\" rx=\"6\" fill=\"#ffffff\"/>\n",
      plot_.width, plot_.height, escape_markup(heading));
  double top = margin;
  if (!plot_.title.empty()) {
    text(margin, top + 12.0, heading_size, plot_.title, "font-weight=\"bold\"");
    top += 26.0;
  }
  top = legend(top, true) + 8.0;

  std::string note;
  bool any = false;
  for (const PlotSeries& series : plot_.series) {
    for (const PlotPoint& point : series.points) {
      any = any || shown(point);
      if (shown(point) && hollow(point)) note = "Hollow on an axis' end: 0, for which a logarithmic axis has no place.";
    }
  }
  if (!any) note = "Nothing was measured that could be drawn here.";
  // The vertical axis' texts say how wide they are only once its height is known.
  area_ = {0.0, top, plot_.width - margin - 8.0, plot_.height - margin - 40.0 - (note.empty() ? 0.0 : 20.0)};
  y_.first = area_.bottom;
  y_.last = area_.top;
  const std::vector<AxisTick> up = ticks_of(y_, 34.0);
  double widest = 0.0;
  for (const AxisTick& tick : up) widest = std::max(widest, text_width(tick.text, tick_size));
  area_.left = margin + 24.0 + widest + 8.0;
  x_.first = area_.left;
  x_.last = area_.right;
  placer_ = LabelPlacer(area_);
  axes(ticks_of(x_, 62.0), up);
  guides();
  series();
  labels();
  if (!note.empty()) text(margin, plot_.height - margin + 2.0, tick_size - 1.0, note, "fill=\"#555555\"");
  return out_ + "</svg>\n";
}

}  // namespace

std::string plot_svg(const Plot& plot) {
  if (plot.width < 320 || plot.height < 240) {
    throw UsageError(
        fmt::format("plot \"{}\": {}x{} is too small, at least 320x240", plot.name, plot.width, plot.height));
  }
  return Drawing(plot).svg();
}

}  // namespace atomesh::cli
