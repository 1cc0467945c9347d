// The peers of bench render: what VTK's volume mappers show of scenes whose pictures are known. Without a display, and
// without Xvfb, there is nothing to test.
#include <gtest/gtest.h>

#include <cmath>

#include "app/cli/peer_vtk_volume.h"
#include "app/cli/virtual_display.h"
#include "tests/render/fixtures.h"

namespace atomesh::test {
namespace {

using cli::VtkMapper;

class PeerVtkVolume : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { display_ = std::make_unique<cli::VirtualDisplay>(); }
  static void TearDownTestSuite() { display_.reset(); }
  void SetUp() override {
    if (!display_->available()) GTEST_SKIP() << display_->why_not();
  }

  static Scene scene_of(const Material& material, const Parameters& parameters,
                        const std::function<float(const Vec3f&)>& scalar) {
    Scene scene = make_scene(material, parameters);
    for (std::size_t v = 0; v < scene.vertices.size(); ++v) scene.scalars[v] = scalar(scene.vertices[v]);
    return scene;
  }

  static std::unique_ptr<cli::VirtualDisplay> display_;
};
std::unique_ptr<cli::VirtualDisplay> PeerVtkVolume::display_;

Parameters volume_looking(std::string_view view, Projection projection, double alpha_length, ColorMap map) {
  Parameters parameters = looking(Mode::volume, view, projection);
  parameters.volume.alpha_length = alpha_length;
  parameters.volume.color_map = std::move(map);
  return parameters;
}

// What one channel of a mapper may be off by where its integral is exact: 8 bits, cut off or blended.
double quantum(VtkMapper mapper) {
  switch (mapper) {
    case VtkMapper::ray_cast:
    case VtkMapper::ray_cast_linear:
      return 1.0 / 255.0;
    case VtkMapper::z_sweep:
      return 1e-5;
    case VtkMapper::projected_tetrahedra:
      return 1.5 / 255.0;
  }
  return 0.0;
}

TEST_F(PeerVtkVolume, AConstantCubeLetsThroughWhatItShould) {
  const ColorMap map{{{0.0, {1.0F, 0.6F, 0.2F, 0.6F}}, {1.0, {1.0F, 0.6F, 0.2F, 0.6F}}}};
  const Parameters parameters = volume_looking("front", Projection::parallel, 0.25, map);
  const Material material = box_material(2, 2, 2, 2.0);
  const Scene scene = scene_of(material, parameters, [](const Vec3f& p) { return 0.5F + 0.1F * p.z; });
  const Camera camera = make_camera(parameters, scene.bounds, 64, 48);
  const auto opacity = static_cast<float>(1.0 - std::exp(-0.25 * 0.6 * 4.0));
  cli::VtkVolumeScene vtk(scene, parameters);
  for (const VtkMapper mapper : cli::vtk_mappers) {
    SCOPED_TRACE(cli::vtk_mapper_name(mapper));
    vtk.draw(mapper, camera);
    const Image image = vtk.image();
    ASSERT_EQ(image.width, 64);
    ASSERT_EQ(image.height, 48);
    const Vec4f middle = image.at(30, 22);
    const double tolerance = quantum(mapper) + (mapper == VtkMapper::ray_cast ? 0.005 : 0.0);
    EXPECT_NEAR(middle.a, opacity, tolerance);
    EXPECT_NEAR(middle.r, opacity, tolerance);
    EXPECT_NEAR(middle.g, 0.6F * opacity, tolerance);
    EXPECT_NEAR(middle.b, 0.2F * opacity, tolerance);
    EXPECT_EQ(image.at(1, 1), Vec4f(0.0F));
  }
  EXPECT_FALSE(vtk.driver().empty());
  EXPECT_NE(vtk.driver(), "unknown");
}

// A ramp of opacity along the ray, seen from its thin end and from its dense end, behind an edge in the colour map.
TEST_F(PeerVtkVolume, ARampIsIntegratedBetweenTheKnotsOfTheMap) {
  const ColorMap map{
      {{0.0, {1.0F, 0.0F, 0.0F, 0.0F}}, {0.3, {0.0F, 1.0F, 0.0F, 0.3F}}, {1.0, {0.0F, 0.2F, 1.0F, 1.0F}}}};
  for (const char* view : {"front", "back"}) {
    SCOPED_TRACE(view);
    const Parameters parameters = volume_looking(view, Projection::parallel, 0.2, map);
    const Material material = box_material(1, 1, 1, 8.0);
    const Scene scene = scene_of(material, parameters, [](const Vec3f& p) { return (p.y + 4.0F) / 8.0F; });
    const Camera camera = make_camera(parameters, scene.bounds, 64, 64);
    const Drawn judge = draw(find_renderer("reference"), scene, camera, parameters);
    cli::VtkVolumeScene vtk(scene, parameters);
    for (const VtkMapper mapper : {VtkMapper::ray_cast_linear, VtkMapper::z_sweep}) {
      SCOPED_TRACE(cli::vtk_mapper_name(mapper));
      vtk.draw(mapper, camera);
      const Image image = vtk.image();
      for (const int row : {20, 40}) {
        for (int channel = 0; channel < 4; ++channel) {
          EXPECT_NEAR(image.at(25, row)[channel], judge.image.at(25, row)[channel], quantum(mapper) + 1e-3);
        }
      }
    }
  }
}

// Where the picture's light stands, in pixels.
Vec3 centroid(const Image& image) {
  Vec3 sum(0.0);
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const double a = image.at(column, row).a;
      sum += a * Vec3(column, row, 1.0);
    }
  }
  return sum / sum.z;
}

TEST_F(PeerVtkVolume, PicturesLieOnOurs) {
  const ColorMap map{{{0.0, {1.0F, 0.0F, 0.0F, 0.2F}}, {1.0, {0.0F, 1.0F, 1.0F, 1.0F}}}};
  for (const Projection projection : {Projection::parallel, Projection::perspective}) {
    Parameters parameters = volume_looking("iso", projection, 0.1, map);
    parameters.roll = 12.0;
    parameters.pan = Vec3(0.7, 0.2, -0.4);
    const Material material = box_material(4, 3, 5, 2.0, shaking(0.3, 7));
    const Scene scene = scene_of(material, parameters, [](const Vec3f& p) { return 0.5F + 0.08F * p.x; });
    const Camera camera = make_camera(parameters, scene.bounds, 150, 110);
    const Drawn ours = draw(find_renderer("cpu"), scene, camera, parameters);
    cli::VtkVolumeScene vtk(scene, parameters);
    for (const VtkMapper mapper : cli::vtk_mappers) {
      SCOPED_TRACE(cli::vtk_mapper_name(mapper));
      vtk.draw(mapper, camera);
      const Image image = vtk.image();
      const Vec3 shift = centroid(image) - centroid(ours.image);
      const ImageDifference difference = compare_images(image, ours.image);
      // Z sweep moves vertices to whole pixels; the others are cut off or rounded to 8 bits.
      const bool sweep = mapper == VtkMapper::z_sweep;
      EXPECT_NEAR(shift.x, 0.0, sweep ? 0.2 : 0.05);
      EXPECT_NEAR(shift.y, 0.0, sweep ? 0.2 : 0.05);
      EXPECT_LE(difference.max, sweep ? 0.1 : quantum(mapper) + 0.007);
      EXPECT_LE(difference.rmse, sweep ? 0.005 : 0.002);
    }
  }
}

}  // namespace
}  // namespace atomesh::test
