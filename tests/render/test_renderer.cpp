// What lies around the renderers: their names, supersampling, the background.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "render/cpu/reference.h"
#include "render/renderer.h"
#include "tests/render/fixtures.h"

namespace atomesh {
namespace {

using namespace test;

// Paints each pixel by a function of its image-plane position; channels depth and thickness are that position.
class Painter final : public Renderer {
 public:
  using Paint = Vec4f (*)(double, double);
  explicit Painter(Paint paint) : paint_(paint) {}
  std::string_view name() const override { return "painter"; }
  std::unique_ptr<Frame> prepare(const Scene&, const Camera& camera, const Parameters&, const PixelWindow& window,
                                 RenderStats&, Progress&) const override {
    return std::make_unique<Painted>(paint_, camera, window);
  }

 private:
  class Painted final : public Frame {
   public:
    Painted(Paint paint, const Camera& camera, const PixelWindow& window)
        : paint_(paint), camera_(camera), window_(window) {}
    void draw(const PixelLattice& lattice, Image& image, RenderStats&, const Channels& channels,
              Progress&) const override {
      size_channel(channels.depth, window_, 0.0F);
      size_channel(channels.thickness, window_, 0.0F);
      const LatticeGrid grid(lattice, window_);
      for (int j = 0; j < grid.rows(); ++j) {
        for (int i = 0; i < grid.columns(); ++i) {
          const double x = camera_.x_of(grid.column(i));
          const double y = camera_.y_of(grid.row(j));
          const std::size_t pixel = window_.place(grid.column(i), grid.row(j));
          image.pixels[pixel] = paint_(x, y);
          if (channels.depth != nullptr) (*channels.depth)[pixel] = static_cast<float>(x);
          if (channels.thickness != nullptr) (*channels.thickness)[pixel] = static_cast<float>(y);
        }
      }
    }

   private:
    Paint paint_;
    const Camera& camera_;
    PixelWindow window_;
  };

  Paint paint_;
};

Camera unit_camera(int width, int height) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  return camera;
}

Image render_with(const Painter& painter, const Parameters& parameters, const Camera& camera,
                  const Channels& channels = {}) {
  RenderStats stats;
  return render(painter, Scene(), camera, parameters, stats, channels);
}

TEST(Renderers, AreFoundByNameAndUnknownOnesListThem) {
  const auto names = renderer_names();
  EXPECT_NE(std::find(names.begin(), names.end(), "reference"), names.end());
  for (const std::string& name : names) EXPECT_EQ(find_renderer(name).name(), name);
  EXPECT_EQ(&find_renderer("auto"), &find_renderer(names.front()));
  EXPECT_EQ(find_renderer("havs").name(), "havs");
  EXPECT_THROW(find_renderer("cuda"), UnavailableError);
  try {
    find_renderer("refernce");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean reference?"), std::string::npos) << error.what();
  }
}

TEST(Render, SupersamplingAveragesPremultipliedColoursOverThePixel) {
  // The left half-plane opaque red, the right clear: the middle pixel of three is half covered.
  const Painter half([](double x, double) { return x < 0.0 ? Vec4f(1, 0, 0, 1) : Vec4f(0.0F); });
  Parameters parameters;
  parameters.supersampling = 4;
  parameters.background = Vec4f(0, 0, 1, 1);
  std::vector<float> depth;
  std::vector<float> thickness;
  const Image image = render_with(half, parameters, unit_camera(3, 1), {&thickness, &depth, nullptr});
  EXPECT_EQ(image.at(0, 0), Vec4f(1, 0, 0, 1));
  EXPECT_EQ(image.at(1, 0), Vec4f(0.5F, 0, 0.5F, 1));
  EXPECT_EQ(image.at(2, 0), Vec4f(0, 0, 1, 1));
  // Depth from the ray right of the middle, thickness the mean.
  EXPECT_FLOAT_EQ(depth[1], 0.125F);
  EXPECT_FLOAT_EQ(thickness[1], 0.0F);
  parameters.supersampling = 3;
  depth.clear();
  thickness.clear();
  render_with(half, parameters, unit_camera(3, 1), {nullptr, &depth, nullptr});
  EXPECT_FLOAT_EQ(depth[0], -1.0F);
}

TEST(Render, TransparentBackgroundKeepsTheColourOfWhatCoversIt) {
  const Painter veil([](double x, double) { return x < 0.0 ? Vec4f(0.25F, 0, 0, 0.25F) : Vec4f(0.0F); });
  Parameters parameters;
  parameters.background = Vec4f(1, 1, 1, 0);
  Image image = render_with(veil, parameters, unit_camera(2, 1));
  EXPECT_EQ(image.at(0, 0), Vec4f(1, 0, 0, 0.25F));
  EXPECT_EQ(image.at(1, 0), Vec4f(0.0F));
  parameters.background = Vec4f(0, 1, 0, 0.5F);
  image = render_with(veil, parameters, unit_camera(2, 1));
  EXPECT_FLOAT_EQ(image.at(0, 0).a, 0.625F);
  EXPECT_FLOAT_EQ(image.at(0, 0).r, 0.25F / 0.625F);
  EXPECT_FLOAT_EQ(image.at(0, 0).g, 0.375F / 0.625F);
  EXPECT_EQ(image.at(1, 0), Vec4f(0, 1, 0, 0.5F));
}

TEST(Render, PictureWithoutPixelsIsAnError) {
  const Painter nothing([](double, double) { return Vec4f(0.0F); });
  EXPECT_THROW(render_with(nothing, Parameters(), unit_camera(0, 5)), UsageError);
}

TEST(Render, CancelsAndGivesEmptyPicturesOfEmptyScenes) {
  const Material one = atoms_material({{"Fe", {3, 4, 5}}});
  for (const Mode mode : {Mode::volume_surface, Mode::volume, Mode::surface, Mode::xray, Mode::atoms}) {
    Parameters parameters = looking(mode, "front");
    parameters.background = Vec4f(0, 0, 0, 0);
    const Scene scene = make_scene(one, parameters);
    const Camera camera = make_camera(parameters, scene.bounds, 9, 9);
    for (const std::string& name : renderer_names()) {
      RenderStats stats;
      const Image image = render(find_renderer(name), scene, camera, parameters, stats);
      EXPECT_EQ(image.at(0, 0), Vec4f(0.0F)) << name;
      EXPECT_EQ(image.at(4, 4).a, mode == Mode::atoms ? 1.0F : 0.0F) << name;
      Progress progress;
      progress.request_cancel();
      EXPECT_THROW(render(find_renderer(name), scene, camera, parameters, stats, {}, progress), CancelledError) << name;
    }
  }
}

// A box of one density with a ball in its middle: through the ball's middle a ray passes the box up to the ball, and
// then sees it; beside it all of the box.
TEST(Solids, EndRaysWhereTheyStand) {
  Material material = box_material(4, 4, 4, 1.0);
  material.defects.positional.assign(material.atoms.size(), 0.0F);
  material.defects.vacancy = material.defects.extra = material.defects.positional;
  const Vec3 middle(2.0, 2.0, 2.0);
  std::size_t atom = 0;
  for (std::size_t a = 0; a < material.atoms.size(); ++a) {
    if (glm::distance(material.atoms.positions[a], middle) < 1e-9) atom = a;
  }
  material.defects.positional[atom] = 1.0F;
  Parameters parameters = looking(Mode::volume, "front");
  parameters.volume.alpha_length = 0.5;
  parameters.volume.color_map.entries = {{0.0, {0.25F, 0.5F, 1.0F, 1.0F}}, {1.0, {0.25F, 0.5F, 1.0F, 1.0F}}};
  parameters.volume.solid = VolumeSolid::defects;
  parameters.lights = {};  // ambient light alone: one color all over the ball
  const Scene scene = make_scene(material, parameters);
  ASSERT_NE(scene.solids, nullptr);
  ASSERT_EQ(scene.solids->balls.size(), 1U);
  const double radius = static_cast<double>(scene.solids->balls.front().radius);
  ASSERT_LT(radius, 1.9);
  Camera camera = make_camera(parameters, scene.bounds, 65, 65);
  parameters.mode = Mode::atoms;
  parameters.atoms.regular_opacity = 0.0;
  const Vec4f ball = draw(reference_renderer(), make_scene(material, parameters), camera, parameters).image.at(32, 32);
  ASSERT_EQ(ball.a, 1.0F);
  parameters.mode = Mode::volume;
  for (const std::string& name : renderer_names()) {
    const Image image = draw(find_renderer(name), scene, camera, parameters).image;
    const double through = std::exp(-0.5 * (2.0 - radius));
    const Vec4f at_ball = image.at(32, 32);
    EXPECT_NEAR(at_ball.r, (1.0 - through) * 0.25 + through * static_cast<double>(ball.r), 2e-3) << name;
    EXPECT_NEAR(at_ball.g, (1.0 - through) * 0.5 + through * static_cast<double>(ball.g), 2e-3) << name;
    EXPECT_NEAR(at_ball.b, (1.0 - through) + through * static_cast<double>(ball.b), 2e-3) << name;
    EXPECT_NEAR(at_ball.a, 1.0, 1e-6) << name;
    const int beside = 32 + static_cast<int>(std::ceil((radius + 0.1) / camera.pixel));
    ASSERT_LT((beside - 32) * camera.pixel, 1.95);
    EXPECT_NEAR(image.at(beside, 32).a, 1.0 - std::exp(-2.0), 1e-3) << name;
  }
}

// Behind a box that is hardly there its far wall is seen, lit from where the eye is, and nothing of its near one.
TEST(Solids, WallsAreBehindEverything) {
  Material material = box_material(4, 4, 4, 1.0);
  add_defects(material, 3);
  Parameters parameters = looking(Mode::volume, "front");
  parameters.volume.solid = VolumeSolid::walls;
  const Scene scene = make_scene(material, parameters);
  const Camera camera = make_camera(parameters, scene.bounds, 33, 33);
  for (const std::string& name : renderer_names()) {
    RenderStats stats;
    std::vector<float> depth;
    const Image walls =
        find_renderer(name).draw(*scene.solids, camera, parameters, stats, {nullptr, &depth, nullptr}, no_progress());
    EXPECT_EQ(walls.at(16, 16).a, 1.0F) << name;
    const double far = glm::dot(Vec3(2.0, 4.0, 2.0) - camera.eye, camera.forward);
    EXPECT_NEAR(depth[16 * 33 + 16], far, 1e-4) << name;
  }
}

}  // namespace
}  // namespace atomesh
