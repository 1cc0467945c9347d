#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/tet_mesh.h"
#include "tests/support/meshes.h"

namespace atomesh {
namespace {

using test::mesh_of;

// True when one of the complaints contains `words`.
bool complains(const TetMesh& mesh, const std::string& words) {
  for (const std::string& complaint : validate(mesh)) {
    if (complaint.find(words) != std::string::npos) return true;
  }
  return false;
}

bool never(int, int, int) {
  return false;
}

TEST(TetMesh, VolumesAndAnglesAreThoseOfTheTextbook) {
  EXPECT_DOUBLE_EQ(volume(test::corner_tetrahedron()), 1.0 / 6.0);
  EXPECT_NEAR(min_dihedral_degrees(test::corner_tetrahedron()), 54.735610317245346, 1e-12);
  EXPECT_DOUBLE_EQ(volume(test::regular_tetrahedron()), 8.0 / 3.0);
  EXPECT_NEAR(min_dihedral_degrees(test::regular_tetrahedron()), 70.528779365509308, 1e-12);
  EXPECT_DOUBLE_EQ(volume(test::cube_of_six(3.0)), 27.0);
  EXPECT_NEAR(min_dihedral_degrees(test::cube_of_six()), 45.0, 1e-12);
  EXPECT_EQ(volume(TetMesh{}), 0.0);
  EXPECT_EQ(min_dihedral_degrees(TetMesh{}), 0.0);
}

TEST(TetMesh, VolumeOfManyCellsKeepsItsDigits) {
  const TetMesh mesh = test::cubes(20, never);
  EXPECT_NEAR(volume(mesh) / 8000.0, 1.0, 1e-15);
}

TEST(TetMesh, SoundMeshesHaveNothingToComplainAbout) {
  for (const TetMesh& mesh : {TetMesh{}, test::corner_tetrahedron(), test::regular_tetrahedron(), test::cube_of_six(),
                              test::two_at_an_edge(), test::cubes(3, never)}) {
    EXPECT_EQ(validate(mesh), std::vector<std::string>{});
  }
  // Kuhn's cubes happen to be Delaunay: all corners of a cube lie on one sphere.
  TetMesh cubes = test::cubes(3, never);
  cubes.delaunay = true;
  EXPECT_EQ(validate(cubes), std::vector<std::string>{});
}

TEST(TetMesh, NeighboursLieAcrossTheFaceAndLookBack) {
  const TetMesh mesh = test::cubes(3, never);
  const auto neighbours = face_neighbours(mesh);
  std::size_t outside = 0;
  for (std::size_t t = 0; t < neighbours.size(); ++t) {
    for (int f = 0; f < 4; ++f) {
      const Index other = neighbours[t][f];
      if (other == no_index) {
        ++outside;
        continue;
      }
      EXPECT_NE(std::find(neighbours[other].begin(), neighbours[other].end(), static_cast<Index>(t)),
                neighbours[other].end());
      for (const int corner : face_corners[f]) {
        const Tetrahedron& tet = mesh.tetrahedra[other];
        EXPECT_NE(std::find(tet.begin(), tet.end(), mesh.tetrahedra[t][corner]), tet.end());
      }
    }
  }
  EXPECT_EQ(outside, 6U * 9U * 2U);
}

TEST(TetMesh, NeighboursDoNotDependOnThreads) {
  const TetMesh mesh = test::cubes(18, never);
  set_threads(1);
  const auto one = face_neighbours(mesh);
  set_threads(2);
  const auto two = face_neighbours(mesh);
  set_threads(0);
  EXPECT_EQ(one, two);
}

TEST(TetMesh, AFaceOfThreeTetrahedraIsAnError) {
  const TetMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, -1}},
                               {{0, 1, 2, 3}, {0, 1, 2, 4}, {1, 0, 2, 5}});
  EXPECT_THROW(face_neighbours(mesh), Error);
  EXPECT_TRUE(complains(mesh, "belongs to 3"));
}

TEST(ValidateMesh, FindsEachFault) {
  const std::vector<Vec3> corner = test::corner_tetrahedron().vertices;
  EXPECT_TRUE(complains(mesh_of(corner, {{0, 2, 1, 3}}), "tetrahedron 0 is inverted"));
  EXPECT_TRUE(complains(mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2, 3}}), "is flat"));
  EXPECT_TRUE(complains(mesh_of(corner, {{0, 1, 1, 3}}), "names a vertex twice"));
  EXPECT_TRUE(complains(mesh_of(corner, {{0, 1, 2, 4}}), "names vertex 4 of 4"));
  EXPECT_TRUE(complains(mesh_of(corner, {{0, 1, 2, 3}, {0, 1, 2, 3}}), "same side"));

  // Two apexes above one triangle.
  auto vertices = corner;
  vertices.emplace_back(0.2, 0.2, 2.0);
  EXPECT_TRUE(complains(mesh_of(vertices, {{0, 1, 2, 3}, {0, 1, 2, 4}}), "same side"));

  TetMesh mesh = test::corner_tetrahedron();
  mesh.vertices[2].y = std::nan("");
  EXPECT_TRUE(complains(mesh, "vertex 2 has a coordinate that is not finite"));
  mesh = test::corner_tetrahedron();
  mesh.vertex_atom.pop_back();
  EXPECT_TRUE(complains(mesh, "3 entries in vertex_atom"));
  mesh = test::corner_tetrahedron();
  mesh.vertex_atom = {0, 1, 1, no_index};
  EXPECT_TRUE(complains(mesh, "atom 1 has more than one vertex"));
}

TEST(ValidateMesh, AsksForDelaunayOnlyWhereItIsPromised) {
  // Two tetrahedra on a triangle whose apexes both lie close to it: three around the axis would be Delaunay.
  TetMesh mesh =
      mesh_of({{1, 0, 0}, {-0.5, 0.8, 0}, {-0.5, -0.8, 0}, {0, 0, 0.1}, {0, 0, -0.1}}, {{0, 1, 2, 3}, {0, 2, 1, 4}});
  EXPECT_EQ(validate(mesh), std::vector<std::string>{});
  mesh.delaunay = true;
  EXPECT_TRUE(complains(mesh, "not Delaunay"));
}

TEST(ValidateMesh, StopsAtTheLimit) {
  const TetMesh mesh = mesh_of(test::corner_tetrahedron().vertices, std::vector<Tetrahedron>(50, {0, 2, 1, 3}));
  EXPECT_EQ(validate(mesh, 7).size(), 7U);
}

}  // namespace
}  // namespace atomesh
