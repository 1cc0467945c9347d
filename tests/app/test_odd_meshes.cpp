// Meshes that no mesher should write and people have: what is read of them and what the notes say.
#include <gtest/gtest.h>

#include "app/cli/read_mesh.h"
#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace atomesh::cli {
namespace {

using test::TemporaryFolder;

struct Read {
  Material material;
  MeshFileReport report;
};

Read read(const std::string& path) {
  Read result;
  result.material = read_mesh_file(path, {}, result.report);
  EXPECT_EQ(validate(result.material.mesh), std::vector<std::string>()) << path;
  return result;
}

// Fortran writes a double's exponent with D.
TEST(OddMeshes, TextGridsWithDExponents) {
  const TemporaryFolder folder;
  const std::string grid =
      "2 2 3\n0 .1D+01 0 1 0 1 0 1.d0 0 1 0 1\n0 0 1 1 0 0 1 1 0 0 1 1\n0 0 0 0\n1 1 1 1 2.0D+00 0.2D+1 2e0 2E+00\n";
  std::string solution = "2 2 3\n0.5D0 0 1D3 2\n";
  for (int i = 0; i < 60; ++i) solution += i < 12 ? ".25D+02 " : i < 48 ? "0 " : "1D1\n";
  const std::string path = folder.file("a.x", grid);
  folder.file("a.q", solution);
  const Read file = read(path);
  EXPECT_EQ(file.report.format, "plot3d");
  EXPECT_NEAR(volume(file.material.mesh), 2.0, 1e-15);
  ASSERT_EQ(file.material.fields.size(), 7U);
  EXPECT_EQ(file.material.fields[0].name, "Density");
  EXPECT_EQ(file.material.fields[0].values, std::vector<float>(12, 25.0F));
  EXPECT_EQ(file.material.fields[6].name, "Pressure");
  EXPECT_EQ(file.material.fields[6].values, std::vector<float>(12, 4.0F));
  // What is no number is refused by what it is.
  std::string damaged = grid;
  damaged.replace(damaged.find("2.0D+00"), 7, "2.0D+-0");
  try {
    read(folder.file("b.x", damaged));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("\"2.0D+-0\""), std::string::npos) << error.what();
  }
}

// Two grids in text, one after another, each with its blanking.
TEST(OddMeshes, TextGridsWithBlanking) {
  const TemporaryFolder folder;
  const std::string text =
      "2\n2 2 2 3 2 2\n0 1 0 1 0 1 0 1  0 0 1 1 0 0 1 1  0 0 0 0 1 1 1 1  1 1 1 1 1 1 1 1\n"
      "5 6 7 5 6 7 5 6 7 5 6 7  0 0 0 1 1 1 0 0 0 1 1 1  0 0 0 0 0 0 1 1 1 1 1 1  0 1 1 1 1 -1 1 1 1 1 1 1\n";
  const Read file = read(folder.file("a.p3d", text));
  EXPECT_EQ(file.report.cells, 2U);
  EXPECT_EQ(file.report.blanked, 1U);
  EXPECT_NEAR(volume(file.material.mesh), 2.0, 1e-15);
}

}  // namespace
}  // namespace atomesh::cli
