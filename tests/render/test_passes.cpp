// Pictures drawn in passes are the direct ones to the last bit.
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/memory.h"
#include "render/passes.h"
#include "tests/render/fixtures.h"

namespace atomesh {
namespace {

using namespace test;

Drawn direct(const Renderer& renderer, const Subject& subject) {
  Drawn drawn;
  drawn.image = render(renderer, subject.scene, subject.camera, subject.parameters, drawn.stats,
                       {&drawn.thickness, &drawn.depth, &drawn.id});
  return drawn;
}

Drawn in_passes(const Renderer& renderer, const Subject& subject, int rows) {
  Drawn drawn;
  drawn.image = Image(subject.camera.width, subject.camera.height);
  std::vector<float> thickness;
  std::vector<float> depth;
  std::vector<Index> id;
  int next = 0;
  const auto append = [](auto& to, const auto& band) { to.insert(to.end(), band.begin(), band.end()); };
  render_in_passes(renderer, subject.scene, subject.camera, subject.parameters, rows, drawn.stats,
                   {&thickness, &depth, &id}, [&](const Image& band, int first_row) {
                     EXPECT_EQ(first_row, next);
                     EXPECT_EQ(band.width, subject.camera.width);
                     EXPECT_EQ(band.height, std::min(rows, subject.camera.height - first_row));
                     next += band.height;
                     std::copy(band.pixels.begin(), band.pixels.end(), &drawn.image.at(0, first_row));
                     append(drawn.thickness, thickness);
                     append(drawn.depth, depth);
                     append(drawn.id, id);
                   });
  EXPECT_EQ(next, subject.camera.height);
  return drawn;
}

TEST(Passes, AreTheDirectPictureToTheLastBit) {
  for (const std::string& name : renderer_names()) {
    for (const Mode mode : all_modes) {
      for (const auto& [width, height] : {std::pair{1, 1}, std::pair{7, 5}, std::pair{33, 65}}) {
        for (const int n : {1, 3}) {
          if (name == "reference" && n > 1 && height > 5) continue;  // the same code, slowly
          Subject subject = shaken_box(mode, Projection::perspective, width, height);
          subject.parameters.supersampling = n;
          subject.parameters.background = Vec4f(0.2F, 0.4F, 0.6F, 0.5F);
          const Drawn whole = direct(find_renderer(name), subject);
          for (const int rows : {1, 4, 32, 64, 100}) {
            SCOPED_TRACE(name + " " + std::string(mode_name(mode)) + " " + std::to_string(width) + "x" +
                         std::to_string(height) + ", " + std::to_string(n) + " rays, rows " + std::to_string(rows));
            const Drawn parts = in_passes(find_renderer(name), subject, rows);
            EXPECT_EQ(parts.image.pixels, whole.image.pixels);
            EXPECT_EQ(parts.thickness, whole.thickness);
            EXPECT_EQ(parts.depth, whole.depth);
            EXPECT_EQ(parts.id, whole.id);
            // Cell projection draws blocks of 4×4 rays, and counts those that a pass cuts off.
            if (rows * n % 32 == 0 || (mode != Mode::volume && mode != Mode::volume_surface)) {
              EXPECT_EQ(parts.stats.steps, whole.stats.steps);
            }
          }
        }
      }
    }
  }
}

TEST(Passes, ProgressGoesOverAllOfThemAndACancelEndsThem) {
  const Subject subject = shaken_box(Mode::volume, Projection::parallel, 40, 60);
  double last = 0.0;
  int reports = 0;
  Progress followed([&](std::string_view stage, double fraction) {
    EXPECT_EQ(stage, "render");
    EXPECT_GE(fraction, last);
    last = fraction;
    ++reports;
  });
  RenderStats stats;
  int bands = 0;
  const Renderer& cpu = find_renderer("cpu");
  const auto count = [&bands](const Image&, int) { ++bands; };
  render_in_passes(cpu, subject.scene, subject.camera, subject.parameters, 16, stats, {}, count, followed);
  EXPECT_EQ(last, 1.0);
  EXPECT_EQ(bands, 4);
  EXPECT_GE(reports, 5);

  Progress cancelled;
  bands = 0;
  const auto cancel = [&](const Image&, int) {
    ++bands;
    cancelled.request_cancel();
  };
  EXPECT_THROW(
      render_in_passes(cpu, subject.scene, subject.camera, subject.parameters, 16, stats, {}, cancel, cancelled),
      CancelledError);
  EXPECT_EQ(bands, 1);
}

TEST(Passes, TakeAsManyRowsAsFit) {
  Camera camera;
  camera.width = 1000;
  camera.height = 500;
  Parameters parameters;
  EXPECT_EQ(pass_bytes_per_row(camera, parameters, {}), 16'000U);
  std::vector<float> depth;
  std::vector<Index> id;
  EXPECT_EQ(pass_bytes_per_row(camera, parameters, {nullptr, &depth, &id}), 24'000U);
  EXPECT_EQ(rows_within(8'000'000, camera, parameters, {}), 500);
  EXPECT_EQ(rows_within(7'999'999, camera, parameters, {}), 480);  // 499 would fit
  EXPECT_EQ(rows_within(20 * 16'000, camera, parameters, {}), 20);
  EXPECT_EQ(rows_within(0, camera, parameters, {}), 1);
  parameters.supersampling = 2;
  EXPECT_EQ(pass_bytes_per_row(camera, parameters, {}), 80'000U);
  EXPECT_GT(default_pass_bytes(), 0U);
  EXPECT_LE(default_pass_bytes(), 1'000'000'000U);
}

TEST(Passes, PictureWithoutPixelsIsAnError) {
  Subject subject = shaken_box(Mode::surface, Projection::parallel, 0, 5);
  RenderStats stats;
  EXPECT_THROW(render_in_passes(find_renderer("cpu"), subject.scene, subject.camera, subject.parameters, 8, stats, {},
                                [](const Image&, int) {}),
               UsageError);
}

}  // namespace
}  // namespace atomesh
