// A perfect crystal has exactly zero defects, whatever its lattice, cell, cut and rounding.
#include <cmath>

#include "core/error.h"
#include "tests/preprocess/defect_checks.h"

namespace atomesh::test {
namespace {

constexpr double wanted_edge = 20.0;  // Å

Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random);
  const double y = normal(random);
  return glm::normalize(Vec3(x, y, normal(random)));
}

TEST(PerfectCrystal, HasNoDefectsInAPeriodicBox) {
  for (const Lattice& lattice : lattices()) {
    const Atoms atoms = periodic_crystal(lattice, wanted_edge);
    const Quantified q = quantify(atoms, lattice.cell);
    expect_perfect(q, atoms.size(), lattice.name);
    EXPECT_EQ(q.report.surface_atoms, 0u) << lattice.name;
    EXPECT_EQ(q.report.matched_fraction, 1.0) << lattice.name;
    EXPECT_TRUE(q.report.notes.empty()) << lattice.name;
  }
}

TEST(PerfectCrystal, HasNoDefectsInABoxSmallerThanTheNeighbourhood) {
  for (const Lattice& lattice : lattices()) {
    const Atoms atoms = periodic_block(lattice.cell, 1, 1, 1);
    for (const double neighbourhood : {1.0, 1.9}) {
      const Quantified q = quantify(atoms, lattice.cell, {neighbourhood, 0.0});
      expect_perfect(q, atoms.size(), lattice.name);
      EXPECT_EQ(q.report.surface_atoms, 0u) << lattice.name;
    }
  }
}

TEST(PerfectCrystal, HasNoDefectsCutAsABlockASphereAndACylinder) {
  for (const Lattice& lattice : lattices()) {
    const Vec3 half(0.5 * wanted_edge);
    for (const Vec3& axis : {Vec3(0, 0, 1), glm::normalize(Vec3(1, 2, 0.3))}) {
      const Atoms cylinder =
          cut_where(lattice.cell, half, [&](const Vec3& p) { return glm::length(p - glm::dot(p, axis) * axis) < 6.0; });
      expect_perfect(quantify(cylinder, lattice.cell), cylinder.size(), lattice.name + " cylinder");
    }
    const Atoms block = cut_where(lattice.cell, half, [](const Vec3&) { return true; });
    expect_perfect(quantify(block, lattice.cell), block.size(), lattice.name + " block");
    for (const double radius : {2.0, 5.3, 9.0}) {
      const Atoms sphere = cut_sphere(lattice.cell, radius);
      expect_perfect(quantify(sphere, lattice.cell), sphere.size(), lattice.name + " sphere");
    }
  }
}

TEST(PerfectCrystal, HasNoDefectsCutByRandomPlanes) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> offset(1.0, 7.0);
  for (const Lattice& lattice : lattices()) {
    for (int trial = 0; trial < 12; ++trial) {
      std::vector<std::pair<Vec3, double>> planes;
      for (int n = 0; n < 4; ++n) planes.emplace_back(random_direction(random), offset(random));
      const Atoms cut = cut_where(lattice.cell, Vec3(0.5 * wanted_edge), [&](const Vec3& p) {
        return std::all_of(planes.begin(), planes.end(),
                           [&](const auto& plane) { return glm::dot(plane.first, p) < plane.second; });
      });
      expect_perfect(quantify(cut, lattice.cell), cut.size(), lattice.name + " planes");
    }
  }
}

// A concave outside. (Sharp cusps are left out: a single site beyond the last atoms they cut is a vacancy to anybody.)
TEST(PerfectCrystal, HasNoDefectsAroundABoredHoleOrASlot) {
  std::mt19937_64 random(11);
  for (const Lattice& lattice : lattices()) {
    for (int trial = 0; trial < 12; ++trial) {
      const Vec3 axis = random_direction(random);
      const Vec3 across = glm::normalize(glm::cross(axis, random_direction(random)));
      const Atoms bored = cut_where(lattice.cell, Vec3(0.5 * wanted_edge),
                                    [&](const Vec3& p) { return glm::length(p - glm::dot(p, axis) * axis) > 6.0; });
      expect_perfect(quantify(bored, lattice.cell), bored.size(), lattice.name + " hole");
      const Atoms slotted = cut_where(lattice.cell, Vec3(0.5 * wanted_edge), [&](const Vec3& p) {
        return std::abs(glm::dot(axis, p)) > 3.5 || glm::dot(across, p) < 0.0;
      });
      expect_perfect(quantify(slotted, lattice.cell), slotted.size(), lattice.name + " slot");
    }
  }
}

TEST(PerfectCrystal, HasNoDefectsWhenTheFileIsRoundedToThreeDecimals) {
  for (const Lattice& lattice : lattices()) {
    const auto rounded = [](Vec3 v) { return glm::round(v * 1000.0) / 1000.0; };
    const Mat3 turn = odd_rotation();
    UnitCell cell = turned(lattice.cell, turn);
    Atoms atoms = cut_block(cell, 5, 5, 4);
    for (Vec3& p : atoms.positions) p = rounded(p);
    for (Vec3& v : cell.primitive) v = rounded(v);
    for (BasisAtom& atom : cell.basis) atom.position = rounded(atom.position);
    expect_perfect(quantify(atoms, cell), atoms.size(), lattice.name);
  }
}

TEST(PerfectCrystal, HasNoDefectsFarFromTheOriginNorInAnyOrder) {
  for (const Lattice& lattice : lattices()) {
    Atoms atoms = shuffled(periodic_crystal(lattice, wanted_edge), 3);
    translate(atoms, Vec3(1e6, -1e6, 1e6));  // the box stays: every atom is wrapped into it
    expect_perfect(quantify(atoms, lattice.cell), atoms.size(), lattice.name);
    atoms.box = Box{};
    expect_perfect(quantify(atoms, lattice.cell), atoms.size(), lattice.name + ", open");
  }
}

TEST(PerfectCrystal, HasNoDefectsPeriodicAlongSomeAxesOnly) {
  for (const Lattice& lattice : lattices()) {
    for (int open = 0; open < 3; ++open) {
      Atoms atoms = periodic_crystal(lattice, wanted_edge);
      atoms.box.periodic[open] = false;
      const Quantified q = quantify(atoms, lattice.cell);
      expect_perfect(q, atoms.size(), lattice.name);
      EXPECT_GT(q.report.surface_atoms, 0u) << lattice.name;
      EXPECT_LE(q.report.surface_atoms, atoms.size()) << lattice.name;
    }
  }
}

// One crystal, many cells: primitive, left-handed, skewed, doubled, basis shifted and given outside the cell.
TEST(PerfectCrystal, HasNoDefectsInAnyOfItsCells) {
  for (const Lattice& lattice : lattices()) {
    const Atoms atoms = periodic_crystal(lattice, wanted_edge);
    UnitCell left = lattice.cell;
    std::swap(left.primitive[0], left.primitive[1]);
    UnitCell skewed = lattice.cell;
    skewed.primitive[2] += 2.0 * skewed.primitive[0] - skewed.primitive[1];
    UnitCell doubled = lattice.cell;
    for (const BasisAtom& atom : lattice.cell.basis) {
      doubled.basis.push_back({atom.species, atom.position + lattice.cell.primitive[1]});
    }
    doubled.primitive[1] *= 2.0;
    UnitCell shifted = lattice.cell;
    for (BasisAtom& atom : shifted.basis) atom.position += Vec3(100.3, -7.7, 0.1) + 3.0 * shifted.primitive[0];
    for (const UnitCell& cell : {left, skewed, doubled, shifted}) {
      expect_perfect(quantify(atoms, cell), atoms.size(), lattice.name);
    }
  }
}

TEST(PerfectCrystal, PrimitiveFccWhoseRadiusIsItsFirstShell) {
  const Lattice& fcc = lattice("fcc");
  const double h = 0.5 * fcc.cell.primitive[0].x;
  const UnitCell primitive{{Vec3(0, h, h), Vec3(h, 0, h), Vec3(h, h, 0)}, {{"Cu", Vec3(0.0)}}};
  Atoms atoms = cut_block(fcc.cell, 5, 5, 5);
  expect_perfect(quantify(atoms, primitive), atoms.size(), "fcc");
  const Vec3 hole = remove_nearest(atoms, Vec3(2.5 * fcc.cell.primitive[0].x));
  const Quantified q = quantify(atoms, primitive);
  expect_vacancies(q, atoms, {{hole, "Cu"}}, 1e-9, "fcc");
  EXPECT_EQ(q.report.vacancy_atoms, 12u);
}

TEST(PerfectCrystal, SampleOfAFewAtoms) {
  for (const Lattice& lattice : lattices()) {
    for (int count = 0; count <= 4; ++count) {
      Atoms atoms = cut_block(lattice.cell, 1, 1, 4);
      std::vector<Index> removed;
      for (Index i = static_cast<Index>(count); i < atoms.size(); ++i) removed.push_back(i);
      atoms = without_atoms(atoms, removed);
      expect_perfect(quantify(atoms, lattice.cell), atoms.size(), lattice.name);
    }
  }
}

}  // namespace
}  // namespace atomesh::test
