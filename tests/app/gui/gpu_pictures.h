// For tests of the graphics card's pictures: a context, what is drawn in it, and how far that is from the CPU's.
#pragma once

#include <gtest/gtest.h>

#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>
#include <QOpenGLFramebufferObject>
#include <algorithm>
#include <cmath>

#include "app/gui/gpu_scene.h"
#include "core/error.h"
#include "render/renderer.h"
#include "tests/app/gui/window_test.h"
#include "tests/render/fixtures.h"

namespace atomesh::test {

// A context of OpenGL 3.2, current while it lives, as a widget would have it.
class Card {
 public:
  Card() {
    QSurfaceFormat format;
    format.setVersion(3, 2);
    format.setProfile(QSurfaceFormat::CoreProfile);
    context_.setFormat(format);
    if (!context_.create()) throw UnavailableError("no context");
    surface_.setFormat(context_.format());
    surface_.create();
    context_.makeCurrent(&surface_);
  }
  ~Card() { context_.doneCurrent(); }

  QOpenGLContext& context() { return context_; }

  // What the scene draws, premultiplied.
  Image draw(gui::GpuScene& gpu, const Camera& camera, const Parameters& parameters) {
    QOpenGLFramebufferObject target(camera.width, camera.height);
    target.bind();
    gpu.draw(camera, parameters);
    GLint bound = 0;
    auto& gl = *context_.functions();
    gl.glGetIntegerv(GL_FRAMEBUFFER_BINDING, &bound);
    EXPECT_EQ(static_cast<GLuint>(bound), target.handle()) << "the caller's framebuffer is not bound any more";
    EXPECT_EQ(gl.glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    std::vector<unsigned char> bytes(static_cast<std::size_t>(4 * camera.width * camera.height));
    gl.glReadPixels(0, 0, camera.width, camera.height, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
    Image image(camera.width, camera.height);
    for (int row = 0; row < image.height; ++row) {
      for (int column = 0; column < image.width; ++column) {
        const unsigned char* p =
            &bytes[static_cast<std::size_t>(4 * ((image.height - 1 - row) * image.width + column))];
        image.at(column, row) = Vec4f(p[0], p[1], p[2], p[3]) / 255.0F;
      }
    }
    return image;
  }

 private:
  QOpenGLContext context_;
  QOffscreenSurface surface_;
};

#define NEED_A_CARD \
  if (!atomesh::test::has_opengl()) GTEST_SKIP() << "no OpenGL 3.2 here"

inline Image cpu_picture(const Scene& scene, const Camera& camera, const Parameters& parameters) {
  RenderStats stats;
  Image image = render(find_renderer("cpu"), scene, camera, parameters, stats);
  for (Vec4f& pixel : image.pixels) pixel = Vec4f(Vec3f(pixel) * pixel.a, pixel.a);
  return image;
}

inline float difference(const Vec4f& a, const Vec4f& b) {
  const Vec4f d = glm::abs(a - b);
  return std::max({d.r, d.g, d.b, d.a});
}

inline constexpr float tolerance = 1.5F / 255.0F;  // the rounding to bytes, twice (with a background), and a bit

// Pixels that differ from the CPU's by more than the tolerance; and those of them for which no ray is to blame that
// passes within `slack` of a pixel of the pixel's centre: what the card shows there lies not even between the colours
// of such rays.
struct Disagreement {
  std::size_t pixels = 0;
  std::size_t unexplained = 0;
  std::size_t covered = 0;  // pixels that show something
  double mean = 0.0;        // absolute difference of a channel
};

inline Disagreement disagreement(const Image& gpu, const Scene& scene, const Camera& camera,
                                 const Parameters& parameters, double slack) {
  const Image cpu = cpu_picture(scene, camera, parameters);
  Image low = cpu;
  Image high = cpu;
  for (const int across : {-1, 0, 1}) {
    for (const int upward : {-1, 0, 1}) {
      if (across == 0 && upward == 0) continue;
      const Image near = cpu_picture(scene, moved_beside(camera, slack * across, slack * upward), parameters);
      for (std::size_t i = 0; i < near.pixels.size(); ++i) {
        low.pixels[i] = glm::min(low.pixels[i], near.pixels[i]);
        high.pixels[i] = glm::max(high.pixels[i], near.pixels[i]);
      }
    }
  }
  Disagreement found;
  const Vec4f background(Vec3f(parameters.background) * parameters.background.a, parameters.background.a);
  for (std::size_t i = 0; i < cpu.pixels.size(); ++i) {
    const Vec4f& pixel = gpu.pixels[i];
    found.covered += difference(cpu.pixels[i], background) > 0.0F;
    for (int k = 0; k < 4; ++k) found.mean += std::abs(pixel[k] - cpu.pixels[i][k]);
    if (difference(pixel, cpu.pixels[i]) <= tolerance) continue;
    ++found.pixels;
    found.unexplained += difference(pixel, glm::clamp(pixel, low.pixels[i], high.pixels[i])) > tolerance;
  }
  found.mean /= 4.0 * static_cast<double>(cpu.pixels.size());
  return found;
}

// The card snaps vertices to 1/256 of a pixel, so the edges of triangles lie that far off at most. Balls have none:
// what is left there is the rounding of a float.
inline constexpr double surface_slack = 1.0 / 256.0;
inline constexpr double ball_slack = 1e-3;

// The pictures agree, and show something.
inline void expect_agreement(const Image& gpu, const Scene& scene, const Camera& camera, const Parameters& parameters,
                             const std::string& what) {
  const double slack = scene.mode == Mode::surface ? surface_slack : ball_slack;
  const Disagreement found = disagreement(gpu, scene, camera, parameters, slack);
  const auto all = static_cast<double>(gpu.pixels.size());
  ::testing::Test::RecordProperty(what, std::to_string(found.pixels) + " of " + std::to_string(gpu.pixels.size()));
  EXPECT_EQ(found.unexplained, 0U) << what << ": " << found.pixels << " pixels differ";
  EXPECT_LE(static_cast<double>(found.pixels), 1e-3 * all) << what;
  EXPECT_LT(found.mean, 0.3 / 255.0) << what;
  EXPECT_GT(static_cast<double>(found.covered), 0.1 * all) << what << ": nearly nothing to be seen";
}

inline void keep(const Image& image, const std::string& name) {
  QImage bytes(image.width, image.height, QImage::Format_RGBA8888_Premultiplied);
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      for (int k = 0; k < 4; ++k) {
        bytes.scanLine(row)[4 * column + k] =
            static_cast<unsigned char>(std::lround(255.0F * std::clamp(image.at(column, row)[k], 0.0F, 1.0F)));
      }
    }
  }
  keep_screenshot(bytes, name);
}

}  // namespace atomesh::test
