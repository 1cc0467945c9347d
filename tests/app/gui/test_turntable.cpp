// Movies of a sample that turns: as many frames as asked for, which show what they should; nothing left of one that is
// not finished; and what is said where ffmpeg is missing.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "app/gui/picture_state.h"
#include "app/gui/turntable.h"
#include "core/camera.h"
#include "core/error.h"
#include "core/image.h"
#include "tests/app/gui/diamond.h"
#include "tests/app/gui/ogg_movie.h"
#include "tests/support/temporary_folder.h"

namespace atomesh::gui {
namespace {

namespace fs = std::filesystem;

// PATH as it is needed, and as it was again.
class SearchPath {
 public:
  explicit SearchPath(const std::string& path) : before_(std::getenv("PATH")) { ::setenv("PATH", path.c_str(), 1); }
  ~SearchPath() { ::setenv("PATH", before_.c_str(), 1); }
  SearchPath(const SearchPath&) = delete;
  SearchPath& operator=(const SearchPath&) = delete;

 private:
  std::string before_;
};

class Turntable : public DiamondTest {
 protected:
  static TurntableSettings settings(int frames, int width = 96, int height = 64) {
    TurntableSettings turn;
    turn.frames = frames;
    turn.frames_per_second = 12;
    turn.picture.width = width;
    turn.picture.height = height;
    return turn;
  }
  static Parameters surface() {
    Parameters parameters;
    parameters.mode = Mode::surface;
    parameters.surface.color = Vec3f(0.9F, 0.3F, 0.2F);
    return parameters;
  }
  static Vec3 middle(const Document& document, const Parameters& parameters) {
    return sample_bounds(*document.material, parameters).center();
  }
  static Image picture(const Document& document, const Parameters& view, const PictureSettings& size) {
    const PictureStudio studio(document, view, size, no_progress());
    return studio.draw(studio.parameters(), std::nullopt, no_progress());
  }
  // A program called ffmpeg in a folder of its own.
  static void fake_ffmpeg(const std::string& folder, const std::string& script) {
    const std::string file = folder + "/ffmpeg";
    std::ofstream(file) << "#!/bin/sh\n" << script;
    fs::permissions(file, fs::perms::owner_all);
  }
};

TEST_F(Turntable, ViewsGoAroundOnce) {
  const Bounds bounds{Vec3(0.0), Vec3(10.0, 20.0, 30.0)};
  const Vec3 pivot(1.0, 2.0, 3.0);
  Parameters start;
  start.pan = Vec3(3.0, 0.0, -2.0);
  start.roll = 10.0;
  for (const TurntableAxis axis : {TurntableAxis::z, TurntableAxis::picture}) {
    const Camera first = make_camera(start, bounds, 100, 80);
    const Vec3 at = project(first, pivot);
    for (int i = 0; i <= 8; ++i) {
      const Parameters view = turntable_view(start, bounds, pivot, axis, 45.0 * i);
      const Camera camera = make_camera(view, bounds, 100, 80);
      EXPECT_LT(glm::length(project(camera, pivot) - at), 1e-9) << "the pivot stays";
      const Vec3 vertical = axis == TurntableAxis::z ? Vec3(0, 0, 1) : first.up;
      // The axis stands still, and what is at right angles to it has gone that far.
      EXPECT_NEAR(glm::dot(camera.forward, vertical), glm::dot(first.forward, vertical), 1e-9);
      EXPECT_NEAR(glm::dot(camera.up, vertical), glm::dot(first.up, vertical), 1e-9);
      const auto flat = [&](const Vec3& v) { return glm::normalize(v - glm::dot(v, vertical) * vertical); };
      const double cosine = glm::dot(flat(camera.forward), flat(first.forward));
      EXPECT_NEAR(cosine, std::cos(i * std::numbers::pi / 4.0), 1e-9);
      check_parameters(view);
    }
    EXPECT_EQ(turntable_view(start, bounds, pivot, axis, 0.0), start);
    // What is in front goes to the right.
    const Vec3 front = pivot - 5.0 * first.forward;
    const Camera turned = make_camera(turntable_view(start, bounds, pivot, axis, 10.0), bounds, 100, 80);
    EXPECT_GT(project(turned, front).x, project(first, front).x);
  }
}

TEST_F(Turntable, AnOggMovieHasTheFrames) {
  const Document document = open();
  const TurntableSettings turn = settings(7);
  save_turntable(path("turn.ogv"), document, surface(), middle(document, surface()), turn, no_progress());
  const test::Movie movie = test::decode_theora(place->read("turn.ogv"));
  EXPECT_EQ(movie.width, 96);
  EXPECT_EQ(movie.height, 64);
  EXPECT_EQ(movie.frames_per_second, 12.0);
  ASSERT_EQ(movie.frames.size(), 7U);
  for (int i = 0; i < 7; ++i) {
    const Parameters view = turntable_view(surface(), sample_bounds(*document.material, surface()),
                                           middle(document, surface()), TurntableAxis::z, 360.0 * i / 7);
    const Image expected = picture(document, view, turn.picture);
    // Compressed, and with half the resolution in colour: about 30 dB; another frame is far from that.
    const auto& frame = movie.frames[static_cast<std::size_t>(i)];
    EXPECT_GT(compare_images(frame, expected).psnr, 27.0) << i;
    EXPECT_LT(compare_images(movie.frames[static_cast<std::size_t>((i + 1) % 7)], expected).psnr, 24.0) << i;
  }
}

TEST_F(Turntable, OddSizesAndTransparencyBecomeWhatMoviesHave) {
  const PictureSettings odd{.width = 97, .height = 63, .transparent = true};
  EXPECT_EQ(frame_settings("a.ogv", odd).width, 98);
  EXPECT_EQ(frame_settings("a.MP4", odd).height, 64);
  EXPECT_FALSE(frame_settings("a.ogv", odd).transparent);
  EXPECT_EQ(frame_settings("a.png", odd).width, 97);
  EXPECT_TRUE(frame_settings("a.png", odd).transparent);
  const Document document = open();
  TurntableSettings turn = settings(2, 97, 63);
  Parameters parameters = surface();
  parameters.background = Vec4f(0.0F, 0.0F, 1.0F, 0.0F);
  save_turntable(path("odd.ogv"), document, parameters, middle(document, parameters), turn, no_progress());
  const test::Movie movie = test::decode_theora(place->read("odd.ogv"));
  ASSERT_EQ(movie.frames.size(), 2U);
  EXPECT_EQ(movie.width, 98);
  EXPECT_EQ(movie.height, 64);
  const Vec4f corner = movie.frames[0].at(2, 2);
  EXPECT_NEAR(corner.b, 1.0F, 0.05F);
  EXPECT_NEAR(corner.r, 0.0F, 0.05F);
}

TEST_F(Turntable, NumberedPicturesCarryTheirViews) {
  const Document document = open();
  TurntableSettings turn = settings(4, 41, 31);
  turn.axis = TurntableAxis::picture;
  turn.picture.transparent = true;
  turn.picture.parts.tripod = true;
  fs::create_directory(place->path("series"));
  save_turntable(path("series/t.png"), document, surface(), middle(document, surface()), turn, no_progress());
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(place->path("series"))) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"t-0001.png", "t-0002.png", "t-0003.png", "t-0004.png"}));
  for (int i = 0; i < 4; ++i) {
    const std::string png = numbered_path(path("series/t.png"), i + 1);
    EXPECT_EQ(read_png(png).at(0, 0).a, 0.0F);
    // As it says of itself, saved as a single picture.
    const PictureState state = read_picture_state(png);
    ASSERT_TRUE(state.data);
    EXPECT_EQ(state.data->match, PictureData::Match::same);
    save_picture(path("one.png"), document, state.origin.parameters, turn.picture, no_progress());
    EXPECT_EQ(read_png(path("one.png")).pixels, read_png(png).pixels);
  }
  // A shorter series beside the rest of this one would be mixed up with it.
  turn.frames = 3;
  EXPECT_THROW(save_turntable(path("series/t.png"), document, surface(), Vec3(0.0), turn, no_progress()), UsageError);
  EXPECT_EQ(std::distance(fs::directory_iterator(place->path("series")), fs::directory_iterator()), 4);
}

TEST_F(Turntable, AnXrayMovieHasOneLegend) {
  const Document document = open();
  Parameters parameters;
  parameters.mode = Mode::xray;
  parameters.projection = Projection::parallel;
  TurntableSettings turn = settings(3, 200, 160);
  turn.picture.parts.legend = true;
  save_turntable(path("x.png"), document, parameters, middle(document, parameters), turn, no_progress());
  // The legend stands in the lower right corner; its numbers are those of the thickest frame in all of them.
  const auto corner = [&](int frame) {
    const Image image = read_png(numbered_path(path("x.png"), frame));
    std::vector<Vec4f> pixels;
    for (int row = 100; row < 160; ++row) {
      for (int column = 150; column < 200; ++column) pixels.push_back(image.at(column, row));
    }
    return pixels;
  };
  const auto alike = [](const std::vector<Vec4f>& a, const std::vector<Vec4f>& b) {
    std::size_t same = 0;
    for (std::size_t i = 0; i < a.size(); ++i) same += a[i] == b[i] ? 1U : 0U;
    return static_cast<double>(same) / static_cast<double>(a.size());
  };
  EXPECT_GT(alike(corner(1), corner(2)), 0.5);
  double thickest = 0.0;
  const PictureStudio studio(document, parameters, turn.picture, no_progress());
  for (int i = 0; i < 3; ++i) {
    thickest = std::max(
        thickest, studio.largest_thickness(turntable_view(parameters, studio.scene().bounds,
                                                          middle(document, parameters), TurntableAxis::z, 120.0 * i),
                                           no_progress()));
  }
  const Image first = studio.draw(parameters, thickest, no_progress());
  EXPECT_LE(compare_images(read_png(numbered_path(path("x.png"), 1)), first).max, 0.5 / 255.0 + 1e-6);
}

TEST_F(Turntable, CancelledLeavesNothing) {
  const Document document = open();
  for (const char* name : {"never.ogv", "never.png"}) {
    const std::vector<std::string> before = place->files();
    Progress* running = nullptr;
    double reached = 0.0;
    Progress progress([&](std::string_view stage, double fraction) {
      if (stage != "turntable") return;
      reached = std::max(reached, fraction);
      if (fraction > 0.5) running->request_cancel();
    });
    running = &progress;
    EXPECT_THROW(save_turntable(path(name), document, surface(), Vec3(0.0), settings(6), progress), CancelledError);
    EXPECT_GT(reached, 0.5);
    EXPECT_LT(reached, 0.9);
    EXPECT_EQ(place->files(), before) << name;
  }
}

TEST_F(Turntable, WhatCannotBeIsSaid) {
  const Document document = open();
  const auto save = [&](const std::string& name, const TurntableSettings& turn) {
    save_turntable(path(name), document, surface(), Vec3(0.0), turn, no_progress());
  };
  EXPECT_THROW(save("a.doc", settings(3)), UsageError);
  EXPECT_THROW(save("no/such/a.ogv", settings(3)), UsageError);
  EXPECT_THROW(save("a.ogv", settings(1)), UsageError);
  TurntableSettings turn = settings(3);
  turn.degrees = 0.0;
  EXPECT_THROW(save("a.ogv", turn), UsageError);
  turn = settings(3);
  turn.frames_per_second = 0;
  EXPECT_THROW(save("a.ogv", turn), UsageError);
  const SearchPath nowhere("/nowhere");
  EXPECT_EQ(ffmpeg_program(), "");
  EXPECT_EQ(movie_problem("a.ogv"), "");
  EXPECT_EQ(movie_problem("a.png"), "");
  for (const char* name : {"a.mp4", "a.mov", "a.mkv", "a.webm", "a.avi"}) {
    try {
      save(name, settings(3));
      ADD_FAILURE() << name;
    } catch (const UnavailableError& error) {
      EXPECT_NE(std::string(error.what()).find("apt install ffmpeg"), std::string::npos) << error.what();
    }
    EXPECT_FALSE(place->exists(name));
  }
}

TEST_F(Turntable, FfmpegGetsEveryFrame) {
  const Document document = open();
  const test::TemporaryFolder folder;
  // Keeps its words and what it is sent: the raw frames.
  fake_ffmpeg(folder.path().string(),
              "for last; do :; done\necho \"$@\" > " + folder.file("words") + "\nexec cat > \"$last\"\n");
  const SearchPath path_with(folder.path().string() + ":" + std::getenv("PATH"));
  for (const auto& [name, codec] : {std::pair("a.mp4", "libx264"), {"a.webm", "libvpx-vp9"}, {"a.avi", "mpeg4"}}) {
    save_turntable(path(name), document, surface(), middle(document, surface()), settings(5), no_progress());
    const std::string bytes = place->read(name);
    ASSERT_EQ(bytes.size(), 5U * 96 * 64 * 3) << name;
    const std::string words = test::read_bytes(folder.file("words"));
    EXPECT_NE(words.find("-s 96x64 -r 12 "), std::string::npos) << words;
    EXPECT_NE(words.find(codec), std::string::npos) << words;
    // The first frame, from the top.
    const Image expected = picture(document, surface(), settings(5).picture);
    for (int c = 0; c < 3; ++c) {
      for (const std::size_t pixel : {std::size_t{0}, std::size_t{32 * 96 + 48}, std::size_t{20 * 96 + 40}}) {
        EXPECT_EQ(static_cast<unsigned char>(bytes[3 * pixel + static_cast<std::size_t>(c)]),
                  std::lround(255.0F * std::min(1.0F, expected.pixels[pixel][c])));
      }
    }
  }
}

TEST_F(Turntable, FfmpegsTroubleIsTold) {
  const Document document = open();
  const test::TemporaryFolder folder;
  const SearchPath path_with(folder.path().string() + ":" + std::getenv("PATH"));
  for (const char* script : {"echo no such codec >&2\nexit 1\n", "cat > /dev/null\necho no such codec >&2\nexit 1\n"}) {
    fake_ffmpeg(folder.path().string(), script);
    const std::vector<std::string> before = place->files();
    try {
      // Large enough that a pipe does not take it all.
      save_turntable(path("a.mp4"), document, surface(), Vec3(0.0), settings(3, 300, 200), no_progress());
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("ffmpeg says: no such codec"), std::string::npos) << error.what();
    }
    EXPECT_EQ(place->files(), before);
  }
}

// Where it is installed: what it makes is a movie to itself.
TEST_F(Turntable, TheRealFfmpegReadsWhatItWrote) {
  if (ffmpeg_program().empty()) GTEST_SKIP() << "ffmpeg is not installed";
  const Document document = open();
  for (const char* name : {"real.mp4", "real.mov", "real.mkv", "real.webm", "real.avi"}) {
    save_turntable(path(name), document, surface(), middle(document, surface()), settings(5), no_progress());
    const std::string command = ffmpeg_program() + " -loglevel error -i " + path(name) +
                                " -f rawvideo -pix_fmt rgb24 -y " + path("raw") + " < /dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0) << name;
    const std::string bytes = place->read("raw");
    ASSERT_EQ(bytes.size(), 5U * 96 * 64 * 3) << name;
    Image frame(96, 64);
    for (std::size_t i = 0; i < frame.pixels.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        frame.pixels[i][c] =
            static_cast<float>(static_cast<unsigned char>(bytes[3 * i + static_cast<std::size_t>(c)])) / 255.0F;
      }
      frame.pixels[i].a = 1.0F;
    }
    EXPECT_GT(compare_images(frame, picture(document, surface(), settings(5).picture)).psnr, 25.0) << name;
  }
}

}  // namespace
}  // namespace atomesh::gui
