// Fields of the vertices: which is shown, from which range, in which colours.
#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "render/scene.h"
#include "tests/render/fixtures.h"

namespace atomesh {
namespace {

using namespace test;

// A mesh without atoms; "ramp" is 10 x - 5, "other" 0 and 1 in turn, "flat" 3 everywhere.
Material mesh_with_fields() {
  Material material = box_material(4, 1, 1, 1.0);
  material.atoms = {};
  material.mesh.vertex_atom.assign(material.mesh.vertices.size(), no_index);
  material.fields = {{"ramp", {}}, {"other", {}}, {"flat", {}}};
  for (std::size_t v = 0; v < material.mesh.vertices.size(); ++v) {
    material.fields[0].values.push_back(static_cast<float>(10.0 * material.mesh.vertices[v].x - 5.0));
    material.fields[1].values.push_back(static_cast<float>(v % 2));
    material.fields[2].values.push_back(3.0F);
  }
  return material;
}

Parameters showing(Mode mode, const std::string& field) {
  Parameters parameters = looking(mode, "front");
  parameters.volume.field = field;
  return parameters;
}

std::string refusal(const Material& material, const Parameters& parameters) {
  try {
    make_scene(material, parameters);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(SceneFields, TheFirstIsShownUnlessAnotherIsNamed) {
  const Material material = mesh_with_fields();
  const Bounds bounds = bounds_of(material.mesh.vertices);
  const Scene first = make_scene(material, showing(Mode::volume, ""));
  const Scene second = make_scene(material, showing(Mode::volume, "other"));
  Material behind_flat = material;
  std::swap(behind_flat.fields.front(), behind_flat.fields.back());
  EXPECT_EQ(make_scene(behind_flat, showing(Mode::volume, "")).scalars,
            make_scene(material, showing(Mode::volume, "other")).scalars);
  const Scene flat = make_scene(material, showing(Mode::volume, "flat"));
  ASSERT_EQ(first.scalars.size(), material.mesh.vertices.size());
  for (std::size_t v = 0; v < first.scalars.size(); ++v) {
    const double x = material.mesh.vertices[v].x;
    EXPECT_FLOAT_EQ(first.scalars[v], static_cast<float>((x - bounds.min.x) / bounds.extent().x));
    EXPECT_EQ(second.scalars[v], static_cast<float>(v % 2));
    EXPECT_EQ(flat.scalars[v], 0.5F);
  }
}

TEST(SceneFields, ASetRangeIsWhatTheColorMapsEndsStandFor) {
  const Material material = mesh_with_fields();
  Parameters parameters = showing(Mode::volume, "ramp");
  parameters.volume.range_low = 5.0;
  parameters.volume.range_high = 25.0;
  const Scene scene = make_scene(material, parameters);
  for (std::size_t v = 0; v < scene.scalars.size(); ++v) {
    const float expected = std::clamp((material.fields[0].values[v] - 5.0F) / 20.0F, 0.0F, 1.0F);
    EXPECT_FLOAT_EQ(scene.scalars[v], expected);
  }
  parameters.volume.range_high = 5.0;
  EXPECT_NE(refusal(material, parameters).find("volume.range_low (5) must be below volume.range_high (5); ramp goes"),
            std::string::npos);
  parameters.volume.range_low.reset();
  parameters.volume.range_high = -1e9;
  EXPECT_NE(refusal(material, parameters), "");
}

TEST(SceneFields, RangesAsLongAsFloatsGo) {
  Material material = mesh_with_fields();
  const float largest = std::numeric_limits<float>::max();
  material.fields[0].values.front() = -largest;
  material.fields[0].values.back() = largest;
  Parameters parameters = showing(Mode::volume, "ramp");
  Scene scene = make_scene(material, parameters);
  EXPECT_EQ(scene.scalars.front(), 0.0F);
  EXPECT_EQ(scene.scalars.back(), 1.0F);
  EXPECT_EQ(scene.scalars[1], 0.5F);
  parameters.volume.range_low = -1e300;
  parameters.volume.range_high = 1e300;
  scene = make_scene(material, parameters);
  EXPECT_EQ(scene.scalars[1], 0.5F);
}

TEST(SceneFields, VolumeAndSurfaceIsColouredByTheColorMap) {
  const Material material = mesh_with_fields();
  Parameters parameters = showing(Mode::volume_surface, "");
  parameters.volume.color_map = preset_color_map("blue-white-red");
  const Scene scene = make_scene(material, parameters);
  const std::vector<float> scalars = make_scene(material, showing(Mode::volume, "")).scalars;
  ASSERT_EQ(scene.colors.size(), scalars.size());
  for (std::size_t v = 0; v < scalars.size(); ++v) {
    EXPECT_EQ(scene.colors[v], parameters.volume.color_map(scalars[v]));
  }
}

TEST(SceneFields, DefectsComeFirstUntilAFieldIsNamed) {
  Material material = box_material(2, 2, 2, 1.0);
  add_defects(material, 1);
  const Scene defects = make_scene(material, showing(Mode::volume, ""));
  material.fields = {{"zero", std::vector<float>(material.mesh.vertices.size(), 0.0F)}};
  material.fields[0].values[3] = 1.0F;
  EXPECT_EQ(make_scene(material, showing(Mode::volume, "")).scalars, defects.scalars);
  EXPECT_EQ(make_scene(material, showing(Mode::volume, "defects")).scalars, defects.scalars);
  EXPECT_EQ(make_scene(material, showing(Mode::volume, "zero")).scalars, material.fields[0].values);
  // And of a field of that name, which has to be asked for by it, the field.
  material.fields[0].name = "defects";
  EXPECT_EQ(make_scene(material, showing(Mode::volume, "defects")).scalars, material.fields[0].values);
}

TEST(SceneFields, UnknownNamesAreRefusedWithTheNearestOrAll) {
  const Material material = mesh_with_fields();
  EXPECT_EQ(refusal(material, showing(Mode::volume, "Ramp")),
            "volume.field: the material has no field \"Ramp\"; did you mean ramp?");
  EXPECT_EQ(refusal(material, showing(Mode::volume_surface, "temperature of the wall")),
            "volume.field: the material has no field \"temperature of the wall\"; it has ramp, other, flat");
  EXPECT_EQ(refusal(material, showing(Mode::surface, "Ramp")), "") << "where it is not used it does not matter";
  EXPECT_EQ(refusal(box_material(1, 1, 1, 1.0), showing(Mode::volume, "x")),
            "volume.field: the material has no field \"x\"; it has none");
}

TEST(SceneFields, AFieldOfAnotherLengthIsRefused) {
  Material material = mesh_with_fields();
  material.fields[1].values.pop_back();
  EXPECT_THROW(make_scene(material, showing(Mode::volume, "ramp")), Error);
}

}  // namespace
}  // namespace atomesh
