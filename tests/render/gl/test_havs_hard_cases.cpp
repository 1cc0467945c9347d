// The catalogue of hard cases (perfect lattices seen along their axes, slivers, cells round the eye, gaps) by the
// renderer "havs": known answers first, then the judge.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <span>

#include "app/cli/hard_case_errors.h"
#include "preprocess/tetrahedralize.h"
#include "render/gl/context.h"
#include "render/gl/volume.h"
#include "render/renderer.h"
#include "samples/hard_cases.h"

namespace atomesh {
namespace {

using namespace cli;

// A vertex is moved by half of a 256th of a pixel along each axis at most.
constexpr double beside = 1.0 / 256.0;
// What lies nearer than a two-thousandth of the sample's radius is not drawn, and that near reciprocal depths are
// rough.
constexpr double length_limit = 0.01;
constexpr double color_limit = 4.0 / 255.0;

// Under the sanitizers, which look at what the code does and not at what comes out, a view of each case has to do.
#ifdef __SANITIZE_ADDRESS__
constexpr std::size_t most_views = 1;
constexpr std::size_t least_pixels = 10000;
constexpr int least_on_card = 5;
#else
constexpr std::size_t most_views = std::numeric_limits<std::size_t>::max();
constexpr std::size_t least_pixels = 50000;
constexpr int least_on_card = 30;
#endif
std::span<const HardView> views_of(const HardCase& hard) {
  return std::span(hard.views).first(std::min(hard.views.size(), most_views));
}

const std::vector<HardCase>& catalogue() {
  static const std::vector<HardCase> cases =
      hard_cases([](std::span<const Vec3> points) { return delaunay_cgal(points, no_progress()); });
  return cases;
}

// Cells prepared by the processor, and by the card where it can.
class HavsHardCases : public testing::TestWithParam<bool> {
 protected:
  HavsHardCases() { volume_.set_prepare_on_card(GetParam()); }
  ~HavsHardCases() override { EXPECT_GT(on_card_, GetParam() ? least_on_card : -1); }

  void set_scene(const Scene& scene) { volume_.set_scene(scene); }
  Image draw(const Camera& camera, const Parameters& parameters) {
    RenderStats stats;
    volume_.draw(camera, parameters, whole_picture(camera), {}, stats, no_progress());
    on_card_ += volume_.last().on_card ? 1 : 0;
    return volume_.read();
  }

 private:
  gl::HeadlessContext context_;
  gl::HeadlessContext::Current current_{context_};
  gl::Volume volume_;
  int on_card_ = 0;  // pictures
};
INSTANTIATE_TEST_SUITE_P(Both, HavsHardCases, testing::Bool(),
                         [](const auto& test) { return test.param ? "OnTheCard" : "OnTheProcessor"; });

TEST_P(HavsHardCases, OpticalDepthIsTheLengthInside) {
  std::size_t pixels = 0;
  for (const HardCase& hard : catalogue()) {
    if (hard.known == HardCase::Known::nothing) continue;
    const double extinction = 1.0 / bounds_of(hard.material.mesh.vertices).diagonal();
    const Parameters parameters = constant_density(Mode::volume, extinction);
    const Scene scene = make_scene(hard.material, parameters);
    set_scene(scene);
    for (const HardView& view : views_of(hard)) {
      const LengthError error =
          KnownLengths(hard, view.camera, beside).of_optical_depth(extinction, draw(view.camera, parameters));
      EXPECT_LE(error.relative, length_limit)
          << hard.name << ", " << view.name << ": pixel " << error.column << ' ' << error.row << " expected "
          << error.expected << " found " << error.found;
      EXPECT_LE(error.color, 1e-5) << hard.name << ", " << view.name;
      pixels += error.pixels;
    }
  }
  EXPECT_GT(pixels, least_pixels);
}

TEST_P(HavsHardCases, PicturesAreTheJudges) {
  for (const HardCase& hard : catalogue()) {
    const Parameters parameters = varying_density(Mode::volume, hard);
    const Scene scene = make_scene(hard.material, parameters);
    set_scene(scene);
    for (const HardView& view : views_of(hard)) {
      const Image image = draw(view.camera, parameters);
      EXPECT_LE(outside_of_colors(image), 1e-5) << hard.name << ", " << view.name;
      if (hard.known != HardCase::Known::values) continue;  // which of two overlapping cells comes first is open
      const VariedError error = JudgedRays(scene, view.camera, parameters, beside).error(image);
      EXPECT_LE(error.nearest, color_limit)
          << hard.name << ", " << view.name << ": pixel " << error.column << ' ' << error.row;
    }
  }
}

}  // namespace
}  // namespace atomesh
