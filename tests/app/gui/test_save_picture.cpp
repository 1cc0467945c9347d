// Saved pictures are those of `atomesh render`, to the last bit; nothing is left of one that is not finished.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "app/gui/save_picture.h"
#include "core/error.h"
#include "core/memory.h"
#include "render/passes.h"
#include "tests/app/gui/diamond.h"

namespace atomesh::gui {
namespace {

const std::vector<std::string> modes{"volume-surface", "volume", "surface", "xray", "atoms"};

class SavePicture : public DiamondTest {
 protected:
  static std::size_t files() { return place->files().size(); }
  // Cancels as soon as the named stage is under way.
  static std::unique_ptr<Progress> cancelled_in(const std::string& stage) {
    auto progress = std::make_shared<Progress*>(nullptr);
    auto made = std::make_unique<Progress>([progress, stage](std::string_view name, double fraction) {
      if (name == stage && fraction > 0.0) (*progress)->request_cancel();
    });
    *progress = made.get();
    return made;
  }
};

TEST_F(SavePicture, IsTheCommandLinesToTheLastByte) {
  const Document document = open();
  for (const std::string& mode : modes) {
    Parameters parameters;
    parameters.mode = mode_from_name(mode);
    parameters.azimuth = 50.0;
    save_picture(path("window.png"), document, parameters, {.width = 123, .height = 91}, no_progress());
    cli({"render", "d.crb", "-o", "cli.png", "--mode", mode, "--size", "123x91", "--set", "view.azimuth=50"});
    EXPECT_EQ(place->read("window.png"), place->read("cli.png")) << mode;
  }
}

TEST_F(SavePicture, WithLegendScaleBarAndTripodToo) {
  const Document document = open();
  for (const std::string& mode : modes) {
    Parameters parameters;
    parameters.mode = mode_from_name(mode);
    save_picture(
        path("window.png"), document, parameters,
        {.width = 320, .height = 240, .supersampling = 2, .parts = {.legend = true, .scale_bar = true, .tripod = true}},
        no_progress());
    cli({"render", "d.crb", "-o", "cli.png", "--mode", mode, "--size", "320x240", "--legend", "--scale-bar", "--tripod",
         "--set", "quality.supersampling=2"});
    EXPECT_EQ(place->read("window.png"), place->read("cli.png")) << mode;
    cli({"render", "d.crb", "-o", "bare.png", "--mode", mode, "--size", "320x240", "--set", "quality.supersampling=2"});
    EXPECT_NE(read_png(path("window.png")).pixels, read_png(path("bare.png")).pixels) << mode;
  }
}

TEST_F(SavePicture, ReadsThePartsThatAreMissing) {
  Parameters parameters;
  parameters.mode = Mode::atoms;
  const Document document = open_document(path("d.crb"), parts_needed(parameters), no_progress());
  ASSERT_TRUE(document.material->mesh.tetrahedra.empty());
  parameters.mode = Mode::volume_surface;
  save_picture(path("window.png"), document, parameters, {.width = 60, .height = 40}, no_progress());
  cli({"render", "d.crb", "-o", "cli.png", "--size", "60x40"});
  EXPECT_EQ(place->read("window.png"), place->read("cli.png"));
}

TEST_F(SavePicture, TransparentIsNothingButTheSample) {
  const Document document = open();
  Parameters parameters;
  parameters.mode = Mode::surface;
  parameters.background = Vec4f(1.0F, 0.0F, 0.0F, 1.0F);
  const PictureSettings settings{.width = 100, .height = 80, .transparent = true};
  save_picture(path("clear.png"), document, parameters, settings, no_progress());
  const Image clear = read_png(path("clear.png"));
  EXPECT_EQ(clear.at(0, 0).a, 0.0F);
  EXPECT_EQ(clear.at(50, 40).a, 1.0F);
  save_picture(path("red.png"), document, parameters, {.width = 100, .height = 80}, no_progress());
  const Image red = read_png(path("red.png"));
  EXPECT_EQ(red.at(0, 0), Vec4f(1.0F, 0.0F, 0.0F, 1.0F));
  EXPECT_EQ(red.at(50, 40), clear.at(50, 40));
  // What is in memory, for the clipboard, is what is in the file.
  const PictureStudio studio(document, parameters, settings, no_progress());
  const Image drawn = studio.draw(studio.parameters(), std::nullopt, no_progress());
  EXPECT_LE(compare_images(drawn, clear).max, 0.5 / 255.0 + 1e-6);
}

TEST_F(SavePicture, MarksAndPicksAreInIt) {
  const Document document = open();
  Parameters parameters;
  parameters.mode = Mode::surface;
  PictureSettings settings{.width = 160, .height = 120};
  const auto drawn = [&] {
    const PictureStudio studio(document, parameters, settings, no_progress());
    return studio.draw(studio.parameters(), std::nullopt, no_progress());
  };
  const Image bare = drawn();
  settings.marks = {{.position = document.material->atoms.positions[10], .radius = 3.0, .text = "here"}};
  const Image marked = drawn();
  EXPECT_GT(compare_images(bare, marked).pixels_over, 50U);
  settings.picks = {pick_atom(*document.material, 0), pick_atom(*document.material, 500)};
  EXPECT_GT(compare_images(marked, drawn()).pixels_over, 50U);
}

TEST_F(SavePicture, CancelledLeavesNothing) {
  const Document document = open();
  Parameters parameters;
  const std::size_t before = files();
  const PictureSettings settings{.width = 800, .height = 600};
  EXPECT_THROW(save_picture(path("never.png"), document, parameters, settings, *cancelled_in("render")),
               CancelledError);
  EXPECT_EQ(files(), before);
  Progress at_once;
  at_once.request_cancel();
  EXPECT_THROW(save_picture(path("never.png"), document, parameters, settings, at_once), CancelledError);
  EXPECT_EQ(files(), before);
  EXPECT_THROW(save_picture(path("no/such/folder.png"), document, parameters, {}, no_progress()), Error);
  EXPECT_EQ(files(), before);
}

TEST_F(SavePicture, SizesAreChecked) {
  const Document document = open();
  for (const auto& [width, height] : {std::pair(0, 10), {10, 0}, {largest_picture_side + 1, 10}, {-5, -5}}) {
    EXPECT_THROW(save_picture(path("never.png"), document, {}, {.width = width, .height = height}, no_progress()),
                 UsageError);
  }
  EXPECT_THROW(save_picture(path("never.png"), document, {}, {.renderer = "crayons"}, no_progress()), UsageError);
  EXPECT_THROW(save_picture(path("never.png"), document, {}, {.supersampling = 99}, no_progress()), UsageError);
  EXPECT_FALSE(place->exists("never.png"));
}

TEST_F(SavePicture, LargerThanMemoryIsDrawnInPasses) {
  const Document document = open();
  Parameters parameters;
  parameters.mode = Mode::xray;
  const PictureSettings settings{.width = 9000, .height = 7000, .parts = {.legend = true}};
  // 63 million pixels of 20 bytes are more than a pass may take.
  const PicturePlan plan = plan_picture(parameters, settings);
  EXPECT_GT(plan.passes, 1);
  EXPECT_LE(plan.bytes, default_pass_bytes() + default_pass_bytes() / 100);
  release_free_memory();
  reset_peak_memory();
  const std::uint64_t before = current_memory();
  const PicturePlan done = save_picture(path("large.png"), document, parameters, settings, no_progress());
  EXPECT_EQ(done.passes, plan.passes);
#if !defined(__SANITIZE_ADDRESS__)  // whose allocator keeps what is freed
  EXPECT_LT(recent_peak_memory() - before, plan.bytes + 200'000'000);
#else
  static_cast<void>(before);
#endif
  EXPECT_EQ(cli::read_picture_origin(path("large.png")).parts, settings.parts);
  std::filesystem::remove(path("large.png"));
}

}  // namespace
}  // namespace atomesh::gui
