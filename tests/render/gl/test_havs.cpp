// The renderer "havs": the judge's pictures, windows and lattices, and what it does not draw.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/error.h"
#include "render/gl/context.h"
#include "render/gl/volume.h"
#include "render/renderer.h"
#include "tests/render/fixtures.h"

namespace atomesh {
namespace {

using namespace test;

Subject subject_of(Projection projection, int width, int height) {
  Subject subject = shaken_box(Mode::volume, projection, width, height);
  subject.parameters.volume.alpha_length = 0.6;
  subject.parameters.volume.color_map.entries = {{0.0, {0.1F, 0.2F, 0.8F, 0.0F}},
                                                 {0.3, {0.2F, 0.9F, 0.4F, 0.5F}},
                                                 {0.6, {0.9F, 0.7F, 0.1F, 0.1F}},
                                                 {1.0, {0.9F, 0.1F, 0.1F, 1.0F}}};
  return subject;
}

class Havs : public testing::TestWithParam<Projection> {};
INSTANTIATE_TEST_SUITE_P(Both, Havs, testing::Values(Projection::parallel, Projection::perspective));

TEST_P(Havs, DrawsWhatTheJudgeDraws) {
  const Subject subject = subject_of(GetParam(), 160, 120);
  const Drawn drawn = draw(find_renderer("havs"), subject.scene, subject.camera, subject.parameters);
  const Drawn judged = draw(find_renderer("reference"), subject.scene, subject.camera, subject.parameters);
  const ImageDifference difference = compare_images(drawn.image, judged.image);
  EXPECT_LE(difference.max, 4.0 / 255.0);
  EXPECT_GE(difference.psnr, 60.0);
  const auto light = std::count_if(judged.image.pixels.begin(), judged.image.pixels.end(),
                                   [](const Vec4f& pixel) { return pixel.a > 0.1F; });
  EXPECT_GT(light, 2000);
}

TEST_P(Havs, WindowsAndLatticesAreThePictureToRounding) {
  const Subject subject = subject_of(GetParam(), 101, 75);
  const Renderer& havs = find_renderer("havs");
  const Drawn whole = draw(havs, subject.scene, subject.camera, subject.parameters);
  for (const PixelWindow& window :
       {PixelWindow{0, 0, 101, 75}, PixelWindow{33, 5, 50, 64}, PixelWindow{50, 37, 1, 1}}) {
    for (const PixelLattice& lattice : {PixelLattice{}, PixelLattice{2, 2, 1, 0}, PixelLattice{2, 8, 1, 5}}) {
      RenderStats stats;
      const auto frame = havs.prepare(subject.scene, subject.camera, subject.parameters, window, stats, no_progress());
      Image image(window.width, window.height);
      const Vec4f untouched(-1.0F);
      std::fill(image.pixels.begin(), image.pixels.end(), untouched);
      frame->draw(lattice, image, stats, {}, no_progress());
      for (int row = 0; row < window.height; ++row) {
        for (int column = 0; column < window.width; ++column) {
          const int picture_column = window.left + column;
          const int picture_row = window.top + row;
          const bool drawn = picture_column % lattice.column_stride == lattice.column_phase &&
                             picture_row % lattice.row_stride == lattice.row_phase;
          const Vec4f expected = drawn ? whole.image.at(picture_column, picture_row) : untouched;
          // A lattice has a grid of subpixels of its own.
          const double tolerance = lattice.column_stride == 1 && lattice.row_stride == 1 ? 1e-5 : 0.02;
          for (int k = 0; k < 4; ++k) {
            ASSERT_NEAR(image.at(column, row)[k], expected[k], tolerance)
                << "pixel " << column << ' ' << row << " of the window " << window.left << ' ' << window.top;
          }
        }
      }
    }
  }
}

TEST_P(Havs, IntegratesByTheTableToItsError) {
  Subject subject = subject_of(GetParam(), 160, 120);
  const Drawn exact = draw(find_renderer("havs"), subject.scene, subject.camera, subject.parameters);
  subject.parameters.havs.integration = HavsIntegration::table;
  subject.parameters.havs.table_error = 0.01;  // the map bends sharply
  const Drawn table = draw(find_renderer("havs"), subject.scene, subject.camera, subject.parameters);
  const ImageDifference difference = compare_images(table.image, exact.image);
  EXPECT_GT(difference.max, 1e-6);  // it is the table
  EXPECT_LE(difference.max, subject.parameters.havs.table_error);
}

// Software's default. Jumps, a constant scalar, pieces that nothing is seen of, few and many pieces a cell.
TEST_P(Havs, IntegratesBySumsOfRampsNearlyExactly) {
  gl::HeadlessContext context;
  const gl::HeadlessContext::Current current(context);
  if (!gl::current_driver().software) GTEST_SKIP() << "a graphics card integrates by its table";
  Subject subject = subject_of(GetParam(), 160, 120);
  subject.material = box_material(9, 9, 9, 2.0, shaking(0.3, 5));
  add_defects(subject.material, 3);
  subject.scene = make_scene(subject.material, subject.parameters);
  subject.camera = make_camera(subject.parameters, subject.scene.bounds, 160, 120);
  subject.parameters.volume.alpha_length = 2.0 / subject.scene.bounds.diagonal();
  const std::vector<ColorMap> maps{subject.parameters.volume.color_map,
                                   preset_color_map("viridis"),
                                   {{{0.0, {0.1F, 0.2F, 0.8F, 0.3F}},
                                     {0.45, {0.1F, 0.9F, 0.8F, 0.3F}},
                                     {0.45, {0.9F, 0.2F, 0.1F, 1.0F}},
                                     {0.6, {0.9F, 0.2F, 0.1F, 0.0F}},
                                     {0.9, {0.9F, 0.2F, 0.1F, 0.0F}},
                                     {1.0, {0.0F, 1.0F, 0.0F, 1.0F}}}}};
  for (const bool constant : {false, true}) {
    if (constant) std::fill(subject.scene.scalars.begin(), subject.scene.scalars.end(), 0.3F);
    for (const ColorMap& map : maps) {
      SCOPED_TRACE(std::to_string(&map - maps.data()) + (constant ? ", constant" : ""));
      subject.parameters.volume.color_map = map;
      gl::Volume volume;
      volume.set_scene(subject.scene);
      const auto drawn = [&](HavsIntegration integration) {
        subject.parameters.havs.integration = integration;
        RenderStats stats;
        volume.draw(subject.camera, subject.parameters, whole_picture(subject.camera), {}, stats, no_progress());
        return volume.read();
      };
      const Image exact = drawn(HavsIntegration::exact);
      EXPECT_EQ(volume.last().ramp_triangles, 0U);
      const Image ramps = drawn(HavsIntegration::automatic);
      EXPECT_GT(2 * volume.last().ramp_triangles, volume.last().triangles);
      const ImageDifference difference = compare_images(ramps, exact);
      EXPECT_LE(difference.max, 0.5 / 255.0);
      EXPECT_GT(difference.max, 0.0);  // it is something else
      EXPECT_GE(difference.psnr, 70.0);
      const Image again = drawn(HavsIntegration::exact);
      EXPECT_EQ(compare_images(again, exact).max, 0.0);
    }
  }
  // Just where the map jumps it is what lies above; what is integrated exactly is to one side or the other there, by
  // rounding.
  std::fill(subject.scene.scalars.begin(), subject.scene.scalars.end(), 0.45F);
  subject.parameters.volume.color_map = maps[2];
  subject.parameters.havs.integration = HavsIntegration::automatic;
  const Drawn ramps = draw(find_renderer("havs"), subject.scene, subject.camera, subject.parameters);
  const Vec4f above{0.9F, 0.2F, 0.1F, 1.0F};
  subject.parameters.volume.color_map.entries = {{0.0, above}, {1.0, above}};
  const Drawn judged = draw(find_renderer("reference"), subject.scene, subject.camera, subject.parameters);
  EXPECT_LE(compare_images(ramps.image, judged.image).max, 0.5 / 255.0);
}

// No face is shared, and no order of whole cells is right.
TEST_P(Havs, RepairsWhatTheOutsideShows) {
  const Parameters parameters = looking(Mode::volume, "front", GetParam());
  Subject subject{ring_of_bars(), parameters, {}, {}};
  subject.parameters.volume.color_map.entries = {{0.0, {0.2F, 0.9F, 0.4F, 0.5F}}, {1.0, {0.9F, 0.1F, 0.1F, 1.0F}}};
  subject.scene = make_scene(subject.material, subject.parameters);
  subject.parameters.volume.alpha_length = 80.0 / subject.scene.bounds.diagonal();
  for (std::size_t v = 0; v < subject.scene.scalars.size(); ++v) {
    subject.scene.scalars[v] = static_cast<float>(v / 4) / 2.0F;  // a colour a bar
  }
  subject.camera = make_camera(subject.parameters, subject.scene.bounds, 160, 160);
  gl::HeadlessContext context;
  const gl::HeadlessContext::Current current(context);
  gl::Volume volume;
  volume.set_order_by_faces(true);
  volume.set_scene(subject.scene);
  const auto drawn = [&](HavsOrder order) {
    subject.parameters.havs.order = order;
    RenderStats stats;
    volume.draw(subject.camera, subject.parameters, whole_picture(subject.camera), {}, stats, no_progress());
    return volume.read();
  };
  const Drawn judged = draw(find_renderer("reference"), subject.scene, subject.camera, subject.parameters);
  EXPECT_GT(compare_images(drawn(HavsOrder::none), judged.image).max, 0.02);
  for (const HavsOrder order : {HavsOrder::lists, HavsOrder::k_buffer}) {
    EXPECT_LE(compare_images(drawn(order), judged.image).max, 4.0 / 255.0);
    EXPECT_GT(volume.last().repair.pixels, 10U);
    EXPECT_EQ(volume.last().repair.wrong_pixels, 0U);
  }
}

TEST_P(Havs, DrawsFromInsideTheSample) {
  Subject subject = subject_of(GetParam(), 96, 96);
  subject.camera.eye = subject.scene.bounds.center() + 0.1 * subject.camera.right;
  const Drawn drawn = draw(find_renderer("havs"), subject.scene, subject.camera, subject.parameters);
  const Drawn judged = draw(find_renderer("reference"), subject.scene, subject.camera, subject.parameters);
  const ImageDifference difference = compare_images(drawn.image, judged.image);
  EXPECT_LE(difference.max, 4.0 / 255.0);
  EXPECT_GE(difference.psnr, 55.0);
}

TEST_P(Havs, EndsRaysAtWhatStandsInTheVolume) {
  for (const VolumeSolid solid : {VolumeSolid::atoms, VolumeSolid::walls}) {
    Subject subject = subject_of(GetParam(), 120, 90);
    subject.parameters.volume.solid = solid;
    subject.parameters.atoms.scale = 0.3;
    subject.scene = make_scene(subject.material, subject.parameters);
    const Drawn drawn = draw(find_renderer("havs"), subject.scene, subject.camera, subject.parameters);
    const Drawn judged = draw(find_renderer("cpu"), subject.scene, subject.camera, subject.parameters);
    const ImageDifference difference = compare_images(drawn.image, judged.image);
    EXPECT_LE(difference.max, 4.0 / 255.0);
    EXPECT_GE(difference.psnr, 55.0);
    Subject empty = subject_of(GetParam(), 120, 90);
    const Drawn without = draw(find_renderer("havs"), empty.scene, empty.camera, empty.parameters);
    EXPECT_GT(compare_images(without.image, drawn.image).max, 0.2);
  }
}

TEST(HavsRenderer, NamesWhoDrawsTheOtherModes) {
  for (const Mode mode : all_modes) {
    if (mode == Mode::volume) continue;
    const Subject subject = shaken_box(mode, Projection::parallel, 20, 20);
    try {
      draw(find_renderer("havs"), subject.scene, subject.camera, subject.parameters);
      FAIL() << mode_name(mode);
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find("cpu"), std::string::npos) << error.what();
    }
  }
}

TEST(HavsRenderer, DrawsNothingOfAnEmptyScene) {
  Subject subject = subject_of(Projection::perspective, 20, 20);
  subject.scene.tetrahedra = {};
  const Drawn drawn = draw(find_renderer("havs"), subject.scene, subject.camera, subject.parameters);
  for (const Vec4f& pixel : drawn.image.pixels) EXPECT_EQ(pixel, Vec4f(0.0F));
}

// Wider than what is drawn at once.
TEST(HavsRenderer, PutsLargePicturesTogether) {
  Subject subject = subject_of(Projection::perspective, 2600, 20);
  subject.parameters.zoom = 0.02;
  subject.parameters.field_of_view = 120.0;
  subject.camera = make_camera(subject.parameters, subject.scene.bounds, 2600, 20);
  // The middle of the sample stands where two windows meet.
  subject.camera.pixel /= 40.0;
  subject.camera.eye -= (2048.0 - 1300.0) * subject.camera.pixel *
                        glm::dot(subject.scene.bounds.center() - subject.camera.eye, subject.camera.forward) *
                        subject.camera.right;
  std::vector<double> fractions;
  Progress progress([&](std::string_view, double fraction) { fractions.push_back(fraction); });
  RenderStats stats;
  const Image drawn =
      find_renderer("havs").draw(subject.scene, subject.camera, subject.parameters, stats, {}, progress);
  const Drawn other = draw(find_renderer("cpu"), subject.scene, subject.camera, subject.parameters);
  EXPECT_LE(compare_images(drawn, other.image).max, 4.0 / 255.0);
  EXPECT_GT(other.image.at(2040, 10).a, 0.1F);
  EXPECT_GT(other.image.at(2056, 10).a, 0.1F);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1.0);
}

TEST(HavsRenderer, CanBeCancelled) {
  const Subject subject = subject_of(Projection::perspective, 64, 64);
  Progress progress;
  progress.request_cancel();
  RenderStats stats;
  EXPECT_THROW(find_renderer("havs").draw(subject.scene, subject.camera, subject.parameters, stats, {}, progress),
               CancelledError);
}

// In a context that checks every call: draw() and read() throw what it finds.
class DebugVolume : public testing::Test {
 protected:
  void draw(const Subject& subject) {
    RenderStats stats;
    volume.draw(subject.camera, subject.parameters, whole_picture(subject.camera), {}, stats, no_progress());
  }

  gl::HeadlessContext context{true};
  gl::HeadlessContext::Current current{context};
  gl::Volume volume;
};

TEST_F(DebugVolume, ViewsThatStayAreDrawnWithoutSorting) {
  Subject subject = subject_of(Projection::perspective, 90, 70);
  volume.set_scene(subject.scene);
  draw(subject);
  const Image first = volume.read();
  draw(subject);
  EXPECT_EQ(volume.last().project_ms, 0.0);
  EXPECT_EQ(volume.last().order_ms, 0.0);
  EXPECT_EQ(volume.last().faces_ms, 0.0);
  EXPECT_EQ(compare_images(volume.read(), first).max, 0.0);

  // Other colours, of other transparency.
  subject.parameters.volume.color_map.entries[0].color.a = 0.4F;
  draw(subject);
  const Image recolored = volume.read();
  EXPECT_GT(compare_images(recolored, first).max, 0.05);
  volume.set_scene(subject.scene);
  draw(subject);
  EXPECT_EQ(compare_images(volume.read(), recolored).max, 0.0);

  // A smaller picture in the same texture.
  subject.camera = make_camera(subject.parameters, subject.scene.bounds, 40, 30);
  draw(subject);
  const Image small = volume.read();
  EXPECT_EQ(small.width, 40);
  const Drawn judged = test::draw(find_renderer("reference"), subject.scene, subject.camera, subject.parameters);
  EXPECT_LE(compare_images(small, judged.image).max, 4.0 / 255.0);
}

// However little at a time: the same bits.
TEST_F(DebugVolume, TimedStepsMakeTheSamePicture) {
  Subject subject = subject_of(Projection::perspective, 90, 70);
  volume.set_scene(subject.scene);
  draw(subject);
  const Image whole = volume.read();
  for (const bool on_card : {false, true}) {
    volume.set_prepare_on_card(on_card);
    volume.set_timed_steps(true);
    volume.set_scene(subject.scene);
    draw(subject);
    EXPECT_EQ(volume.last().on_card, on_card);
    EXPECT_LE(compare_images(volume.read(), whole).max, on_card ? 2e-3 : 0.0);
    EXPECT_GT(volume.last().project_ms, 0.0);
    EXPECT_GT(volume.last().order_ms, 0.0);
    // Software gets the processor's faces in portions while it draws.
    const bool portions = !on_card && gl::current_driver().software;
    EXPECT_EQ(volume.last().faces_ms > 0.0, !portions);
  }
}

TEST_F(DebugVolume, SlicesOfTimeMakeTheSamePicture) {
  Subject subject = subject_of(Projection::perspective, 90, 70);
  volume.set_scene(subject.scene);
  const PixelWindow window = whole_picture(subject.camera);
  RenderStats stats;
  EXPECT_TRUE(volume.proceed(1.0, stats, no_progress()));  // nothing is begun
  draw(subject);
  const Image whole = volume.read();
  const std::size_t triangles = volume.last().triangles;
  const auto in_slices = [&](double milliseconds) {
    volume.begin(subject.camera, subject.parameters, window, {});
    int calls = 1;
    for (; !volume.proceed(milliseconds, stats, no_progress()); ++calls) {
      // What somebody else does meanwhile, and finds as it was.
      glUseProgram(0);
      glViewport(0, 0, 1, calls % 7 + 1);
      glDisable(GL_BLEND);
      glBindTexture(GL_TEXTURE_2D, 0);
    }
    EXPECT_EQ(glIsEnabled(GL_BLEND), GL_FALSE);
    std::array<GLint, 4> viewport{};
    glGetIntegerv(GL_VIEWPORT, viewport.data());
    EXPECT_TRUE(calls == 1 || viewport[3] == (calls - 1) % 7 + 1);
    return calls;
  };
  volume.set_scene(subject.scene);
  EXPECT_GT(in_slices(0.0), 10);
  EXPECT_EQ(volume.read().pixels, whole.pixels);
  EXPECT_EQ(volume.last().triangles, triangles);
  // Of the same view again, which is not prepared again.
  EXPECT_GT(in_slices(0.1), 1);
  EXPECT_EQ(volume.last().faces_ms, 0.0);
  EXPECT_EQ(volume.read().pixels, whole.pixels);
  EXPECT_EQ(in_slices(1e9), 1);
  EXPECT_EQ(volume.read().pixels, whole.pixels);

  // One that is dropped at any step changes none that comes after it.
  const Camera camera = subject.camera;
  for (int calls = 1; calls < 8; ++calls) {
    subject.camera = make_camera(subject.parameters, subject.scene.bounds, 60, 80);
    volume.begin(subject.camera, subject.parameters, whole_picture(subject.camera), {});
    for (int i = 0; i < calls; ++i) volume.proceed(0.0, stats, no_progress());
    subject.camera = camera;
    draw(subject);
    EXPECT_EQ(volume.read().pixels, whole.pixels) << calls;
    // A cancelled one, too.
    volume.begin(subject.camera, subject.parameters, window, {});
    Progress cancelled;
    cancelled.request_cancel();
    EXPECT_THROW(volume.proceed(1e9, stats, cancelled), CancelledError);
    EXPECT_TRUE(volume.proceed(1e9, stats, no_progress()));
  }
}

// From three slabs of cells to one, prepared by a thread that has no OpenGL.
TEST_F(DebugVolume, SlicesOfTimeMayNeedLessMemoryThanBefore) {
  Subject subject = subject_of(Projection::perspective, 60, 50);
  subject.material = box_material(30, 30, 26, 2.0, shaking(0.35, 1));
  add_defects(subject.material, 1);
  subject.parameters.volume.color_map.entries[0].color.a = 0.1F;
  subject.scene = make_scene(subject.material, subject.parameters);
  subject.camera = make_camera(subject.parameters, subject.scene.bounds, 400, 300);
  volume.set_scene(subject.scene);
  draw(subject);
  EXPECT_GT(volume.last().cells, 2U * 65536U);
  subject.camera = make_camera(subject.parameters, subject.scene.bounds, 24, 18);
  RenderStats stats;
  volume.begin(subject.camera, subject.parameters, whole_picture(subject.camera), {});
  while (!volume.proceed(5.0, stats, no_progress())) {
  }
  EXPECT_LT(volume.last().cells, 65536U);
  const Image slices = volume.read();
  volume.set_scene(subject.scene);
  draw(subject);
  EXPECT_EQ(slices.pixels, volume.read().pixels);
}

TEST_F(DebugVolume, LeavesOpenGlAsItWas) {
  const Subject subject = subject_of(Projection::perspective, 30, 30);
  glViewport(3, 4, 5, 6);
  glEnable(GL_CULL_FACE);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE, GL_DST_ALPHA, GL_ZERO);
  glStencilFunc(GL_LESS, 3, 7);
  volume.set_scene(subject.scene);
  draw(subject);
  volume.read();
  std::array<GLint, 4> viewport{};
  glGetIntegerv(GL_VIEWPORT, viewport.data());
  EXPECT_EQ(viewport, (std::array<GLint, 4>{3, 4, 5, 6}));
  EXPECT_EQ(glIsEnabled(GL_CULL_FACE), GL_TRUE);
  EXPECT_EQ(glIsEnabled(GL_BLEND), GL_FALSE);
  GLint value = 0;
  glGetIntegerv(GL_BLEND_DST_RGB, &value);
  EXPECT_EQ(value, GL_ONE);
  glGetIntegerv(GL_STENCIL_FUNC, &value);
  EXPECT_EQ(value, GL_LESS);
  glGetIntegerv(GL_CURRENT_PROGRAM, &value);
  EXPECT_EQ(value, 0);
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &value);
  EXPECT_EQ(value, 0);
}

}  // namespace
}  // namespace atomesh
