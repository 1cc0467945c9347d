// Mesh files of a few cells whose volume, surface and fields are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/cli/read_mesh.h"
#include "app/cli/write_vtu.h"
#include "core/error.h"
#include "core/material_file.h"
#include "tests/app/mesh_files.h"
#include "tests/core/random_material.h"
#include "tests/support/temporary_folder.h"

namespace atomesh::cli {
namespace {

using test::legacy_vtk;
using test::Plot3dForm;
using test::Plot3dGrid;
using test::TemporaryFolder;
using test::VtkCell;
using test::vtu;

struct Read {
  Material material;
  MeshFileReport report;
};

Read read(const std::string& path, const MeshFileOptions& options = {}) {
  Read result;
  result.material = read_mesh_file(path, options, result.report);
  EXPECT_EQ(validate(result.material.mesh), std::vector<std::string>()) << path;
  EXPECT_EQ(validate(result.material.surface, result.material.mesh), std::vector<std::string>()) << path;
  for (const VertexField& field : result.material.fields) {
    EXPECT_EQ(field.values.size(), result.material.mesh.vertices.size()) << field.name;
  }
  return result;
}

bool says(const MeshFileReport& report, const std::string& words) {
  return std::any_of(report.notes.begin(), report.notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

std::vector<std::string> names(const Material& material) {
  std::vector<std::string> list;
  for (const VertexField& field : material.fields) list.push_back(field.name);
  return list;
}

// value(position) at every vertex.
template <class Value>
void expect_field(const Material& material, const std::string& name, Value&& value, double tolerance = 1e-6) {
  const auto field = std::find_if(material.fields.begin(), material.fields.end(),
                                  [&](const VertexField& f) { return f.name == name; });
  ASSERT_NE(field, material.fields.end()) << name;
  for (std::size_t v = 0; v < field->values.size(); ++v) {
    EXPECT_NEAR(field->values[v], value(material.mesh.vertices[v]), tolerance) << name << " at vertex " << v;
  }
}

using Names = std::vector<std::string>;

const std::vector<Vec3> cube{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

// One cell of each kind side by side along x, two apart: (cells, their volume together).
std::pair<std::vector<VtkCell>, double> one_of_each(std::vector<Vec3>& points) {
  std::vector<VtkCell> cells;
  const auto add = [&](int type, const std::vector<Vec3>& corners) {
    VtkCell cell{type, {}};
    for (const Vec3& p : corners) {
      cell.corners.push_back(static_cast<int>(points.size()));
      points.push_back(p + Vec3(2.0 * static_cast<double>(cells.size()), 0.0, 0.0));
    }
    cells.push_back(cell);
  };
  const auto& c = cube;
  add(10, {c[0], c[1], c[3], c[4]});                          // tetrahedron, 1/6
  add(10, {c[0], c[3], c[1], c[4]});                          // inside out
  add(11, {c[0], c[1], c[3], c[2], c[4], c[5], c[7], c[6]});  // voxel, 1
  add(12, c);                                                 // hexahedron, 1
  add(13, {c[0], c[3], c[1], c[4], c[7], c[5]});              // wedge, 1/2
  add(14, {c[0], c[1], c[2], c[3], {0.5, 0.5, 1.0}});         // pyramid, 1/3
  add(24, {c[0], c[1], c[3], c[4], {.5, 0, 0}, {.5, .5, 0}, {0, .5, 0}, {0, 0, .5}, {.5, 0, .5}, {0, .5, .5}});
  add(5, {c[0], c[1], c[2]});  // triangle
  add(1, {c[0]});              // point
  return {cells, 3.0 / 6.0 + 2.0 + 0.5 + 1.0 / 3.0};
}

TEST(ReadMesh, EveryKindOfCellKeepsItsVolumeInBothFormats) {
  const TemporaryFolder folder;
  std::vector<Vec3> points;
  const auto [cells, expected] = one_of_each(points);
  for (const std::string& path :
       {folder.file("a.vtk", legacy_vtk(points, cells)), folder.file("a.vtu", vtu(points, cells)),
        folder.file("named otherwise", legacy_vtk(points, cells))}) {
    EXPECT_TRUE(is_mesh_file(path));
    const Read file = read(path);
    EXPECT_NEAR(volume(file.material.mesh), expected, 1e-14);
    EXPECT_EQ(file.report.points, points.size());
    EXPECT_EQ(file.report.cells, 7U);
    EXPECT_EQ(file.report.skipped, 2U);
    EXPECT_GE(file.report.turned, 1U);
    EXPECT_TRUE(says(file.report, "2 cells without volume"));
    EXPECT_TRUE(says(file.report, "1 curved cells"));
    EXPECT_TRUE(says(file.report, "no scalar"));
    EXPECT_FALSE(file.material.mesh.delaunay);
    EXPECT_EQ(file.material.atoms.size(), 0U);
    EXPECT_EQ(file.material.mesh.vertices.size(), 4U + 4 + 8 + 8 + 6 + 5 + 4) << "points of cells only";
    EXPECT_EQ(file.material.provenance.counts[2].second, file.material.mesh.tetrahedra.size());
  }
}

TEST(ReadMesh, APolyhedronIsReadByItsFaces) {
  const TemporaryFolder folder;
  // The cube as a polyhedron, in the stream of faces that the legacy format has.
  const VtkCell cell{42, {6, 4, 0, 4, 7, 3, 4, 1, 2, 6, 5, 4, 0, 1, 5, 4, 4, 3, 7, 6, 2, 4, 0, 3, 2, 1, 4, 4, 5, 6, 7}};
  const Read file = read(folder.file("a.vtk", legacy_vtk(cube, {cell})));
  EXPECT_NEAR(volume(file.material.mesh), 1.0, 1e-15);
  EXPECT_EQ(file.report.cells, 1U);
}

TEST(ReadMesh, FieldsAreScalarsMagnitudesComponentsAndAverages) {
  const TemporaryFolder folder;
  // Two cubes along x; every point shared by number.
  std::vector<Vec3> points = cube;
  for (const int c : {1, 2, 5, 6}) points.push_back(cube[static_cast<std::size_t>(c)] + Vec3(1, 0, 0));
  const std::vector<VtkCell> cells{{12, {0, 1, 2, 3, 4, 5, 6, 7}}, {12, {1, 8, 9, 2, 5, 10, 11, 6}}};
  std::string data = "CELL_DATA 2\nSCALARS load float 1\nLOOKUP_TABLE default\n2 6\nPOINT_DATA 12\n";
  data += "VECTORS velocity float\n";
  for (const Vec3& p : points) {
    data += std::to_string(3 * p.x) + " " + std::to_string(4 * p.x) + " " + std::to_string(12 * p.x) + "\n";
  }
  data += "SCALARS depth float 1\nLOOKUP_TABLE default\n";
  for (const Vec3& p : points) data += std::to_string(p.y - p.z) + "\n";
  data += "SCALARS load double 1\nLOOKUP_TABLE default\n";
  for (std::size_t p = 0; p < points.size(); ++p) data += "1\n";
  const Read file = read(folder.file("a.vtk", legacy_vtk(points, cells, data)));
  EXPECT_EQ(names(file.material),
            (Names{"depth", "velocity", "velocity_x", "velocity_y", "velocity_z", "load", "load_cell"}));
  expect_field(file.material, "depth", [](const Vec3& p) { return p.y - p.z; });
  expect_field(file.material, "velocity", [](const Vec3& p) { return 13.0 * p.x; });
  expect_field(file.material, "velocity_y", [](const Vec3& p) { return 4.0 * p.x; });
  expect_field(file.material, "load_cell", [](const Vec3& p) { return p.x < 0.5 ? 2.0 : p.x < 1.5 ? 4.0 : 6.0; });
}

TEST(ReadMesh, PointsOfOnePlaceAndEqualValuesAreOneVertex) {
  const TemporaryFolder folder;
  // Two cubes that do not share their points.
  std::vector<Vec3> points = cube;
  for (const Vec3& p : cube) points.push_back(p + Vec3(1, 0, 0));
  const std::vector<VtkCell> cells{{12, {0, 1, 2, 3, 4, 5, 6, 7}}, {12, {8, 9, 10, 11, 12, 13, 14, 15}}};
  const auto data = [](const char* second) {
    std::string text = "POINT_DATA 16\nSCALARS s float 1\nLOOKUP_TABLE default\n";
    for (int i = 0; i < 8; ++i) text += "1\n";
    for (int i = 0; i < 8; ++i) text += second;
    return text;
  };
  const Read joined = read(folder.file("a.vtk", legacy_vtk(points, cells, data("1\n"))));
  EXPECT_EQ(joined.material.mesh.vertices.size(), 12U);
  EXPECT_NEAR(area(joined.material.surface, joined.material.mesh.vertices), 10.0, 1e-14);
  EXPECT_TRUE(says(joined.report, "4 points that repeat"));
  // A jump is kept: two boxes, each with its own face.
  const Read apart = read(folder.file("b.vtk", legacy_vtk(points, cells, data("2\n"))));
  EXPECT_EQ(apart.material.mesh.vertices.size(), 16U);
  EXPECT_NEAR(area(apart.material.surface, apart.material.mesh.vertices), 12.0, 1e-14);
}

TEST(ReadMesh, FlatCellsAreLeftOut) {
  const TemporaryFolder folder;
  std::vector<Vec3> points = cube;
  points.emplace_back(0.5, 0.5, 0.0);
  const std::vector<VtkCell> cells{{10, {0, 1, 3, 4}}, {10, {0, 1, 2, 8}}, {10, {0, 1, 1, 4}}};
  const Read file = read(folder.file("a.vtk", legacy_vtk(points, cells)));
  EXPECT_EQ(file.report.flat, 2U);
  EXPECT_EQ(file.material.mesh.tetrahedra.size(), 1U);
  EXPECT_EQ(file.material.mesh.vertices.size(), 4U);
  EXPECT_THROW(read(folder.file("b.vtk", legacy_vtk(points, {{10, {0, 1, 2, 8}}}))), InputError);
}

// What no sound mesh has must still be drawn: three cells at one face, one cell twice, one that folds back.
TEST(ReadMesh, CellsThatOverlapGetFacesOfTheirOwn) {
  const TemporaryFolder folder;
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {0.2, 0.2, 0.8}};
  const Read three =
      read(folder.file("a.vtk", legacy_vtk(points, {{10, {0, 1, 2, 3}}, {10, {0, 2, 1, 4}}, {10, {0, 1, 2, 5}}})));
  EXPECT_EQ(three.material.mesh.tetrahedra.size(), 3U);
  EXPECT_NEAR(volume(three.material.mesh), 1.0 / 6 + 1.0 / 6 + 0.8 / 6, 1e-15);
  EXPECT_EQ(three.material.surface.triangles.size(), 6U + 4U);
  EXPECT_TRUE(says(three.report, "1 tetrahedra overlap"));

  const Read twice =
      read(folder.file("b.vtk", legacy_vtk(points, {{10, {0, 1, 2, 3}}, {10, {1, 2, 0, 3}}, {10, {0, 2, 1, 3}}})));
  EXPECT_EQ(twice.material.mesh.tetrahedra.size(), 1U);
  EXPECT_TRUE(says(twice.report, "2 tetrahedra that stand twice"));
  EXPECT_EQ(twice.report.turned, 1U);
}

// The middle vertex of a fan of four pulled through: one cell turns over and lies upon its neighbours.
TEST(ReadMesh, OfAFoldOnlyTheCellThatFoldsIsTakenOut) {
  const TemporaryFolder folder;
  std::vector<Vec3> points{{1, 0, 0}, {0, 1, 0}, {-1, -1, 0}, {0, 0, 1}, {0.6, 0.6, 0.1}};
  const std::vector<VtkCell> cells{{10, {1, 0, 3, 4}}, {10, {2, 1, 3, 4}}, {10, {0, 2, 3, 4}}, {10, {0, 1, 2, 4}}};
  const Read file = read(folder.file("a.vtk", legacy_vtk(points, cells)));
  EXPECT_EQ(file.material.mesh.tetrahedra.size(), 4U);
  EXPECT_EQ(file.report.turned, 1U);
  EXPECT_TRUE(says(file.report, "1 tetrahedra overlap"));
  // And reading it back finds the same one.
  write_vtu(folder.file("b.vtu"), file.material);
  const Read again = read(folder.file("b.vtu"));
  EXPECT_EQ(again.material.mesh.vertices, file.material.mesh.vertices);
  EXPECT_EQ(again.material.mesh.tetrahedra, file.material.mesh.tetrahedra);
}

// ---- structured grids

Plot3dGrid box(int ni, int nj, int nk) {
  return {{ni, nj, nk}, [](int i, int j, int k) { return Vec3(i, j, k); }, nullptr};
}

TEST(ReadMesh, FieldsThatAreNoNumbersSomewhereAreLeftOut) {
  const TemporaryFolder folder;
  const std::vector<Plot3dGrid> grids{box(3, 2, 2)};
  std::string solution = test::plot3d_solution({}, grids);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(solution.data() + 12 + 16 + 4 * 7, &nan, 4);  // the density of the eighth point
  folder.file("a.q", solution);
  const Read file = read(folder.file("a.x", test::plot3d_grid({}, grids)));
  EXPECT_EQ(names(file.material), (Names{"Energy", "Momentum", "Momentum_x", "Momentum_y", "Momentum_z"}));
  EXPECT_TRUE(says(file.report, "field Density was left out: it is not a finite number at 1 points"));
  // Beyond what a float holds is no number either.
  const std::string huge = "POINT_DATA 8\nSCALARS huge double 1\nLOOKUP_TABLE default\n1 2 3 1e300 5 6 7 8\n";
  const Read second = read(folder.file("a.vtk", legacy_vtk(cube, {{12, {0, 1, 2, 3, 4, 5, 6, 7}}}, huge)));
  EXPECT_TRUE(says(second.report, "field huge was left out"));
  EXPECT_TRUE(second.material.fields.empty());
}

TEST(ReadMesh, Plot3dIsReadInEveryByteLayout) {
  const TemporaryFolder folder;
  const std::vector<Plot3dGrid> grids{box(4, 3, 5)};
  for (int bits = 0; bits < 16; ++bits) {
    const Plot3dForm form{(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0};
    for (const bool blanking : {false, true}) {
      std::vector<Plot3dGrid> written = grids;
      // One corner point blanked takes one cell; a negative number means interpolated, which is a value like others.
      if (blanking) written[0].iblank = [](int i, int j, int k) { return i + j + k == 0 ? 0 : i == 3 ? -1 : 1; };
      const std::string path = folder.file("gridxyz.bin", test::plot3d_grid(form, written));
      folder.file("gridq.bin", test::plot3d_solution(form, written));
      EXPECT_TRUE(is_mesh_file(path));
      const Read file = read(path);
      EXPECT_EQ(file.report.format, "plot3d");
      EXPECT_EQ(file.report.cells, blanking ? 23U : 24U) << bits;
      EXPECT_EQ(file.report.blanked, blanking ? 1U : 0U);
      EXPECT_EQ(file.material.mesh.tetrahedra.size(), blanking ? 115U : 120U);
      EXPECT_NEAR(volume(file.material.mesh), blanking ? 23.0 : 24.0, 1e-12);
      EXPECT_NEAR(area(file.material.surface, file.material.mesh.vertices), 52.0, 1e-12) << "inside faces are shared";
      EXPECT_EQ(names(file.material),
                (Names{"Density", "Energy", "Momentum", "Momentum_x", "Momentum_y", "Momentum_z", "Pressure"}));
      expect_field(file.material, "Density", [](const Vec3& p) { return 1.0 + p.x; });
      expect_field(file.material, "Momentum", [](const Vec3& p) { return glm::length(p); });
      expect_field(file.material, "Momentum_z", [](const Vec3& p) { return p.z; });
      expect_field(
          file.material, "Pressure", [](const Vec3& p) { return 0.4 * (100.0 - 0.5 * glm::dot(p, p) / (1.0 + p.x)); },
          1e-4);
      EXPECT_TRUE(says(file.report, "solution gridq.bin"));
    }
  }
}

TEST(ReadMesh, Plot3dInTextAndWithoutASolution) {
  const TemporaryFolder folder;
  const std::string text = "2 2 3\n0 1 0 1 0 1 0 1 0 1 0 1\n0 0 1 1 0 0 1 1 0 0 1 1\n0 0 0 0\n1 1 1 1 2 2 2 2\n";
  const Read file = read(folder.file("a.xyz", text));
  EXPECT_EQ(file.report.format, "plot3d");
  EXPECT_NEAR(volume(file.material.mesh), 2.0, 1e-15);
  EXPECT_TRUE(says(file.report, "no solution was found"));
  // Atoms in an .xyz are not meant.
  EXPECT_FALSE(is_mesh_file(folder.file("b.xyz", "2\ncomment\nNa 0 0 0\nCl 1 1 1\n")));
  EXPECT_FALSE(is_mesh_file(folder.file("c.xyz", "2\n\n11 0 0 0\n17 1 1 1\n")));
  EXPECT_FALSE(is_mesh_file(folder.file("d.dat", "Na 0 0 0\n")));
  EXPECT_FALSE(is_mesh_file(folder.file("none.xyz")));
  EXPECT_FALSE(is_mesh_file(folder.file("empty", "")));
}

TEST(ReadMesh, SolutionsAreFoundByNameOrNamed) {
  const TemporaryFolder folder;
  const std::vector<Plot3dGrid> grids{box(3, 3, 3)};
  const std::string grid = test::plot3d_grid({}, grids);
  const std::string solution = test::plot3d_solution({}, grids);
  const auto density = [](const Vec3& p) { return 1.0 + p.x; };
  folder.file("wing.q", solution);
  expect_field(read(folder.file("wing.x", grid)).material, "Density", density);
  expect_field(read(folder.file("wing.xyz", grid)).material, "Density", density);
  const std::string apart = folder.file("other", solution);
  expect_field(read(folder.file("plane.x", grid), {apart}).material, "Density", density);
  // Padded with zeros, as some are.
  const std::string padded = folder.file("padded.q", solution + std::string(484, '\0'));
  expect_field(read(folder.file("padded.x", grid)).material, "Density", density);
  const auto refusal = [&](const std::string& path, const std::string& with) -> std::string {
    try {
      read(path, {with});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal(folder.file("plane.x"), folder.file("short", solution.substr(0, 300))).find("short: "),
            std::string::npos);
  EXPECT_NE(refusal(folder.file("plane.x"), folder.file("small", test::plot3d_solution({}, {box(3, 3, 2)})))
                .find("3 x 3 x 3"),
            std::string::npos);
  EXPECT_NE(refusal(apart, "").find("no mesh file"), std::string::npos);
  EXPECT_NE(refusal(folder.file("alone.bin", solution), "").find("is a PLOT3D solution"), std::string::npos);
  EXPECT_NE(
      refusal(folder.file("cube.vtk", legacy_vtk(cube, {{12, {0, 1, 2, 3, 4, 5, 6, 7}}})), apart).find("only PLOT3D"),
      std::string::npos);
}

TEST(ReadMesh, SeveralGridsAreOneMesh) {
  const TemporaryFolder folder;
  // Two boxes that touch at x = 3, an odd number of cells away from the first's corner: the turns do not match.
  Plot3dGrid second = box(3, 4, 4);
  second.at = [](int i, int j, int k) { return Vec3(3 + i, j, k); };
  const std::vector<Plot3dGrid> grids{box(4, 4, 4), second};
  const Plot3dForm form{.multi_grid = true};
  const Read file = read(folder.file("a.x", test::plot3d_grid(form, grids)));
  EXPECT_NEAR(volume(file.material.mesh), 45.0, 1e-12);
  EXPECT_NEAR(area(file.material.surface, file.material.mesh.vertices), 2.0 * (15 + 15 + 9), 1e-12);
  EXPECT_EQ(file.material.mesh.tetrahedra.size(), 5U * 45 + 9) << "six where the turns do not match";
}

// A ring of cells that closes on itself, with an odd and an even number of cells round it.
TEST(ReadMesh, AGridThatClosesOnItselfHasNoSeam) {
  const TemporaryFolder folder;
  for (const int round : {7, 8}) {
    const auto at = [round](int i, int j, int k) {
      const double angle = 2.0 * std::numbers::pi * (j % round) / round;
      return Vec3((1 + i) * std::cos(angle), (1 + i) * std::sin(angle), k);
    };
    const Plot3dForm form{.double_precision = true};
    const Read file = read(folder.file("a.x", test::plot3d_grid(form, {{{4, round + 1, 5}, at, nullptr}})));
    const double sine = std::sin(2.0 * std::numbers::pi / round);
    EXPECT_NEAR(volume(file.material.mesh), 0.5 * round * sine * (16 - 1) * 4, 1e-11);
    EXPECT_EQ(file.material.mesh.vertices.size(), static_cast<std::size_t>(4 * round * 5));
    // Inner and outer wall, top and bottom.
    EXPECT_EQ(file.material.surface.triangles.size(), static_cast<std::size_t>(2 * (2 * 4 * round + 2 * 3 * round)));
    EXPECT_EQ(file.material.mesh.tetrahedra.size(), static_cast<std::size_t>(5 * 3 * 4 * round + (round % 2) * 12));
  }
}

TEST(ReadMesh, CollapsedEdgesOfAGridDoNoHarm) {
  const TemporaryFolder folder;
  // The inner wall shrunk to a line: one edge of each innermost cell is a point.
  const auto at = [](int i, int j, int k) {
    const double angle = 2.0 * std::numbers::pi * (j % 6) / 6;
    return Vec3(i * std::cos(angle), i * std::sin(angle), k);
  };
  const Plot3dForm form{.double_precision = true};
  const Read file = read(folder.file("a.x", test::plot3d_grid(form, {{{3, 7, 3}, at, nullptr}})));
  EXPECT_NEAR(volume(file.material.mesh), 0.5 * 6 * std::sin(std::numbers::pi / 3) * 4 * 2, 1e-12);
  EXPECT_EQ(file.material.surface.triangles.size(), 2U * (6 * 2) + 2U * (6 * 2 + 6));
  EXPECT_EQ(file.report.flat, 0U);
}

TEST(ReadMesh, LeftHandedGridsAreTurned) {
  const TemporaryFolder folder;
  Plot3dGrid mirrored = box(3, 3, 3);
  mirrored.at = [](int i, int j, int k) { return Vec3(-i, j, k); };
  const Read file = read(folder.file("a.x", test::plot3d_grid({}, {mirrored})));
  EXPECT_EQ(file.report.turned, 40U);
  EXPECT_NEAR(volume(file.material.mesh), 8.0, 1e-14);
}

TEST(ReadMesh, LegacyGridsOfEveryStructure) {
  const TemporaryFolder folder;
  const std::string head = "# vtk DataFile Version 2.0\ntest\nASCII\nDATASET ";
  const std::string data = "POINT_DATA 12\nSCALARS s int 1\nLOOKUP_TABLE default\n0 1 2 3 4 5 6 7 8 9 10 11\n";
  std::string points;
  for (int i = 0; i < 12; ++i) {
    points += std::to_string(2 * (i % 2)) + " " + std::to_string(i / 2 % 3) + " " + std::to_string(i / 6) + "\n";
  }
  const std::string image = "STRUCTURED_POINTS\nDIMENSIONS 2 3 2\nORIGIN 0 0 0\nSPACING 2 1 1\n";
  const std::string rectilinear =
      "RECTILINEAR_GRID\nDIMENSIONS 2 3 2\nX_COORDINATES 2 float\n0 2\nY_COORDINATES 3 float\n0 1 2\n"
      "Z_COORDINATES 2 float\n0 1\n";
  const std::string structured = "STRUCTURED_GRID\nDIMENSIONS 2 3 2\nPOINTS 12 float\n" + points;
  for (const std::string& geometry : {image, rectilinear, structured}) {
    const Read file = read(folder.file("a.vtk", head + geometry + data));
    EXPECT_NEAR(volume(file.material.mesh), 4.0, 1e-14) << geometry;
    EXPECT_EQ(file.material.mesh.tetrahedra.size(), 10U);
    expect_field(file.material, "s", [](const Vec3& p) { return p.x / 2 + 2 * p.y + 6 * p.z; });
  }
  const auto refusal = [&](const std::string& text) -> std::string {
    try {
      read(folder.file("b.vtk", head + text));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal("STRUCTURED_POINTS\nDIMENSIONS 4 3 1\nORIGIN 0 0 0\nSPACING 2 1 1\n" + data)
                .find("has no cells with volume"),
            std::string::npos);
  EXPECT_NE(refusal("POLYDATA\nPOINTS 12 float\n" + points).find("POLYDATA; expected a grid with volume"),
            std::string::npos);
}

TEST(ReadMesh, TetgenCountsFromZeroOrOne) {
  const TemporaryFolder folder;
  for (const int first : {0, 1}) {
    std::string nodes = "# five points\n5 3 1 0\n";
    const Vec3 points[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    for (int p = 0; p < 5; ++p) {
      const Vec3& at = points[p];
      nodes += std::to_string(p + first) + " " + std::to_string(at.x) + " " + std::to_string(at.y) + " " +
               std::to_string(at.z) + " " + std::to_string(10 * p) + " # a comment\n";
    }
    const auto corner = [&](int p) { return " " + std::to_string(p + first); };
    const std::string elements = "2 4 1\n\n0" + corner(0) + corner(1) + corner(2) + corner(3) + " 7\n1" + corner(1) +
                                 corner(2) + corner(3) + corner(4) + " 9\n";
    folder.file("a.1.node", nodes);
    folder.file("a.1.ele", elements);
    for (const char* name : {"a.1.node", "a.1.ele"}) {
      const Read file = read(folder.file(name));
      EXPECT_EQ(file.report.format, "tetgen");
      EXPECT_NEAR(volume(file.material.mesh), 0.5, 1e-15);
      EXPECT_EQ(names(file.material), (Names{"attribute_1", "region_1"}));
      EXPECT_EQ(file.material.fields[0].values, (std::vector<float>{0, 10, 20, 30, 40}));
      EXPECT_EQ(file.material.fields[1].values, (std::vector<float>{7, 8, 8, 8, 9}));
    }
  }
  const std::string alone = folder.file("alone.node", "1 3 0 0\n1 0 0 0\n");
  try {
    read(alone);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("expected alone.ele beside it"), std::string::npos) << error.what();
  }
}

TEST(ReadMesh, FieldsComeBackFromEveryFormat) {
  const TemporaryFolder folder;
  Plot3dGrid warped = box(5, 4, 6);
  warped.at = [](int i, int j, int k) { return Vec3(i + 0.1 * std::sin(j), j + 0.1 * std::cos(k), k - 0.2 * i); };
  folder.file("a.q", test::plot3d_solution({}, {warped}));
  const Material material = read(folder.file("a.x", test::plot3d_grid({}, {warped}))).material;
  for (const char* name : {"b.crb", "b.crt"}) {
    write_material(folder.file(name), material);
    EXPECT_EQ(test::difference(read_material(folder.file(name)), material), "") << name;
  }
  write_vtu(folder.file("b.vtu"), material);
  const Read again = read(folder.file("b.vtu"));
  EXPECT_EQ(again.material.mesh.vertices, material.mesh.vertices);
  EXPECT_EQ(again.material.mesh.tetrahedra, material.mesh.tetrahedra);
  EXPECT_EQ(again.material.surface.triangles, material.surface.triangles);
  ASSERT_EQ(names(again.material), names(material));
  for (std::size_t f = 0; f < material.fields.size(); ++f) {
    EXPECT_EQ(again.material.fields[f].values, material.fields[f].values);
  }
}

TEST(ReadMesh, CancellingStopsIt) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.x", test::plot3d_grid({}, {box(20, 20, 20)}));
  Progress progress;
  progress.request_cancel();
  MeshFileReport report;
  EXPECT_THROW(read_mesh_file(path, {}, report, progress), CancelledError);
}

}  // namespace
}  // namespace atomesh::cli
