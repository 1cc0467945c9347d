#include "render/gl/solid_rays.h"

#include <chrono>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/stopwatch.h"
#include "render/cpu/cpu_renderer.h"
#include "render/renderer.h"

namespace atomesh::gl {

bool same_solids(const SolidView& a, const SolidView& b) {
  const auto window = [](const PixelWindow& w) { return std::tuple(w.left, w.top, w.width, w.height); };
  const auto lattice = [](const PixelLattice& l) {
    return std::tuple(l.column_stride, l.row_stride, l.column_phase, l.row_phase);
  };
  const auto camera = [](const Camera& c) {
    return std::tuple(c.eye, c.right, c.up, c.forward, c.projection, c.width, c.height, c.pixel);
  };
  if (window(a.window) != window(b.window) || lattice(a.lattice) != lattice(b.lattice) ||
      camera(a.camera) != camera(b.camera)) {
    return false;
  }
  Parameters parameters = a.parameters;
  parameters.volume = b.parameters.volume;
  parameters.havs = b.parameters.havs;
  parameters.background = b.parameters.background;
  parameters.integrator = b.parameters.integrator;
  parameters.samples_per_cell = b.parameters.samples_per_cell;
  return parameters == b.parameters;
}

void SolidDrawing::cancel() {
  beside_.cancel();
}

std::optional<SolidRays> SolidDrawing::proceed(const std::shared_ptr<const Scene>& solids, const SolidView& view,
                                               double milliseconds, Progress& progress) {
  if (!std::isfinite(milliseconds)) return draw(*solids, view, progress);
  progress.check();
  const auto start = std::chrono::steady_clock::now();
  const bool ours =
      beside_.started() && !beside_.cancelled() && task_.solids == solids && same_solids(task_.view, view);
  if (!ours) {
    // What is given up comes to its end first.
    beside_.cancel();
    if (!beside_.over(milliseconds)) return std::nullopt;
    beside_.give_up();
    task_ = {.solids = solids, .view = view, .rays = {}};
    beside_.start([this](Progress& own) { task_.rays = draw_now(*task_.solids, task_.view, own); });
  }
  if (!beside_.over(milliseconds - ms_since(start))) return std::nullopt;
  beside_.take();
  return std::exchange(task_, {}).rays;
}

SolidRays SolidDrawing::draw(const Scene& solids, const SolidView& view, Progress& progress) {
  beside_.give_up();
  return draw_now(solids, view, progress);
}

SolidRays SolidDrawing::draw_now(const Scene& solids, const SolidView& view, Progress& progress) {
  RenderStats stats;
  const auto frame = cpu_renderer().prepare(solids, view.camera, view.parameters, view.window, stats, progress);
  const auto start = std::chrono::steady_clock::now();
  // What is left of another view between the lattice's pixels is never read.
  if (image_.width != view.window.width || image_.height != view.window.height) {
    image_ = Image(view.window.width, view.window.height);
  }
  Channels channels;
  channels.depth = &depth_;
  frame->draw(view.lattice, image_, stats, channels, progress);
  SolidRays rays;
  rays.setup_ms = stats.setup_ms;
  const LatticeGrid grid(view.lattice, view.window);
  if (grid.pixels() == view.window.pixels()) {
    rays.colors = std::move(image_.pixels);
    rays.ends = std::move(depth_);
    image_ = Image();
  } else {
    rays.colors.reserve(grid.pixels());
    rays.ends.reserve(grid.pixels());
    for (int j = 0; j < grid.rows(); ++j) {
      for (int i = 0; i < grid.columns(); ++i) {
        const std::size_t pixel = view.window.place(grid.column(i), grid.row(j));
        rays.colors.push_back(image_.pixels[pixel]);
        rays.ends.push_back(depth_[pixel]);
      }
    }
  }
  rays.render_ms = ms_since(start);
  return rays;
}

void SolidDrawing::forget() {
  beside_.give_up();
  task_ = {};
  image_ = Image();
  depth_ = {};
}

}  // namespace atomesh::gl
