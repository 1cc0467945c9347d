#include "render/cpu/reference.h"

#include <atomic>
#include <chrono>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "render/cpu/reference_modes.h"
#include "render/solids.h"

namespace atomesh {

namespace {

using namespace reference;
using Clock = std::chrono::steady_clock;

// The scene's primitives over the window; lists the mode has no use for are empty.
struct Candidates {
  Bins cells;
  Bins triangles;
  Bins balls;

  Candidates(const View& view, const PixelWindow& window, const Progress& progress)
      : cells(window, view.scene.tetrahedra.size(), progress,
              [&view](std::size_t i) { return view.sight.extent_of_vertices(view.scene.tetrahedra[i].data(), 4); }),
        triangles(window, view.scene.surface.size(), progress,
                  [&view](std::size_t i) { return view.sight.extent_of_vertices(view.scene.surface[i].data(), 3); }),
        balls(window, view.scene.balls.size(), progress,
              [&view](std::size_t i) { return view.sight.extent_of_ball(view.scene.balls[i]); }) {}
};

Seen see(const View& view, const Candidates& candidates, int column, int row, double ray_end) {
  const PixelRay ray = view.sight.pixel_ray(column, row);
  switch (view.scene.mode) {
    case Mode::volume_surface:
    case Mode::volume:
      return see_volume(view, ray, candidates.cells.at(column, row), candidates.triangles.at(column, row), ray_end);
    case Mode::surface:
      return see_surface(view, ray, candidates.triangles.at(column, row));
    case Mode::xray:
      return see_xray(view, ray, candidates.triangles.at(column, row));
    case Mode::atoms:
      return see_balls(view, optics::ball_ray(view.scene, view.sight.camera(), column, row),
                       candidates.balls.at(column, row));
  }
  return {};
}

class ReferenceFrame final : public Frame {
 public:
  ReferenceFrame(const Scene& scene, const Camera& camera, const Parameters& parameters, const PixelWindow& window,
                 const Progress& progress)
      : window_(window), view_(scene, camera, parameters), candidates_(view_, window, progress) {}

  void draw(const PixelLattice& lattice, Image& image, RenderStats& stats, const Channels& channels,
            Progress& progress) const override {
    const Clock::time_point start = Clock::now();
    const Mode mode = view_.scene.mode;
    const bool hits = mode == Mode::surface || mode == Mode::atoms;
    std::vector<float>* thickness = mode == Mode::xray ? channels.thickness : nullptr;
    std::vector<float>* depth = hits ? channels.depth : nullptr;
    std::vector<Index>* id = hits ? channels.id : nullptr;
    size_channel(thickness, window_, 0.0F);
    size_channel(depth, window_, std::numeric_limits<float>::infinity());
    size_channel(id, window_, no_index);
    const LatticeGrid grid(lattice, window_);
    std::atomic<std::uint64_t> steps{0};
    std::atomic<std::size_t> done{0};
    constexpr std::size_t together = 32;  // rays between two looks at whether to go on
    parallel_for(grid.pixels(), together, [&](std::size_t begin, std::size_t end) {
      progress.check();
      std::uint64_t range_steps = 0;
      for (std::size_t n = begin; n < end; ++n) {
        const int column = grid.column(static_cast<int>(n % static_cast<std::size_t>(grid.columns())));
        const int row = grid.row(static_cast<int>(n / static_cast<std::size_t>(grid.columns())));
        const std::size_t pixel = window_.place(column, row);
        const double ray_end = channels.ray_end != nullptr ? static_cast<double>((*channels.ray_end)[pixel])
                                                           : std::numeric_limits<double>::infinity();
        const Seen seen = see(view_, candidates_, column, row, ray_end);
        image.pixels[pixel] = Vec4f(glm::dvec4(seen.light.color, 1.0 - seen.light.transmittance));
        if (thickness != nullptr) (*thickness)[pixel] = static_cast<float>(seen.thickness);
        if (depth != nullptr) (*depth)[pixel] = static_cast<float>(seen.depth);
        if (id != nullptr) (*id)[pixel] = seen.id;
        range_steps += seen.steps;
      }
      steps += range_steps;
      const std::size_t finished = done += end - begin;
      // The listener belongs to the thread that called us.
      if (omp_get_thread_num() == 0)
        progress.update(static_cast<double>(finished) / static_cast<double>(grid.pixels()));
    });
    progress.update(1.0);
    stats.steps += steps;
    stats.render_ms += ms_since(start);
  }

 private:
  PixelWindow window_;
  View view_;
  Candidates candidates_;
};

class Reference final : public Renderer {
 public:
  std::string_view name() const override { return "reference"; }

  std::unique_ptr<Frame> prepare(const Scene& scene, const Camera& camera, const Parameters& parameters,
                                 const PixelWindow& window, RenderStats& stats, Progress& progress) const override {
    progress.stage("reference");
    const Clock::time_point start = Clock::now();
    std::unique_ptr<Frame> frame = std::make_unique<ReferenceFrame>(scene, camera, parameters, window, progress);
    stats.setup_ms += ms_since(start);
    return with_solids(std::move(frame), *this, scene, camera, parameters, window, stats, progress);
  }
};

}  // namespace

const Renderer& reference_renderer() {
  static const Reference renderer;
  return renderer;
}

}  // namespace atomesh
