// Plots of a report as SVG: points and lines over two axes, readable with every common colour blindness, on a white
// panel of their own, so that they look the same on a light and on a dark page.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace atomesh::cli {

enum class AxisScale { linear, logarithmic };

struct PlotAxis {
  std::string title;  // with its unit: "time, ms"
  AxisScale scale = AxisScale::linear;
  // Ends of the axis where they must be certain; else those of the points and guides, a little widened (with a
  // logarithmic axis the end may not be 0 or below).
  std::optional<double> min{};
  std::optional<double> max{};
  bool whole = false;  // counts, of threads say: no ticks between whole numbers
};

struct PlotPoint {
  double x = 0.0;
  double y = 0.0;
  std::string label{};  // written beside the point: "4 samples"
};

// One of seven colours with one of six markers; no series has the pair of another. A point that is not finite is left
// out and breaks the line. On a logarithmic axis values of 0 or below, an error that is exactly none for instance,
// stand hollow on the axis' lower end, and a line below the plot says so.
struct PlotSeries {
  std::string name;  // in the legend
  std::vector<PlotPoint> points;
  bool line = true;     // joins the points in the order given
  bool dashed = false;  // a peer, say
};

// A line across the plot: what is required, or the ideal.
struct PlotGuide {
  bool horizontal = true;  // at y = value, else at x = value
  double value = 0.0;
  std::string label{};
};

struct Plot {
  std::string name;   // of its file: letters, digits, '-'; "error-over-time-comb"
  std::string title;  // may be empty
  PlotAxis x;
  PlotAxis y;
  std::vector<PlotSeries> series;
  std::vector<PlotGuide> guides{};
  std::string caption{};  // under the plot in the HTML report
  int width = 760;        // px of the SVG, at least 320
  int height = 460;       // at least 240
};

// A whole SVG document. A plot without a point that can be drawn shows empty axes and says so. Throws UsageError for a
// size too small and for a logarithmic axis whose given end is not above 0.
std::string plot_svg(const Plot& plot);

}  // namespace atomesh::cli
