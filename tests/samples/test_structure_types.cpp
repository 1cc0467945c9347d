// The common structures against what is known of them: density, coordination, bond length, largest void.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "core/error.h"
#include "samples/structure_types.h"

namespace atomesh {
namespace {

// Atoms of the endless crystal around p, by distance.
std::map<double, int> shells(const UnitCell& cell, const Vec3& p, double reach) {
  std::map<double, int> counts;
  for (int i = -4; i <= 4; ++i) {
    for (int j = -4; j <= 4; ++j) {
      for (int k = -4; k <= 4; ++k) {
        for (const BasisAtom& atom : cell.basis) {
          const double d = glm::distance(p, atom.position + cell.matrix() * Vec3(i, j, k));
          if (d < 1e-9 || d > reach) continue;
          const auto same = counts.lower_bound(d - 1e-4);
          if (same != counts.end() && same->first < d + 1e-4) {
            ++same->second;
          } else {
            counts[d] = 1;
          }
        }
      }
    }
  }
  return counts;
}

struct Known {
  double density;    // g/cm³, X-ray densities of the literature
  double bond;       // Å
  int coordination;  // of basis[0] within 5 % of its nearest neighbour
  std::size_t basis;
};

const std::map<std::string, Known, std::less<>>& known() {
  static const std::map<std::string, Known, std::less<>> all{
      {"fcc", {8.93, 2.556, 12, 4}},       {"bcc", {7.87, 2.482, 8, 2}},          {"hcp", {1.738, 3.197, 12, 2}},
      {"diamond", {3.515, 1.5445, 4, 8}},  {"zinc-blende", {5.317, 2.448, 4, 8}}, {"rock-salt", {2.163, 2.820, 6, 8}},
      {"cscl", {3.99, 3.571, 8, 2}},       {"perovskite", {5.12, 1.9525, 12, 5}}, {"graphite", {2.26, 1.4226, 3, 4}},
      {"fluorite", {3.18, 2.3655, 8, 12}}, {"wurtzite", {6.08, 1.949, 4, 4}},     {"rutile", {4.25, 1.949, 6, 6}},
  };
  return all;
}

double mass(std::string_view species) {
  static const std::map<std::string, double, std::less<>> masses{
      {"Cu", 63.546}, {"Fe", 55.845}, {"Mg", 24.305}, {"C", 12.011},   {"Ga", 69.723},
      {"As", 74.922}, {"Na", 22.990}, {"Cl", 35.45},  {"Cs", 132.905}, {"Sr", 87.62},
      {"Ti", 47.867}, {"O", 15.999},  {"Ca", 40.078}, {"F", 18.998},   {"N", 14.007}};
  return masses.find(species)->second;
}

TEST(StructureTypes, AreTheTwelve) {
  ASSERT_EQ(structure_types().size(), known().size());
  for (const StructureType& type : structure_types()) EXPECT_TRUE(known().contains(type.name)) << type.name;
}

TEST(StructureTypes, HaveTheDensityOfTheirMaterial) {
  for (const StructureType& type : structure_types()) {
    double sum = 0.0;
    for (const BasisAtom& atom : type.cell.basis) sum += mass(atom.species);
    const double density = sum * 1.66053907 / type.cell.volume();
    const double expected = known().find(type.name)->second.density;
    EXPECT_NEAR(density, expected, 0.006 * expected) << type.name;
  }
}

TEST(StructureTypes, HaveTheirNeighbours) {
  for (const StructureType& type : structure_types()) {
    const Known& expected = known().find(type.name)->second;
    EXPECT_EQ(type.cell.basis.size(), expected.basis) << type.name;
    EXPECT_NEAR(type.nearest_neighbour, expected.bond, 0.0006) << type.name;
    const auto near = shells(type.cell, type.cell.basis[0].position, 6.0);
    int count = 0;
    for (const auto& [d, n] : near) count += d < 1.05 * near.begin()->first ? n : 0;
    EXPECT_EQ(count, expected.coordination) << type.name;
  }
}

TEST(StructureTypes, AreConventionalCells) {
  for (const StructureType& type : structure_types()) {
    EXPECT_NO_THROW(check_unit_cell(type.cell)) << type.name;
    EXPECT_GT(glm::determinant(type.cell.matrix()), 0.0) << type.name;
    EXPECT_EQ(type.cell.primitive[0].y, 0.0);
    EXPECT_EQ(type.cell.basis.size() % type.primitive_atoms, 0U) << type.name;
    const Mat3 inverse = glm::inverse(type.cell.matrix());
    std::set<std::string> species;
    for (const BasisAtom& atom : type.cell.basis) {
      const Vec3 f = inverse * atom.position;
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GT(f[axis], -1e-9) << type.name;
        EXPECT_LT(f[axis], 1.0 - 1e-9) << type.name;
      }
      species.insert(atom.species);
    }
    EXPECT_FALSE(species.contains(std::string(type.impurity))) << type.name;
  }
}

TEST(StructureTypes, UnknownNamesAreRefusedWithTheNearest) {
  EXPECT_EQ(find_structure_type("wurtzite").space_group, 186);
  try {
    find_structure_type("wurzite");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"wurtzite\""), std::string::npos) << error.what();
  }
}

// Octahedral in fcc, tetrahedral in bcc, the empty eighth-cubes of diamond and rock salt.
TEST(LargestVoids, OfCubicCrystalsAreTheTextbooks) {
  const auto of = [](const char* name) { return largest_voids(find_structure_type(name).cell); };
  const LargestVoids fcc = of("fcc");
  EXPECT_EQ(fcc.positions.size(), 4U);
  EXPECT_NEAR(fcc.radius, 0.5 * 3.6149, 1e-9);
  const LargestVoids bcc = of("bcc");
  EXPECT_EQ(bcc.positions.size(), 12U);
  EXPECT_NEAR(bcc.radius, std::sqrt(5.0) / 4.0 * 2.8665, 1e-9);
  const LargestVoids diamond = of("diamond");
  EXPECT_EQ(diamond.positions.size(), 8U);
  EXPECT_NEAR(diamond.radius, std::sqrt(3.0) / 4.0 * 3.56684, 1e-9);
  const LargestVoids salt = of("rock-salt");
  EXPECT_EQ(salt.positions.size(), 8U);
  EXPECT_NEAR(salt.radius, std::sqrt(3.0) / 4.0 * 5.6402, 1e-9);
}

// No point of a fine grid is further from every atom than the voids are, and the voids are as far as they say.
TEST(LargestVoids, LeaveNoLargerOnes) {
  for (const StructureType& type : structure_types()) {
    const LargestVoids voids = largest_voids(type.cell);
    ASSERT_FALSE(voids.positions.empty()) << type.name;
    for (const Vec3& p : voids.positions) {
      EXPECT_NEAR(shells(type.cell, p, 6.0).begin()->first, voids.radius, 1e-6) << type.name;
    }
    constexpr int steps = 9;
    for (int i = 0; i < steps * steps * steps; ++i) {
      const Vec3 f(i % steps, i / steps % steps, i / steps / steps);
      const auto near = shells(type.cell, type.cell.matrix() * ((f + 0.31) / static_cast<double>(steps)), 4.0);
      ASSERT_FALSE(near.empty()) << type.name;
      EXPECT_LT(near.begin()->first, voids.radius + 1e-9) << type.name;
    }
  }
}

}  // namespace
}  // namespace atomesh
