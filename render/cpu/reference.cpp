#include "render/cpu/reference.h"

#include <atomic>
#include <chrono>

#include "core/parallel.h"
#include "render/cpu/reference_modes.h"
#include "render/cpu/whole_picture_frame.h"

namespace atomesh {

namespace {

using namespace reference;
using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// The scene's primitives over the picture; lists the mode has no use for are empty.
struct Candidates {
  Bins cells;
  Bins triangles;
  Bins balls;

  explicit Candidates(const View& view)
      : cells(view.sight.camera(), view.scene.tetrahedra.size(),
              [&view](std::size_t i) { return view.sight.extent_of_vertices(view.scene.tetrahedra[i].data(), 4); }),
        triangles(view.sight.camera(), view.scene.surface.size(),
                  [&view](std::size_t i) { return view.sight.extent_of_vertices(view.scene.surface[i].data(), 3); }),
        balls(view.sight.camera(), view.scene.balls.size(),
              [&view](std::size_t i) { return view.sight.extent_of_ball(view.scene.balls[i]); }) {}
};

Seen see(const View& view, const Candidates& candidates, int column, int row) {
  const PixelRay ray = view.sight.pixel_ray(column, row);
  switch (view.scene.mode) {
    case Mode::volume_surface:
    case Mode::volume:
      return see_volume(view, ray, candidates.cells.at(column, row), candidates.triangles.at(column, row));
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

class Reference final : public Renderer {
 public:
  std::string_view name() const override { return "reference"; }

  std::unique_ptr<Frame> prepare(const Scene& scene, const Camera& camera, const Parameters& parameters,
                                 const PixelWindow& window, RenderStats&, Progress& progress) const override {
    progress.stage("reference");
    return std::make_unique<WholePictureFrame>(
        window, [&scene, &camera, &parameters](RenderStats& stats, const Channels& channels, Progress& following) {
          return draw_whole(scene, camera, parameters, stats, channels, following);
        });
  }

 private:
  static Image draw_whole(const Scene& scene, const Camera& camera, const Parameters& parameters, RenderStats& stats,
                          const Channels& channels, Progress& progress) {
    const Clock::time_point start = Clock::now();
    const View view(scene, camera, parameters);
    const Candidates candidates(view);
    stats.setup_ms = ms_since(start);

    const Clock::time_point drawing = Clock::now();
    Image image(camera.width, camera.height);
    const bool hits = scene.mode == Mode::surface || scene.mode == Mode::atoms;
    if (channels.thickness != nullptr && scene.mode == Mode::xray) channels.thickness->resize(image.pixels.size());
    if (channels.depth != nullptr && hits) channels.depth->resize(image.pixels.size());
    if (channels.id != nullptr && hits) channels.id->resize(image.pixels.size());
    std::atomic<std::uint64_t> steps{0};
    parallel_for(image.pixels.size(), 512, [&](std::size_t begin, std::size_t end) {
      progress.check();
      std::uint64_t range_steps = 0;
      for (std::size_t pixel = begin; pixel < end; ++pixel) {
        const auto width = static_cast<std::size_t>(camera.width);
        const Seen seen = see(view, candidates, static_cast<int>(pixel % width), static_cast<int>(pixel / width));
        image.pixels[pixel] = Vec4f(Vec4(seen.light.color, 1.0 - seen.light.transmittance));
        if (channels.thickness != nullptr && scene.mode == Mode::xray) {
          (*channels.thickness)[pixel] = static_cast<float>(seen.thickness);
        }
        if (channels.depth != nullptr && hits) (*channels.depth)[pixel] = static_cast<float>(seen.depth);
        if (channels.id != nullptr && hits) (*channels.id)[pixel] = seen.id;
        range_steps += seen.steps;
      }
      steps += range_steps;
    });
    stats.render_ms = ms_since(drawing);
    stats.steps = steps;
    progress.update(1.0);
    return image;
  }
};

}  // namespace

const Renderer& reference_renderer() {
  static const Reference renderer;
  return renderer;
}

}  // namespace atomesh
