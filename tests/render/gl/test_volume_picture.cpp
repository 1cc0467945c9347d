// Finished pictures of volumes in somebody else's framebuffer: those of render(), and what happens when OpenGL fails.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/error.h"
#include "render/gl/context.h"
#include "render/gl/objects.h"
#include "render/gl/volume_picture.h"
#include "tests/render/fixtures.h"
#include "tests/render/gl/instead.h"

namespace atomesh {
namespace {

using gl::PictureDetail;
using gl::VolumePicture;
using test::Subject;

Subject subject_of(Projection projection, int width, int height) {
  Subject subject = test::shaken_box(Mode::volume, projection, width, height);
  subject.parameters.volume.alpha_length = 0.6;
  subject.parameters.volume.color_map.entries = {{0.0, {0.1F, 0.2F, 0.8F, 0.0F}},
                                                 {0.3, {0.2F, 0.9F, 0.4F, 0.5F}},
                                                 {0.6, {0.9F, 0.7F, 0.1F, 0.1F}},
                                                 {1.0, {0.9F, 0.1F, 0.1F, 1.0F}}};
  return subject;
}

constexpr VolumeSolid all_solids[] = {VolumeSolid::defects, VolumeSolid::atoms, VolumeSolid::walls};

// With something in it.
Subject subject_with(VolumeSolid solid, Projection projection, int width, int height) {
  Subject subject = subject_of(projection, width, height);
  subject.parameters.volume.solid = solid;
  for (auto& entry : subject.parameters.volume.color_map.entries) entry.color.a *= 0.3F;
  subject.scene = make_scene(subject.material, subject.parameters);
  return subject;
}

std::shared_ptr<const Scene> scene_of(const Subject& subject) {
  return std::make_shared<const Scene>(subject.scene);
}

// Premultiplied, as the framebuffer has it.
Image rendered(const char* renderer, const Subject& subject) {
  RenderStats stats;
  Image image = render(find_renderer(renderer), subject.scene, subject.camera, subject.parameters, stats);
  for (Vec4f& pixel : image.pixels) pixel = Vec4f(Vec3f(pixel) * pixel.a, pixel.a);
  return image;
}

// In a context that checks every call.
class FinishedVolume : public testing::TestWithParam<Projection> {
 protected:
  // What is drawn into a framebuffer of floats that is a bit larger.
  Image drawn(VolumePicture& picture, const Subject& subject, const PictureDetail& detail = {}) {
    return framed(subject, [&] { picture.draw(subject.camera, subject.parameters, detail); });
  }
  // What `draw` draws.
  template <class Draw>
  Image framed(const Subject& subject, Draw&& draw) {
    const Camera& camera = subject.camera;
    const gl::Texture target = gl::Texture::make_2d(GL_RGBA32F, camera.width + 3, camera.height + 2);
    const gl::Framebuffer framebuffer = gl::make_framebuffer();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.name(), 0);
    draw();
    GLint bound = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
    EXPECT_EQ(static_cast<GLuint>(bound), framebuffer.name());
    Image upside_down(camera.width, camera.height);
    glReadPixels(0, 0, camera.width, camera.height, GL_RGBA, GL_FLOAT, upside_down.pixels.data());
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    gl::check_errors("the test");
    Image image(camera.width, camera.height);
    for (int row = 0; row < image.height; ++row) {
      for (int column = 0; column < image.width; ++column) {
        image.at(column, row) = upside_down.at(column, image.height - 1 - row);
      }
    }
    return image;
  }

  gl::HeadlessContext context_{true};
  gl::HeadlessContext::Current current_{context_};
};
INSTANTIATE_TEST_SUITE_P(Both, FinishedVolume, testing::Values(Projection::parallel, Projection::perspective));

TEST_P(FinishedVolume, IsWhatTheRenderersGive) {
  VolumePicture picture;
  for (const int n : {1, 2, 3}) {
    for (const Vec4f& background : {Vec4f(0.2F, 0.4F, 0.6F, 1.0F), Vec4f(0.9F, 0.5F, 0.1F, 0.5F), Vec4f(0.0F)}) {
      Subject subject = subject_of(GetParam(), 95, 70);
      subject.parameters.supersampling = n;
      subject.parameters.background = background;
      picture.set_scene(scene_of(subject));
      const Image image = drawn(picture, subject);
      EXPECT_LE(compare_images(image, rendered("havs", subject)).max, 1e-5) << n;
      EXPECT_LE(compare_images(image, rendered("cpu", subject)).max, 4.0 / 255.0) << n;
    }
  }
}

TEST_P(FinishedVolume, IsTheSameInParts) {
  Subject subject = subject_of(GetParam(), 95, 70);
  for (const int n : {1, 2}) {
    subject.parameters.supersampling = n;
    VolumePicture whole;
    whole.set_scene(scene_of(subject));
    VolumePicture parts(33);
    parts.set_scene(whole.scene());
    EXPECT_LE(compare_images(drawn(parts, subject), drawn(whole, subject)).max, 1e-5) << n;
  }
}

TEST_P(FinishedVolume, HasInItWhatTheRenderersHave) {
  VolumePicture picture;
  for (const VolumeSolid solid : all_solids) {
    for (const int n : {1, 2, 3}) {
      Subject subject = subject_with(solid, GetParam(), 95, 70);
      subject.parameters.supersampling = n;
      subject.parameters.background = Vec4f(0.9F, 0.5F, 0.1F, 0.5F);
      picture.set_scene(scene_of(subject));
      const Image image = drawn(picture, subject);
      EXPECT_LE(compare_images(image, rendered("havs", subject)).max, 1e-5) << n;
      EXPECT_LE(compare_images(image, rendered("cpu", subject)).max, 4.0 / 255.0) << n;
      VolumePicture parts(33);
      parts.set_scene(picture.scene());
      EXPECT_LE(compare_images(drawn(parts, subject), image).max, 1e-5) << n;
      subject.scene.solids.reset();
      EXPECT_GT(compare_images(image, rendered("havs", subject)).rmse, 0.02) << "there is nothing in it";
    }
  }
}

TEST_P(FinishedVolume, HasTheSameInItWithFewRays) {
  for (const VolumeSolid solid : all_solids) {
    const Subject subject = subject_with(solid, GetParam(), 95, 70);
    VolumePicture picture(33);
    picture.set_scene(scene_of(subject));
    const Image whole = drawn(picture, subject);
    for (const int stride : {2, 4, 8}) {
      const Image coarse = drawn(picture, subject, {.stride = stride});
      for (int row = 0; row < 70; row += stride) {
        for (int column = 0; column < 95; column += stride) {
          for (int k = 0; k < 4; ++k) {
            ASSERT_NEAR(coarse.at(column, row)[k], whole.at(column, row)[k], 0.03) << column << ' ' << row;
          }
        }
      }
    }
  }
}

TEST_P(FinishedVolume, KeepsWhatIsInItWhileTheViewIsTheSame) {
  for (const int part_side : {33, 4096}) {
    Subject subject = subject_with(VolumeSolid::atoms, GetParam(), 95, 70);
    VolumePicture picture(part_side);
    picture.set_scene(scene_of(subject));
    const auto expect = [&](bool kept, const char* changed) {
      const Image image = drawn(picture, subject);
      EXPECT_EQ(picture.last().solids == 0.0, kept) << changed;
      VolumePicture fresh(part_side);
      fresh.set_scene(picture.scene());
      EXPECT_EQ(image.pixels, drawn(fresh, subject).pixels) << changed;
    };
    expect(false, "nothing known");
    expect(true, "nothing");
    subject.parameters.volume.color_map.entries[1].color.a = 0.9F;
    subject.parameters.volume.alpha_length = 0.7;
    subject.parameters.background = Vec4f(0.1F, 0.1F, 0.1F, 1.0F);
    expect(true, "the colour map");
    drawn(picture, subject, {.stride = 4});
    EXPECT_GT(picture.last().solids, 0.0);
    drawn(picture, subject, {.stride = 4});
    EXPECT_EQ(picture.last().solids, 0.0);
    expect(true, "few rays between");
    subject.parameters.lights[0].color *= 0.5F;
    expect(false, "a light");
    subject.parameters.supersampling = 2;
    expect(false, "rays");
    subject.parameters.supersampling = 1;
    subject.parameters.azimuth += 5.0;
    subject.camera = make_camera(subject.parameters, subject.scene.bounds, 95, 70);
    expect(false, "the view");
    subject.parameters.volume.solid = VolumeSolid::walls;
    subject.scene = make_scene(subject.material, subject.parameters);
    picture.set_scene(scene_of(subject));
    expect(false, "the scene");
  }
}

TEST_P(FinishedVolume, HasTheSameInItInSlicesOfTime) {
  for (const VolumeSolid solid : all_solids) {
    Subject subject = subject_with(solid, GetParam(), 95, 70);
    subject.parameters.supersampling = 2;
    Subject turned = subject;
    turned.parameters.azimuth += 20.0;
    turned.camera = make_camera(turned.parameters, turned.scene.bounds, 95, 70);
    for (const int part_side : {4096, 100}) {
      VolumePicture whole(part_side);
      whole.set_scene(scene_of(subject));
      const Image expected = drawn(whole, subject);
      VolumePicture slices(part_side);
      slices.set_scene(whole.scene());
      // What was begun for another view is given up at whatever point: by slices, and by what is drawn at once.
      for (const int calls : {1, 2, 3, 1000}) {
        const Image image = framed(subject, [&] {
          slices.begin(turned.camera, turned.parameters);
          for (int i = 0; i < calls; ++i) slices.proceed(0.5);
          if (calls == 2) slices.draw(turned.camera, turned.parameters, {.stride = 4});
          slices.begin(subject.camera, subject.parameters);
          slices.begin(subject.camera, subject.parameters);
          while (!slices.proceed(calls == 3 ? 0.0 : 2.0)) glViewport(0, 0, 1, 1);
        });
        EXPECT_EQ(image.pixels, expected.pixels) << part_side << ' ' << calls;
        EXPECT_GT(slices.last().solids, 0.0);
      }
      Progress cancelled;
      cancelled.request_cancel();
      slices.begin(turned.camera, turned.parameters);
      EXPECT_THROW(slices.proceed(1.0, cancelled), CancelledError);
      slices.begin(turned.camera, turned.parameters);
      slices.proceed(0.0);  // and goes while it is drawn
    }
  }
}

TEST_P(FinishedVolume, IsTheSameInSlicesOfTime) {
  Subject subject = subject_of(GetParam(), 95, 70);
  subject.parameters.supersampling = 2;
  for (const int part_side : {4096, 100}) {
    VolumePicture whole(part_side);
    whole.set_scene(scene_of(subject));
    VolumePicture slices(part_side);
    slices.set_scene(whole.scene());
    for (const PictureDetail& detail : {PictureDetail{}, PictureDetail{.stride = 2}}) {
      const Image expected = drawn(whole, subject, detail);
      for (const double milliseconds : {0.0, 2.0}) {
        int calls = 1;
        const Image image = framed(subject, [&] {
          slices.begin(subject.camera, subject.parameters, detail);
          for (; !slices.proceed(milliseconds); ++calls) glViewport(0, 0, 1, 1);
        });
        EXPECT_EQ(image.pixels, expected.pixels) << part_side << ' ' << detail.stride << ' ' << milliseconds;
        EXPECT_GT(calls, milliseconds == 0.0 ? 5 : 0);
        EXPECT_GT(slices.last().pixels, 0.0);
      }
    }
  }
  VolumePicture picture;
  EXPECT_TRUE(picture.proceed(1.0));
  subject.camera.width = 0;
  EXPECT_THROW(picture.begin(subject.camera, subject.parameters), UsageError);
}

// A thread of its own looks at the scene, which nobody else keeps. (One that looks too long is told of by the address
// sanitizer.)
TEST_P(FinishedVolume, MayGoWhileItsSceneIsLookedAt) {
  Subject subject = subject_of(GetParam(), 400, 300);
  subject.material = test::box_material(36, 36, 36, 2.0, test::shaking(0.3, 5));
  test::add_defects(subject.material, 3);
  const Subject other = subject_of(GetParam(), 40, 30);
  const Image expected = rendered("havs", other);
  for (const VolumeSolid solid : {VolumeSolid::none, VolumeSolid::atoms}) {
    subject.parameters.volume.solid = solid;
    subject.scene = make_scene(subject.material, subject.parameters);
    subject.camera = make_camera(subject.parameters, subject.scene.bounds, 400, 300);
    enum class End { destroyed, other_scene, other_picture };
    for (const End end : {End::destroyed, End::other_scene, End::other_picture}) {
      for (const int calls : {2, 3, 6}) {
        std::optional<VolumePicture> picture(std::in_place);
        std::shared_ptr<const Scene> scene = scene_of(subject);
        const std::weak_ptr<const Scene> watched = scene;
        picture->set_scene(std::exchange(scene, nullptr));
        picture->begin(subject.camera, subject.parameters);
        for (int i = 0; i < calls; ++i) ASSERT_FALSE(picture->proceed(0.0)) << calls;
        ASSERT_FALSE(watched.expired());
        if (end == End::destroyed) {
          picture.reset();
          EXPECT_TRUE(watched.expired());
          continue;
        }
        if (end == End::other_picture) {
          picture->begin(other.camera, subject.parameters, {.stride = 8});
          picture->proceed(0.0);
        }
        picture->set_scene(scene_of(other));
        EXPECT_TRUE(watched.expired());
        EXPECT_LE(compare_images(drawn(*picture, other), expected).max, 1e-5);
      }
    }
  }
}

TEST_P(FinishedVolume, OfFewRaysIsNearTheWhole) {
  Subject subject = subject_of(GetParam(), 95, 70);
  subject.parameters.background = Vec4f(0.2F, 0.4F, 0.6F, 1.0F);
  VolumePicture picture;
  picture.set_scene(scene_of(subject));
  const Image whole = drawn(picture, subject);
  subject.parameters.supersampling = 4;  // has no part in it
  double last_psnr = 100.0;
  for (const int stride : {2, 4, 8}) {
    const Image coarse = drawn(picture, subject, {.stride = stride});
    const double psnr = compare_images(coarse, whole).psnr;
    EXPECT_GE(psnr, stride == 2 ? 30.0 : stride == 4 ? 25.0 : 20.0) << stride;
    EXPECT_LT(psnr, last_psnr);
    last_psnr = psnr;
    // Where there are rays, they are the whole's, but for a lattice's own grid of subpixels.
    for (int row = 0; row < 70; row += stride) {
      for (int column = 0; column < 95; column += stride) {
        for (int k = 0; k < 4; ++k) {
          ASSERT_NEAR(coarse.at(column, row)[k], whole.at(column, row)[k], 0.03) << column << ' ' << row;
        }
      }
    }
  }
}

TEST_P(FinishedVolume, LeavesStateAndOthersErrorsAlone) {
  const Subject subject = subject_of(GetParam(), 40, 30);
  VolumePicture picture;
  picture.set_scene(scene_of(subject));
  glEnable(GL_SCISSOR_TEST);
  glScissor(3, 4, 5, 6);
  glViewport(1, 2, 3, 4);
  glEnable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glColorMask(GL_TRUE, GL_FALSE, GL_TRUE, GL_FALSE);
  glEnable(static_cast<GLenum>(-1));  // somebody's mistake, not heard of yet
  gl::take_messages();
  glClearColor(0.1F, 0.2F, 0.3F, 0.4F);
  const Image image = drawn(picture, subject);
  EXPECT_LE(compare_images(image, rendered("havs", subject)).max, 1e-5);
  std::array<GLint, 4> box{};
  glGetIntegerv(GL_VIEWPORT, box.data());
  EXPECT_EQ(box, (std::array<GLint, 4>{1, 2, 3, 4}));
  glGetIntegerv(GL_SCISSOR_BOX, box.data());
  EXPECT_EQ(box, (std::array<GLint, 4>{3, 4, 5, 6}));
  std::array<GLboolean, 4> mask{};
  glGetBooleanv(GL_COLOR_WRITEMASK, mask.data());
  EXPECT_EQ(mask, (std::array<GLboolean, 4>{GL_TRUE, GL_FALSE, GL_TRUE, GL_FALSE}));
  for (const GLenum on : {GL_SCISSOR_TEST, GL_BLEND, GL_DEPTH_TEST}) EXPECT_EQ(glIsEnabled(on), GL_TRUE) << on;
}

TEST_P(FinishedVolume, IsOfVolumesAlone) {
  VolumePicture picture;
  EXPECT_THROW(picture.set_scene(scene_of(test::shaken_box(Mode::atoms, GetParam(), 20, 20))), UsageError);
  Subject subject = subject_of(GetParam(), 20, 20);
  picture.set_scene(scene_of(subject));
  subject.camera.width = 0;
  EXPECT_THROW(picture.draw(subject.camera, subject.parameters), UsageError);
}

void expect_unavailable(const std::function<void()>& act, const std::string& word) {
  try {
    act();
    FAIL() << "nothing thrown";
  } catch (const UnavailableError& error) {
    EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
  }
}

class FailingVolume : public FinishedVolume {
 protected:
  void SetUp() override {
    picture_.emplace();
    picture_->set_scene(scene_of(subject_));
    good_ = drawn(*picture_, subject_);
  }
  // What failed harms no other that comes after it.
  void TearDown() override {
    picture_.reset();
    gl::take_messages();
    VolumePicture next;
    next.set_scene(scene_of(subject_));
    EXPECT_EQ(drawn(next, subject_).pixels, good_.pixels);
  }

  Subject subject_ = subject_of(GetParam(), 40, 30);
  std::optional<VolumePicture> picture_;
  Image good_;
};
INSTANTIATE_TEST_SUITE_P(Perspective, FailingVolume, testing::Values(Projection::perspective));

TEST_P(FailingVolume, SaysThatADriverIsTooOld) {
  static PFNGLGETSTRINGPROC real;
  static const GLubyte* version;
  real = epoxy_glGetString;
  // NOLINTNEXTLINE: OpenGL's strings are of unsigned characters
  version = reinterpret_cast<const GLubyte*>("4.2 (Core Profile) of a test");
  const Instead other(
      epoxy_glGetString, +[](GLenum name) -> const GLubyte* { return name == GL_VERSION ? version : real(name); });
  expect_unavailable([] { const VolumePicture picture; }, "4.2");
}

TEST_P(FailingVolume, SaysThatAShaderFails) {
  static PFNGLSHADERSOURCEPROC real;
  real = epoxy_glShaderSource;
  const Instead other(
      epoxy_glShaderSource, +[](GLuint shader, GLsizei, const GLchar* const*, const GLint*) {
        const GLchar* nonsense = "#version 430\nvoid main() { nothing(); }";
        real(shader, 1, &nonsense, nullptr);
      });
  expect_unavailable([] { const VolumePicture picture; }, "nothing");
}

TEST_P(FailingVolume, SaysThatTheCardsMemoryIsTooSmall) {
  const Instead other(
      epoxy_glTexStorage2D, +[](GLenum, GLsizei, GLenum, GLsizei, GLsizei) {});
  const Instead error(
      epoxy_glGetError, +[]() -> GLenum { return GL_OUT_OF_MEMORY; });
  const Camera camera = make_camera(subject_.parameters, subject_.scene.bounds, 400, 300);
  expect_unavailable([&] { picture_->draw(camera, subject_.parameters); }, "memory");
}

TEST_P(FailingVolume, SaysThatVerticesFindNoMemory) {
  const Instead other(
      epoxy_glMapBufferRange, +[](GLenum, GLintptr, GLsizeiptr, GLbitfield) -> void* { return nullptr; });
  const Camera camera = make_camera(subject_.parameters, subject_.scene.bounds, 41, 30);
  expect_unavailable([&] { picture_->draw(camera, subject_.parameters); }, "memory");
}

TEST_P(FailingVolume, SaysThatTheContextIsLost) {
  {
    const Instead other(
        epoxy_glGetGraphicsResetStatus, +[]() -> GLenum { return GL_INNOCENT_CONTEXT_RESET; });
    expect_unavailable([&] { drawn(*picture_, subject_); }, "lost");
  }
  const Instead other(
      epoxy_glGetError, +[]() -> GLenum { return GL_CONTEXT_LOST; });
  expect_unavailable([&] { drawn(*picture_, subject_); }, "lost");
}

}  // namespace
}  // namespace atomesh
