// Legend and scale bar into the finished picture: on panels in its lower corners, as large as goes with the picture,
// and readable over whatever is drawn there.
#pragma once

#include "render/canvas.h"
#include "render/legend.h"

namespace atomesh {

// What is written over a picture goes with its size: the em of text, in pixels.
double overlay_text_size(int width, int height);
// And with its background (not premultiplied): dark paper and light ink on dark ones, the other way round on others and
// on none.
struct OverlayColors {
  Vec4f paper;  // opaque
  Vec4f ink;
};
OverlayColors overlay_colors(const Vec4f& background);

// Where everything stands; made once for a picture, drawn as often as wanted: into every sub-resolution of a
// progressive one, into each band of one drawn in passes.
class LegendDrawing {
 public:
  // For a picture of that size over `background` (not premultiplied): dark panels on dark ones, light on others and on
  // none. The legend goes into the lower right corner, the scale bar into the lower left. A part for which the picture
  // is too small is left out.
  LegendDrawing(int width, int height, const Vec4f& background, const std::optional<Legend>& legend,
                const std::optional<ScaleBar>& scale_bar);

  void draw(Canvas& canvas) const;

  // The panels, where they are drawn.
  const std::optional<CanvasBox>& legend_box() const { return legend_box_; }
  const std::optional<CanvasBox>& scale_bar_box() const { return scale_bar_box_; }
  // The bar of colours within the legend, for a legend with a scale: its first row is that of the largest value.
  const std::optional<CanvasBox>& color_bar() const { return color_bar_; }

 private:
  struct Text {
    std::string text;
    double x;  // where it starts
    double baseline;
  };
  struct Swatch {
    CanvasBox box;
    double radius;
    Vec4f color;
  };

  struct Mark {
    CanvasBox box;
    Vec4f color;
  };

  void lay_out_scale(const Legend& legend);
  void lay_out_entries(const Legend& legend);
  void lay_out_scale_bar(const ScaleBar& bar);
  std::string shortened(const std::string& text, double room) const;
  double width_of(const std::string& text) const;
  bool fits(int width, int height) const;
  int pixels(double ems) const;

  int width_;
  int height_;
  double size_;  // of text, pixels
  int margin_;   // between panels and the picture's edges
  int pad_;      // between a panel's edges and what is on it
  int line_;     // thickness of frames and ticks
  Vec4f panel_;
  Vec4f ink_;
  std::optional<CanvasBox> legend_box_;
  std::optional<CanvasBox> scale_bar_box_;
  std::optional<CanvasBox> color_bar_;
  std::function<Vec4f(double)> bar_color_;  // of a row's place on the bar: 0 at the bottom, 1 at the top
  std::optional<Mark> mark_;
  std::vector<Text> texts_;
  std::vector<Swatch> swatches_;
  std::vector<CanvasBox> lines_;
};

}  // namespace atomesh
