// What stands in a volume as its rays meet it: drawn at once and beside, and given up without delay.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/stopwatch.h"
#include "render/gl/solid_rays.h"
#include "tests/render/fixtures.h"

namespace atomesh {
namespace {

using gl::SolidDrawing;
using gl::SolidRays;
using gl::SolidView;

class SolidRaysTest : public testing::Test {
 protected:
  SolidView view_of(int width, int height, const PixelLattice& lattice = {}) const {
    SolidView view;
    view.camera = make_camera(subject_.parameters, subject_.scene.bounds, width, height);
    view.parameters = subject_.parameters;
    view.window = whole_picture(view.camera);
    view.lattice = lattice;
    return view;
  }

  test::Subject subject_ = test::shaken_box(Mode::atoms, Projection::perspective, 40, 30);
  std::shared_ptr<const Scene> scene_ = std::make_shared<const Scene>(subject_.scene);
};

TEST_F(SolidRaysTest, AreTheSameBeside) {
  SolidDrawing drawing;
  for (const PixelLattice& lattice : {PixelLattice{}, PixelLattice{4, 2, 0, 0}}) {
    const SolidView view = view_of(64, 48, lattice);
    const SolidRays at_once = drawing.draw(*scene_, view, no_progress());
    ASSERT_EQ(at_once.colors.size(), LatticeGrid(lattice, view.window).pixels());
    std::optional<SolidRays> rays;
    while (!rays) rays = drawing.proceed(scene_, view, 0.0, no_progress());
    EXPECT_EQ(rays->colors, at_once.colors);
    EXPECT_EQ(rays->ends, at_once.ends);
    const auto met = [](const SolidRays& of) {
      return std::count_if(of.ends.begin(), of.ends.end(), [](float end) { return std::isfinite(end); });
    };
    EXPECT_GT(met(at_once), 10);
  }
}

// However long the view before would take.
TEST_F(SolidRaysTest, OfAnotherViewAreThereWithoutTheOneBefore) {
  const SolidView slow = view_of(2400, 1800);
  const SolidView quick = view_of(24, 18);
  SolidDrawing drawing;
  const SolidRays expected = drawing.draw(*scene_, quick, no_progress());
  auto start = std::chrono::steady_clock::now();
  drawing.draw(*scene_, slow, no_progress());
  const double slow_ms = ms_since(start);
  for (const bool told : {false, true}) {
    double least = slow_ms;
    for (int i = 0; i < 5; ++i) {
      ASSERT_FALSE(drawing.proceed(scene_, slow, 0.0, no_progress()));
      if (told) drawing.cancel();
      start = std::chrono::steady_clock::now();
      const std::optional<SolidRays> rays = drawing.proceed(scene_, quick, 1e6, no_progress());
      least = std::min(least, ms_since(start));
      ASSERT_TRUE(rays);
      EXPECT_EQ(rays->colors, expected.colors);
    }
    EXPECT_LE(least, 0.3 * slow_ms);
  }
}

// Nobody else keeps the scene.
TEST_F(SolidRaysTest, KeepTheirSceneWhileTheyAreDrawn) {
  const std::weak_ptr<const Scene> watched = scene_;
  {
    SolidDrawing drawing;
    EXPECT_FALSE(drawing.proceed(scene_, view_of(1200, 900), 0.0, no_progress()));
    scene_.reset();
    EXPECT_FALSE(watched.expired());
    drawing.forget();
    EXPECT_TRUE(watched.expired());
    scene_ = std::make_shared<const Scene>(subject_.scene);
    EXPECT_FALSE(drawing.proceed(std::exchange(scene_, nullptr), view_of(1200, 900), 0.0, no_progress()));
  }
}

TEST_F(SolidRaysTest, AreCancelled) {
  SolidDrawing drawing;
  Progress cancelled;
  cancelled.request_cancel();
  for (const double milliseconds : {0.0, 10.0, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(drawing.proceed(scene_, view_of(64, 48), milliseconds, cancelled), CancelledError);
  }
}

}  // namespace
}  // namespace atomesh
