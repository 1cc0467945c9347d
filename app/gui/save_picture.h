// Pictures for keeping: what the view shows, at any size, drawn by the CPU renderers as `atomesh render` draws it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/picture_text.h"
#include "app/gui/document.h"
#include "app/gui/workspace.h"
#include "core/camera.h"
#include "core/image.h"
#include "render/renderer.h"
#include "render/scene.h"

namespace atomesh::gui {

inline constexpr int largest_picture_side = 32768;  // pixels, as of the command line

struct PictureSettings {
  int width = 800;  // pixels
  int height = 600;
  bool transparent = false;  // background; else that of the parameters
  int supersampling = 0;     // n × n rays a pixel; 0: as the parameters say
  cli::PictureParts parts{};
  std::vector<Mark> marks{};  // drawn into the picture, as are these with what was measured between them
  std::vector<Pick> picks{};
  std::string renderer = "auto";  // find_renderer()
};

// The parameters by which the picture is drawn, and which its file carries.
Parameters picture_parameters(const Parameters& parameters, const PictureSettings& settings);

// How a picture will be drawn, before anything is read or drawn.
struct PicturePlan {
  int rows = 0;  // of a pass
  int passes = 1;
  std::uint64_t bytes = 0;  // that a pass takes, beside the scene
};
PicturePlan plan_picture(const Parameters& parameters, const PictureSettings& settings);

// A sample ready for pictures of it by these parameters, from any side: its view parameters are those of each picture.
class PictureStudio {
 public:
  // Reads the parts that are missing. Throws what reading and make_scene() throw, UsageError for a size beyond
  // largest_picture_side or an unknown renderer.
  PictureStudio(const Document& document, const Parameters& parameters, const PictureSettings& settings,
                Progress& progress);

  const Parameters& parameters() const { return parameters_; }
  const PictureSettings& settings() const { return settings_; }
  const Document& document() const { return document_; }
  const Scene& scene() const { return scene_; }
  std::string_view renderer_name() const { return renderer_.name(); }
  Camera camera(const Parameters& view) const;

  // Whether overlays go by the largest thickness of the picture (a legend in mode xray), Å.
  bool goes_by_thickness() const;
  double largest_thickness(const Parameters& view, Progress& progress) const;

  // The whole picture in memory. `thickest`: for the legend, where it is not that of this view. `view` must differ from
  // parameters() in nothing but the view. Throws UnavailableError where it does not fit the memory, CancelledError.
  Image draw(const Parameters& view, std::optional<double> thickest, Progress& progress) const;
  // Into a PNG, in passes that fit the memory. Nothing is left of one that is cancelled or fails. Returns the passes.
  PicturePlan save(const std::string& png, const Parameters& view, std::optional<double> thickest,
                   Progress& progress) const;
  // What a PNG of this view says of itself.
  PngText text(const std::string& png, const Parameters& view) const;

 private:
  Document document_;  // keeps what the scene borrows
  Parameters parameters_;
  PictureSettings settings_;
  const Renderer& renderer_;
  Scene scene_;
  std::string data_hash_;
};

// One picture: PictureStudio(…).save(…) of the parameters' own view.
PicturePlan save_picture(const std::string& png, const Document& document, const Parameters& parameters,
                         const PictureSettings& settings, Progress& progress);

}  // namespace atomesh::gui
