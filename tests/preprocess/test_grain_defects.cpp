// Samples of several grains: each is compared with its own cell, and what remains is the boundary.
#include <cmath>

#include "core/error.h"
#include "tests/preprocess/defect_checks.h"

namespace atomesh::test {
namespace {

struct Polycrystal {
  Atoms atoms;
  Crystal crystal;
};

// Two crystals that meet in the plane z = 0 of a block; where atoms of both come closer than 0.7 of the nearest
// distance, those of the upper one go. Atoms nearer to the plane than `core` are left without a grain.
Polycrystal bicrystal(const UnitCell& lower, const UnitCell& upper, double half, double nearest, double core = 0.0) {
  Polycrystal result;
  result.crystal.grains = {lower, upper};
  result.atoms = cut_where(lower, Vec3(half), [](const Vec3& p) { return p.z <= 1e-6; });
  result.crystal.grain_of.assign(result.atoms.size(), 0);
  const Atoms other = cut_where(upper, Vec3(half), [](const Vec3& p) { return p.z > 1e-6; });
  const std::size_t first = result.atoms.size();
  for (std::size_t i = 0; i < other.size(); ++i) {
    const Vec3& p = other.positions[i];
    bool free = true;
    for (std::size_t j = 0; free && p.z < nearest && j < first; ++j) {
      free = glm::distance(p, result.atoms.positions[j]) > 0.7 * nearest;
    }
    if (!free) continue;
    result.atoms.positions.push_back(p);
    result.atoms.species.push_back(result.atoms.add_species(other.species_name(i)));
    result.crystal.grain_of.push_back(1);
  }
  for (std::size_t i = 0; i < result.atoms.size(); ++i) {
    if (std::abs(result.atoms.positions[i].z) < core) result.crystal.grain_of[i] = no_grain;
  }
  return result;
}

Quantified quantify(const Polycrystal& sample, const DefectOptions& options = {}) {
  Quantified result;
  result.defects = quantify_defects(sample.atoms, sample.crystal, options, result.report);
  return result;
}

Mat3 turn(double degrees, const Vec3& axis) {
  const double a = degrees * std::numbers::pi / 180.0;
  const Vec3 n = glm::normalize(axis);
  const Mat3 cross(Vec3(0, n.z, -n.y), Vec3(-n.z, 0, n.x), Vec3(n.y, -n.x, 0));
  return Mat3(1.0) + std::sin(a) * cross + (1.0 - std::cos(a)) * cross * cross;
}

void remove(Polycrystal& sample, Index atom) {
  sample.atoms = without_atoms(sample.atoms, {atom});
  sample.crystal.grain_of.erase(sample.crystal.grain_of.begin() + atom);
}

void add(Polycrystal& sample, const Vec3& place, const std::string& species) {
  sample.atoms.positions.push_back(place);
  sample.atoms.species.push_back(sample.atoms.add_species(species));
  sample.crystal.grain_of.push_back(no_grain);
}

TEST(GrainDefects, OnlyTheBoundaryRemains) {
  for (const char* name : {"fcc", "bcc", "diamond", "nacl"}) {
    const Lattice& crystal = lattice(name);
    const UnitCell lower = turned(crystal.cell, odd_rotation());
    const UnitCell upper = turned(crystal.cell, turn(33.0, Vec3(1, 2, 3)));
    for (const double core : {0.0, 0.8 * crystal.nearest_neighbour}) {
      const Polycrystal sample = bicrystal(lower, upper, 14.0, crystal.nearest_neighbour, core);
      const Quantified q = quantify(sample);
      const std::string what = std::string(name) + " core " + std::to_string(core);
      EXPECT_GT(q.report.matched_fraction, 0.8) << what;
      EXPECT_TRUE(q.defects.vacancies.empty()) << what << ": " << q.defects.vacancies.size();
      EXPECT_TRUE(q.defects.extras.empty()) << what << ": " << q.defects.extras.size();
      std::size_t near = 0;
      std::size_t shown = 0;
      for (std::size_t i = 0; i < sample.atoms.size(); ++i) {
        const Vec3& p = sample.atoms.positions[i];
        if (std::abs(p.z) > q.report.radius + q.report.tolerance + 0.3 * crystal.nearest_neighbour) {
          ASSERT_FALSE(q.defects.defective(i)) << what << " " << p.z;
        }
        if (std::abs(p.z) > 0.5 * crystal.nearest_neighbour || std::abs(p.x) > 9.0 || std::abs(p.y) > 9.0) continue;
        ++near;
        shown += q.defects.defective(i) ? 1 : 0;
      }
      EXPECT_GT(10 * shown, 9 * near) << what;
    }
  }
}

TEST(GrainDefects, DefectsInsideAGrainAreFound) {
  const Lattice& fcc = lattice("fcc");
  const UnitCell lower = turned(fcc.cell, odd_rotation());
  const UnitCell upper = turned(fcc.cell, turn(33.0, Vec3(1, 2, 3)));
  for (const double noise : {0.0, 0.02}) {
    Polycrystal sample = bicrystal(lower, upper, 16.0, fcc.nearest_neighbour, 0.8 * fcc.nearest_neighbour);
    std::vector<std::pair<Vec3, std::string>> vacancies;
    for (const Vec3& place : {Vec3(1, 2, -8), Vec3(-2, 0, 7.5), Vec3(5, -5, 8)}) {
      const Index atom = nearest_atom(sample.atoms, place);
      vacancies.emplace_back(sample.atoms.positions[atom], "Cu");
      remove(sample, atom);
    }
    const Index foreign = nearest_atom(sample.atoms, Vec3(-6, -5, -8));
    vacancies.emplace_back(sample.atoms.positions[foreign], "Cu");
    sample.atoms.species[foreign] = sample.atoms.add_species("Ni");
    const auto interstitial = static_cast<Index>(sample.atoms.size());
    const Vec3 site = sample.atoms.positions[nearest_atom(sample.atoms, Vec3(6, 5, -8))];
    add(sample, site + odd_rotation() * Vec3(0.5 * fcc.cell.primitive[0].x, 0, 0), "Cu");
    std::mt19937_64 random(4);
    std::normal_distribution<double> normal(0.0, noise * fcc.nearest_neighbour + 1e-12);
    for (Vec3& p : sample.atoms.positions) {
      const double x = normal(random);
      const double y = normal(random);
      p += Vec3(x, y, normal(random));
    }
    const Quantified q = quantify(sample);
    expect_vacancies(q, sample.atoms, vacancies, 0.3 * fcc.nearest_neighbour, "fcc");
    expect_extras(q, {foreign, interstitial}, "fcc");
    expect_substitutions(q, sample.atoms, {{foreign, "Cu"}}, "fcc");
  }
}

// A coherent twin: the atoms of the plane belong to both grains and have each half of their neighbours as one of them
// has it; all others have nothing to complain of.
TEST(GrainDefects, TwinBoundaryIsOneLayer) {
  const double h = 2.556;
  const double root3 = std::sqrt(3.0);
  const double layer = h * std::sqrt(2.0 / 3.0);
  const UnitCell lower{{Vec3(0.5 * root3 * h, 0.5 * h, 0), Vec3(0, h, 0), Vec3(0.5 * h / root3, 0.5 * h, layer)},
                       {{"Cu", Vec3(0.0)}}};
  UnitCell upper = lower;
  for (Vec3& v : upper.primitive) v.z = -v.z;
  for (const double core : {0.0, 0.5}) {
    for (const std::size_t holes : {0u, 1u}) {
      Polycrystal sample = bicrystal(lower, upper, 16.0, h, core);
      std::vector<std::pair<Vec3, std::string>> truth;
      if (holes == 1) {
        const Index atom = nearest_atom(sample.atoms, Vec3(0, 0, -3.0 * layer));
        truth.emplace_back(sample.atoms.positions[atom], "Cu");
        remove(sample, atom);
      }
      const Quantified q = quantify(sample);
      expect_vacancies(q, sample.atoms, truth, 1e-3, "twin");
      expect_extras(q, {}, "twin");
      for (std::size_t i = 0; i < sample.atoms.size(); ++i) {
        const Vec3& p = sample.atoms.positions[i];
        if (std::abs(p.x) > 12.0 || std::abs(p.y) > 12.0) continue;
        const bool in_plane = std::abs(p.z) < 0.1;
        const bool beside = holes == 1 && glm::distance(p, truth[0].first) < 1.1 * h;
        ASSERT_EQ(q.defects.defective(i), in_plane || beside) << core << " z " << p.z;
      }
    }
  }
}

TEST(GrainDefects, AtomsOfNoGrainBelongToTheOneAroundThem) {
  const Lattice& nacl = lattice("nacl");
  const Atoms atoms = periodic_block(nacl.cell, 6, 6, 6);
  Polycrystal sample{atoms, {{nacl.cell}, std::vector<std::uint16_t>(atoms.size(), 0)}};
  for (std::size_t i = 0; i < atoms.size(); i += 3) sample.crystal.grain_of[i] = no_grain;
  expect_perfect(quantify(sample), atoms.size(), "nacl");
  // Nobody knows anything: nothing is said but that.
  sample.crystal.grain_of.assign(atoms.size(), no_grain);
  const Quantified lost = quantify(sample);
  EXPECT_TRUE(lost.defects.vacancies.empty());
  EXPECT_TRUE(lost.defects.extras.empty());
  EXPECT_EQ(lost.report.extra_atoms, atoms.size());
}

TEST(GrainDefects, OneGrainIsTheUnitCell) {
  const Lattice& diamond = lattice("diamond");
  Atoms atoms = periodic_crystal(diamond, 20.0);
  remove_nearest(atoms, Vec3(10.0));
  shake(atoms, 0.05, 3);
  const Quantified plain = test::quantify(atoms, diamond.cell);
  for (const bool numbered : {false, true}) {
    Polycrystal sample{atoms, {{diamond.cell}, {}}};
    if (numbered) sample.crystal.grain_of.assign(atoms.size(), 0);
    const Quantified q = quantify(sample);
    EXPECT_EQ(q.defects.positional, plain.defects.positional);
    EXPECT_EQ(q.defects.vacancy, plain.defects.vacancy);
    EXPECT_EQ(q.defects.extra, plain.defects.extra);
    EXPECT_EQ(q.defects.vacancies.size(), 1u);
  }
}

TEST(GrainDefects, GrainsOfSeveralPhases) {
  const Lattice& nacl = lattice("nacl");
  const Lattice& fcc = lattice("fcc");
  const Polycrystal sample = bicrystal(nacl.cell, fcc.cell, 16.0, 2.7, 1.0);
  const Quantified q = quantify(sample);
  for (std::size_t i = 0; i < sample.atoms.size(); ++i) {
    if (std::abs(sample.atoms.positions[i].z) > q.report.radius + 2.0) {
      ASSERT_FALSE(q.defects.defective(i)) << sample.atoms.positions[i].z;
    }
  }
  EXPECT_TRUE(q.defects.vacancies.empty());
  EXPECT_TRUE(q.defects.extras.empty());
}

TEST(GrainDefects, WhatDoesNotBelongToTheAtomsIsRefused) {
  const Lattice& fcc = lattice("fcc");
  const Atoms atoms = cut_block(fcc.cell, 3, 3, 3);
  EXPECT_THROW(quantify(Polycrystal{atoms, {}}), UsageError);
  EXPECT_THROW(quantify(Polycrystal{atoms, {{fcc.cell}, {0, 0}}}), Error);
  EXPECT_THROW(quantify(Polycrystal{atoms, {{fcc.cell}, std::vector<std::uint16_t>(atoms.size(), 1)}}), Error);
}

}  // namespace
}  // namespace atomesh::test
