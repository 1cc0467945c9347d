// A frame's windows and lattices: whatever is drawn in whatever portions is the whole picture to the last bit.
#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "core/parallel.h"
#include "render/renderer.h"
#include "tests/render/fixtures.h"

namespace atomesh {
namespace {

using namespace test;

std::string describe(const std::string& renderer, Mode mode, const PixelWindow& window, const PixelLattice& lattice) {
  return renderer + " " + std::string(mode_name(mode)) + ", window " + std::to_string(window.left) + "," +
         std::to_string(window.top) + " " + std::to_string(window.width) + "x" + std::to_string(window.height) +
         ", strides " + std::to_string(lattice.column_stride) + " " + std::to_string(lattice.row_stride) + ", phases " +
         std::to_string(lattice.column_phase) + " " + std::to_string(lattice.row_phase);
}

// Draws the lattice over a picture that is all sentinel, and compares pixel by pixel.
void expect_part_of(const Drawn& whole, const Renderer& renderer, const Subject& subject, const PixelWindow& window,
                    const PixelLattice& lattice) {
  SCOPED_TRACE(describe(std::string(renderer.name()), subject.scene.mode, window, lattice));
  const Vec4f sentinel(-1.0F);
  RenderStats stats;
  const auto frame = renderer.prepare(subject.scene, subject.camera, subject.parameters, window, stats, no_progress());
  Image image(window.width, window.height);
  std::fill(image.pixels.begin(), image.pixels.end(), sentinel);
  std::vector<float> thickness;
  std::vector<float> depth;
  std::vector<Index> id;
  frame->draw(lattice, image, stats, {&thickness, &depth, &id}, no_progress());
  ASSERT_EQ(thickness.size(), whole.thickness.empty() ? 0 : window.pixels());
  ASSERT_EQ(depth.size(), whole.depth.empty() ? 0 : window.pixels());
  ASSERT_EQ(id.size(), whole.id.empty() ? 0 : window.pixels());
  std::size_t wrong = 0;
  for (int row = window.top; row < window.top + window.height; ++row) {
    for (int column = window.left; column < window.left + window.width; ++column) {
      const bool in_lattice =
          column % lattice.column_stride == lattice.column_phase && row % lattice.row_stride == lattice.row_phase;
      const std::size_t at = window.place(column, row);
      const std::size_t of_whole = whole_picture(subject.camera).place(column, row);
      const auto differs = [&](const auto& part, const auto& of, auto nothing) {
        return !of.empty() && part[at] != (in_lattice ? of[of_whole] : nothing);
      };
      wrong += image.pixels[at] != (in_lattice ? whole.image.pixels[of_whole] : sentinel) ||
                       differs(thickness, whole.thickness, 0.0F) ||
                       differs(depth, whole.depth, std::numeric_limits<float>::infinity()) ||
                       differs(id, whole.id, no_index)
                   ? 1
                   : 0;
    }
  }
  EXPECT_EQ(wrong, 0U);
}

TEST(Frames, EveryWindowAndLatticeIsThePictureToTheLastBit) {
  for (const std::string& name : renderer_names()) {
    const Renderer& renderer = find_renderer(name);
    const int width = name == "reference" ? 37 : 101;
    const int height = name == "reference" ? 29 : 75;
    const std::vector<PixelWindow> windows{{0, 0, width, height},
                                           {0, height / 3, width, height / 3},
                                           {width / 3, 5, width / 2, height - 11},
                                           {width - 1, height - 1, 1, 1},
                                           {3, 0, 1, height}};
    const std::vector<PixelLattice> lattices{{1, 1, 0, 0}, {2, 2, 1, 0}, {4, 4, 2, 2}, {8, 8, 0, 0},
                                             {8, 8, 4, 4}, {2, 8, 1, 5}, {8, 1, 7, 0}};
    std::vector<std::pair<Mode, VolumeSolid>> kinds{{Mode::volume, VolumeSolid::atoms},
                                                    {Mode::volume, VolumeSolid::walls}};
    for (const Mode mode : all_modes) kinds.emplace_back(mode, VolumeSolid::none);
    for (const auto& [mode, solid] : kinds) {
      for (const Projection projection : {Projection::parallel, Projection::perspective}) {
        Subject subject = shaken_box(mode, projection, width, height);
        subject.parameters.volume.solid = solid;
        if (solid != VolumeSolid::none) subject.scene = make_scene(subject.material, subject.parameters);
        const Drawn whole = draw(renderer, subject.scene, subject.camera, subject.parameters);
        for (const PixelWindow& window : windows) {
          for (const PixelLattice& lattice : lattices) expect_part_of(whole, renderer, subject, window, lattice);
        }
      }
    }
  }
}

// An eye in the sample: primitives reach behind it and cover the whole picture.
TEST(Frames, AnEyeInsideSeesTheSameInParts) {
  for (const std::string& name : renderer_names()) {
    for (const Mode mode : all_modes) {
      Subject subject = shaken_box(mode, Projection::perspective, 43, 35);
      subject.camera.eye = subject.scene.center + Vec3(0.21, 0.13, 0.34);
      const Drawn whole = draw(find_renderer(name), subject.scene, subject.camera, subject.parameters);
      for (const PixelWindow& window : {PixelWindow{0, 0, 43, 35}, PixelWindow{10, 17, 30, 3}}) {
        for (const PixelLattice& lattice : {PixelLattice{}, PixelLattice{4, 4, 1, 3}}) {
          expect_part_of(whole, find_renderer(name), subject, window, lattice);
        }
      }
    }
  }
}

TEST(Frames, LatticesThatShareAFrameMakeTheWholePictureOnAnyNumberOfThreads) {
  for (const std::string& name : renderer_names()) {
    for (const Mode mode : all_modes) {
      Subject subject = shaken_box(mode, Projection::perspective, 39, 27);
      const Drawn whole = draw(find_renderer(name), subject.scene, subject.camera, subject.parameters);
      Drawn parts;
      parts.image = Image(39, 27);
      set_threads(3);
      const auto frame = find_renderer(name).prepare(subject.scene, subject.camera, subject.parameters,
                                                     whole_picture(subject.camera), parts.stats, no_progress());
      for (int phase = 0; phase < 8; ++phase) {
        frame->draw({4, 2, phase % 4, phase / 4}, parts.image, parts.stats, {&parts.thickness, &parts.depth, &parts.id},
                    no_progress());
      }
      set_threads(0);
      EXPECT_EQ(parts.image.pixels, whole.image.pixels) << name << " " << mode_name(mode);
      EXPECT_EQ(parts.thickness, whole.thickness) << name << " " << mode_name(mode);
      EXPECT_EQ(parts.depth, whole.depth) << name << " " << mode_name(mode);
      EXPECT_EQ(parts.id, whole.id) << name << " " << mode_name(mode);
      EXPECT_GE(parts.stats.setup_ms, 0.0);
      EXPECT_GT(parts.stats.steps, 0U) << name << " " << mode_name(mode);
    }
  }
}

TEST(Frames, ProgressGoesFromZeroToOneInEachDrawingWhichCanBeCancelled) {
  for (const std::string& name : renderer_names()) {
    for (const Mode mode : all_modes) {
      Subject subject = shaken_box(mode, Projection::parallel, 64, 64);
      RenderStats stats;
      const auto frame = find_renderer(name).prepare(subject.scene, subject.camera, subject.parameters,
                                                     whole_picture(subject.camera), stats, no_progress());
      Image image(64, 64);
      for (int time = 0; time < 2; ++time) {
        double last = 0.0;
        Progress followed([&last](std::string_view, double fraction) {
          EXPECT_GE(fraction, last);
          last = fraction;
        });
        frame->draw({}, image, stats, {}, followed);
        EXPECT_EQ(last, 1.0) << name << " " << mode_name(mode);
      }
      Progress cancelled;
      cancelled.request_cancel();
      EXPECT_THROW(frame->draw({}, image, stats, {}, cancelled), CancelledError) << name << " " << mode_name(mode);
    }
  }
}

}  // namespace
}  // namespace atomesh
