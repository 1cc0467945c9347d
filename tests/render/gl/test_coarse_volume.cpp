// Volumes of fewer cells: how few, that they fill the same space, and that what stands out stays.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/geometry.h"
#include "render/gl/coarse_volume.h"
#include "tests/render/fixtures.h"

namespace atomesh {
namespace {

double filled(const Scene& scene) {
  double sum = 0.0;
  for (const Tetrahedron& t : scene.tetrahedra) {
    const double size = signed_volume(Vec3(scene.vertices[t[0]]), Vec3(scene.vertices[t[1]]),
                                      Vec3(scene.vertices[t[2]]), Vec3(scene.vertices[t[3]]));
    EXPECT_GT(size, 0.0);
    sum += size;
  }
  return sum;
}

Scene scene_of(const Material& material) {
  return make_scene(material, test::looking(Mode::volume, "iso"));
}

TEST(CoarseVolume, OfASmallMeshIsTheMesh) {
  const Material material = test::one_tetrahedron();
  const Scene scene = scene_of(material);
  const Scene coarse = gl::coarse_volume(scene, 1000);
  EXPECT_EQ(coarse.tetrahedra.size(), 1U);
  EXPECT_NEAR(filled(coarse), 1.0 / 6.0, 1e-6);
  EXPECT_TRUE(gl::coarse_volume(scene, 1).tetrahedra.empty());
  EXPECT_TRUE(gl::coarse_volume(Scene(), 1000).tetrahedra.empty());
}

// Boxes of two or three vertices along each side, the outermost of which is taken: places 0, 3, 5, 7, 10, 12, 15.
TEST(CoarseVolume, OfALatticeIsALattice) {
  const Material material = test::box_material(15, 15, 15, 1.0);
  const Scene scene = scene_of(material);
  const Scene coarse = gl::coarse_volume(scene, 6 * 7 * 7 * 7);
  EXPECT_EQ(coarse.vertices.size(), 7U * 7U * 7U);
  EXPECT_EQ(coarse.tetrahedra.size(), 6U * 6U * 6U * 6U);
  EXPECT_NEAR(filled(coarse), 15.0 * 15.0 * 15.0, 1e-3);
}

TEST(CoarseVolume, FillsTheSameSpaceAboutOnce) {
  Material material = test::box_material(24, 20, 16, 2.0, test::shaking(0.4, 7));
  test::add_defects(material, 3);
  const Scene scene = scene_of(material);
  const double whole = filled(scene);
  for (const std::size_t cells : {20000U, 5000U}) {
    const Scene coarse = gl::coarse_volume(scene, cells);
    EXPECT_LE(coarse.tetrahedra.size(), 3 * cells / 2);
    EXPECT_GE(coarse.tetrahedra.size(), cells / 3);
    EXPECT_GT(filled(coarse), 0.6 * whole) << cells;
    EXPECT_LT(filled(coarse), 1.3 * whole) << cells;
    EXPECT_EQ(*std::max_element(coarse.scalars.begin(), coarse.scalars.end()),
              *std::max_element(scene.scalars.begin(), scene.scalars.end()));
  }
}

TEST(CoarseVolume, LooksMuchTheSame) {
  const Material material = test::box_material(24, 24, 24, 2.0);
  const Scene scene = scene_of(material);
  Parameters parameters = test::looking(Mode::volume, "iso");
  parameters.volume.alpha_length = 20.0;
  parameters.volume.color_map.entries = {{0.0, {0.2F, 0.5F, 0.9F, 0.5F}}, {1.0, {0.9F, 0.1F, 0.1F, 1.0F}}};
  const Camera camera = make_camera(parameters, scene.bounds, 120, 90);
  const Image whole = test::draw(find_renderer("cpu"), scene, camera, parameters).image;
  const Image coarse =
      test::draw(find_renderer("cpu"), gl::coarse_volume(scene, scene.tetrahedra.size() / 8), camera, parameters).image;
  EXPECT_GE(compare_images(coarse, whole).psnr, 20.0);
}

}  // namespace
}  // namespace atomesh
