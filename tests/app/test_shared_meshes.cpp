// The literature's data sets and other people's meshes (see INDEX.md beside them), where they are there.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "app/cli/read_mesh.h"
#include "core/surface.h"
#include "render/renderer.h"
#include "render/scene.h"

namespace atomesh::cli {
namespace {

struct Expected {
  const char* file;
  const char* format;
  std::uint64_t cells;
  std::uint64_t tetrahedra;  // with the flat ones, as the literature counts
  std::uint64_t flat;
  const char* field;  // one of them
};

const Expected meshes[] = {
    {"vtkdata__combxyz.bin", "plot3d", 43008, 215040, 0, "Density"},
    {"vtkdata__bluntfinxyz.bin", "plot3d", 37479, 187395, 77, "Pressure"},
    // 513,375, and one more for each cell at the seam where the grid closes on itself out of turn.
    {"vtkdata__postxyz.bin", "plot3d", 102675, 513375 + 37 * 37, 0, "Energy"},
    {"vtkdata__post.vtk", "vtk", 8750, 8750, 0, "Pressure"},
    {"usm3d_box.vtk", "vtk", 63926, 63926, 0, "rho"},
    {"quake_sf10.vtk", "vtk", 35025, 35025, 0, "depth"},
    {"chaste__Cube21.node", "tetgen", 48000, 48000, 0, "region_1"},
    {"chaste__monodomain3d_0.vtu", "vtu", 3600, 3600, 0, "V_000001"},
    {"sofa__raptorTetra_8418.vtu", "vtu", 8418, 8418, 0, ""},
};
void PrintTo(const Expected& expected, std::ostream* out) {
  *out << expected.file;
}

std::string path_of(const char* file) {
  return std::string(ATOMESH_SHARED_DATA) + "/volume/" + file;
}

class SharedMeshes : public testing::TestWithParam<Expected> {};

TEST_P(SharedMeshes, AreReadWholeAndSound) {
  const Expected& expected = GetParam();
  const std::string path = path_of(expected.file);
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  ASSERT_TRUE(is_mesh_file(path));
  MeshFileReport report;
  const Material material = read_mesh_file(path, {}, report);
  EXPECT_EQ(report.format, expected.format);
  EXPECT_EQ(report.cells, expected.cells);
  EXPECT_EQ(report.flat, expected.flat);
  EXPECT_EQ(report.tetrahedra + report.flat, expected.tetrahedra);
  EXPECT_EQ(material.mesh.tetrahedra.size(), report.tetrahedra);
  EXPECT_EQ(validate(material.mesh), std::vector<std::string>());
  EXPECT_EQ(validate(material.surface, material.mesh), std::vector<std::string>());
  EXPECT_NEAR(enclosed_volume(material.surface, material.mesh.vertices), volume(material.mesh),
              1e-9 * volume(material.mesh));
  const bool found = std::any_of(material.fields.begin(), material.fields.end(),
                                 [&](const VertexField& field) { return field.name == expected.field; });
  EXPECT_EQ(found, *expected.field != '\0');
}

std::string case_name(const testing::TestParamInfo<Expected>& info) {
  std::string name = info.param.file;
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(Volume, SharedMeshes, testing::ValuesIn(meshes), case_name);

// Two renderers that share no code but the camera.
TEST(SharedMeshes, CombIsTheJudges) {
  const std::string path = path_of("vtkdata__combxyz.bin");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  MeshFileReport report;
  const Material material = read_mesh_file(path, {}, report);
  for (const Mode mode : {Mode::volume, Mode::surface}) {
    Parameters parameters;
    parameters.mode = mode;
    const Scene scene = make_scene(material, parameters);
    const Camera camera = make_camera(parameters, scene.bounds, 64, 48);
    RenderStats stats;
    const Image cpu = render(find_renderer("cpu"), scene, camera, parameters, stats);
    const Image judge = render(find_renderer("reference"), scene, camera, parameters, stats);
    const ImageDifference difference = compare_images(cpu, judge, 2.0 / 255.0);
    EXPECT_EQ(difference.pixels_over, 0U) << mode_name(mode) << ": " << difference.max;
  }
}

}  // namespace
}  // namespace atomesh::cli
