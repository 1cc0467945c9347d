// Pictures of the graphics card (here mostly: of OpenGL in software) against those of the CPU's renderer, pixel by
// pixel, and known answers.
#include <gtest/gtest.h>

#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>
#include <QOpenGLFramebufferObject>
#include <algorithm>
#include <cmath>
#include <functional>

#include "app/gui/gpu_scene.h"
#include "core/error.h"
#include "render/renderer.h"
#include "tests/app/gui/window_test.h"
#include "tests/render/fixtures.h"

namespace atomesh {
namespace {

using gui::GpuScene;

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
  Image draw(GpuScene& gpu, const Camera& camera, const Parameters& parameters) {
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
  if (!test::has_opengl()) GTEST_SKIP() << "no OpenGL 3.2 here"

Image cpu_picture(const Scene& scene, const Camera& camera, const Parameters& parameters) {
  RenderStats stats;
  Image image = render(find_renderer("cpu"), scene, camera, parameters, stats);
  for (Vec4f& pixel : image.pixels) pixel = Vec4f(Vec3f(pixel) * pixel.a, pixel.a);
  return image;
}

float difference(const Vec4f& a, const Vec4f& b) {
  const Vec4f d = glm::abs(a - b);
  return std::max({d.r, d.g, d.b, d.a});
}

constexpr float tolerance = 1.5F / 255.0F;  // the rounding to bytes, twice (with a background), and a bit

// Pixels that differ from the CPU's by more than the tolerance; and those of them for which no ray is to blame that
// passes within `slack` of a pixel of the pixel's centre: what the card shows there lies not even between the colours
// of such rays.
struct Disagreement {
  std::size_t pixels = 0;
  std::size_t unexplained = 0;
  std::size_t covered = 0;  // pixels that show something
  double mean = 0.0;        // absolute difference of a channel
};

Disagreement disagreement(const Image& gpu, const Scene& scene, const Camera& camera, const Parameters& parameters,
                          double slack) {
  const Image cpu = cpu_picture(scene, camera, parameters);
  Image low = cpu;
  Image high = cpu;
  for (const int across : {-1, 0, 1}) {
    for (const int upward : {-1, 0, 1}) {
      if (across == 0 && upward == 0) continue;
      const Image near = cpu_picture(scene, test::nudged(camera, slack * across, slack * upward), parameters);
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
constexpr double surface_slack = 1.0 / 256.0;
constexpr double ball_slack = 1e-3;

// The pictures agree, and show something.
void expect_agreement(const Image& gpu, const Scene& scene, const Camera& camera, const Parameters& parameters,
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

void keep(const Image& image, const std::string& name) {
  QImage bytes(image.width, image.height, QImage::Format_RGBA8888_Premultiplied);
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      for (int k = 0; k < 4; ++k) {
        bytes.scanLine(row)[4 * column + k] =
            static_cast<unsigned char>(std::lround(255.0F * std::clamp(image.at(column, row)[k], 0.0F, 1.0F)));
      }
    }
  }
  test::keep_screenshot(bytes, name);
}

struct Subject {
  Material material;
  Parameters parameters;
  std::shared_ptr<Scene> scene;
  Camera camera;
};

Subject subject_of(Material material, const Parameters& parameters, int width, int height) {
  Subject subject{std::move(material), parameters, nullptr, {}};
  subject.scene = std::make_shared<Scene>(make_scene(subject.material, parameters));
  subject.camera = make_camera(parameters, subject.scene->bounds, width, height);
  // A scene that borrows the material's surface may outlive this one.
  subject.scene->surface.own();
  return subject;
}

Material crystal() {
  Material material = test::box_material(5, 6, 4, 2.0, test::shaking(0.3, 5));
  test::add_defects(material, 3);
  return material;
}

TEST(GpuScene, ABallInFrontOfItsLightHasTheColourOfTheFormula) {
  NEED_A_CARD;
  Card card;
  Parameters parameters;
  parameters.mode = Mode::atoms;
  parameters.background = {0.25F, 0.5F, 0.75F, 1.0F};
  parameters.lights = {};
  parameters.lights[0] = {.enabled = true, .position = {0, 0, 1}, .color = {1, 0.5F, 0}, .intensity = 0.5F};
  parameters.atoms.colors["C"] = {0.6F, 0.2F, 0.4F};
  const Vec3f light(0.5F, 0.25F, 0.0F);
  const Vec3f expected = 0.3F * Vec3f(0.6F, 0.2F, 0.4F) + 0.7F * Vec3f(0.6F, 0.2F, 0.4F) * light + 0.2F * light;
  GpuScene gpu;
  for (const Projection projection : {Projection::perspective, Projection::parallel}) {
    parameters.projection = projection;
    const Subject subject = subject_of(test::atoms_material({{"C", {3, 4, 5}}}), parameters, 65, 65);
    gpu.set_scene(subject.scene);
    const Image image = card.draw(gpu, subject.camera, parameters);
    EXPECT_LE(difference(image.at(32, 32), Vec4f(expected, 1.0F)), 0.6F / 255.0F);
    EXPECT_LE(difference(image.at(0, 0), parameters.background), 0.6F / 255.0F);
    // Its outline: radius / (√3 radius) of half the picture for parallel projection.
    if (projection == Projection::parallel) {
      int columns = 0;
      for (int column = 0; column < 65; ++column)
        columns += difference(image.at(column, 32), parameters.background) > 0.01F;
      EXPECT_NEAR(columns, 65.0 / std::sqrt(3.0), 1.0);
    }
  }
  gpu.release();
}

TEST(GpuScene, AFaceInFrontOfItsLightHasTheColourOfTheFormula) {
  NEED_A_CARD;
  Card card;
  Parameters parameters = test::looking(Mode::surface, "front", Projection::parallel);
  parameters.shading = Shading::flat;
  parameters.lights = {};
  // Far away in front: every point of the face sees it along the normal.
  parameters.lights[2] = {.enabled = true, .position = {0, 0, 1e6F}, .color = {1, 1, 0.5F}, .intensity = 0.5F};
  parameters.surface.color = {0.6F, 0.2F, 0.4F};
  parameters.surface.specular = {0.1F, 0.2F, 0.3F};
  parameters.surface.emission = {0.0F, 0.1F, 0.0F};
  const Subject subject = subject_of(test::box_material(2, 2, 2, 3.0), parameters, 65, 65);
  GpuScene gpu;
  gpu.set_scene(subject.scene);
  const Image image = card.draw(gpu, subject.camera, parameters);
  const Vec3f light(0.5F, 0.5F, 0.25F);
  const Vec3f expected = parameters.surface.emission + 0.3F * parameters.surface.color +
                         0.7F * parameters.surface.color * light + parameters.surface.specular * light;
  EXPECT_LE(difference(image.at(32, 32), Vec4f(expected, 1.0F)), 0.6F / 255.0F);
  EXPECT_LE(difference(image.at(0, 0), Vec4f(1.0F)), 0.6F / 255.0F);
  gpu.release();
}

// One of a table of what can be set.
struct Case {
  std::string name;
  Mode mode;
  std::function<void(Parameters&)> set;
};

std::vector<Case> cases() {
  const auto nothing = [](Parameters&) {};
  const auto lights = [](Parameters& p) {
    p.lights = {};
    for (std::size_t i = 0; i < p.lights.size(); ++i) {
      const auto angle = static_cast<float>(i);
      p.lights[i] = {.enabled = i != 3,
                     .position = {2.0F * std::cos(angle), 1.5F * std::sin(angle), 0.3F * angle - 0.5F},
                     .color = {0.5F + 0.06F * angle, 1.0F - 0.1F * angle, i % 2 == 0 ? 0.2F : 0.9F},
                     .intensity = 0.35F};
    }
  };
  const auto cuts = [](Parameters& p) {
    p.cut_planes[0] = {.enabled = true, .normal = {1, 0.4, 0.2}, .side = CutPlane::Side::less_equal, .distance = 8.5};
    p.cut_planes[5] = {.enabled = true, .normal = {0, 0, 1}, .side = CutPlane::Side::greater_equal, .distance = 1.0};
  };
  const auto transparent_background = [](Parameters& p) { p.background = {0.9F, 0.3F, 0.1F, 0.4F}; };
  const auto no_background = [](Parameters& p) { p.background = {0.9F, 0.3F, 0.1F, 0.0F}; };
  const auto no_light = [](Parameters& p) { p.lights = {}; };
  const auto near = [](Parameters& p) { p.zoom = 6.0; };
  const auto inside = [](Parameters& p) {
    p.zoom = 3.0;
    p.pan = Vec3(0.4, 1.0, -0.7);
    p.field_of_view = 60.0;
  };
  const auto rolled = [](Parameters& p) {
    p.roll = 33.0;
    p.azimuth = -110.0;
    p.elevation = -48.0;
  };
  return {
      {"surface, smooth", Mode::surface, nothing},
      {"surface, flat", Mode::surface, [](Parameters& p) { p.shading = Shading::flat; }},
      {"surface, lights", Mode::surface, lights},
      {"surface, flat, lights", Mode::surface,
       [=](Parameters& p) {
         lights(p);
         p.shading = Shading::flat;
       }},
      {"surface, cut", Mode::surface, cuts},
      {"surface, its material", Mode::surface,
       [](Parameters& p) {
         p.surface = {.color = {0.8F, 0.5F, 0.2F},
                      .emission = {0.1F, 0.0F, 0.05F},
                      .specular = {0.6F, 0.7F, 0.8F},
                      .shininess = 100.0};
       }},
      {"surface, transparent background", Mode::surface, transparent_background},
      {"surface, no background", Mode::surface, no_background},
      {"surface, no light", Mode::surface, no_light},
      {"surface, near", Mode::surface, near},
      {"surface, eye inside", Mode::surface, inside},
      {"surface, rolled", Mode::surface, rolled},
      {"balls", Mode::atoms, nothing},
      {"balls, lights", Mode::atoms, lights},
      {"balls, cut", Mode::atoms, cuts},
      {"balls, transparent background", Mode::atoms, transparent_background},
      {"balls, no background", Mode::atoms, no_background},
      {"balls, no light", Mode::atoms, no_light},
      {"balls, near", Mode::atoms, near},
      {"balls, eye among them", Mode::atoms, inside},
      {"balls, rolled", Mode::atoms, rolled},
      {"balls, small", Mode::atoms, [](Parameters& p) { p.atoms.scale = 0.4; }},
      {"balls, large", Mode::atoms, [](Parameters& p) { p.atoms.scale = 2.5; }},
      {"balls, regular ones transparent", Mode::atoms, [](Parameters& p) { p.atoms.regular_opacity = 0.3; }},
      {"balls, most transparent", Mode::atoms,
       [](Parameters& p) {
         p.atoms.regular_opacity = 0.07;
         p.atoms.regular_limit = 0.99;
         p.atoms.scale = 1.6;
       }},
      {"balls, transparent, no background", Mode::atoms,
       [=](Parameters& p) {
         no_background(p);
         p.atoms.regular_opacity = 0.4;
         p.atoms.regular_limit = 0.5;
       }},
      {"balls, transparent, eye among them", Mode::atoms,
       [=](Parameters& p) {
         inside(p);
         p.atoms.regular_opacity = 0.4;
         p.atoms.regular_limit = 0.8;
       }},
  };
}

TEST(GpuScene, PicturesAreTheCpusWhateverIsSet) {
  NEED_A_CARD;
  Card card;
  GpuScene gpu;  // one for all: each scene takes the place of the one before
  for (const Case& c : cases()) {
    for (const Projection projection : {Projection::perspective, Projection::parallel}) {
      Parameters parameters = test::looking(c.mode, "iso", projection);
      c.set(parameters);
      const Subject subject = subject_of(crystal(), parameters, 200, 150);
      gpu.set_scene(subject.scene);
      const Image image = card.draw(gpu, subject.camera, parameters);
      const std::string name = c.name + (projection == Projection::perspective ? ", perspective" : ", parallel");
      keep(image, "gpu " + name);
      expect_agreement(image, *subject.scene, subject.camera, parameters, name);
    }
  }
  gpu.release();
}

}  // namespace
}  // namespace atomesh
