// Cells of one colour, filled from the surface's crossings instead of being projected: known answers, the judge, and
// the same picture with every cell projected.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "render/cpu/cell_projection_kernel.h"
#include "render/cpu/cpu_renderer.h"
#include "render/cpu/reference.h"
#include "render/cpu/uniform_medium.h"
#include "tests/render/fixtures.h"

namespace atomesh::test {
namespace {

using cell_projection::UniformMedium;

constexpr int side = 20;  // cubes

// A box with hollows, one of which opens to the outside, and with defects in two places; most of it has none.
Material hollow_box(bool with_defects) {
  Material material = box_material(side, side, side, 1.0, shaking(0.1, 3));
  TetMesh& mesh = material.mesh;
  std::erase_if(mesh.tetrahedra, [&](const Tetrahedron& t) {
    const Vec3 p = 0.25 * (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]] + mesh.vertices[t[3]]);
    return glm::length(p - Vec3(6.0, 7.0, 12.0)) < 3.0 || glm::length(p - Vec3(14.0, 20.0, 8.0)) < 4.0;
  });
  material.surface = extract_surface(mesh);
  if (!with_defects) return material;
  add_defects(material, 5);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3& p = mesh.vertices[v];
    if (glm::length(p - Vec3(10.0, 10.0, 10.0)) < 4.0 || p.x > 17.5) continue;
    material.defects.positional[v] = material.defects.extra[v] = material.defects.vacancy[v] = 0.0F;
  }
  return material;
}

Parameters medium_parameters(const char* view, Projection projection, double alpha_length, double face_alpha) {
  Parameters parameters = looking(Mode::volume_surface, view, projection);
  parameters.volume_surface.base_color = Vec4f(0.3F, 0.6F, 0.2F, 0.1F);
  parameters.volume_surface.alpha_length = alpha_length;
  parameters.volume_surface.face_alpha = face_alpha;
  return parameters;
}

// Colours that differ by next to nothing: no medium.
Scene without_medium(Scene scene) {
  for (std::size_t v = 0; v < scene.colors.size(); ++v) scene.colors[v].a += 1e-8F * static_cast<float>(v % 3);
  EXPECT_FALSE(UniformMedium(scene).present());
  return scene;
}

TEST(UniformMedium, IsWhatMostVerticesHave) {
  const Material material = hollow_box(true);
  const Parameters parameters = medium_parameters("front", Projection::parallel, 1.0, 0.0);
  Scene scene = make_scene(material, parameters);
  const UniformMedium medium(scene);
  ASSERT_TRUE(medium.present());
  EXPECT_FALSE(medium.everywhere());
  EXPECT_EQ(medium.color(), parameters.volume_surface.base_color);
  std::size_t held = 0;
  for (const Tetrahedron& t : scene.tetrahedra) {
    const bool same = scene.colors[t[0]] == medium.color() && scene.colors[t[1]] == medium.color() &&
                      scene.colors[t[2]] == medium.color() && scene.colors[t[3]] == medium.color();
    ASSERT_EQ(medium.holds(t), same);
    held += same ? 1 : 0;
  }
  EXPECT_GT(held, scene.tetrahedra.size() / 2);
  EXPECT_LT(held, scene.tetrahedra.size());
  EXPECT_TRUE(UniformMedium(make_scene(hollow_box(false), parameters)).everywhere());
  // It takes a surface to know where it ends, and one that is small beside the mesh to be worth it.
  scene.surface.clear();
  EXPECT_FALSE(UniformMedium(scene).present());
  EXPECT_FALSE(UniformMedium(make_scene(box_material(4, 4, 4, 1.0), parameters)).present());
  EXPECT_FALSE(UniformMedium().present());
}

TEST(UniformMedium, ABoxSeenFromTheFrontIsBeersLaw) {
  const Material box = box_material(side, side, side, 0.5);
  for (const double alpha_length : {1e-4, 0.3, 4.0, 100.0}) {
    const Parameters parameters = medium_parameters("front", Projection::parallel, alpha_length, 0.0);
    const Scene scene = make_scene(box, parameters);
    ASSERT_TRUE(UniformMedium(scene).everywhere());
    const Camera camera = make_camera(parameters, scene.bounds, 24, 24);
    const Drawn drawn = draw(cpu_renderer(), scene, camera, parameters);
    const double covered = -std::expm1(-alpha_length * 0.1 * 0.5 * side);
    std::size_t met = 0;
    for (const Vec4f& pixel : drawn.image.pixels) {
      if (pixel.a == 0.0F) continue;
      ++met;
      ASSERT_NEAR(pixel.a, covered, 1e-6 * covered);
      ASSERT_NEAR(pixel.g, 0.6 * covered, 1e-6 * covered);
    }
    EXPECT_GT(met, 100U);
    EXPECT_EQ(drawn.stats.steps, met);  // each ray passes one stretch
  }
}

class Mediums : public testing::TestWithParam<std::tuple<const char*, Projection>> {};

// The cells' rays pass a hair beside the pixel's centre (ray_shift), which tells where sides are seen nearly edge-on;
// so much the picture may differ from the judge's.
TEST_P(Mediums, AreWhatTheJudgeSeesAndWhatTheirCellsAre) {
  const auto [view, projection] = GetParam();
  for (const bool with_defects : {false, true}) {
    const Material material = hollow_box(with_defects);
    for (const auto& [alpha_length, face_alpha] : {std::pair(0.3, 0.2), std::pair(6.0, 0.0)}) {
      const Parameters parameters = medium_parameters(view, projection, alpha_length, face_alpha);
      const Scene scene = make_scene(material, parameters);
      ASSERT_TRUE(UniformMedium(scene).present());
      const Camera camera = make_camera(parameters, scene.bounds, 21, 21);
      const Drawn filled = draw(cpu_renderer(), scene, camera, parameters);
      const Drawn projected = draw(cpu_renderer(), without_medium(scene), camera, parameters);
      EXPECT_LT(filled.stats.steps, projected.stats.steps / 2);
      EXPECT_LE(compare_images(projected.image, filled.image).max, 1e-5);
      using cell_projection::ray_lift;
      using cell_projection::ray_shift;
      const Image judged = draw(reference_renderer(), scene, camera, parameters).image;
      const Image beside =
          draw(reference_renderer(), scene, moved_beside(camera, ray_shift, ray_shift * ray_lift), parameters).image;
      EXPECT_LE(compare_images(judged, filled.image).max, 5e-6 + compare_images(judged, beside).max);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Views, Mediums,
                         testing::Combine(testing::Values("front", "iso", "12.3,-45.6"),
                                          testing::Values(Projection::parallel, Projection::perspective)));

TEST(UniformMedium, BeginsAtAnEyeWithin) {
  const Material material = hollow_box(true);
  for (const Vec3& eye : {Vec3(3.3, 3.1, 16.2), Vec3(6.0, 7.0, 12.0), Vec3(10.1, 9.8, 10.3)}) {
    const Parameters parameters = medium_parameters("iso", Projection::perspective, 0.8, 0.2);
    const Scene scene = make_scene(material, parameters);
    Camera camera = make_camera(parameters, scene.bounds, 21, 21);
    camera.eye = eye;
    camera.pixel = 0.12;
    const Image filled = draw(cpu_renderer(), scene, camera, parameters).image;
    EXPECT_LE(compare_images(draw(reference_renderer(), scene, camera, parameters).image, filled).max, 1e-5);
  }
}

TEST(UniformMedium, NeitherWindowsNorLatticesNorKernelsChangeIt) {
  const Material material = hollow_box(true);
  const Parameters parameters = medium_parameters("iso", Projection::perspective, 0.8, 0.2);
  const Scene scene = make_scene(material, parameters);
  const Camera camera = make_camera(parameters, scene.bounds, 70, 50);
  const Image whole = draw(cpu_renderer(), scene, camera, parameters).image;
  RenderStats stats;
  Progress progress;
  const PixelWindow window{9, 5, 50, 41};
  const auto frame = cpu_renderer().prepare(scene, camera, parameters, window, stats, progress);
  Image part(window.width, window.height);
  for (int phase = 0; phase < 4; ++phase) frame->draw({2, 2, phase % 2, phase / 2}, part, stats, {}, progress);
  for (int row = 0; row < window.height; ++row) {
    for (int column = 0; column < window.width; ++column) {
      ASSERT_EQ(part.at(column, row), whole.at(window.left + column, window.top + row));
    }
  }
  cell_projection::set_kernel("baseline");
  const Image plain = draw(cpu_renderer(), scene, camera, parameters).image;
  cell_projection::set_kernel("");
  EXPECT_LE(compare_images(plain, whole).max, 1e-5);
}

}  // namespace
}  // namespace atomesh::test
