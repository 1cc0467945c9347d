#include "render/progressive.h"

#include <algorithm>

#include "core/error.h"
#include "render/finish.h"

namespace atomesh {

namespace {

using Clock = Progress::Clock;

double ms_between(Clock::time_point start, Clock::time_point end) {
  return std::chrono::duration<double, std::milli>(end - start).count();
}

// Draws a step's lattices; false where the deadline came first.
bool draw_step(const Frame& frame, const std::vector<PixelLattice>& lattices, const PixelWindow& window,
               RayPicture& rays, std::size_t& drawn, Clock::time_point deadline, RenderStats& stats,
               const Channels& channels, Progress& progress) {
  const auto fraction = [&window](std::size_t pixels) {
    return static_cast<double>(pixels) / static_cast<double>(window.pixels());
  };
  std::size_t reached = drawn;
  try {
    for (const PixelLattice& lattice : lattices) {
      const std::size_t pixels = LatticeGrid(lattice, window).pixels();
      Progress part(progress, fraction(reached), std::min(1.0, fraction(reached + pixels)), deadline);
      part.check();
      if (pixels > 0) frame.draw(lattice, rays.image, stats, channels, part);
      reached += pixels;
    }
    reached = std::min(reached, window.pixels());
  } catch (const CancelledError&) {
    if (progress.cancelled()) throw;
    return false;
  }
  drawn = reached;
  return true;
}

}  // namespace

ProgressivePicture render_progressively(const Renderer& renderer, const Scene& scene, const Camera& camera,
                                        const Parameters& parameters, const ProgressiveOptions& options,
                                        RenderStats& stats, const Channels& channels,
                                        const std::function<void(const ProgressivePicture&)>& on_picture,
                                        Progress& progress) {
  check_picture(camera, parameters);
  if (options.sub_window != 4 && options.sub_window != 8) {
    throw UsageError("sub-windows of " + std::to_string(options.sub_window) + " pixels: there are 4 and 8");
  }
  const auto start = Clock::now();
  Clock::duration elsewhere{0};
  progress.stage("render");
  const int n = parameters.supersampling;
  const Camera rays_from = ray_camera(camera, n);
  const PixelWindow window = whole_picture(rays_from);
  Progress preparing(progress, 0.0, 0.0);
  const std::unique_ptr<Frame> frame = renderer.prepare(scene, rays_from, parameters, window, stats, preparing);
  RayPicture rays;
  rays.image = Image(window.width, window.height);
  const Channels ray_channels = rays.channels(channels);

  std::vector<SubResolutionStep> steps = sub_resolution_steps(options.sub_window);
  if (options.then_whole > 0 && options.then_whole + 1 < static_cast<int>(steps.size())) {
    steps[options.then_whole] = {steps.back().reached, {PixelLattice{}}};
    steps.resize(options.then_whole + 1);
  }
  ProgressivePicture picture;
  picture.levels = static_cast<int>(steps.size());
  std::size_t drawn = 0;
  for (const SubResolutionStep& step : steps) {
    auto deadline = Clock::time_point::max();
    if (picture.level > 0 && options.time_budget_ms) {
      // In double, and only then as a time: a budget may be larger than the clock's range.
      const double left = *options.time_budget_ms - ms_between(start + elsewhere, Clock::now());
      if (left <= 0.0) break;
      if (left < 1e9) {
        deadline =
            Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double, std::milli>(left));
      }
    }
    if (!draw_step(*frame, step.lattices, window, rays, drawn, deadline, stats, ray_channels, progress)) break;
    const auto finishing = Clock::now();
    picture.resolution = step.reached;
    if (step.reached.complete()) {
      picture.image = finish(std::move(rays), n, parameters.background, channels);
    } else {
      finish_spread(rays, step.reached, n, parameters.background, picture.image);
    }
    ++picture.level;
    picture.fraction = static_cast<double>(drawn) / static_cast<double>(window.pixels());
    const auto finished = Clock::now();
    stats.render_ms += ms_between(finishing, finished);
    picture.ms = ms_between(start + elsewhere, finished);
    if (on_picture) on_picture(picture);
    elsewhere += Clock::now() - finished;
  }
  if (!picture.complete()) spread_channels(rays, picture.resolution, n, channels);
  progress.update(1.0);
  return picture;
}

}  // namespace atomesh
