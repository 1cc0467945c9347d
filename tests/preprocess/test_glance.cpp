// What is recognised at a glance is what a full comparison finds, on every processor.
#include "preprocess/examine_atoms.h"
#include "preprocess/within_64.h"
#include "tests/preprocess/defect_checks.h"

namespace atomesh::test {
namespace {

struct Examined {
  Defects defects;
  std::vector<std::uint16_t> standing;
  RangeResult found;
};

Examined examine(const SampleView& sample, const GlanceTables& tables) {
  Examined result;
  const std::size_t count = sample.atoms.size();
  result.defects.positional.assign(count, 0.0F);
  result.defects.vacancy = result.defects.extra = result.defects.positional;
  result.standing.assign(count, no_grain);
  Examiner examiner(sample, tables, true);
  for (const Index slot : sample.grid.home_slots()) {
    examiner.examine(slot, result.defects, result.standing[sample.grid.point(slot)], result.found);
  }
  return result;
}

TEST(Glance, SaysWhatAFullComparisonSays) {
  for (const Lattice& crystal : lattices()) {
    for (const double noise : {0.0, 0.01, 0.04}) {
      for (const double told : {0.0, 0.5, 1.0}) {
        Atoms atoms = periodic_crystal(crystal, 16.0);
        atoms.box.periodic[2] = false;
        remove_nearest(atoms, Vec3(6.0));
        atoms.positions.push_back(Vec3(9.3, 8.1, 10.2));
        atoms.species.push_back(0);
        shake(atoms, 1.7 * noise * crystal.nearest_neighbour, 5);
        const FeatureSet features = build_feature_vectors(std::span(&crystal.cell, 1), atoms.species_table, 1.0, 0.0,
                                                          {told * noise * crystal.nearest_neighbour, 9.0});
        const NeighbourGrid grid(atoms.positions, atoms.box, features.search_radius + features.pair_distance,
                                 features.glance_radius);
        const SampleView sample{atoms, features, grid, {}};
        const Examined full = examine(sample, no_glance());
        const Examined glanced = examine(sample, GlanceTables(features));
        EXPECT_EQ(full.defects.positional, glanced.defects.positional) << crystal.name << " " << noise;
        EXPECT_EQ(full.defects.vacancy, glanced.defects.vacancy) << crystal.name << " " << noise;
        EXPECT_EQ(full.defects.extra, glanced.defects.extra) << crystal.name << " " << noise;
        EXPECT_EQ(full.standing, glanced.standing) << crystal.name << " " << noise;
        EXPECT_EQ(full.found.misfits.missing, glanced.found.misfits.missing) << crystal.name << " " << noise;
        EXPECT_EQ(full.found.misfits.strays, glanced.found.misfits.strays) << crystal.name << " " << noise;
        EXPECT_EQ(full.found.census.matched, glanced.found.census.matched) << crystal.name << " " << noise;
      }
    }
  }
}

TEST(Glance, BlocksHoldWhatASearchFinds) {
  const Atoms atoms = random_atoms(4000, 30.0, 7);
  Box box;
  box.vectors = {Vec3(30, 0, 0), Vec3(4, 28, 0), Vec3(0, -3, 31)};
  for (const bool periodic : {false, true}) {
    box.periodic = {periodic, periodic, false};
    for (const double cell : {1.5, 4.0, 5.0}) {
      const NeighbourGrid grid(atoms.positions, box, 4.0, cell);
      GridBlock block;
      std::vector<Index> found;
      std::vector<Index> expected;
      for (const Index slot : grid.home_slots()) {
        grid.gather(slot, 4.0, block);
        const std::size_t count = grid.find_in(block, slot, 4.0, found);
        grid.find(grid.position(slot), 4.0, expected, slot);
        ASSERT_EQ(std::vector<Index>(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count)), expected);
      }
    }
  }
}

TEST(Glance, KernelsAgreeBitForBit) {
  std::mt19937 random(2);
  std::normal_distribution<float> normal(0.0F, 2.0F);
  std::array<std::vector<float>, 3> places;
  for (auto& values : places) values.resize(64);
  for (int trial = 0; trial < 2000; ++trial) {
    for (auto& values : places) {
      for (float& v : values) v = normal(random);
    }
    const std::array<float, 3> centre{normal(random), normal(random), normal(random)};
    // Just the distance of one of them: the last bit decides.
    const auto n = static_cast<std::size_t>(trial % 64);
    const float dx = places[0][n] - centre[0];
    const float dy = places[1][n] - centre[1];
    const float dz = places[2][n] - centre[2];
    const float limit = dx * dx + dy * dy + dz * dz;
    std::uint64_t expected = 0;
    for (std::size_t k = 0; k < 64; ++k) {
      const float x = places[0][k] - centre[0];
      const float y = places[1][k] - centre[1];
      const float z = places[2][k] - centre[2];
      expected |= std::uint64_t{x * x + y * y + z * z <= limit} << k;
    }
    for (int kernel = 0; kernel < within_64_kernels; ++kernel) {
      const Within64 within = within_64_kernel(kernel);
      if (within == nullptr) continue;
      ASSERT_EQ(within(places[0].data(), places[1].data(), places[2].data(), centre.data(), limit), expected) << kernel;
    }
  }
}

}  // namespace
}  // namespace atomesh::test
