// Where the texts beside a plot's points go, so that they hide as little as may be. In pixels of the SVG, y down.
#pragma once

#include <string_view>
#include <vector>

namespace atomesh::cli {

struct PlotPixel {
  double x = 0.0;
  double y = 0.0;
};

struct PlotBox {
  double left = 0.0;
  double top = 0.0;
  double right = 0.0;
  double bottom = 0.0;

  bool holds(const PlotPixel& p) const { return p.x >= left && p.x <= right && p.y >= top && p.y <= bottom; }
};

// The most a text takes in the fonts an SVG may be shown with: they differ, and DejaVu Sans is a wide one.
double text_width(std::string_view text, double size);

// Cuts a line to a box (Liang and Barsky 1984). False when nothing of it is inside.
bool clip_line(const PlotBox& box, PlotPixel& from, PlotPixel& to);

// Finds a place for one text after the other.
class LabelPlacer {
 public:
  LabelPlacer() = default;
  explicit LabelPlacer(const PlotBox& area) : area_(area) {}
  void avoid(const PlotBox& box) { boxes_.push_back(box); }
  void avoid_line(const PlotPixel& from, const PlotPixel& to);
  // The box of a text beside `point`, inside the area where it fits there at all; avoided from now on.
  PlotBox place(const PlotPixel& point, double width, double height);

 private:
  double covered(const PlotBox& box) const;

  PlotBox area_;
  std::vector<PlotBox> boxes_;
  std::vector<PlotPixel> points_;  // along the lines
};

}  // namespace atomesh::cli
