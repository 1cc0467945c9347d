// Unit cells of the common structures found in planted crystals, and of the ten samples.
#include <gtest/gtest.h>

#include <random>

#include "core/error.h"
#include "core/parallel.h"
#include "samples/planted_crystal.h"
#include "samples/structure_types.h"
#include "tests/preprocess/cell_checks.h"
#include "tests/support/lattices.h"

namespace atomesh {
namespace {

constexpr std::size_t count = 2000;

struct Case {
  std::string structure;
  int noise;  // % of the nearest-neighbour distance
  PlantedShape shape;
};

// 1 % of the atoms are missing, the same ones for any noise.
Atoms thinned(const Atoms& atoms) {
  std::mt19937 random(5);
  std::vector<Index> kept;
  for (Index i = 0; i < atoms.size(); ++i) {
    if (random() % 100 != 0) kept.push_back(i);
  }
  return atoms.subset(kept);
}

Sample planted(const Case& c) {
  PlantedCrystalOptions options;
  options.structure = c.structure;
  options.atoms = count;
  options.shape = c.shape;
  options.noise = 0.01 * c.noise;
  options.rotation = 11 + static_cast<std::uint64_t>(c.noise);
  options.seed = 3;
  return make_planted_crystal(options);
}

class Structures : public testing::TestWithParam<Case> {};

TEST_P(Structures, AreFound) {
  const StructureType& type = find_structure_type(GetParam().structure);
  const Sample sample = planted(GetParam());
  const Atoms atoms = thinned(sample.atoms);
  FindCellReport report;
  const Crystal crystal = find_unit_cell(atoms, {}, report);
  ASSERT_TRUE(report.found) << report.why;
  ASSERT_EQ(crystal.grains.size(), 1U);
  const UnitCell& cell = crystal.grains[0];
  EXPECT_EQ(cell.basis.size(), type.primitive_atoms);
  EXPECT_GT(glm::determinant(cell.matrix()), 0.0);
  EXPECT_GT(report.explained, 0.999);
  EXPECT_EQ(report.foreign, 0.0);
  EXPECT_NEAR(report.displacement, 0.01 * GetParam().noise * type.nearest_neighbour,
              0.05 * 0.01 * GetParam().noise * type.nearest_neighbour + 1e-6);
  EXPECT_EQ(test::difference_of_cells(cell, *sample.unit_cell, 1e-3, 0.02 * type.nearest_neighbour), "");

  const auto group = find_space_group(cell);
  const auto expected = find_space_group(type.cell);
  ASSERT_TRUE(group && expected);
  EXPECT_EQ(group->number, type.space_group);
  EXPECT_EQ(group->symbol, expected->symbol);
  const double tolerance = GetParam().noise == 0 ? 1e-7 : 1e-3;
  EXPECT_LT(test::relative(group->a, expected->a), tolerance);
  EXPECT_LT(test::relative(group->b, expected->b), tolerance);
  EXPECT_LT(test::relative(group->c, expected->c), tolerance);
}

// Every structure at every noise; the shapes take turns, so that every structure and every noise meets each.
std::vector<Case> all_cases() {
  std::vector<Case> cases;
  int turn = 0;
  for (const StructureType& type : structure_types()) {
    for (int noise = 0; noise <= 3; ++noise) {
      cases.push_back({std::string(type.name), noise, static_cast<PlantedShape>((turn + noise) % 3)});
    }
    ++turn;
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Noise, Structures, testing::ValuesIn(all_cases()), [](const auto& test) {
  std::string name = test.param.structure + "_" + std::to_string(test.param.noise) + "_percent";
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
});

TEST(FindUnitCell, DoesNotDependOnThreadsOrOrder) {
  const Sample sample = planted({"perovskite", 2, PlantedShape::sphere});
  FindCellReport first_report;
  set_threads(1);
  const UnitCell first = find_unit_cell(sample.atoms, {}, first_report).grains.at(0);
  set_threads(3);
  FindCellReport second_report;
  const UnitCell second = find_unit_cell(test::shuffled(sample.atoms, 4), {}, second_report).grains.at(0);
  set_threads(0);
  EXPECT_EQ(first.primitive, second.primitive);
  ASSERT_EQ(first.basis.size(), second.basis.size());
  for (std::size_t j = 0; j < first.basis.size(); ++j) {
    EXPECT_EQ(first.basis[j].species, second.basis[j].species);
    EXPECT_EQ(first.basis[j].position, second.basis[j].position);
  }
  EXPECT_EQ(first_report.explained, second_report.explained);
  EXPECT_NEAR(first_report.displacement, second_report.displacement, 1e-12);
}

// Vacancies, interstitials and substitutions at once.
TEST(FindUnitCell, StandsOtherDefects) {
  for (const char* structure : {"diamond", "rock-salt", "bcc"}) {
    PlantedCrystalOptions options;
    options.structure = structure;
    options.atoms = 6000;
    options.vacancies = 8;
    options.interstitials = 8;
    options.substitutions = 8;
    options.least_distance = 5.0;
    options.depth = 5.0;
    options.noise = 0.02;
    options.rotation = 5;
    const Sample sample = make_planted_crystal(options);
    FindCellReport report;
    const Crystal crystal = find_unit_cell(sample.atoms, {}, report);
    ASSERT_TRUE(report.found) << structure << ": " << report.why;
    EXPECT_EQ(test::difference_of_cells(crystal.grains[0], *sample.unit_cell, 1e-3, 0.05), "") << structure;
    EXPECT_NEAR(report.explained, 1.0 - 8.0 / static_cast<double>(sample.atoms.size()), 1e-3) << structure;
  }
}

// 40 % indium at random on gallium's sites; the basis has what most of a site's atoms are.
TEST(FindUnitCell, AlloysHaveTheirMajority) {
  Atoms atoms = planted({"zinc-blende", 1, PlantedShape::block}).atoms;
  const std::uint16_t gallium = atoms.add_species("Ga");
  const std::uint16_t indium = atoms.add_species("In");
  std::mt19937 random(3);
  for (std::uint16_t& s : atoms.species) {
    if (s == gallium && random() % 100 < 40) s = indium;
  }
  FindCellReport report;
  const Crystal crystal = find_unit_cell(atoms, {}, report);
  ASSERT_TRUE(report.found) << report.why;
  ASSERT_EQ(crystal.grains[0].basis.size(), 2U);
  EXPECT_EQ(find_space_group(crystal.grains[0])->number, 216);
  EXPECT_GT(report.explained, 0.999);
  EXPECT_NEAR(report.foreign, 0.2, 0.02);
  EXPECT_FALSE(report.notes.empty());
}

// Five species at random on one lattice: no translation keeps the species.
TEST(FindUnitCell, ManySpeciesOnOneLattice) {
  Atoms atoms = planted({"fcc", 2, PlantedShape::periodic_block}).atoms;
  std::mt19937 random(3);
  for (const char* name : {"Co", "Cr", "Fe", "Ni"}) atoms.add_species(name);
  for (std::uint16_t& s : atoms.species) s = static_cast<std::uint16_t>(random() % 5);
  FindCellReport report;
  const Crystal crystal = find_unit_cell(atoms, {}, report);
  ASSERT_TRUE(report.found) << report.why;
  EXPECT_EQ(crystal.grains[0].basis.size(), 1U);
  EXPECT_EQ(find_space_group(crystal.grains[0])->number, 225);
}

TEST(FindUnitCell, SkewAndUnequalCells) {
  UnitCell cell;
  cell.primitive = {Vec3(2.6, 0.2, 0.1), Vec3(-0.9, 3.9, 0.3), Vec3(1.1, 1.7, 11.5)};
  cell.basis = {{"Si", Vec3(0.0)}, {"O", Vec3(1.1, 0.4, 1.9)}, {"O", Vec3(0.3, 2.2, 4.6)}, {"Na", Vec3(1.5, 1.4, 8.2)}};
  Atoms atoms = test::cut_block(cell, 16, 11, 5);
  test::shake(atoms, 0.04, 2);
  FindCellReport report;
  const Crystal crystal = find_unit_cell(atoms, {}, report);
  ASSERT_TRUE(report.found) << report.why;
  EXPECT_EQ(crystal.grains[0].basis.size(), 4U);
  EXPECT_EQ(test::difference_of_cells(crystal.grains[0], cell, 1e-3, 0.05), "");
  EXPECT_EQ(find_space_group(crystal.grains[0])->number, 1);
}

// A box one to three cells thick repeats itself, not only its crystal.
TEST(FindUnitCell, ThinPeriodicBoxes) {
  const UnitCell cell = test::lattice("perovskite").cell;
  Atoms atoms = test::periodic_block(cell, 3, 2, 2);
  test::shake(atoms, 0.02, 1);
  FindCellReport report;
  const Crystal crystal = find_unit_cell(atoms, {}, report);
  ASSERT_TRUE(report.found) << report.why;
  EXPECT_EQ(crystal.grains[0].basis.size(), 5U);
  EXPECT_EQ(test::difference_of_cells(crystal.grains[0], cell, 5e-3, 0.1), "");
}

TEST(FindUnitCell, RefusesWhatDoesNotRepeat) {
  FindCellReport report;
  EXPECT_FALSE(find_unit_cell(test::random_atoms(5000, 45.0, 1), {}, report).known());
  EXPECT_FALSE(report.found);
  EXPECT_NE(report.why.find("no lattice of translations"), std::string::npos) << report.why;

  // A glass in a small box repeats with its box only.
  Atoms glass = test::random_atoms(60, 10.0, 2);
  glass.box.vectors = {Vec3(10, 0, 0), Vec3(0, 10, 0), Vec3(0, 0, 10)};
  glass.box.periodic = {true, true, true};
  EXPECT_FALSE(find_unit_cell(glass, {}, report).known());
  EXPECT_FALSE(report.why.empty());

  EXPECT_FALSE(find_unit_cell(test::cut_block(test::lattice("fcc").cell, 1, 1, 1), {}, report).known());
  EXPECT_NE(report.why.find("too few"), std::string::npos) << report.why;
  EXPECT_FALSE(find_unit_cell(Atoms{}, {}, report).known());
}

TEST(FindUnitCell, OptionsAreHeeded) {
  const Atoms atoms = test::cut_block(test::lattice("perovskite").cell, 9, 9, 9);
  FindCellReport report;
  EXPECT_TRUE(find_unit_cell(atoms, {.largest_basis = 5}, report).known());
  EXPECT_FALSE(find_unit_cell(atoms, {.largest_basis = 4}, report).known());
  // Half crystal, half gas.
  Atoms half = atoms;
  Atoms gas = test::random_atoms(atoms.size() * 2, 36.0, 3);
  for (const Vec3& p : gas.positions) {
    half.positions.push_back(p + Vec3(60, 0, 0));
    half.species.push_back(half.species[0]);
  }
  EXPECT_TRUE(find_unit_cell(half, {.least_explained = 0.3}, report).known()) << report.why;
  EXPECT_FALSE(find_unit_cell(half, {.least_explained = 0.5}, report).known());
  EXPECT_NE(report.why.find("explains"), std::string::npos) << report.why;
}

TEST(FindUnitCell, RefusesWhatIsNoCell) {
  // Every atom twice, a hair apart.
  const UnitCell simple_cubic{{Vec3(2.5, 0, 0), Vec3(0, 2.5, 0), Vec3(0, 0, 2.5)}, {{"Po", Vec3(0.0)}}};
  Atoms twice = test::cut_block(simple_cubic, 6, 6, 6);
  for (std::size_t i = twice.size(); i-- > 0;) {
    twice.positions.push_back(twice.positions[i] + Vec3(1e-8, 0, 0));
    twice.species.push_back(twice.species[i]);
  }
  FindCellReport report;
  EXPECT_FALSE(find_unit_cell(twice, {}, report).known());
  EXPECT_FALSE(report.found);
  EXPECT_NE(report.why.find("same site"), std::string::npos) << report.why;

  // A layer repeats, but not in three directions.
  std::vector<Vec3> layer;
  for (int i = 0; i < 400; ++i) layer.emplace_back(2.5 * (i % 20), 2.5 * (i / 20), 0.0);
  EXPECT_FALSE(find_unit_cell(test::atoms_at(layer), {}, report).known());
  EXPECT_NE(report.why.find("three independent directions"), std::string::npos) << report.why;
}

TEST(FindUnitCell, CancelsAndChecks) {
  Atoms atoms = test::cut_block(test::lattice("fcc").cell, 8, 8, 8);
  FindCellReport report;
  Progress progress;
  progress.request_cancel();
  EXPECT_THROW(find_unit_cell(atoms, {}, report, progress), CancelledError);
  atoms.positions[7].x = std::nan("");
  EXPECT_THROW(find_unit_cell(atoms, {}, report), Error);
}

}  // namespace
}  // namespace atomesh
