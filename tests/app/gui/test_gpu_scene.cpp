// Pictures of the graphics card (here mostly: of OpenGL in software) against those of the CPU's renderer, pixel by
// pixel, and known answers.
#include <gtest/gtest.h>

#include <QOpenGLWidget>
#include <QPainter>
#include <functional>

#include "tests/app/gui/gpu_pictures.h"

namespace atomesh {
namespace {

using gui::GpuScene;
using test::Card;
using test::difference;
using test::expect_agreement;
using test::keep;

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
    p.lights[5].position = {0.3F, 0.2F, -4.0F};  // behind: no highlight where no light falls
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
  // With parallel projection too what is behind the eye is not seen.
  const auto halfway = [](Parameters& p) { p.pan = 16.0 * Vec3(-0.47, 0.81, -0.34); };
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
      {"surface, halfway", Mode::surface, halfway},
      {"surface, rolled", Mode::surface, rolled},
      {"balls", Mode::atoms, nothing},
      {"balls, lights", Mode::atoms, lights},
      {"balls, cut", Mode::atoms, cuts},
      {"balls, transparent background", Mode::atoms, transparent_background},
      {"balls, no background", Mode::atoms, no_background},
      {"balls, no light", Mode::atoms, no_light},
      {"balls, near", Mode::atoms, near},
      {"balls, eye among them", Mode::atoms, inside},
      {"balls, halfway", Mode::atoms, halfway},
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

Parameters see_through(Projection projection = Projection::perspective) {
  Parameters parameters = test::looking(Mode::atoms, "iso", projection);
  parameters.atoms.regular_opacity = 0.15;
  parameters.atoms.regular_limit = 0.97;
  parameters.atoms.scale = 1.5;
  return parameters;
}

// What OpenGL 4.5 does by lists, in bands where they are long, OpenGL 3.2 peels; one picture.
TEST(GpuScene, TransparentBallsAreComposedOneWayOrAnother) {
  NEED_A_CARD;
  Card card;
  const Parameters parameters = see_through();
  const Subject subject = subject_of(crystal(), parameters, 160, 120);
  std::vector<Image> images;
  const std::vector<std::pair<std::string, gui::GpuLimits>> ways{
      {"lists", {}},
      {"lists in bands", {.list_bytes = 12 * 8000}},
      {"lists that have no room for a row", {.list_bytes = 12 * 100}},
      {"peeled", {.lists = false}},
      {"peeled, in parts", {.texture_floats = 9 * 50}},
  };
  for (const auto& [name, limits] : ways) {
    GpuScene gpu(limits);
    gpu.set_scene(subject.scene);
    images.push_back(card.draw(gpu, subject.camera, parameters));
    expect_agreement(images.back(), *subject.scene, subject.camera, parameters, name);
    // A second time everything is there already, and bands have found their height.
    EXPECT_EQ(card.draw(gpu, subject.camera, parameters).pixels, images.back().pixels) << name;
    gpu.release();
  }
  keep(images.back(), "gpu transparent");
}

// Balls in one place, and balls that cut each other halfway between two pixels' rays: whoever comes first in the scene
// is in front, as in render/cpu/ball_hits.h.
TEST(GpuScene, BallsOfOneDepthAreInTheirOrder) {
  NEED_A_CARD;
  Card card;
  for (const int opaque : {0, 1, 2, 3}) {  // none, all, those with an even index, the others
    Parameters parameters = test::looking(Mode::atoms, "front", Projection::parallel);
    parameters.atoms.regular_opacity = 0.5;
    parameters.atoms.colors = {{"A", {1, 0, 0}}, {"B", {0, 0, 1}}, {"C", {0, 1, 0}}};
    parameters.atoms.radii = {{"A", 2.0}, {"B", 2.0}, {"C", 2.0}};
    const Material material = test::atoms_material({{"A", {0, 0, 0}},
                                                    {"B", {0, 0, 0}},
                                                    {"C", {0, 0, 0}},
                                                    {"B", {6, 0, 0}},
                                                    {"A", {6, 0, 0}},
                                                    {"C", {2, 0, 5}},
                                                    {"A", {4, 0, 5}}});
    const Subject subject = subject_of(material, parameters, 101, 101);
    for (Ball& ball : subject.scene->balls) {
      if (opaque == 1 || (opaque > 1 && ball.atom % 2 == static_cast<Index>(opaque - 2))) ball.color.a = 1.0F;
    }
    for (const bool lists : {true, false}) {
      GpuScene gpu({.lists = lists});
      gpu.set_scene(subject.scene);
      const Image image = card.draw(gpu, subject.camera, parameters);
      keep(image, "gpu ties");
      expect_agreement(image, *subject.scene, subject.camera, parameters, lists ? "lists" : "peeled");
      gpu.release();
    }
  }
}

TEST(GpuScene, SpeciesAreHiddenColouredAndSized) {
  NEED_A_CARD;
  Card card;
  std::vector<std::pair<std::string, Vec3>> atoms;
  for (int i = 0; i < 60; ++i) {
    atoms.push_back({i % 3 == 0 ? "Na" : i % 3 == 1 ? "Cl" : "Cs", Vec3(i % 5, (i / 5) % 4, i / 20) * 2.5});
  }
  Parameters parameters = test::looking(Mode::atoms, "iso", Projection::perspective);
  parameters.atoms.visible["Cl"] = false;
  parameters.atoms.colors["Cs"] = {0.9F, 0.4F, 0.0F};
  parameters.atoms.radii["Na"] = 0.6;
  const Subject subject = subject_of(test::atoms_material(atoms), parameters, 160, 160);
  ASSERT_EQ(subject.scene->balls.size(), 40U);
  GpuScene gpu;
  gpu.set_scene(subject.scene);
  const Image image = card.draw(gpu, subject.camera, parameters);
  keep(image, "gpu species");
  expect_agreement(image, *subject.scene, subject.camera, parameters, "species");
  gpu.release();
}

// Near a corner of a large sample a float about its centre is coarse, and the eye's place must not be rounded to it.
TEST(GpuScene, NearACornerOfALargeSampleTheyAreAsSharp) {
  NEED_A_CARD;
  Card card;
  std::vector<std::pair<std::string, Vec3>> atoms{{"C", {-2000, -1500, -1800}}, {"C", {2000, 1500, 1800}}};
  const Vec3 corner(1531.123, -1377.456, 1210.789);
  for (int i = 0; i < 60; ++i) atoms.push_back({"C", corner + 1.7 * Vec3(i % 5, (i / 5) % 4, i / 20)});
  GpuScene gpu;
  for (const Projection projection : {Projection::perspective, Projection::parallel}) {
    Parameters parameters = test::looking(Mode::atoms, "iso", projection);
    parameters.pan = corner;
    parameters.zoom = 3000.0;
    const Subject subject = subject_of(test::atoms_material(atoms), parameters, 200, 200);
    gpu.set_scene(subject.scene);
    const Image image = card.draw(gpu, subject.camera, parameters);
    keep(image, projection == Projection::perspective ? "gpu corner" : "gpu corner, parallel");
    expect_agreement(image, *subject.scene, subject.camera, parameters, "corner");
  }
  gpu.release();
}

TEST(GpuScene, ScenesThatDoNotFitOneTextureAreDrawnInParts) {
  NEED_A_CARD;
  Card card;
  GpuScene gpu({.texture_floats = 9 * 33});
  for (const Mode mode : {Mode::surface, Mode::atoms}) {
    Parameters parameters = test::looking(mode, "iso", Projection::perspective);
    parameters.shading = Shading::flat;
    const Subject subject = subject_of(crystal(), parameters, 160, 120);
    gpu.set_scene(subject.scene);
    expect_agreement(card.draw(gpu, subject.camera, parameters), *subject.scene, subject.camera, parameters, "parts");
  }
  gpu.release();
}

TEST(GpuScene, RaysOfAPixelAreAveraged) {
  NEED_A_CARD;
  Card card;
  GpuScene gpu;
  for (const Mode mode : {Mode::surface, Mode::atoms}) {
    for (const int n : {2, 3}) {
      Parameters parameters = test::looking(mode, "iso", Projection::perspective);
      parameters.supersampling = n;
      parameters.background = {1.0F / 3.0F, 2.0F / 3.0F, 1.0F, 0.6F};  // whole bytes
      const Subject subject = subject_of(crystal(), parameters, 121, 90);
      gpu.set_scene(subject.scene);
      const Image image = card.draw(gpu, subject.camera, parameters);
      keep(image, "gpu supersampled");
      expect_agreement(image, *subject.scene, subject.camera, parameters, "supersampling " + std::to_string(n));
    }
  }
  gpu.release();
}

TEST(GpuScene, SizesScenesAndContextsChange) {
  NEED_A_CARD;
  const Parameters opaque = test::looking(Mode::atoms, "iso", Projection::perspective);
  const Parameters transparent = see_through(Projection::parallel);
  const Parameters surface = test::looking(Mode::surface, "iso", Projection::perspective);
  const Material material = crystal();
  GpuScene gpu;
  for (int round = 0; round < 2; ++round) {
    Card card;  // another context each time
    for (const Parameters& parameters : {opaque, transparent, surface, opaque}) {
      for (const auto& [width, height] : {std::pair(90, 120), std::pair(200, 64), std::pair(1, 1)}) {
        const Subject subject = subject_of(material, parameters, width, height);
        gpu.set_scene(subject.scene);
        gpu.set_scene(subject.scene);
        const Image image = card.draw(gpu, subject.camera, parameters);
        if (width == 1) continue;
        expect_agreement(image, *subject.scene, subject.camera, parameters, "size");
        // Turned, nothing is uploaded again.
        Parameters turned = parameters;
        turned.azimuth += 40.0;
        const Camera camera = make_camera(turned, subject.scene->bounds, height, width);
        expect_agreement(card.draw(gpu, camera, turned), *subject.scene, camera, turned, "turned");
      }
    }
    gpu.release();
    if (round == 0) {
      // The scene is still the last one's, in the same context once more.
      const Subject subject = subject_of(material, opaque, 90, 120);
      expect_agreement(card.draw(gpu, subject.camera, opaque), *subject.scene, subject.camera, opaque, "again");
      gpu.release();
    }
  }
}

// Draws the scene, and with Qt's painter over it.
class PaintedView final : public QOpenGLWidget {
 public:
  explicit PaintedView(const Subject& subject) : subject_(subject) { gpu_.set_scene(subject.scene); }
  ~PaintedView() override {
    makeCurrent();
    gpu_.release();
    doneCurrent();
  }

 private:
  void paintGL() override {
    gpu_.draw(subject_.camera, subject_.parameters);
    QPainter painter(this);
    painter.fillRect(QRect(10, 20, 30, 40), Qt::red);
    painter.setOpacity(0.0);
    painter.drawText(QPoint(5, 15), "0");
  }

  const Subject& subject_;
  GpuScene gpu_;
};

// Neither leaves anything behind that the other stumbles over.
TEST(GpuScene, QtPaintsOverIt) {
  NEED_A_CARD;
  for (const Parameters& parameters : {see_through(), test::looking(Mode::surface, "iso", Projection::perspective)}) {
    const Subject subject = subject_of(crystal(), parameters, 200, 150);
    PaintedView view(subject);
    view.resize(200, 150);
    test::show(view);
    Image expected = test::cpu_picture(*subject.scene, subject.camera, parameters);
    for (int row = 20; row < 60; ++row) {
      for (int column = 10; column < 40; ++column) expected.at(column, row) = {1, 0, 0, 1};
    }
    for (int frame = 0; frame < 3; ++frame) {
      const Image image = test::to_image(view.grabFramebuffer());
      ASSERT_EQ(image.width, 200);
      EXPECT_EQ(compare_images(image, expected, test::tolerance).pixels_over, 0U) << "frame " << frame;
    }
  }
}

TEST(GpuScene, WithoutASceneThereIsTheBackground) {
  NEED_A_CARD;
  Card card;
  GpuScene gpu;
  Parameters parameters;
  parameters.background = {0.2F, 0.4F, 0.6F, 0.5F};
  const Camera camera = make_camera(parameters, {}, 20, 10);
  const auto expect_background = [&](const Image& image) {
    for (const Vec4f& pixel : image.pixels) EXPECT_LE(difference(pixel, {0.1F, 0.2F, 0.3F, 0.5F}), 0.6F / 255.0F);
  };
  expect_background(card.draw(gpu, camera, parameters));
  for (const Mode mode : {Mode::surface, Mode::atoms}) {
    auto empty = std::make_shared<Scene>();
    empty->mode = mode;
    gpu.set_scene(empty);
    expect_background(card.draw(gpu, camera, parameters));
  }
  gpu.set_scene(nullptr);
  expect_background(card.draw(gpu, camera, parameters));
  auto volume = std::make_shared<Scene>();
  volume->mode = Mode::volume;
  EXPECT_THROW(gpu.set_scene(volume), UsageError);
  EXPECT_THROW(gpu.draw(make_camera(parameters, {}, 0, 10), parameters), UsageError);
  gpu.release();
}

TEST(GpuInfo, SaysWhatTheContextIs) {
  NEED_A_CARD;
  Card card;
  const gui::GpuInfo info = gui::gpu_info([&](const char* name) {
    // NOLINTNEXTLINE: as OpenGL has it
    return reinterpret_cast<void*>(card.context().getProcAddress(name));
  });
  EXPECT_FALSE(info.renderer.empty());
  EXPECT_TRUE(info.sufficient) << info.version;
  if (info.renderer.find("llvmpipe") != std::string::npos) {
    EXPECT_TRUE(info.software);
  }
}

}  // namespace
}  // namespace atomesh
