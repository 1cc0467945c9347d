#include "render/passes.h"

#include <algorithm>

#include "core/memory.h"
#include "render/finish.h"

namespace atomesh {

void render_in_passes(const Renderer& renderer, const Scene& scene, const Camera& camera, const Parameters& parameters,
                      int rows, RenderStats& stats, const Channels& channels, const BandSink& sink,
                      Progress& progress) {
  check_picture(camera, parameters);
  progress.stage("render");
  for (int top = 0; top < camera.height; top += rows) {
    const int bottom = std::min(top + rows, camera.height);
    Progress part(progress, static_cast<double>(top) / camera.height, static_cast<double>(bottom) / camera.height);
    Image band =
        render_window(renderer, scene, camera, parameters, {0, top, camera.width, bottom - top}, stats, channels, part);
    sink(band, top);
  }
  progress.update(1.0);
}

double largest_thickness(const Renderer& renderer, const Scene& scene, const Camera& camera,
                         const Parameters& parameters, int rows, Progress& progress) {
  std::vector<float> thickness;
  double largest = 0.0;
  RenderStats stats;
  const BandSink keep_largest = [&](Image&, int) {
    if (thickness.empty()) return;
    largest = std::max(largest, static_cast<double>(*std::max_element(thickness.begin(), thickness.end())));
  };
  render_in_passes(renderer, scene, camera, parameters, rows, stats, {.thickness = &thickness}, keep_largest, progress);
  return largest;
}

std::uint64_t pass_bytes_per_row(const Camera& camera, const Parameters& parameters, const Channels& channels) {
  const auto n = static_cast<std::uint64_t>(parameters.supersampling);
  std::uint64_t pixel = sizeof(Vec4f);
  if (channels.thickness != nullptr) pixel += sizeof(float);
  if (channels.depth != nullptr) pixel += sizeof(float);
  if (channels.id != nullptr) pixel += sizeof(Index);
  // The rays, and beside them the finished pixels where they are not the same.
  return static_cast<std::uint64_t>(camera.width) * pixel * (n == 1 ? 1 : n * n + 1);
}

int rows_within(std::uint64_t bytes, const Camera& camera, const Parameters& parameters, const Channels& channels) {
  constexpr std::uint64_t together = 32;  // the side of the renderers' largest tiles
  const std::uint64_t fit = bytes / pass_bytes_per_row(camera, parameters, channels);
  if (fit >= static_cast<std::uint64_t>(camera.height)) return camera.height;
  return static_cast<int>(fit > together ? fit / together * together : std::max<std::uint64_t>(fit, 1));
}

std::uint64_t default_pass_bytes() {
  constexpr std::uint64_t most = 1'000'000'000;
  const auto room = memory_room();
  return room ? std::min(room->bytes / 4, most) : most;
}

}  // namespace atomesh
