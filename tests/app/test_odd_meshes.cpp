// Meshes that no mesher should write and people have: what is read of them and what the notes say.
#include <gtest/gtest.h>

#include <algorithm>

#include "app/cli/inner_walls.h"
#include "app/cli/read_mesh.h"
#include "core/error.h"
#include "tests/app/mesh_files.h"
#include "tests/support/temporary_folder.h"

namespace atomesh::cli {
namespace {

using test::legacy_vtk;
using test::TemporaryFolder;
using test::VtkCell;

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

bool says(const MeshFileReport& report, const std::string& words) {
  return std::any_of(report.notes.begin(), report.notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

const std::vector<Vec3> cube{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

// A corner of each of 100,000 cells stands at one place with a value of its own, of another 100,000 with a common one.
TEST(OddMeshes, AnyNumberOfPointsShareAPlace) {
  const TemporaryFolder folder;
  constexpr int cells_of_each = 100000;
  std::vector<Vec3> points;
  std::vector<VtkCell> cells;
  std::string data;
  for (int c = 0; c < 2 * cells_of_each; ++c) {
    const int p = 4 * c;
    const double x = 1.0 + c;
    points.insert(points.end(), {{0, 0, 0}, {x, 1, 0}, {x, 2, 0}, {x, 1, 1}});
    cells.push_back({10, {p, p + 1, p + 2, p + 3}});
    data += std::to_string(c < cells_of_each ? c : cells_of_each) + " 0 0 0\n";
  }
  data = "POINT_DATA " + std::to_string(points.size()) + "\nSCALARS s float 1\nLOOKUP_TABLE default\n" + data;
  const Read file = read(folder.file("a.vtk", legacy_vtk(points, cells, data)));
  EXPECT_EQ(file.material.mesh.tetrahedra.size(), 2U * cells_of_each);
  EXPECT_EQ(file.material.mesh.vertices.size(), 2U * cells_of_each * 3 + cells_of_each + 1);
  EXPECT_TRUE(says(file.report, "99999 points that repeat"));
}

TEST(OddMeshes, CoordinatesWhoseVolumesOverflowAreRefused) {
  const TemporaryFolder folder;
  const auto scaled = [&](double by) {
    std::vector<Vec3> points = cube;
    for (Vec3& p : points) p *= by;
    return folder.file("a.vtk", legacy_vtk(points, {{10, {0, 1, 3, 4}}}));
  };
  EXPECT_EQ(read(scaled(1e99)).report.turned, 0U);
  for (const double by : {1.5e100, -1e300}) {
    try {
      read(scaled(by));
      ADD_FAILURE() << by;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("a coordinate of point 1 is beyond 1e100"), std::string::npos)
          << error.what();
    }
  }
}

TEST(OddMeshes, ACellOfAKindThatIsNotReadIsCountedOnce) {
  const TemporaryFolder folder;
  const int convex_point_set = 41;
  const Read file = read(folder.file(
      "a.vtk",
      legacy_vtk(cube,
                 {{12, {0, 1, 2, 3, 4, 5, 6, 7}}, {convex_point_set, {0, 1, 2, 3, 4}}, {5, {0, 1, 2}}, {3, {0, 1}}})));
  EXPECT_EQ(file.report.cells, 1U);
  EXPECT_EQ(file.report.skipped, 2U);
  EXPECT_TRUE(says(file.report, "1 cells of kinds that are not read"));
  EXPECT_TRUE(says(file.report, "2 cells without volume"));
}

// A hexahedron one corner of which is pulled through the opposite side has tetrahedra of both senses.
TEST(OddMeshes, FoldedCellsAreNotCalledInsideOut) {
  const TemporaryFolder folder;
  std::vector<Vec3> points = cube;
  points[6] = {-1, -1, -1};
  const std::vector<int> listed{0, 1, 2, 3, 4, 5, 6, 7};
  const Read folded = read(folder.file("a.vtk", legacy_vtk(points, {{12, listed}})));
  EXPECT_EQ(folded.report.turned, 0U);
  EXPECT_TRUE(says(folded.report, "1 cells are folded"));
  EXPECT_FALSE(says(folded.report, "inside out"));
  // The cube listed from its top down is inside out, all of it.
  const Read turned = read(folder.file("b.vtk", legacy_vtk(cube, {{12, {4, 5, 6, 7, 0, 1, 2, 3}}})));
  EXPECT_EQ(turned.report.turned, turned.report.tetrahedra);
  EXPECT_FALSE(says(turned.report, "folded"));
  EXPECT_NEAR(volume(turned.material.mesh), 1.0, 1e-15);
}

// Points of an i-j-k grid of unit cubes in a box from `at`, and its hexahedra; points may repeat those of others.
void add_cubes(std::vector<Vec3>& points, std::vector<VtkCell>& cells, const Vec3& at, int count, double edge) {
  for (int k = 0; k < count; ++k) {
    for (int j = 0; j < count; ++j) {
      for (int i = 0; i < count; ++i) {
        VtkCell cell{12, {}};
        for (const Vec3& corner : cube) {
          cell.corners.push_back(static_cast<int>(points.size()));
          points.push_back(at + edge * (corner + Vec3(i, j, k)));
        }
        cells.push_back(cell);
      }
    }
  }
}

TEST(OddMeshes, HangingVerticesLeaveWallsThatAreSaid) {
  const TemporaryFolder folder;
  std::vector<Vec3> points;
  std::vector<VtkCell> cells;
  add_cubes(points, cells, {0, 0, 0}, 1, 2.0);
  add_cubes(points, cells, {2, 0, 0}, 2, 1.0);
  const Read hanging = read(folder.file("a.vtk", legacy_vtk(points, cells)));
  EXPECT_NEAR(volume(hanging.material.mesh), 16.0, 1e-14);
  EXPECT_NEAR(area(hanging.material.surface, hanging.material.mesh.vertices), 40.0 + 2 * 4.0, 1e-13)
      << "the wall, seen from its two sides";
  EXPECT_TRUE(says(hanging.report, "lie back to back inside the mesh"));
  // Eight cubes that fit together have none, nor have two that only share an edge.
  points.clear();
  cells.clear();
  add_cubes(points, cells, {0, 0, 0}, 2, 1.0);
  EXPECT_FALSE(says(read(folder.file("b.vtk", legacy_vtk(points, cells))).report, "back to back"));
  points.clear();
  cells.clear();
  add_cubes(points, cells, {0, 0, 0}, 1, 1.0);
  add_cubes(points, cells, {1, 1, 0}, 1, 1.0);
  EXPECT_FALSE(says(read(folder.file("c.vtk", legacy_vtk(points, cells))).report, "back to back"));
}

// Two prisms' quadrilateral halved along one diagonal and along the other.
TEST(OddMeshes, FacesSplitDifferentlyAreWalls) {
  const TemporaryFolder folder;
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}, {0.5, 0.5, -1}};
  const Read apart = read(folder.file(
      "a.vtk", legacy_vtk(points, {{10, {0, 1, 2, 4}}, {10, {0, 2, 3, 4}}, {10, {0, 1, 3, 5}}, {10, {1, 2, 3, 5}}})));
  EXPECT_EQ(count_inner_walls(apart.material.surface, apart.material.mesh.vertices), 4U);
  EXPECT_TRUE(says(apart.report, "4 faces of the surface lie back to back"));
  const Read alike = read(folder.file(
      "b.vtk", legacy_vtk(points, {{10, {0, 1, 2, 4}}, {10, {0, 2, 3, 4}}, {10, {0, 1, 2, 5}}, {10, {0, 2, 3, 5}}})));
  EXPECT_EQ(count_inner_walls(alike.material.surface, alike.material.mesh.vertices), 0U);
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
