// A coarse picture soon, and finer ones until it is the direct one (seed 4.2.2).
#pragma once

#include <functional>
#include <optional>

#include "render/renderer.h"
#include "render/sub_resolution.h"

namespace atomesh {

struct ProgressiveOptions {
  int sub_window = 8;  // 4 or 8 pixels along a side: the first picture has a 16th or a 64th of them
  // After so many milliseconds, prepare() included, the sub-resolution that is being drawn is given up. The first is
  // always finished. What `on_picture` takes does not count.
  std::optional<double> time_budget_ms;
  // After so many sub-resolutions (1 to all of them but one) the whole picture is drawn at once: sooner done than all
  // of them, for each sets up its cells anew, but with nothing to see on the way. 0: all.
  int then_whole = 0;
};

struct ProgressivePicture {
  Image image;  // finished: every pixel is drawn, or has the colour of the drawn one that stands for it
  SubResolution resolution;
  int level = 0;          // 1 is the first sub-resolution
  int levels = 0;         // 5 with sub-windows of 4 pixels, 7 with 8; or then_whole + 1
  double fraction = 0.0;  // of the pixels (with supersampling: of the rays) that are drawn
  double ms = 0.0;        // since the start, without what `on_picture` took
  bool complete() const { return level == levels; }
};

// Draws the picture in the seed's order and calls `on_picture` (which may be empty) with every sub-resolution, from
// the calling thread, which may be any. Returns the last of them: complete, and then equal to render()'s to the last
// bit, or the best the time budget allowed. With n×n supersampling the sub-windows are of rays: the first pictures have
// one ray for many pixels, and each pixel's n×n come in last.
//
// Channels are those of the picture returned. One frame serves all sub-resolutions, and no pixel is drawn twice (but
// with then_whole).
// Throws UsageError for another size of sub-windows and as render() does; CancelledError, which a cancel brings about
// within a tile.
ProgressivePicture render_progressively(const Renderer& renderer, const Scene& scene, const Camera& camera,
                                        const Parameters& parameters, const ProgressiveOptions& options,
                                        RenderStats& stats, const Channels& channels = {},
                                        const std::function<void(const ProgressivePicture&)>& on_picture = {},
                                        Progress& progress = no_progress());

}  // namespace atomesh
