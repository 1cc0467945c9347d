// What the parts of bench render share: a timed picture, and its rows.
#pragma once

#include <chrono>
#include <ctime>
#include <string>
#include <vector>

#include "app/cli/bench_judge.h"
#include "app/cli/bench_scenes.h"
#include "app/cli/bench_tools.h"
#include "core/camera.h"
#include "core/image.h"
#include "core/parameters.h"
#include "core/progress.h"
#include "render/renderer.h"
#include "render/scene.h"

namespace atomesh::cli {

Run timed(auto&& work) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  work();
  const std::clock_t ticks = std::clock() - cpu;
  const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
  return {elapsed.count(), 1e3 * static_cast<double>(ticks) / CLOCKS_PER_SEC};
}

// Pictures of one view by one of our renderers, as Renderer::draw() makes them, and how long they took.
class TimedPicture {
 public:
  // References are kept.
  TimedPicture(const Scene& scene, const Camera& camera, const Parameters& parameters)
      : scene_(scene), camera_(camera), parameters_(parameters) {}

  // Once more. A run that is not `counted` warms up, and shows what memory a picture takes.
  void draw(Progress& progress, bool counted = true);
  void draw(int repeats, Session& session, const std::string& what);

  const Image& image() const { return image_; }  // premultiplied, of the last run
  std::uint64_t steps() const { return stats_.steps; }
  // The most that preparing and drawing took beyond the scene, the picture included; bytes.
  double memory() const { return memory_; }
  Times total() const { return times_of(total_); }
  Times prepare() const { return times_of(prepare_); }
  Times pixels() const { return times_of(pixels_); }
  // Million steps a second and core, by processor time of the whole picture.
  double rate() const { return 1e-6 * total().per_core(static_cast<double>(stats_.steps)); }

 private:
  const Scene& scene_;
  const Camera& camera_;
  const Parameters& parameters_;
  Image image_;
  RenderStats stats_;  // of the last run
  double memory_ = 0.0;
  std::vector<Run> total_, prepare_, pixels_;
};

// "exact", "linear", "preintegrated", "sampled, 4 a cell".
std::string integrator_text(const Parameters& parameters);

// Whether the mode draws volumes.
bool has_integrator(Mode mode);

// These parameters with every integrator, and with several numbers of samples; as they are where the mode has none.
std::vector<Parameters> integrator_settings(const Parameters& parameters);

// {mode, map, view, projection, integrator, size, threads, renderer}, without the integrator where the mode has none;
// map, BenchScene::volume_map, is mode volume's alone.
Json picture_settings(const BenchScene& data, const BenchView& view, const Parameters& parameters,
                      const Camera& camera);

// A row of suite "render" with the times, steps and rates of `picture`.
BenchRow picture_row(const std::string& case_name, std::string what, Json settings, const TimedPicture& picture);

// Of premultiplied pictures: A, averaged over all pixels; 0 where nothing is seen, 1 where all of it is opaque.
double mean_coverage(const Image& picture);

// Sets max_error, rmse and psnr.
void set_error(BenchRow& row, const PictureError& error);

}  // namespace atomesh::cli
