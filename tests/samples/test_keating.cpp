// The force field against closed forms, and the relaxed quantum dots.
#include <gtest/gtest.h>

#include "core/parallel.h"
#include "samples/keating.h"
#include "samples/random.h"
#include "samples/samples.h"
#include "tests/samples/sample_checks.h"

namespace atomesh {
namespace {

struct Block {
  BlockShape shape;
  std::vector<Vec3> positions;
  KeatingNetwork network;
};

Block gaas_block(std::size_t cells, std::uint8_t kind) {
  Block block;
  block.shape.cells = {cells, cells, cells};
  block.positions = build_block(zinc_blende_cell("Ga", "As", gaas_edge), block.shape).positions;
  block.network =
      zinc_blende_network(block.shape, std::vector<std::uint8_t>(block.positions.size(), kind), {gaas_bond, inas_bond});
  return block;
}

std::vector<Vec3> jittered(std::vector<Vec3> positions, double amplitude) {
  Random random(7);
  for (Vec3& p : positions) {
    for (int axis = 0; axis < 3; ++axis) p[axis] += amplitude * (2.0 * random.uniform() - 1.0);
  }
  return positions;
}

std::size_t bonds_of(const KeatingNetwork& network, std::size_t atom) {
  return static_cast<std::size_t>(
      4 - std::count(network.neighbours[atom].begin(), network.neighbours[atom].end(), no_index));
}

TEST(Keating, BondsEveryNeighbourOnce) {
  const Block block = gaas_block(3, 0);
  std::size_t bonds = 0;
  for (std::size_t i = 0; i < block.positions.size(); ++i) {
    for (std::size_t s = 0; s < bonds_of(block.network, i); ++s) {
      const Index j = block.network.neighbours[i][s];
      ASSERT_EQ(block.network.neighbours[j][block.network.reverse[i][s]], i);
      EXPECT_NEAR(glm::distance(block.positions[i], block.positions[j]), gaas_bond.length, 1e-12);
      ++bonds;
    }
  }
  std::size_t pairs = 0;
  const test::NearGrid grid(block.positions, 2.5);
  for (const Vec3& p : block.positions) grid.near(p, [&](Index, double d) { pairs += d > 0.0 ? 1 : 0; });
  EXPECT_EQ(bonds, pairs);
}

TEST(Keating, StrainsAsTheBulkModulusSays) {
  Block block = gaas_block(4, 0);
  std::vector<Vec3> gradient;
  EXPECT_LT(keating_energy(block.network, block.positions, gradient), 1e-20);

  const double d = gaas_bond.length;
  const double strain = 0.01;
  for (Vec3& p : block.positions) p *= 1.0 + strain;
  double bonds = 0.0;
  double angles = 0.0;
  for (std::size_t i = 0; i < block.positions.size(); ++i) {
    const auto n = static_cast<double>(bonds_of(block.network, i));
    bonds += 0.5 * n;
    angles += 0.5 * n * (n - 1.0);
  }
  const double growth = 2.0 * strain + strain * strain;  // of every r²
  const double bond_energy = 0.375 * gaas_bond.alpha * d * d * growth * growth;
  const double angle_energy = 0.375 * gaas_bond.beta * d * d * growth * growth / 9.0;
  EXPECT_NEAR(keating_energy(block.network, block.positions, gradient), bonds * bond_energy + angles * angle_energy,
              1e-10 * bonds * bond_energy);
  // Two atoms of bulk have 4 bonds and 12 angles in 16 d³/(3√3); ½ B (3 strain)² is their energy density.
  const double modulus = (4.0 * bond_energy + 12.0 * angle_energy) / (16.0 * d * d * d / (3.0 * std::sqrt(3.0))) /
                         (0.5 * 9.0 * 0.25 * growth * growth);
  EXPECT_NEAR(modulus, std::sqrt(3.0) * (3.0 * gaas_bond.alpha + gaas_bond.beta) / (12.0 * d), 1e-12);
  EXPECT_NEAR(modulus * 160.2177, 75.5, 4.0);  // GPa, measured for GaAs
}

TEST(Keating, PullsDownhill) {
  const Block block = gaas_block(2, 1);
  std::vector<Vec3> positions = jittered(block.positions, 0.2);
  std::vector<Vec3> gradient;
  std::vector<Vec3> unused;
  keating_energy(block.network, positions, gradient);
  const double h = 1e-4;
  for (std::size_t i = 0; i < positions.size(); i += 5) {
    for (int axis = 0; axis < 3; ++axis) {
      const double at = positions[i][axis];
      positions[i][axis] = at + h;
      const double above = keating_energy(block.network, positions, unused);
      positions[i][axis] = at - h;
      const double below = keating_energy(block.network, positions, unused);
      positions[i][axis] = at;
      EXPECT_NEAR(gradient[i][axis], (above - below) / (2.0 * h), 1e-6);
    }
  }
}

TEST(Keating, RelaxesAShakenCrystalToItsSites) {
  const Block block = gaas_block(5, 0);
  std::vector<Vec3> positions = jittered(block.positions, 0.15);
  std::vector<bool> held(positions.size(), false);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (bonds_of(block.network, i) == 4) continue;
    held[i] = true;
    positions[i] = block.positions[i];
  }
  const RelaxReport report = relax(block.network, held, positions, {1e-10, 2000});
  EXPECT_TRUE(report.converged);
  EXPECT_LT(report.energy_after, 1e-15 * report.energy_before);
  for (std::size_t i = 0; i < positions.size(); ++i) ASSERT_LT(glm::distance(positions[i], block.positions[i]), 1e-8);
}

TEST(Keating, LetsFreeInAsGrowToItsOwnBonds) {
  Block block = gaas_block(4, 1);
  const RelaxReport report =
      relax(block.network, std::vector<bool>(block.positions.size(), false), block.positions, {1e-9, 2000});
  EXPECT_TRUE(report.converged);
  for (std::size_t i = 0; i < block.positions.size(); ++i) {
    for (std::size_t s = 0; s < bonds_of(block.network, i); ++s) {
      ASSERT_NEAR(glm::distance(block.positions[i], block.positions[block.network.neighbours[i][s]]), inas_bond.length,
                  1e-7);
    }
  }
}

struct MeanBonds {
  double gallium = 0.0, indium = 0.0;
};
MeanBonds mean_bonds(const Atoms& atoms) {
  const test::NearGrid grid(atoms.positions, 3.0);
  std::array<double, 2> sum{};
  std::array<double, 2> count{};
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    if (atoms.species_name(i) == "As") continue;
    const std::size_t kind = atoms.species_name(i) == "In" ? 1 : 0;
    grid.near(atoms.positions[i], [&](Index j, double d) {
      if (atoms.species_name(j) != "As") return;
      sum[kind] += d;
      count[kind] += 1.0;
    });
  }
  return {sum[0] / count[0], sum[1] / count[1]};
}

class QuantumDot : public testing::TestWithParam<const char*> {};

TEST_P(QuantumDot, IsRelaxed) {
  const Sample sample = make_sample(GetParam(), {20000, 1});
  // The same sites unrelaxed, from the species alone.
  const BlockShape shape = choose_block(20000 / 8.0, Vec3(gaas_edge), Vec3(1, 1, 0.4));
  ASSERT_EQ(shape.total() * 8, sample.atoms.size());
  const std::vector<Vec3> sites = build_block(*sample.unit_cell, shape).positions;
  std::vector<std::uint8_t> kinds;
  for (std::size_t i = 0; i < sites.size(); ++i) kinds.push_back(sample.atoms.species_name(i) == "In" ? 1 : 0);
  const KeatingNetwork network = zinc_blende_network(shape, kinds, {gaas_bond, inas_bond});
  std::vector<Vec3> gradient;
  const double before = keating_energy(network, sites, gradient);
  const double after = keating_energy(network, sample.atoms.positions, gradient);
  EXPECT_LT(after, 0.5 * before);
  EXPECT_GT(after, 0.0);
  double largest = 0.0;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    if (bonds_of(network, i) == 4) largest = std::max(largest, glm::length(gradient[i]));
  }
  EXPECT_LT(largest, 2e-3);

  const MeanBonds bonds = mean_bonds(sample.atoms);
  EXPECT_GT(bonds.indium, bonds.gallium + 0.05);
  EXPECT_LT(bonds.indium, inas_bond.length);  // the matrix squeezes the dot
  EXPECT_NEAR(bonds.gallium, gaas_bond.length, 0.02);
}

TEST_P(QuantumDot, NamesItsIndiumInAColumn) {
  const Sample sample = make_sample(GetParam(), {20000, 1});
  const Column* column = sample.atoms.find_column("indium");
  ASSERT_NE(column, nullptr);
  for (std::size_t i = 0; i < sample.atoms.size(); ++i) {
    ASSERT_EQ(column->values[i], sample.atoms.species_name(i) == "In" ? 1.0 : 0.0);
  }
}
INSTANTIATE_TEST_SUITE_P(Both, QuantumDot, testing::Values("quantum-dot", "quantum-dot-alloyed"),
                         [](const auto& tested) {
                           return std::string(tested.param) == "quantum-dot" ? "pure" : "alloyed";
                         });

TEST(QuantumDotAlloyed, ReplacesAFifthOfTheDotsIndium) {
  const auto indium = [](const char* name) {
    const Sample sample = make_sample(name, {20000, 1});
    double count = 0.0;
    for (const double value : sample.atoms.find_column("indium")->values) count += value;
    return count;
  };
  const double pure = indium("quantum-dot");
  EXPECT_GT(pure, 400.0);
  EXPECT_NEAR(indium("quantum-dot-alloyed"), 0.2 * pure, 4.0 * std::sqrt(0.16 * pure));
}

}  // namespace
}  // namespace atomesh
