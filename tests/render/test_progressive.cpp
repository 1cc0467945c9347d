// Progressive pictures: the seed's order, every sub-resolution on the way, and the direct picture at the end.
#include <gtest/gtest.h>

#include <array>
#include <set>
#include <thread>

#include "core/error.h"
#include "render/progressive.h"
#include "tests/render/fixtures.h"

namespace atomesh {
namespace {

using namespace test;

// Figure 4.2 of the seed: for its iterations 1 to 8 and 16, which pixel each pixel of the 4×4 sub-window shows. The
// figure counts pixels from the lower left; this is its first line from below.
struct Figure {
  int rows;
  int columns;
  std::array<int, 16> shows;
};
constexpr Figure figure_42[] = {
    {1, 1, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}},
    {2, 1, {0, 0, 0, 0, 0, 0, 0, 0, 10, 10, 10, 10, 10, 10, 10, 10}},
    {2, 2, {0, 0, 2, 2, 0, 0, 2, 2, 8, 8, 10, 10, 8, 8, 10, 10}},
    {4, 2, {0, 0, 2, 2, 5, 5, 7, 7, 8, 8, 10, 10, 13, 13, 15, 15}},
    {4, 4, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}},
};

TEST(SubResolutions, AreTheSeedsFigure) {
  const auto steps = sub_resolution_steps(4);
  ASSERT_EQ(steps.size(), 5U);
  std::set<int> drawn;
  for (std::size_t s = 0; s < steps.size(); ++s) {
    const SubResolution& reached = steps[s].reached;
    EXPECT_EQ(reached.rows, figure_42[s].rows);
    EXPECT_EQ(reached.columns, figure_42[s].columns);
    for (const PixelLattice& lattice : steps[s].lattices) {
      const LatticeGrid grid(lattice, 0, 4, 0, 4);
      for (int j = 0; j < grid.rows(); ++j) {
        for (int i = 0; i < grid.columns(); ++i) {
          EXPECT_TRUE(drawn.insert(4 * grid.row(j) + grid.column(i)).second) << "drawn twice";
        }
      }
    }
    EXPECT_EQ(drawn.size(), static_cast<std::size_t>(reached.rows * reached.columns));
    for (int pixel = 0; pixel < 16; ++pixel) {
      const SubResolution::Pixel from = reached.source(pixel % 4, pixel / 4, 4);
      EXPECT_EQ(4 * from.row + from.column, figure_42[s].shows[static_cast<std::size_t>(pixel)])
          << "step " << s << ", pixel " << pixel;
    }
  }
}

TEST(SubResolutions, ShowOnlyWhatIsDrawnInPicturesOfAnySize) {
  for (const int sub_window : {4, 8}) {
    const auto steps = sub_resolution_steps(sub_window);
    EXPECT_EQ(steps.size(), sub_window == 4 ? 5U : 7U);
    for (int width = 1; width <= 17; ++width) {
      for (int height = 1; height <= 17; ++height) {
        std::vector<int> drawn(static_cast<std::size_t>(width * height), 0);
        const auto at = [&](int column, int row) -> int& {
          return drawn[static_cast<std::size_t>(row * width + column)];
        };
        for (const auto& step : steps) {
          for (const PixelLattice& lattice : step.lattices) {
            const LatticeGrid grid(lattice, 0, width, 0, height);
            for (int j = 0; j < grid.rows(); ++j) {
              for (int i = 0; i < grid.columns(); ++i) ++at(grid.column(i), grid.row(j));
            }
          }
          for (int row = 0; row < height; ++row) {
            for (int column = 0; column < width; ++column) {
              const auto from = step.reached.source(column, row, width);
              ASSERT_LT(from.column, width);
              ASSERT_LT(from.row, height);
              ASSERT_EQ(at(from.column, from.row), 1);
              ASSERT_TRUE(at(column, row) == 0 || (from.column == column && from.row == row)) << "drawn, not shown";
            }
          }
        }
        for (const int times : drawn) ASSERT_EQ(times, 1);
      }
    }
  }
}

Drawn direct(const Renderer& renderer, const Subject& subject) {
  Drawn drawn;
  drawn.image = render(renderer, subject.scene, subject.camera, subject.parameters, drawn.stats,
                       {&drawn.thickness, &drawn.depth, &drawn.id});
  return drawn;
}

TEST(Progressive, EveryPictureShowsTheDirectOnesPixelsAndTheLastAllOfThem) {
  for (const std::string& name : renderer_names()) {
    for (const Mode mode : all_modes) {
      for (const int sub_window : {4, 8}) {
        for (const auto& [width, height] : {std::pair{1, 1}, std::pair{7, 5}, std::pair{33, 65}}) {
          SCOPED_TRACE(name + " " + std::string(mode_name(mode)) + " " + std::to_string(sub_window) + ", " +
                       std::to_string(width) + "x" + std::to_string(height));
          Subject subject = shaken_box(mode, Projection::perspective, width, height);
          subject.parameters.background = Vec4f(0.2F, 0.4F, 0.6F, 0.5F);
          const Drawn whole = direct(find_renderer(name), subject);
          Drawn last;
          int level = 0;
          const auto steps = sub_resolution_steps(sub_window);
          const auto look = [&](const ProgressivePicture& picture) {
            EXPECT_EQ(picture.level, ++level);
            EXPECT_EQ(picture.levels, static_cast<int>(steps.size()));
            const SubResolution& reached = steps[static_cast<std::size_t>(level - 1)].reached;
            EXPECT_EQ(picture.resolution.rows, reached.rows);
            std::size_t wrong = 0;
            for (int row = 0; row < height; ++row) {
              for (int column = 0; column < width; ++column) {
                const auto from = reached.source(column, row, width);
                if (picture.image.at(column, row) != whole.image.at(from.column, from.row)) ++wrong;
              }
            }
            EXPECT_EQ(wrong, 0U) << "level " << level;
          };
          const ProgressivePicture picture =
              render_progressively(find_renderer(name), subject.scene, subject.camera, subject.parameters,
                                   {sub_window, {}, 0}, last.stats, {&last.thickness, &last.depth, &last.id}, look);
          EXPECT_TRUE(picture.complete());
          EXPECT_EQ(level, picture.levels);
          EXPECT_EQ(picture.fraction, 1.0);
          EXPECT_EQ(picture.image.pixels, whole.image.pixels);
          EXPECT_EQ(last.thickness, whole.thickness);
          EXPECT_EQ(last.depth, whole.depth);
          EXPECT_EQ(last.id, whole.id);
          EXPECT_EQ(last.stats.steps, whole.stats.steps);
        }
      }
    }
  }
}

TEST(Progressive, SupersampledPicturesEndAsTheDirectOnesToo) {
  for (const Mode mode : all_modes) {
    for (const int n : {2, 3}) {
      Subject subject = shaken_box(mode, Projection::parallel, 33, 21);
      subject.parameters.supersampling = n;
      const Drawn whole = direct(find_renderer("cpu"), subject);
      Drawn last;
      const ProgressivePicture picture =
          render_progressively(find_renderer("cpu"), subject.scene, subject.camera, subject.parameters, {8, {}, 0},
                               last.stats, {&last.thickness, &last.depth, &last.id});
      EXPECT_EQ(picture.image.pixels, whole.image.pixels) << mode_name(mode) << " " << n;
      EXPECT_EQ(last.thickness, whole.thickness) << mode_name(mode) << " " << n;
      EXPECT_EQ(last.depth, whole.depth) << mode_name(mode) << " " << n;
      EXPECT_EQ(last.id, whole.id) << mode_name(mode) << " " << n;
    }
  }
}

TEST(Progressive, AfterAFewPicturesTheWholeAtOnceIsTheDirectOne) {
  for (const Mode mode : all_modes) {
    for (const int coarse : {1, 3, 6, 7}) {
      Subject subject = shaken_box(mode, Projection::perspective, 45, 37);
      const Drawn whole = direct(find_renderer("cpu"), subject);
      Drawn last;
      int pictures = 0;
      const ProgressivePicture picture = render_progressively(
          find_renderer("cpu"), subject.scene, subject.camera, subject.parameters, {8, {}, coarse}, last.stats,
          {&last.thickness, &last.depth, &last.id}, [&](const ProgressivePicture&) { ++pictures; });
      EXPECT_EQ(pictures, std::min(coarse + 1, 7)) << mode_name(mode);
      EXPECT_TRUE(picture.complete());
      EXPECT_EQ(picture.fraction, 1.0);
      EXPECT_EQ(picture.image.pixels, whole.image.pixels) << mode_name(mode) << " " << coarse;
      EXPECT_EQ(last.thickness, whole.thickness) << mode_name(mode) << " " << coarse;
      EXPECT_EQ(last.depth, whole.depth) << mode_name(mode) << " " << coarse;
      EXPECT_EQ(last.id, whole.id) << mode_name(mode) << " " << coarse;
    }
  }
}

TEST(Progressive, ATimeBudgetLeavesTheBestCompletePicture) {
  const Subject subject = shaken_box(Mode::xray, Projection::parallel, 50, 40);
  const Drawn whole = direct(find_renderer("cpu"), subject);
  std::vector<float> thickness;
  RenderStats stats;
  // No time at all: the first picture, and its channel.
  ProgressivePicture picture =
      render_progressively(find_renderer("cpu"), subject.scene, subject.camera, subject.parameters, {4, 0.0, 0}, stats,
                           {&thickness, nullptr, nullptr});
  EXPECT_EQ(picture.level, 1);
  EXPECT_FALSE(picture.complete());
  EXPECT_DOUBLE_EQ(picture.fraction, 13.0 * 10.0 / (50.0 * 40.0));
  EXPECT_EQ(picture.image.at(6, 7), whole.image.at(4, 4));
  EXPECT_EQ(thickness[7 * 50 + 6], whole.thickness[4 * 50 + 4]);
  // More than the clock can count.
  picture = render_progressively(find_renderer("cpu"), subject.scene, subject.camera, subject.parameters, {8, 1e300, 0},
                                 stats);
  EXPECT_TRUE(picture.complete());
  EXPECT_EQ(picture.image.pixels, whole.image.pixels);
}

// A frame that sleeps in every drawing after the first.
class Slow final : public Renderer {
 public:
  std::string_view name() const override { return "slow"; }
  std::unique_ptr<Frame> prepare(const Scene&, const Camera&, const Parameters&, const PixelWindow& window,
                                 RenderStats&, Progress&) const override {
    return std::make_unique<SlowFrame>(window);
  }

 private:
  class SlowFrame final : public Frame {
   public:
    explicit SlowFrame(const PixelWindow& window) : window_(window) {}
    void draw(const PixelLattice& lattice, Image& image, RenderStats&, const Channels&,
              Progress& progress) const override {
      const LatticeGrid grid(lattice, window_);
      for (int j = 0; j < grid.rows(); ++j) {
        for (int i = 0; i < grid.columns(); ++i) image.at(grid.column(i), grid.row(j)) = Vec4f(1.0F);
      }
      if (lattice.column_phase + lattice.row_phase == 0) return;
      for (;;) {
        progress.check();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    }

   private:
    PixelWindow window_;
  };
};

TEST(Progressive, ABudgetEndsALongPassAndACancelEndsAllOfIt) {
  Camera camera;
  camera.width = camera.height = 16;
  RenderStats stats;
  const ProgressivePicture picture = render_progressively(Slow(), Scene(), camera, Parameters(), {8, 20.0}, stats);
  EXPECT_EQ(picture.level, 1);
  EXPECT_EQ(picture.fraction, 4.0 / 256.0);
  for (const Vec4f& pixel : picture.image.pixels) EXPECT_EQ(pixel, Vec4f(1.0F));

  Progress cancelled;
  int pictures = 0;
  const auto cancel = [&](const ProgressivePicture&) {
    ++pictures;
    cancelled.request_cancel();
  };
  EXPECT_THROW(render_progressively(Slow(), Scene(), camera, Parameters(), {8, 1e6}, stats, {}, cancel, cancelled),
               CancelledError);
  EXPECT_EQ(pictures, 1);
  // From another thread, in the middle of a pass.
  Progress asked;
  std::thread other([&asked] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    asked.request_cancel();
  });
  EXPECT_THROW(render_progressively(Slow(), Scene(), camera, Parameters(), {8, {}, 0}, stats, {}, {}, asked),
               CancelledError);
  other.join();
}

TEST(Progressive, ProgressGoesUpOnceAndOtherSubWindowsAreRefused) {
  const Subject subject = shaken_box(Mode::surface, Projection::parallel, 60, 60);
  double last = 0.0;
  Progress followed([&last](std::string_view stage, double fraction) {
    EXPECT_EQ(stage, "render");
    EXPECT_GE(fraction, last);
    last = fraction;
  });
  RenderStats stats;
  render_progressively(find_renderer("cpu"), subject.scene, subject.camera, subject.parameters, {8, {}, 0}, stats, {},
                       {}, followed);
  EXPECT_EQ(last, 1.0);
  EXPECT_THROW(
      render_progressively(find_renderer("cpu"), subject.scene, subject.camera, subject.parameters, {16, {}}, stats),
      UsageError);
}

}  // namespace
}  // namespace atomesh
