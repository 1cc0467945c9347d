// Published simulations, where they are at hand.
#include <cmath>
#include <filesystem>

#include "preprocess/read_atoms.h"
#include "tests/preprocess/defect_checks.h"

namespace atomesh::test {
namespace {

// The atoms of a file of the shared data, all named like the cell's (dumps number their groups as types); empty when
// the data is not there.
Atoms read_shared(const std::string& name, const std::string& species) {
  const std::string path = std::string(ATOMESH_SHARED_DATA) + "/atoms/" + name;
  if (!std::filesystem::exists(path)) return {};
  Atoms atoms = read_atoms(path).atoms;
  atoms.species_table = {{species, 1.0}};
  std::fill(atoms.species.begin(), atoms.species.end(), std::uint16_t{0});
  return atoms;
}

// Aluminium, a = 4.05 Å, in axes along [112], [110] and [111].
UnitCell aluminium() {
  const double h = 4.05 / std::sqrt(2.0);
  const double root3 = std::sqrt(3.0);
  return {{Vec3(0.5 * root3 * h, 0.5 * h, 0), Vec3(0, h, 0), Vec3(0.5 * h / root3, 0.5 * h, 4.05 / root3)},
          {{"Al", Vec3(0.0)}}};
}

UnitCell body_centred(double edge) {
  return {{Vec3(edge, 0, 0), Vec3(0, edge, 0), Vec3(0, 0, edge)}, {{"X", Vec3(0.0)}, {"X", Vec3(0.5 * edge)}}};
}

TEST(RealDefects, PerfectAluminiumHasNone) {
  Atoms atoms = read_shared("atomman__fcc_Al_base.dump", "Al");
  if (atoms.size() == 0) GTEST_SKIP() << "shared data is not here";
  expect_perfect(quantify(atoms, aluminium()), atoms.size(), "Al");
  const Vec3 hole = remove_nearest(atoms, Vec3(5, 10, 20));
  const Quantified q = quantify(atoms, aluminium());
  expect_vacancies(q, atoms, {{hole, "Al"}}, 1e-3, "Al");
  EXPECT_EQ(q.report.vacancy_atoms, 12u);
}

// A relaxed dislocation displaces atoms; it empties no site and adds none.
TEST(RealDefects, DislocatedAluminiumIsDisplacedOnly) {
  const Atoms atoms = read_shared("atomman__fcc_Al_disl.dump", "Al");
  if (atoms.size() == 0) GTEST_SKIP() << "shared data is not here";
  const Quantified q = quantify(atoms, aluminium());
  expect_vacancies(q, atoms, {}, 0.0, "Al");
  expect_extras(q, {}, "Al");
  EXPECT_GT(q.report.positional_atoms, atoms.size() / 2);
  EXPECT_GT(q.report.matched_fraction, 0.99);
}

// 1,000 cells of bcc at a finite temperature after a collision cascade: as many vacancies as interstitials.
TEST(RealDefects, CascadeLeavesAFrenkelPair) {
  const Atoms atoms = read_shared("csaransh__data_lammps_Pos1.xyz", "X");
  if (atoms.size() == 0) GTEST_SKIP() << "shared data is not here";
  ASSERT_EQ(atoms.size(), 2000u);
  const Quantified q = quantify(atoms, body_centred(glm::length(atoms.box.vectors[0]) / 10.0));
  EXPECT_EQ(q.defects.vacancies.size(), 1u);
  EXPECT_EQ(q.defects.extras.size(), 1u);
}

// 12³ cells of bcc at a high temperature: everything is displaced and nothing is missing. All of it is thermal.
TEST(RealDefects, HotCrystalHasNoSites) {
  const Atoms atoms = read_shared("pyscal__conf.bcc", "X");
  if (atoms.size() == 0) GTEST_SKIP() << "shared data is not here";
  const UnitCell cell = body_centred(glm::length(atoms.box.vectors[0]) / 12.0);
  const Quantified q = quantify(atoms, cell);
  EXPECT_NEAR(q.report.noise, 0.17, 0.02);
  EXPECT_EQ(q.report.positional_atoms, 0u);
  expect_vacancies(q, atoms, {}, 0.0, "hot bcc");
  expect_extras(q, {}, "hot bcc");
  DefectOptions every;
  every.noise = 0.0;
  EXPECT_EQ(quantify(atoms, cell, every).report.positional_atoms, atoms.size());
}

}  // namespace
}  // namespace atomesh::test
