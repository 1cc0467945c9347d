// What planted crystals promise: the defects asked for, where the truth says, in a crystal otherwise perfect.
#include <gtest/gtest.h>

#include <set>

#include "core/error.h"
#include "samples/planted_crystal.h"
#include "samples/structure_types.h"
#include "tests/samples/sample_checks.h"

namespace atomesh {
namespace {

using test::fingerprint;
using test::nearest_site;
using test::NearGrid;

PlantedCrystalOptions some_of_each(const std::string& structure) {
  PlantedCrystalOptions options;
  options.structure = structure;
  options.atoms = 12000;
  options.vacancies = 3;
  options.interstitials = 2;
  options.substitutions = 4;
  options.least_distance = 8.0;
  options.depth = 6.0;
  options.rotation = 7;
  return options;
}

class PlantedCrystal : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Structures, PlantedCrystal, testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const StructureType& type : structure_types()) names.emplace_back(type.name);
                           return names;
                         }()),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST_P(PlantedCrystal, HoldsWhatWasAskedFor) {
  const PlantedCrystalOptions options = some_of_each(GetParam());
  const Sample sample = make_planted_crystal(options);
  EXPECT_NEAR(static_cast<double>(sample.atoms.size()), 12000.0, 600.0);
  const SampleTruth& truth = sample.truth;
  ASSERT_EQ(truth.vacancies.size(), 7U);  // three empty, four taken by foreign atoms
  ASSERT_EQ(truth.extras.size(), 6U);
  ASSERT_EQ(truth.substitutions.size(), 4U);
  EXPECT_TRUE(truth.displaced.empty());
  const StructureType& type = find_structure_type(GetParam());
  const std::set<Index> extras(truth.extras.begin(), truth.extras.end());
  std::set<Index> foreign;
  for (const auto& substitution : truth.substitutions) {
    foreign.insert(substitution.atom);
    EXPECT_TRUE(extras.contains(substitution.atom));
    EXPECT_EQ(sample.atoms.species_name(substitution.atom), type.impurity);
    EXPECT_EQ(sample.atoms.positions[substitution.atom], truth.vacancies[substitution.site].position);
  }
  EXPECT_EQ(foreign.size(), 4U);
  // Everything else stands on its site, and no site of a vacancy is taken.
  for (std::size_t i = 0; i < sample.atoms.size(); ++i) {
    const auto site = nearest_site(*sample.unit_cell, sample.atoms.positions[i]);
    if (extras.contains(static_cast<Index>(i)) && !foreign.contains(static_cast<Index>(i))) {
      EXPECT_NEAR(site.distance, largest_voids(type.cell).radius, 1e-6);
      continue;
    }
    ASSERT_LT(site.distance, 1e-9);
    if (!foreign.contains(static_cast<Index>(i))) {
      ASSERT_EQ(site.species, sample.atoms.species_name(i));
    }
  }
  std::size_t taken = 0;
  for (const auto& vacancy : truth.vacancies) {
    const auto site = nearest_site(*sample.unit_cell, vacancy.position);
    EXPECT_LT(site.distance, 1e-9);
    EXPECT_EQ(site.species, vacancy.species);
    for (const Vec3& p : sample.atoms.positions) taken += glm::distance(p, vacancy.position) < 0.5 ? 1 : 0;
  }
  EXPECT_EQ(taken, 4U);
}

TEST_P(PlantedCrystal, KeepsDefectsApartAndInside) {
  const PlantedCrystalOptions options = some_of_each(GetParam());
  const Sample sample = make_planted_crystal(options);
  std::vector<Vec3> places;
  for (const auto& site : sample.truth.vacancies) places.push_back(site.position);
  places.push_back(sample.atoms.positions[sample.atoms.size() - 1]);
  places.push_back(sample.atoms.positions[sample.atoms.size() - 2]);
  const Mat3 back = glm::transpose(random_rotation(options.rotation));
  // In the crystal's own frame the block's first corner is the origin and its planes start there.
  const Mat3 rows = glm::inverse(find_structure_type(GetParam()).cell.matrix());
  for (std::size_t a = 0; a < places.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) EXPECT_GE(glm::distance(places[a], places[b]), 8.0 - 1e-9);
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 row(rows[0][axis], rows[1][axis], rows[2][axis]);
      EXPECT_GE(glm::dot(row, back * places[a]) / glm::length(row), 6.0 - 1e-6);
    }
  }
}

TEST(PlantedCrystals, ARotationIsOne) {
  EXPECT_EQ(random_rotation(0), Mat3(1.0));
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    const Mat3 r = random_rotation(seed);
    EXPECT_NEAR(glm::determinant(r), 1.0, 1e-14);
    const Mat3 square = r * glm::transpose(r);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(square[i][j], i == j ? 1.0 : 0.0, 1e-14);
    }
  }
}

TEST(PlantedCrystals, NoiseHasItsAmplitude) {
  PlantedCrystalOptions options;
  options.structure = "bcc";
  options.atoms = 50000;
  const Sample still = make_planted_crystal(options);
  options.noise = 0.03;
  const Sample shaken = make_planted_crystal(options);
  ASSERT_EQ(still.atoms.size(), shaken.atoms.size());
  const double sigma = 0.03 * find_structure_type("bcc").nearest_neighbour;
  Vec3 mean(0.0);
  Vec3 square(0.0);
  std::size_t beyond = 0;  // three sigma: 0.27 % along an axis
  for (std::size_t i = 0; i < still.atoms.size(); ++i) {
    const Vec3 step = (shaken.atoms.positions[i] - still.atoms.positions[i]) / sigma;
    mean += step;
    square += step * step;
    for (int axis = 0; axis < 3; ++axis) beyond += std::abs(step[axis]) > 3.0 ? 1 : 0;
  }
  const double n = static_cast<double>(still.atoms.size());
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(mean[axis] / n, 0.0, 5.0 / std::sqrt(n));
    EXPECT_NEAR(square[axis] / n, 1.0, 5.0 * std::sqrt(2.0 / n));
  }
  EXPECT_NEAR(static_cast<double>(beyond) / (3.0 * n), 0.0027, 0.0007);
  EXPECT_GT(shaken.truth.displaced.size(), still.atoms.size() * 9 / 10);
}

TEST(PlantedCrystals, ASphereIsRound) {
  PlantedCrystalOptions options;
  options.structure = "graphite";
  options.atoms = 20000;
  options.shape = PlantedShape::sphere;
  options.rotation = 3;
  const Sample sample = make_planted_crystal(options);
  const double n = static_cast<double>(sample.atoms.size());
  EXPECT_NEAR(n, 20000.0, 200.0);
  const Bounds bounds = bounds_of(sample.atoms.positions);
  const double radius = std::cbrt(n * sample.unit_cell->volume() / 4.0 * 3.0 / (4.0 * std::numbers::pi));
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(bounds.extent()[axis], 2.0 * radius, 0.04 * radius);
  for (const Vec3& p : sample.atoms.positions) ASSERT_LT(glm::distance(p, bounds.center()), 1.04 * radius);
}

TEST(PlantedCrystals, APeriodicBlockHasNoSurface) {
  PlantedCrystalOptions options;
  options.structure = "hcp";
  options.atoms = 4000;
  options.shape = PlantedShape::periodic_block;
  options.noise = 0.02;
  options.rotation = 5;
  options.vacancies = 10;
  const Sample sample = make_planted_crystal(options);
  ASSERT_TRUE(sample.atoms.box.present());
  EXPECT_TRUE(sample.atoms.box.periodic[0] && sample.atoms.box.periodic[1] && sample.atoms.box.periodic[2]);
  const Mat3 inverse = glm::inverse(sample.atoms.box.matrix());
  for (const Vec3& p : sample.atoms.positions) {
    const Vec3 f = inverse * p;
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_GE(f[axis], -1e-12);
      ASSERT_LT(f[axis], 1.0 + 1e-12);
    }
  }
  // As many atoms as the box has sites, less the vacancies.
  const double sites = sample.atoms.box.volume() / sample.unit_cell->volume() * 2.0;
  EXPECT_NEAR(static_cast<double>(sample.atoms.size()), sites - 10.0, 1e-6);
}

TEST(PlantedCrystals, PairsShareNeighbours) {
  PlantedCrystalOptions options = some_of_each("rock-salt");
  options.pairs = true;
  options.interstitials = 0;
  options.vacancies = 4;
  const Sample sample = make_planted_crystal(options);
  int partners = 0;
  for (const auto& a : sample.truth.vacancies) {
    for (const auto& b : sample.truth.vacancies) {
      const double d = glm::distance(a.position, b.position);
      if (d > 1e-9 && d < 2.83) ++partners;
    }
  }
  EXPECT_EQ(partners, 8);  // four pairs, each seen from both sides
}

TEST(PlantedCrystals, AreTheSameEveryTimeAndOtherByTheSeed) {
  PlantedCrystalOptions options = some_of_each("perovskite");
  options.noise = 0.01;
  const std::uint64_t once = fingerprint(make_planted_crystal(options).atoms);
  EXPECT_EQ(fingerprint(make_planted_crystal(options).atoms), once);
  options.seed = 2;
  EXPECT_NE(fingerprint(make_planted_crystal(options).atoms), once);
}

TEST(PlantedCrystals, RefuseWhatDoesNotFit) {
  PlantedCrystalOptions options;
  options.atoms = 1000;
  options.vacancies = 500;
  EXPECT_THROW(make_planted_crystal(options), UsageError);
  options.vacancies = 0;
  options.noise = -0.1;
  EXPECT_THROW(make_planted_crystal(options), UsageError);
  options.noise = 0.0;
  options.structure = "fccc";
  EXPECT_THROW(make_planted_crystal(options), UsageError);
}

}  // namespace
}  // namespace atomesh
