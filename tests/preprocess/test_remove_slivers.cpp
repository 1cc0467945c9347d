#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "core/surface.h"
#include "preprocess/pull_polytope.h"
#include "preprocess/remove_slivers.h"
#include "tests/support/lattices.h"
#include "tests/support/meshes.h"

namespace atomesh {
namespace {

std::vector<Index> identity(std::size_t count) {
  std::vector<Index> numbers(count);
  std::iota(numbers.begin(), numbers.end(), Index{0});
  return numbers;
}

std::vector<Vec3> cube_corners(double x) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.emplace_back(x + (i & 1), (i >> 1) & 1, (i >> 2) & 1);
  return corners;
}

const std::vector<Vec3> octahedron{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

TEST(PullPolytope, FillsPolytopesOfKnownVolume) {
  struct Case {
    const char* name;
    std::vector<Vec3> corners;
    std::size_t tetrahedra;
    double volume;
    double area;
  };
  const double r = std::sqrt(0.5);
  std::vector<Vec3> cuboctahedron;
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-1.0, 1.0}) {
      for (const Vec3& p : {Vec3(a, b, 0), Vec3(a, 0, b), Vec3(0, a, b)}) cuboctahedron.push_back(r * p);
    }
  }
  const std::vector<Case> cases{
      {"tetrahedron", test::regular_tetrahedron().vertices, 1, 8.0 / 3.0, 8.0 * std::sqrt(3.0)},
      {"cube", cube_corners(0), 6, 1.0, 6.0},
      {"octahedron", octahedron, 4, 4.0 / 3.0, 4.0 * std::sqrt(3.0)},
      // 8 triangles and 6 squares of edge 1, less the 2 and 2 about the apex, a square being two triangles.
      {"cuboctahedron", cuboctahedron, 14, 5.0 / 3.0 * std::sqrt(2.0), 6.0 + 2.0 * std::sqrt(3.0)},
  };
  for (const Case& c : cases) {
    for (const bool turn : {false, true}) {
      std::vector<Vec3> corners = c.corners;
      if (turn) {
        for (Vec3& p : corners) p = test::odd_rotation() * p;
      }
      const std::vector<Index> all = identity(corners.size());
      std::vector<Tetrahedron> tetrahedra;
      ASSERT_TRUE(pull_polytope(all, corners, all, 1e-7, tetrahedra)) << c.name;
      EXPECT_EQ(tetrahedra.size(), c.tetrahedra) << c.name;
      const TetMesh mesh = test::mesh_of(corners, tetrahedra);
      EXPECT_EQ(validate(mesh), std::vector<std::string>{}) << c.name;
      EXPECT_NEAR(volume(mesh), c.volume, 1e-12) << c.name;
      EXPECT_NEAR(area(extract_surface(mesh), corners), c.area, 1e-12) << c.name;
      EXPECT_GT(min_dihedral_degrees(mesh), 10.0) << c.name;
    }
  }
}

TEST(PullPolytope, NeighboursCutTheirCommonFaceAlike) {
  std::vector<Vec3> points = cube_corners(0);
  for (const Vec3& p : cube_corners(1)) {
    if (p.x == 2.0) points.push_back(p);
  }
  // Corners 1, 3, 5, 7 are common; whatever the ranks, no slit may open between the cubes.
  const std::vector<Index> left{0, 1, 2, 3, 4, 5, 6, 7};
  const std::vector<Index> right{1, 3, 5, 7, 8, 9, 10, 11};
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    std::vector<Index> rank = identity(points.size());
    std::mt19937_64 generator(seed);
    std::shuffle(rank.begin(), rank.end(), generator);
    std::vector<Tetrahedron> tetrahedra;
    ASSERT_TRUE(pull_polytope(left, points, rank, 1e-7, tetrahedra));
    ASSERT_TRUE(pull_polytope(right, points, rank, 1e-7, tetrahedra));
    const TetMesh mesh = test::mesh_of(points, tetrahedra);
    EXPECT_EQ(validate(mesh), std::vector<std::string>{});
    EXPECT_NEAR(area(extract_surface(mesh), points), 10.0, 1e-12);
  }
}

TEST(PullPolytope, RefusesWhatHasNoVolume) {
  const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  std::vector<Tetrahedron> tetrahedra;
  EXPECT_FALSE(pull_polytope(identity(4), square, identity(4), 1e-7, tetrahedra));
  EXPECT_FALSE(pull_polytope(identity(3), square, identity(4), 1e-7, tetrahedra));
}

// The octahedron cut along one diagonal of its square above and the other below, the square's own sliver between.
TetMesh frayed_octahedron(double lift) {
  std::vector<Vec3> points = octahedron;
  points[0].z = points[1].z = lift;
  return test::mesh_of(points, {{0, 2, 1, 4}, {0, 1, 3, 4}, {3, 2, 0, 5}, {2, 3, 1, 5}, {0, 1, 2, 3}});
}

TEST(RemoveSlivers, FraysAreCutAnew) {
  TetMesh mesh = frayed_octahedron(1e-13);
  ASSERT_EQ(validate(mesh), std::vector<std::string>{});
  ASSERT_LT(min_dihedral_degrees(mesh), 1e-9);
  EXPECT_EQ(remove_slivers(mesh.tetrahedra, mesh.vertices), 1U);
  mesh.delaunay = true;
  EXPECT_EQ(validate(mesh), std::vector<std::string>{});
  EXPECT_EQ(mesh.tetrahedra.size(), 4U);
  EXPECT_GT(min_dihedral_degrees(mesh), 50.0);
  EXPECT_NEAR(volume(mesh), 4.0 / 3.0, 1e-12);
}

TEST(RemoveSlivers, ThinCellsThatAreThereStay) {
  TetMesh mesh = frayed_octahedron(1e-5);
  const auto before = mesh.tetrahedra;
  EXPECT_EQ(remove_slivers(mesh.tetrahedra, mesh.vertices), 0U);
  EXPECT_EQ(mesh.tetrahedra, before);
}

TEST(RemoveSlivers, WhatCannotBeCutAnewStays) {
  // One flat cell alone, and one between two cells of different spheres: nothing to gather.
  for (TetMesh mesh : {test::mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1e-13}}, {{0, 1, 2, 3}}),
                       test::mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 1e-13}, {0, 0, -1}, {0, 0, 1}},
                                     {{0, 1, 2, 3}, {0, 2, 1, 4}})}) {
    const auto before = mesh.tetrahedra;
    ASSERT_EQ(validate(mesh), std::vector<std::string>{});
    remove_slivers(mesh.tetrahedra, mesh.vertices);
    EXPECT_EQ(validate(mesh), std::vector<std::string>{});
    EXPECT_NEAR(volume(mesh), volume(test::mesh_of(mesh.vertices, before)), 1e-12);
  }
}

}  // namespace
}  // namespace atomesh
