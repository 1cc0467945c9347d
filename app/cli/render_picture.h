// How `render` draws its picture into files: at once, in passes where it is large, or progressively.
#pragma once

#include <optional>
#include <string>

#include "app/cli/channel_files.h"
#include "app/cli/json.h"
#include "app/cli/render_legend.h"
#include "app/cli/session.h"
#include "core/camera.h"
#include "core/image.h"
#include "render/renderer.h"

namespace CLI {
class App;
}

namespace atomesh::cli {

struct PictureOptions {
  int pass_rows = 0;    // rows of a pass; 0: as many as fit
  int progressive = 0;  // pixels along a side of the sub-windows; 0: not progressively
  std::optional<double> time_budget_ms;
  bool keep_levels = false;
};
void add_picture_options(CLI::App& app, PictureOptions& options);

// Whether the file is one that --keep-levels writes beside this output.
bool writes_level(const std::string& path, const std::string& output, const PictureOptions& options);

struct Picture {
  const Renderer& renderer;
  const Material& material;
  const Scene& scene;
  const Camera& camera;
  const Parameters& parameters;
  std::string output;
  PngText text;
};

struct PictureReport {
  RenderStats stats;
  std::string summary;  // ", in 5 passes of 3808 rows"; nothing for a picture drawn at once
  Json passes;          // {count, rows}, null likewise
  Json progressive;     // {sub_window, complete, fraction, levels: [{rows, columns, ms, file}]}, null likewise
};

// Draws and writes the picture, the legend in it, and its channels, all of them or none. A picture that would take more
// than default_pass_bytes() is drawn in passes, with a note. Throws UnavailableError where a progressive one does not
// fit the memory.
PictureReport draw_picture(const Picture& picture, const PictureOptions& options, ChannelFiles& channel_files,
                           PictureLegend& legend, Session& session);

}  // namespace atomesh::cli
