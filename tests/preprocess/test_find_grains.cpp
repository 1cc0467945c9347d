// Samples of several grains: how many, how they are turned, and which atom is whose.
#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>

#include "core/parallel.h"
#include "preprocess/match_orientation.h"
#include "preprocess/neighbour_grid.h"
#include "preprocess/read_atoms.h"
#include "samples/planted_crystal.h"
#include "samples/structure_types.h"
#include "tests/preprocess/cell_checks.h"
#include "tests/support/lattices.h"

namespace atomesh {
namespace {

namespace fs = std::filesystem;

double degrees(double radians) {
  return radians * 180.0 / std::numbers::pi;
}

struct Polycrystal {
  Atoms atoms;
  std::vector<std::size_t> grain;  // of each atom
  std::vector<double> depth;       // Å, from the nearest boundary
};

// Each grain fills the places nearest to its seed, within a cube centred on the origin; of two atoms of different
// grains nearer than 0.7 nearest-neighbour distances one goes.
Polycrystal polycrystal(const UnitCell& cell, double nearest, double half, const std::vector<Vec3>& seeds,
                        const std::vector<Mat3>& turns) {
  Polycrystal result;
  std::vector<Index> kept;
  Atoms all;
  std::vector<std::size_t> grain;
  std::vector<double> depth;
  for (std::size_t g = 0; g < seeds.size(); ++g) {
    const auto mine = [&](const Vec3& local) {
      const Vec3 p = turns[g] * local;
      if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > half) return false;
      for (const Vec3& other : seeds) {
        if (glm::length(p - other) < glm::length(p - seeds[g])) return false;
      }
      return true;
    };
    const Atoms part = test::cut_where(cell, Vec3(1.75 * half), mine);
    for (std::size_t i = 0; i < part.size(); ++i) {
      const Vec3 p = turns[g] * part.positions[i];
      double least = 1e9;
      for (std::size_t h = 0; h < seeds.size(); ++h) {
        if (h == g) continue;
        const Vec3 apart = seeds[h] - seeds[g];
        least = std::min(least, std::abs(glm::dot(p - 0.5 * (seeds[h] + seeds[g]), apart)) / glm::length(apart));
      }
      all.positions.push_back(p);
      all.species.push_back(all.add_species(part.species_name(i)));
      grain.push_back(g);
      depth.push_back(least);
    }
  }
  const NeighbourGrid grid(all.positions, Box{}, nearest, nearest);
  std::vector<Index> slots;
  for (Index i = 0; i < all.size(); ++i) {
    grid.find(all.positions[i], 0.7 * nearest, slots);
    bool crowded = false;
    for (const Index s : slots) crowded = crowded || (grain[grid.point(s)] < grain[i]);
    if (crowded) continue;
    kept.push_back(i);
    result.grain.push_back(grain[i]);
    result.depth.push_back(depth[i]);
  }
  result.atoms = all.subset(kept);
  return result;
}

Mat3 turn(const Vec3& axis, double angle) {
  const Vec3 u = glm::normalize(axis);
  const double a = angle * std::numbers::pi / 180.0;
  const Mat3 cross(Vec3(0, u.z, -u.y), Vec3(-u.z, 0, u.x), Vec3(u.y, -u.x, 0));
  return Mat3(1.0) + std::sin(a) * cross + (1.0 - std::cos(a)) * cross * cross;
}

// Of the atoms at least `away` from a boundary, the share that is in the found grain most of its true grain is in.
double rightly_assigned(const Polycrystal& p, const Crystal& crystal, double away) {
  std::vector<std::vector<std::size_t>> votes;
  std::size_t asked = 0;
  for (std::size_t i = 0; i < p.atoms.size(); ++i) {
    if (p.depth[i] < away) continue;
    ++asked;
    votes.resize(std::max(votes.size(), p.grain[i] + 1));
    votes[p.grain[i]].resize(crystal.grains.size());
    if (crystal.grain(i) != no_grain) ++votes[p.grain[i]][crystal.grain(i)];
  }
  std::size_t right = 0;
  for (const auto& vote : votes) right += vote.empty() ? 0 : *std::max_element(vote.begin(), vote.end());
  return static_cast<double>(right) / static_cast<double>(asked);
}

TEST(FindGrains, Bicrystals) {
  for (const char* name : {"fcc", "diamond", "rock-salt", "hcp"}) {
    const StructureType& type = find_structure_type(name);
    // About the axis of fourfold, for hcp sixfold symmetry.
    const double steep = std::string_view(name) == "hcp" ? 21.79 : 36.87;
    for (const double angle : {12.0, steep}) {
      if (angle == 12.0 && std::string_view(name) != "fcc") continue;
      const double half = 3.5 * type.cell.longest_primitive() + 4.0;
      Polycrystal p = polycrystal(type.cell, type.nearest_neighbour, half, {Vec3(-20, 0, 0), Vec3(20, 0, 0)},
                                  {turn(Vec3(1, 2, 3), 5.0), turn(Vec3(1, 2, 3), 5.0) * turn(Vec3(0, 0, 1), angle)});
      test::shake(p.atoms, 0.02 * type.nearest_neighbour, 1);
      FindCellReport report;
      const Crystal crystal = find_unit_cell(p.atoms, {}, report);
      ASSERT_TRUE(report.found) << name << ": " << report.why;
      ASSERT_EQ(crystal.grains.size(), 2U) << name << " " << angle;
      EXPECT_NEAR(degrees(angle_of(report.grains[1].rotation)), angle, 0.1) << name;
      EXPECT_GT(rightly_assigned(p, crystal, 1.5 * type.nearest_neighbour), 0.95) << name << " " << angle;
      EXPECT_GT(report.explained, 0.85) << name << " " << angle;
      // Each grain's cell is the same crystal.
      for (const UnitCell& cell : crystal.grains) {
        EXPECT_EQ(find_space_group(cell)->number, type.space_group) << name;
      }
      EXPECT_EQ(report.grains[0].atoms + report.grains[1].atoms,
                static_cast<std::size_t>(std::count_if(crystal.grain_of.begin(), crystal.grain_of.end(),
                                                       [](std::uint16_t g) { return g != no_grain; })));
    }
  }
}

// The twin on (111): the layers go A B C B A; a third of the sites is common to both.
TEST(FindGrains, Twin) {
  const StructureType& type = find_structure_type("fcc");
  const Mat3 mirror = turn(Vec3(1, 1, 1), 60.0);
  const Vec3 normal = glm::normalize(Vec3(1, 1, 1));
  Polycrystal p =
      polycrystal(type.cell, type.nearest_neighbour, 24.0, {-20.0 * normal, 20.0 * normal}, {Mat3(1.0), mirror});
  FindCellReport report;
  const Crystal crystal = find_unit_cell(p.atoms, {}, report);
  ASSERT_TRUE(report.found) << report.why;
  ASSERT_EQ(crystal.grains.size(), 2U);
  EXPECT_NEAR(degrees(angle_of(report.grains[1].rotation)), 60.0, 0.1);
  EXPECT_GT(rightly_assigned(p, crystal, 1.5 * type.nearest_neighbour), 0.95);
}

TEST(FindGrains, ManyGrains) {
  const StructureType& type = find_structure_type("bcc");
  std::vector<Vec3> seeds;
  std::vector<Mat3> turns;
  for (int n = 0; n < 8; ++n) {
    seeds.emplace_back((n & 1) != 0 ? 14 : -13, (n & 2) != 0 ? 12 : -14, (n & 4) != 0 ? 13 : -12);
    turns.push_back(random_rotation(static_cast<std::uint64_t>(n) + 1));
  }
  Polycrystal p = polycrystal(type.cell, type.nearest_neighbour, 28.0, seeds, turns);
  test::shake(p.atoms, 0.02, 1);
  FindCellReport report;
  const Crystal crystal = find_unit_cell(p.atoms, {}, report);
  ASSERT_TRUE(report.found) << report.why;
  EXPECT_EQ(crystal.grains.size(), 8U);
  EXPECT_GT(rightly_assigned(p, crystal, 1.5 * type.nearest_neighbour), 0.95);
  for (std::size_t g = 1; g < report.grains.size(); ++g) {
    EXPECT_GE(report.grains[g - 1].atoms, report.grains[g].atoms);
  }
}

TEST(FindGrains, DoesNotDependOnThreadsOrOrder) {
  const StructureType& type = find_structure_type("fcc");
  Polycrystal p = polycrystal(type.cell, type.nearest_neighbour, 22.0, {Vec3(-20, 0, 0), Vec3(20, 0, 0)},
                              {Mat3(1.0), turn(Vec3(1, 2, 0), 30.0)});
  test::shake(p.atoms, 0.05, 1);
  std::vector<Index> reversed(p.atoms.size());
  for (Index i = 0; i < reversed.size(); ++i) reversed[i] = static_cast<Index>(reversed.size()) - 1 - i;
  FindCellReport report;
  set_threads(1);
  const Crystal one = find_unit_cell(p.atoms, {}, report);
  set_threads(3);
  const Crystal three = find_unit_cell(p.atoms.subset(reversed), {}, report);
  set_threads(0);
  ASSERT_EQ(one.grains.size(), 2U);
  ASSERT_EQ(three.grains.size(), 2U);
  for (std::size_t g = 0; g < 2; ++g) EXPECT_EQ(one.grains[g].primitive, three.grains[g].primitive);
  for (std::size_t i = 0; i < reversed.size(); ++i) ASSERT_EQ(one.grain_of[reversed[i]], three.grain_of[i]) << i;
}

// A single crystal with an internal surface, a slid half, a bent half is one grain.
TEST(FindGrains, SlidAndStrainedHalvesAreOneGrain) {
  Atoms atoms = test::cut_block(test::lattice("diamond").cell, 8, 6, 6);
  for (Vec3& p : atoms.positions) {
    if (p.x > 21.0) p += Vec3(1.3, 0.7, 0.4);
    p.z *= 1.0 + 2e-4 * p.x;
  }
  FindCellReport report;
  const Crystal crystal = find_unit_cell(atoms, {}, report);
  ASSERT_TRUE(report.found) << report.why;
  EXPECT_EQ(crystal.grains.size(), 1U);
  EXPECT_TRUE(crystal.grain_of.empty());
  EXPECT_GT(report.explained, 0.98);
}

struct Symmetric {
  const char* name;
  std::size_t proper;  // rotations of the point group
};

TEST(MatchOrientation, SymmetriesOfCrystals) {
  for (const auto& [name, proper] : {Symmetric{"fcc", 24}, Symmetric{"diamond", 24}, Symmetric{"zinc-blende", 12},
                                     Symmetric{"hcp", 12}, Symmetric{"wurtzite", 6}, Symmetric{"rutile", 8}}) {
    const StructureType& type = find_structure_type(name);
    FindCellReport report;
    Atoms atoms = test::cut_block(type.cell, 7, 7, 7);
    test::transform(atoms, random_rotation(2));
    const UnitCell cell = find_unit_cell(atoms, {}, report).grains.at(0);
    FittedCell fitted;
    fitted.vectors = cell.matrix();
    for (const BasisAtom& atom : cell.basis) {
      fitted.sites.push_back(atom.position);
      fitted.species.push_back(static_cast<std::uint16_t>(atom.species[0]));
    }
    fitted.nearest = type.nearest_neighbour;
    const std::vector<Mat3> symmetries = symmetry_rotations(fitted, 0.01);
    EXPECT_EQ(symmetries.size(), proper) << name;
    // Turned by a symmetry is not turned.
    for (const Mat3& s : symmetries) EXPECT_LT(angle_of(smallest_rotation(s, symmetries)), 1e-6) << name;
  }
}

// Boundaries that others computed: the file's name says between what.
TEST(FindGrains, SharedBicrystals) {
  struct File {
    const char* name;
    double angle;
  };
  for (const auto& [name, angle] :
       {File{"grip__Cu_210_tilt_lammps_0.936_0.455_0.97_1.76_1_11_900_1000", 36.87},
        File{"grip__W_310_twist_lammps_2.297_0.200_0.59_0.60_1_1_1100_3000", 36.87},
        File{"grip__Si_310_twist_lammps_1.081_0.20_2.91_2.38_1_2_1400_100000", 36.87},
        File{"grip__W_552_tilt_Marinica_2013_lammps_2.731_0.571_0.71_0.80_2_7_1600_88000", 31.59}}) {
    const fs::path path = fs::path(ATOMESH_SHARED_DATA) / "atoms" / name;
    if (!fs::exists(path)) GTEST_SKIP() << path << " is not here";
    FindCellReport report;
    const Crystal crystal = find_unit_cell(read_atoms(path.string()).atoms, {}, report);
    ASSERT_TRUE(report.found) << name << ": " << report.why;
    ASSERT_EQ(crystal.grains.size(), 2U) << name;
    EXPECT_NEAR(degrees(angle_of(report.grains[1].rotation)), angle, 0.3) << name;
    EXPECT_GT(report.explained, 0.95) << name;
  }
}

}  // namespace
}  // namespace atomesh
