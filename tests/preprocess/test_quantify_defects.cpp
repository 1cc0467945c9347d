// Hard and wrong input: cells that do not fit, options out of range, degenerate samples, threads.
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "tests/preprocess/defect_checks.h"

namespace atomesh::test {
namespace {

void expect_does_not_fit(const Quantified& q, const std::string& what) {
  EXPECT_LT(q.report.matched_fraction, 0.5) << what;
  EXPECT_TRUE(q.defects.vacancies.empty()) << what;
  EXPECT_TRUE(q.defects.extras.empty()) << what;
  const bool noted = std::any_of(q.report.notes.begin(), q.report.notes.end(), [](const std::string& note) {
    return note.find("does not fit") != std::string::npos;
  });
  EXPECT_TRUE(noted) << what;
}

TEST(QuantifyDefects, WrongCellIsNotedAndListsNoSites) {
  for (const Lattice& crystal : lattices()) {
    for (const Lattice& other : lattices()) {
      if (crystal.name == other.name) continue;
      UnitCell cell = other.cell;
      for (BasisAtom& atom : cell.basis) atom.species = crystal.cell.basis[0].species;
      const Atoms atoms = cut_block(crystal.cell, 5, 5, 4);
      const Quantified q = quantify(atoms, cell);
      // Two lattices can share much of their neighbourhood (half of perovskite's sites); what is said must agree.
      if (q.report.matched_fraction < 0.5) expect_does_not_fit(q, crystal.name + " as " + other.name);
      for (std::size_t i = 0; i < atoms.size(); ++i) {
        ASSERT_TRUE(std::isfinite(q.defects.positional[i]));
        ASSERT_GE(q.defects.vacancy[i], 0.0F);
        ASSERT_GE(q.defects.extra[i], 0.0F);
      }
    }
  }
}

TEST(QuantifyDefects, TurnedScaledAndForeignCellsAreNoted) {
  for (const Lattice& crystal : lattices()) {
    const Atoms atoms = periodic_block(crystal.cell, 5, 5, 4);
    expect_does_not_fit(quantify(atoms, turned(crystal.cell, odd_rotation())), crystal.name + " turned");
    const Mat3 ten(10.0);
    expect_does_not_fit(quantify(atoms, turned(crystal.cell, ten)), crystal.name + " in nanometres");
    expect_does_not_fit(quantify(atoms, turned(crystal.cell, Mat3(0.1))), crystal.name + " a tenth");
    UnitCell foreign = crystal.cell;
    for (BasisAtom& atom : foreign.basis) atom.species = "Zz";
    expect_does_not_fit(quantify(atoms, foreign), crystal.name + " of Zz");
  }
}

TEST(QuantifyDefects, RandomAtomsFitNoCell) {
  const Atoms atoms = random_atoms(3000, 33.0, 9);
  UnitCell cell = lattice("diamond").cell;
  for (BasisAtom& atom : cell.basis) atom.species = "C";
  expect_does_not_fit(quantify(atoms, cell), "random");
}

TEST(QuantifyDefects, SingularCellAndWrongOptionsAreRefused) {
  const Lattice& fcc = lattice("fcc");
  const Atoms atoms = cut_block(fcc.cell, 2, 2, 2);
  UnitCell flat = fcc.cell;
  flat.primitive[2] = flat.primitive[0] + flat.primitive[1];
  EXPECT_THROW(quantify(atoms, flat), Error);
  UnitCell empty = fcc.cell;
  empty.basis.clear();
  EXPECT_THROW(quantify(atoms, empty), Error);
  for (const double factor : {0.0, -1.0, std::nan(""), HUGE_VAL, 1000.0}) {
    EXPECT_THROW(quantify(atoms, fcc.cell, {factor, 0.0}), UsageError) << factor;
  }
  for (const double tolerance : {-0.1, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(quantify(atoms, fcc.cell, {1.0, tolerance}), UsageError) << tolerance;
  }
  const Quantified wide = quantify(atoms, fcc.cell, {1.0, 100.0});
  EXPECT_LT(wide.report.tolerance, 0.5 * fcc.nearest_neighbour);
  EXPECT_FALSE(wide.report.notes.empty());
  expect_perfect(wide, atoms.size(), "wide tolerance");
}

TEST(QuantifyDefects, BadCoordinatesAndBoxesAreRefused) {
  const Lattice& fcc = lattice("fcc");
  Atoms atoms = cut_block(fcc.cell, 2, 2, 2);
  atoms.positions[3].y = std::nan("");
  EXPECT_THROW(quantify(atoms, fcc.cell), Error);
  atoms = periodic_block(fcc.cell, 2, 2, 2);
  atoms.box.vectors[2] = atoms.box.vectors[0];
  EXPECT_THROW(quantify(atoms, fcc.cell), Error);
  atoms.box.vectors[2] = Vec3(0, 0, 1e-9);
  EXPECT_THROW(quantify(atoms, fcc.cell), Error);
}

// Two crystals a long way from each other, and one atom in the middle of nowhere.
TEST(QuantifyDefects, SparseSamples) {
  const Lattice& nacl = lattice("nacl");
  Atoms atoms = cut_block(nacl.cell, 3, 3, 3);
  const std::size_t one = atoms.size();
  for (std::size_t i = 0; i < one; ++i) {
    atoms.positions.push_back(atoms.positions[i] + Vec3(1e6, 2e6, -3e6));
    atoms.species.push_back(atoms.species[i]);
  }
  atoms.positions.push_back(Vec3(-5e8, 0, 0));
  atoms.species.push_back(0);
  expect_perfect(quantify(atoms, nacl.cell), atoms.size(), "far crystals");
}

// Matching stays linear when a million times denser matter sits beside the crystal.
TEST(QuantifyDefects, DensityRatioOfAMillion) {
  const Lattice& fcc = lattice("fcc");
  Atoms atoms = cut_block(fcc.cell, 6, 6, 6);
  const std::size_t crystal = atoms.size();
  const Atoms clump = random_atoms(20000, 0.6, 3);
  for (const Vec3& p : clump.positions) {
    atoms.positions.push_back(p + Vec3(60.0));
    atoms.species.push_back(0);
  }
  const Quantified q = quantify(atoms, fcc.cell);
  for (std::size_t i = 0; i < crystal; ++i) ASSERT_FALSE(q.defects.defective(i)) << i;
  EXPECT_EQ(q.report.extra_atoms, clump.size());
  EXPECT_TRUE(q.defects.vacancies.empty());
}

TEST(QuantifyDefects, SameAnswerAtAnyNumberOfThreads) {
  for (const Lattice& crystal : lattices()) {
    Atoms atoms = periodic_block(crystal.cell, 8, 8, 6);
    atoms.box.periodic[1] = false;
    std::vector<Index> holes;
    for (Index i = 40; i < atoms.size(); i += 97) holes.push_back(i);
    atoms = without_atoms(atoms, holes);
    shake(atoms, 0.2 * crystal.nearest_neighbour, 6);
    set_threads(1);
    const Quantified one = quantify(atoms, crystal.cell);
    for (const int count : {2, 5}) {
      set_threads(count);
      const Quantified many = quantify(atoms, crystal.cell);
      EXPECT_EQ(one.defects.positional, many.defects.positional) << crystal.name;
      EXPECT_EQ(one.defects.vacancy, many.defects.vacancy) << crystal.name;
      EXPECT_EQ(one.defects.extra, many.defects.extra) << crystal.name;
      EXPECT_EQ(one.report.matched_fraction, many.report.matched_fraction) << crystal.name;
      ASSERT_EQ(one.defects.vacancies.size(), many.defects.vacancies.size()) << crystal.name;
      for (std::size_t v = 0; v < one.defects.vacancies.size(); ++v) {
        EXPECT_EQ(one.defects.vacancies[v].position, many.defects.vacancies[v].position);
        EXPECT_EQ(one.defects.vacancies[v].votes, many.defects.vacancies[v].votes);
      }
      ASSERT_EQ(one.defects.extras.size(), many.defects.extras.size()) << crystal.name;
    }
    set_threads(0);
  }
}

TEST(QuantifyDefects, CancelStopsIt) {
  const Lattice& fcc = lattice("fcc");
  const Atoms atoms = cut_block(fcc.cell, 10, 10, 10);
  Progress progress;
  progress.request_cancel();
  DefectReport report;
  EXPECT_THROW(quantify_defects(atoms, fcc.cell, {}, report, progress), CancelledError);
}

}  // namespace
}  // namespace atomesh::test
