#include <gtest/gtest.h>

#include "core/surface.h"
#include "preprocess/remove_flat.h"
#include "tests/support/meshes.h"

namespace atomesh {
namespace {

// A square pyramid whose base is cut along 0-2, and a flat tetrahedron on the base, whose outer side is cut along 1-3.
const std::vector<Vec3> pyramid{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}, {0.5, 0.5, -1}};
const std::vector<Tetrahedron> upper{{0, 1, 2, 4}, {0, 2, 3, 4}};
const Tetrahedron flat{0, 1, 2, 3};
// The other half of an octahedron, its base cut along 1-3.
const std::vector<Tetrahedron> lower{{1, 0, 3, 5}, {2, 1, 3, 5}};

TEST(RemoveFlat, OnTheOutsideItGoes) {
  for (const Tetrahedron& way : {flat, Tetrahedron{1, 0, 2, 3}}) {
    std::vector<Tetrahedron> tetrahedra = upper;
    tetrahedra.push_back(way);
    EXPECT_EQ(count_flat(tetrahedra, pyramid), 1U);
    EXPECT_EQ(remove_flat_outside(tetrahedra, pyramid), 1U);
    EXPECT_EQ(tetrahedra, upper);
  }
}

TEST(RemoveFlat, InsideItStays) {
  std::vector<Tetrahedron> tetrahedra = upper;
  tetrahedra.push_back(flat);
  tetrahedra.insert(tetrahedra.end(), lower.begin(), lower.end());
  const std::vector<Tetrahedron> before = tetrahedra;
  EXPECT_EQ(remove_flat_outside(tetrahedra, pyramid), 0U);
  EXPECT_EQ(tetrahedra, before);
  EXPECT_EQ(count_flat(tetrahedra, pyramid), 1U);
}

TEST(RemoveFlat, LayersGoFromTheOutsideIn) {
  // Two flat ones on one another: the outer cuts the square along 0-2 again.
  std::vector<Tetrahedron> tetrahedra = upper;
  tetrahedra.push_back(flat);
  std::vector<Vec3> points = pyramid;
  points.emplace_back(2.0 / 3.0, 1.0 / 3.0, 0.0);  // inside triangle 0 1 2, on the outer side of nothing yet
  tetrahedra.push_back({0, 1, 3, 6});
  EXPECT_EQ(remove_flat_outside(tetrahedra, points), 2U);
  EXPECT_EQ(tetrahedra, upper);
}

TEST(RemoveFlat, SoundMeshesAreLeftAlone) {
  TetMesh cube = test::cube_of_six();
  const auto before = cube.tetrahedra;
  EXPECT_EQ(remove_flat_outside(cube.tetrahedra, cube.vertices), 0U);
  EXPECT_EQ(cube.tetrahedra, before);
}

}  // namespace
}  // namespace atomesh
