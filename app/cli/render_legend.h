// --legend, --scale-bar and --tripod of render: what of them a picture gets, into the picture and into --json.
#pragma once

#include <optional>
#include <vector>

#include "app/cli/json.h"
#include "core/camera.h"
#include "core/image.h"
#include "core/material.h"
#include "core/parameters.h"
#include "render/legend_drawing.h"
#include "render/renderer.h"
#include "render/tripod.h"

namespace CLI {
class App;
}

namespace atomesh::cli {

class Session;

struct LegendOptions {
  bool legend = false;
  bool scale_bar = false;
  bool tripod = false;
};
void add_legend_options(CLI::App& app, LegendOptions& options);

// In this order: channels() for the renderer, lay_out() once it has drawn (or, before the first of several bands, with
// what the thickest of them is), draw(), add_to().
class PictureLegend {
 public:
  PictureLegend(const LegendOptions& options, Mode mode) : options_(options), mode_(mode) {}

  // Those wanted and, where the legend goes by the largest in the picture, the thickness.
  Channels channels(const Channels& wanted);

  // Whether lay_out() needs the largest thickness of all pixels.
  bool goes_by_thickness() const { return options_.legend && mode_ == Mode::xray; }

  // `thickest`: Å, where it is needed and channels() do not hold all of the picture. Notes what was asked for and
  // cannot be.
  void lay_out(const Scene& scene, const Material& material, const Parameters& parameters, const Camera& camera,
               std::optional<double> thickest, Session& session);

  // Into a finished picture, or the band of it that begins at this row.
  void draw(Image& band, int first_row = 0) const;

  // Adds "legend", "scale_bar" and "tripod", where they were drawn.
  void add_to(Json& json) const;

 private:
  LegendOptions options_;
  Mode mode_;
  std::vector<float> own_thickness_;
  const std::vector<float>* thickness_ = nullptr;
  std::optional<Legend> legend_;
  std::optional<ScaleBar> scale_bar_;
  std::optional<LegendDrawing> drawing_;
  std::vector<std::vector<TripodArrow>> tripods_;
  std::optional<TripodDrawing> tripod_;
};

}  // namespace atomesh::cli
