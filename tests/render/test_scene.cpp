// Material and parameters → Scene: what each mode is given.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/elements.h"
#include "core/error.h"
#include "render/scene.h"
#include "tests/render/fixtures.h"

namespace atomesh {
namespace {

using namespace test;

TEST(Scene, HoldsOnlyWhatItsModeNeeds) {
  Material material = box_material(2, 2, 2, 1.0);
  add_defects(material, 1);
  const auto scene_of = [&material](Mode mode) { return make_scene(material, looking(mode, "front")); };
  const Scene both = scene_of(Mode::volume_surface);
  EXPECT_EQ(both.tetrahedra.size(), 48U);
  EXPECT_EQ(both.colors.size(), 27U);
  EXPECT_EQ(both.surface.size(), 48U);
  EXPECT_EQ(both.face_normals.size(), 48U);
  EXPECT_EQ(both.vertex_normals.size(), 27U);
  EXPECT_TRUE(both.scalars.empty());
  EXPECT_TRUE(both.balls.empty());
  const Scene volume = scene_of(Mode::volume);
  EXPECT_EQ(volume.scalars.size(), 27U);
  EXPECT_TRUE(volume.surface.empty());
  EXPECT_TRUE(volume.colors.empty());
  const Scene surface = scene_of(Mode::surface);
  EXPECT_TRUE(surface.tetrahedra.empty());
  EXPECT_EQ(surface.surface.size(), 48U);
  EXPECT_EQ(surface.face_normals.size(), 48U);
  const Scene xray = scene_of(Mode::xray);
  EXPECT_EQ(xray.surface.size(), 48U);
  EXPECT_TRUE(xray.face_normals.empty());
  const Scene atoms = scene_of(Mode::atoms);
  EXPECT_EQ(atoms.balls.size(), 27U);
  EXPECT_TRUE(atoms.vertices.empty());
}

TEST(Scene, BorrowsWhatIsNotCutAndOwnsWhatIsWrittenTo) {
  const Material material = box_material(2, 2, 2, 1.0);
  Parameters parameters = looking(Mode::volume_surface, "front");
  Scene scene = make_scene(material, parameters);
  EXPECT_EQ(scene.tetrahedra.data(), material.mesh.tetrahedra.data());
  EXPECT_EQ(scene.surface.data(), material.surface.triangles.data());
  // Copies borrow too; writing to one changes neither the material nor the others.
  Scene copy = scene;
  EXPECT_EQ(copy.tetrahedra.data(), material.mesh.tetrahedra.data());
  std::ranges::reverse(copy.tetrahedra.own());
  copy.surface.clear();
  EXPECT_FALSE(copy.tetrahedra.borrows());
  EXPECT_EQ(copy.tetrahedra[0], material.mesh.tetrahedra.back());
  EXPECT_TRUE(copy.surface.empty());
  EXPECT_EQ(scene.tetrahedra, material.mesh.tetrahedra);
  EXPECT_EQ(scene.surface, material.surface.triangles);
  // Copies and moves of what is owned have their own.
  const Scene second = copy;
  EXPECT_NE(second.tetrahedra.data(), copy.tetrahedra.data());
  const Scene moved = std::move(copy);
  EXPECT_EQ(moved.tetrahedra, second.tetrahedra);
  scene.tetrahedra.push_back({0, 1, 2, 3});
  EXPECT_EQ(scene.tetrahedra.size(), material.mesh.tetrahedra.size() + 1);
  // A material that is given away leaves what is needed with the scene.
  scene = make_scene(Material(material), parameters);
  EXPECT_FALSE(scene.tetrahedra.borrows());
  EXPECT_FALSE(scene.surface.borrows());
  EXPECT_EQ(scene.tetrahedra, material.mesh.tetrahedra);
  EXPECT_EQ(scene.surface, material.surface.triangles);
  parameters.cut_planes[0] = {true, {1, 0, 0}, CutPlane::Side::less_equal, 1.0};
  EXPECT_FALSE(make_scene(material, parameters).tetrahedra.borrows());
}

TEST(Scene, PartsNeededFollowTheModeAndTheCuts) {
  Parameters parameters = looking(Mode::xray, "front");
  EXPECT_FALSE(parts_needed(parameters).tetrahedra);
  EXPECT_FALSE(parts_needed(parameters).defects);
  EXPECT_TRUE(parts_needed(parameters).surface);
  parameters.cut_planes[7].enabled = true;
  EXPECT_TRUE(parts_needed(parameters).tetrahedra);
  EXPECT_FALSE(parts_needed(parameters).surface);
  parameters.mode = Mode::atoms;
  EXPECT_FALSE(parts_needed(parameters).tetrahedra);
  EXPECT_FALSE(parts_needed(parameters).defects);
  parameters.atoms.regular_opacity = 0.5;
  EXPECT_TRUE(parts_needed(parameters).defects);
  // What the parts leave out is not missed.
  Material material = box_material(1, 1, 1, 1.0);
  material.mesh.tetrahedra.clear();
  EXPECT_EQ(make_scene(material, looking(Mode::xray, "front")).surface.size(), 12U);
  EXPECT_THROW(make_scene(material, looking(Mode::volume, "front")), Error);
  parameters.mode = Mode::xray;
  EXPECT_THROW(make_scene(material, parameters), Error);
}

TEST(Scene, ColoursAreTheSeedsFormulaAndTooBrightOnesKeepTheirHue) {
  Material material = one_tetrahedron();
  material.defects.positional = {0.0F, 0.5F, 0.0F, 9.0F};
  material.defects.extra = {0.0F, 0.0F, 2.0F, 0.0F};
  material.defects.vacancy = {0.0F, 0.0F, 1.0F, 0.0F};
  Parameters parameters = looking(Mode::volume_surface, "front");
  VolumeSurfaceParameters& p = parameters.volume_surface;
  p.base_color = {0.1F, 0.2F, 0.3F, 0.05F};
  p.positional_color = {1.0F, 0.0F, 0.5F, 1.0F};
  p.positional_multiplier = 0.5;
  p.extra_color = {0.0F, 0.1F, 0.0F, 0.2F};
  p.extra_multiplier = 2.0;
  p.vacancy_color = {0.0F, 0.0F, 0.2F, 0.1F};
  p.vacancy_multiplier = 1.0;
  const Scene scene = make_scene(material, parameters);
  const auto expect_color = [&scene](std::size_t v, const Vec4f& color) {
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(scene.colors[v][c], color[c], 1e-6F) << v << ' ' << c;
  };
  expect_color(0, p.base_color);
  expect_color(1, {0.35F, 0.2F, 0.425F, 0.3F});
  expect_color(2, {0.1F, 0.6F, 0.5F, 0.95F});
  expect_color(3, {1.0F, 0.2F / 4.6F, 2.55F / 4.6F, 1.0F});
}

TEST(Scene, ScalarsRunFromZeroToOneOverTheUncutSample) {
  Material material = box_material(1, 1, 1, 1.0);
  material.defects.positional.assign(8, 0.0F);
  material.defects.vacancy.assign(8, 0.0F);
  material.defects.extra.assign(8, 0.0F);
  material.defects.positional[7] = 2.0F;
  material.defects.vacancy[3] = 0.25F;
  Parameters parameters = looking(Mode::volume, "front");
  parameters.volume.vacancy_multiplier = 2.0;
  parameters.cut_planes[0] = {true, {0, 0, 1}, CutPlane::Side::less_equal, 0.5};  // cuts the largest away
  const Scene scene = make_scene(material, parameters);
  EXPECT_FLOAT_EQ(scene.scalars[7], 1.0F);
  EXPECT_FLOAT_EQ(scene.scalars[3], 0.25F);
  EXPECT_FLOAT_EQ(scene.scalars[0], 0.0F);
}

TEST(Scene, WithoutDefectsEverythingIsRegular) {
  const Material material = one_tetrahedron();
  Parameters parameters = looking(Mode::volume_surface, "front");
  for (const Vec4f& color : make_scene(material, parameters).colors) {
    EXPECT_EQ(color, parameters.volume_surface.base_color);
  }
  parameters.mode = Mode::volume;
  EXPECT_EQ(make_scene(material, parameters).scalars, std::vector<float>(4, 0.0F));
  parameters.mode = Mode::atoms;
  parameters.atoms.regular_opacity = 0.25;
  for (const Ball& ball : make_scene(material, parameters).balls) EXPECT_EQ(ball.color.a, 0.25F);
}

TEST(Scene, RegularAtomsAreThoseBelowTheLimit) {
  Material material = one_tetrahedron();
  material.defects.positional = {0.0F, 0.5F, 0.0F, 0.0F};
  material.defects.extra = {0.0F, 0.0F, 2.0F, 0.0F};
  material.defects.vacancy = {0.0F, 0.0F, 0.0F, 0.25F};
  Parameters parameters = looking(Mode::atoms, "front");
  parameters.atoms.regular_opacity = 0.25;
  const auto opaque = [&](double limit) {
    parameters.atoms.regular_limit = limit;
    std::vector<Index> atoms;
    for (const Ball& ball : make_scene(material, parameters).balls) {
      if (ball.color.a == 1.0F) atoms.push_back(ball.atom);
    }
    return atoms;
  };
  EXPECT_EQ(opaque(0.0), (std::vector<Index>{1, 2, 3}));
  EXPECT_EQ(opaque(0.25), (std::vector<Index>{1, 2}));
  EXPECT_EQ(opaque(1.0), (std::vector<Index>{2}));
}

TEST(Scene, AtomsOnOneVertexColourItWithTheLargestOfEachDefect) {
  Material material = one_tetrahedron();
  material.atoms.positions.push_back(material.atoms.positions[2]);
  material.atoms.species.push_back(0);
  material.defects.positional = {0, 0, 0.25F, 0, 0};
  material.defects.extra = {0, 0, 0, 0, 0.5F};
  material.defects.vacancy = {0, 0, 0, 0, 0};
  Parameters parameters = looking(Mode::volume, "front");
  const Scene scene = make_scene(material, parameters);
  EXPECT_FLOAT_EQ(scene.scalars[2], 1.0F);  // 0.25 + 0.5, the largest there is
}

TEST(Scene, CutPlanesTakeAtomsTetrahedraAndLeaveAClosedSurface) {
  const Material material = box_material(4, 4, 4, 1.0);
  Parameters parameters = looking(Mode::volume_surface, "front");
  parameters.cut_planes[2] = {true, {1, 0, 0}, CutPlane::Side::less_equal, 2.0};
  parameters.cut_planes[5] = {true, {0, 0, 1}, CutPlane::Side::greater_equal, 0.5};
  Scene scene = make_scene(material, parameters);
  EXPECT_EQ(scene.tetrahedra.size(), 2U * 4U * 3U * 6U);
  EXPECT_EQ(scene.surface.size(), 2U * 2U * (2U * 4U + 4U * 3U + 3U * 2U));
  EXPECT_TRUE(is_closed({scene.surface.own(), {}, {}}));
  const double radius = material.atoms.species_table.front().radius;
  EXPECT_EQ(scene.bounds.max, Vec3(4.0 + radius));  // the camera does not move
  parameters.mode = Mode::xray;
  EXPECT_EQ(make_scene(material, parameters).bounds.max, scene.bounds.max);  // nor with the mode
  EXPECT_EQ(make_scene(material, parameters).surface, scene.surface);
  parameters.mode = Mode::atoms;
  EXPECT_EQ(make_scene(material, parameters).balls.size(), 3U * 5U * 4U);
  // A disabled plane cuts nothing.
  parameters.cut_planes[2].enabled = parameters.cut_planes[5].enabled = false;
  EXPECT_EQ(make_scene(material, parameters).balls.size(), 125U);
}

TEST(Scene, BallsHaveTheSpeciesLookAndHiddenOnesAreGone) {
  Material material = atoms_material({{"Na", {0, 0, 0}}, {"Cl", {2, 0, 0}}, {"Na", {4, 0, 0}}});
  material.atoms.species_table[1].radius = 1.5;
  Parameters parameters = looking(Mode::atoms, "front");
  parameters.atoms.scale = 0.5;
  parameters.atoms.radii["Na"] = 3.0;
  parameters.atoms.colors["Na"] = {1, 0, 1};
  Scene scene = make_scene(material, parameters);
  ASSERT_EQ(scene.balls.size(), 3U);
  EXPECT_FLOAT_EQ(scene.balls[0].radius, 1.5F);
  EXPECT_FLOAT_EQ(scene.balls[1].radius, 0.75F);
  EXPECT_EQ(scene.balls[2].color, Vec4f(1, 0, 1, 1));
  const auto chlorine = default_species_color("Cl", 1);
  EXPECT_EQ(scene.balls[1].color, Vec4f(Vec3f(chlorine[0], chlorine[1], chlorine[2]) / 255.0F, 1.0F));
  EXPECT_EQ(scene.balls[2].atom, 2U);
  EXPECT_EQ(scene.bounds.max, Vec3(5.5, 1.5, 1.5));
  parameters.atoms.visible["Na"] = false;
  scene = make_scene(material, parameters);
  ASSERT_EQ(scene.balls.size(), 1U);
  EXPECT_EQ(scene.balls[0].atom, 1U);
  EXPECT_EQ(scene.bounds.max, Vec3(5.5, 1.5, 1.5));  // hiding moves the camera no more than cutting
}

TEST(Scene, OneAtomAndNoAtoms) {
  const Material one = atoms_material({{"Fe", {3, 4, 5}}});
  for (const Mode mode : {Mode::volume_surface, Mode::volume, Mode::surface, Mode::xray, Mode::atoms}) {
    const Scene scene = make_scene(one, looking(mode, "front"));
    EXPECT_EQ(scene.center, Vec3(3, 4, 5));
    EXPECT_TRUE(scene.tetrahedra.empty());
    EXPECT_TRUE(scene.surface.empty());
    EXPECT_THROW(make_scene(Material(), looking(mode, "front")), Error);
  }
}

}  // namespace
}  // namespace atomesh
