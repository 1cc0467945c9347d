#include "render/gl/solid_rays.h"

#include <algorithm>
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

SolidDrawing::~SolidDrawing() {
  give_up();
}

void SolidDrawing::cancel() {
  if (beside_) beside_->progress.request_cancel();
}

void SolidDrawing::give_up() {
  if (!beside_) return;
  cancel();
  beside_->rays.wait();
  beside_.reset();
}

std::optional<SolidRays> SolidDrawing::proceed(const std::shared_ptr<const Scene>& solids, const SolidView& view,
                                               double milliseconds, Progress& progress) {
  if (!std::isfinite(milliseconds)) return draw(*solids, view, progress);
  progress.check();
  if (!beside_ || beside_->progress.cancelled() || beside_->solids != solids || !same_solids(beside_->view, view)) {
    give_up();
    beside_ = std::make_unique<Beside>();
    beside_->solids = solids;
    beside_->view = view;
    beside_->rays = std::async(std::launch::async, [this, task = beside_.get()] {
      return draw_now(*task->solids, task->view, task->progress);
    });
  }
  // No longer than the clock can tell.
  const std::chrono::duration<double, std::milli> patience(std::min(milliseconds, 1e6));
  if (beside_->rays.wait_for(patience) != std::future_status::ready) return std::nullopt;
  const std::unique_ptr<Beside> done = std::move(beside_);
  return done->rays.get();
}

SolidRays SolidDrawing::draw(const Scene& solids, const SolidView& view, Progress& progress) {
  give_up();
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
  give_up();
  image_ = Image();
  depth_ = {};
}

}  // namespace atomesh::gl
