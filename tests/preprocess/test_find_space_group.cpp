// Space groups of known cells.
#include <gtest/gtest.h>

#include "core/error.h"
#include "preprocess/find_unit_cell.h"
#include "samples/planted_crystal.h"
#include "samples/structure_types.h"
#include "tests/support/lattices.h"

namespace atomesh {
namespace {

// A cell as noise leaves it: symmetrized it is the perfect one again, turned as it was.
TEST(FindSpaceGroup, SymmetrizedCellsAreExact) {
  for (const std::string name : {"rock-salt", "diamond", "perovskite", "rutile", "wurtzite", "graphite"}) {
    SCOPED_TRACE(name);
    const UnitCell perfect = find_structure_type(name).cell;
    const Mat3 turn = random_rotation(3);
    UnitCell noisy = perfect;
    double sign = 1.0;
    for (Vec3& v : noisy.primitive) v = turn * (v + 4e-4 * (sign = -sign) * Vec3(1.0, -0.4, 0.7));
    for (BasisAtom& atom : noisy.basis)
      atom.position = turn * (atom.position + 5e-4 * (sign = -sign) * Vec3(0.3, 1.0, -0.6));
    const std::optional<UnitCell> exact = symmetrized(noisy, 5e-3);
    ASSERT_TRUE(exact.has_value());
    const std::optional<SpaceGroup> group = find_space_group(*exact, 1e-8);
    ASSERT_TRUE(group.has_value());
    EXPECT_EQ(group->number, find_structure_type(name).space_group);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LT(glm::distance(exact->primitive[k], turn * perfect.primitive[k]), 3e-3);
    }
  }
}

TEST(FindSpaceGroup, StructureTypes) {
  for (const StructureType& type : structure_types()) {
    const auto group = find_space_group(type.cell);
    ASSERT_TRUE(group) << type.name;
    EXPECT_EQ(group->number, type.space_group) << type.name;
    EXPECT_EQ(group->conventional.basis.size(), type.cell.basis.size()) << type.name;
    EXPECT_NEAR(group->conventional.volume(), type.cell.volume(), 1e-6 * type.cell.volume()) << type.name;
  }
}

TEST(FindSpaceGroup, SymbolsAndLengths) {
  const auto salt = find_space_group(find_structure_type("rock-salt").cell);
  ASSERT_TRUE(salt);
  EXPECT_EQ(salt->symbol, "Fm-3m");
  EXPECT_EQ(salt->point_group, "m-3m");
  EXPECT_NEAR(salt->a, find_structure_type("rock-salt").cell.primitive[0].x, 1e-9);
  EXPECT_NEAR(salt->alpha, 90.0, 1e-9);
  const auto graphite = find_space_group(find_structure_type("graphite").cell);
  ASSERT_TRUE(graphite);
  EXPECT_EQ(graphite->symbol, "P6_3/mmc");
  EXPECT_EQ(graphite->point_group, "6/mmm");
  EXPECT_NEAR(graphite->gamma, 120.0, 1e-6);
  EXPECT_NEAR(graphite->beta, 90.0, 1e-6);
}

// Turned and described by other vectors it is the same crystal.
TEST(FindSpaceGroup, OrientationAndVectorsDoNotMatter) {
  for (const StructureType& type : structure_types()) {
    UnitCell cell = type.cell;
    const Mat3 turn = random_rotation(9);
    for (Vec3& v : cell.primitive) v = turn * v;
    for (BasisAtom& atom : cell.basis) atom.position = turn * atom.position + Vec3(0.3, 0.1, -7.0);
    cell.primitive[2] += cell.primitive[0] - 2.0 * cell.primitive[1];
    const auto group = find_space_group(cell);
    const auto expected = find_space_group(type.cell);
    ASSERT_TRUE(group && expected) << type.name;
    EXPECT_EQ(group->number, type.space_group) << type.name;
    EXPECT_NEAR(group->a, expected->a, 1e-6) << type.name;
    EXPECT_NEAR(group->c, expected->c, 1e-6) << type.name;
  }
}

// The tolerance decides whether an atom moved by 4 % of the distance to its neighbours breaks the symmetry.
TEST(FindSpaceGroup, Tolerance) {
  UnitCell cell = test::lattice("perovskite").cell;
  cell.basis[1].position.z += 0.04 * 1.95;
  EXPECT_EQ(find_space_group(cell, 0.2)->number, 221);
  EXPECT_EQ(find_space_group(cell)->number, 99);
}

TEST(FindSpaceGroup, BadCellsAreErrors) {
  UnitCell cell = test::lattice("fcc").cell;
  cell.primitive[2] = cell.primitive[0] + cell.primitive[1];
  EXPECT_THROW(find_space_group(cell), Error);
  EXPECT_THROW(find_space_group(UnitCell{}), Error);
}

}  // namespace
}  // namespace atomesh
