// Defects planted in perfect crystals are found where they are, with the values the definition gives, and no others.
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "tests/preprocess/defect_checks.h"

namespace atomesh::test {
namespace {

constexpr double wanted_edge = 20.0;  // Å
constexpr double exact = 1e-6;        // Å

struct Setting {
  std::string name;
  Atoms atoms;
  UnitCell cell;
  double nearest;  // Å, between nearest neighbours
};

// Every lattice periodic, cut as a ball, and periodic in turned axes.
std::vector<Setting> settings() {
  std::vector<Setting> result;
  for (const Lattice& lattice : lattices()) {
    result.push_back(
        {lattice.name + " periodic", periodic_crystal(lattice, wanted_edge), lattice.cell, lattice.nearest_neighbour});
    result.push_back(
        {lattice.name + " ball", cut_sphere(lattice.cell, 0.6 * wanted_edge), lattice.cell, lattice.nearest_neighbour});
    Setting turned_setting{lattice.name + " turned", periodic_crystal(lattice, wanted_edge),
                           turned(lattice.cell, odd_rotation()), lattice.nearest_neighbour};
    transform(turned_setting.atoms, odd_rotation());
    for (Vec3& v : turned_setting.atoms.box.vectors) v = odd_rotation() * v;
    result.push_back(std::move(turned_setting));
  }
  return result;
}

Vec3 middle(const Atoms& atoms) {
  return bounds_of(atoms.positions).center();
}

std::vector<std::string> species_of(const UnitCell& cell) {
  std::vector<std::string> names;
  for (const BasisAtom& atom : cell.basis) {
    if (std::find(names.begin(), names.end(), atom.species) == names.end()) names.push_back(atom.species);
  }
  return names;
}

// How many atoms lie within the neighbourhood radius of an atom, by looking at them all.
std::size_t count_within(const Atoms& atoms, const Vec3& centre, double radius) {
  return static_cast<std::size_t>(std::count_if(atoms.positions.begin(), atoms.positions.end(), [&](const Vec3& p) {
    const double d = box_distance(p, centre, atoms.box);
    return d > 0.1 && d < radius;
  }));
}

TEST(PlantedDefect, VacancyOfEachSpecies) {
  for (const Setting& s : settings()) {
    for (const std::string& species : species_of(s.cell)) {
      const Index hole = nearest_atom(s.atoms, middle(s.atoms), species);
      const Vec3 place = s.atoms.positions[hole];
      const Atoms atoms = without_atoms(s.atoms, {hole});
      const Quantified q = quantify(atoms, s.cell);
      const std::string what = s.name + ", " + species;
      expect_vacancies(q, atoms, {{place, species}}, exact, what);
      expect_extras(q, {}, what);
      EXPECT_EQ(q.report.positional_atoms, 0u) << what;
      EXPECT_EQ(q.report.extra_atoms, 0u) << what;
      const std::size_t neighbours = count_within(atoms, place, q.report.radius);
      EXPECT_EQ(q.report.vacancy_atoms, neighbours) << what;
      ASSERT_EQ(q.defects.vacancies.size(), 1u) << what;
      // Votes also come from the first shells where these reach further than the neighbourhood (sc).
      EXPECT_GE(q.defects.vacancies[0].votes, neighbours) << what;
      EXPECT_EQ(*std::max_element(q.defects.vacancy.begin(), q.defects.vacancy.end()), 1.0F) << what;
    }
  }
}

// The first atom of a periodic crystal sits in the box's corner: its neighbours are images through all faces.
TEST(PlantedDefect, VacancyInTheCornerOfAPeriodicBox) {
  for (const Lattice& lattice : lattices()) {
    for (const double edge : {wanted_edge, 6.0}) {
      const Atoms full = periodic_crystal(lattice, edge);
      const Atoms atoms = without_atoms(full, {0});
      const Quantified q = quantify(atoms, lattice.cell);
      expect_vacancies(q, atoms, {{full.positions[0], full.species_name(0)}}, exact, lattice.name);
    }
  }
}

TEST(PlantedDefect, ForeignAtomOnASiteIsAVacancyAndAnExtra) {
  for (const Setting& s : settings()) {
    for (const std::string& species : species_of(s.cell)) {
      Atoms atoms = s.atoms;
      const Index atom = nearest_atom(atoms, middle(atoms), species);
      atoms.species[atom] = atoms.add_species("Xe");
      atoms.positions[atom] += Vec3(0.05, -0.02, 0.01);  // foreign atoms seldom sit quite where the others did
      const Quantified q = quantify(atoms, s.cell);
      const std::string what = s.name + ", " + species;
      expect_vacancies(q, atoms, {{s.atoms.positions[atom], species}}, exact, what);
      expect_extras(q, {atom}, what);
      expect_substitutions(q, atoms, {{atom, species}}, what);
      EXPECT_EQ(q.report.positional_atoms, 0u) << what;
      EXPECT_EQ(q.report.vacancy_atoms + 1, q.report.extra_atoms) << what;
    }
  }
}

TEST(PlantedDefect, AntisiteIsAVacancyAndAnExtra) {
  for (const Setting& s : settings()) {
    const std::vector<std::string> species = species_of(s.cell);
    for (std::size_t k = 0; species.size() > 1 && k < species.size(); ++k) {
      Atoms atoms = s.atoms;
      const Index atom = nearest_atom(atoms, middle(atoms), species[k]);
      atoms.species[atom] = atoms.add_species(species[(k + 1) % species.size()]);
      const Quantified q = quantify(atoms, s.cell);
      expect_vacancies(q, atoms, {{atoms.positions[atom], species[k]}}, exact, s.name + ", " + species[k]);
      expect_extras(q, {atom}, s.name + ", " + species[k]);
      expect_substitutions(q, atoms, {{atom, species[k]}}, s.name + ", " + species[k]);
    }
  }
}

struct Interstice {
  std::string lattice;
  Vec3 fraction;  // of the cell's vectors
  std::string species;
};

TEST(PlantedDefect, Interstitials) {
  const std::vector<Interstice> interstices{{"sc", {0.5, 0.5, 0.5}, "Po"},
                                            {"fcc", {0.5, 0.5, 0.5}, "Cu"},
                                            {"fcc", {0.25, 0.25, 0.25}, "Cu"},
                                            {"bcc", {0.5, 0.5, 0.0}, "Fe"},
                                            {"bcc", {0.5, 0.25, 0.0}, "Fe"},
                                            {"diamond", {0.5, 0.5, 0.5}, "Si"},
                                            {"nacl", {0.25, 0.25, 0.25}, "Na"},
                                            {"nacl", {0.25, 0.25, 0.25}, "Cl"},
                                            {"graphite", {1.0 / 3, 2.0 / 3, 0.25}, "C"},
                                            {"graphite", {0.5, 0.5, 0.25}, "C"},
                                            {"perovskite", {0.25, 0.25, 0.25}, "O"},
                                            {"perovskite", {0.5, 0.0, 0.0}, "Sr"}};
  for (const Interstice& interstice : interstices) {
    const Lattice& crystal = lattice(interstice.lattice);
    for (const std::string& species : {interstice.species, std::string("He")}) {
      for (const bool periodic : {true, false}) {
        Atoms atoms = periodic_crystal(crystal, wanted_edge);
        if (!periodic) atoms.box = Box{};
        const Mat3 cell = crystal.cell.matrix();
        const Vec3 corner = cell * glm::floor(glm::inverse(cell) * middle(atoms));
        const Index extra = static_cast<Index>(atoms.size());
        atoms.positions.push_back(corner + cell * interstice.fraction);
        atoms.species.push_back(atoms.add_species(species));
        const Quantified q = quantify(atoms, crystal.cell);
        const std::string what = interstice.lattice + (periodic ? " periodic, " : " open, ") + species;
        expect_extras(q, {extra}, what);
        expect_vacancies(q, atoms, {}, exact, what);
        EXPECT_EQ(q.report.vacancy_atoms, 0u) << what;
        EXPECT_EQ(q.report.positional_atoms, 0u) << what;
        const std::size_t neighbours = count_within(atoms, atoms.positions[extra], q.report.radius);
        EXPECT_EQ(q.report.extra_atoms, neighbours + 1) << what;  // and itself
        EXPECT_EQ(*std::max_element(q.defects.extra.begin(), q.defects.extra.end()), 1.0F) << what;
      }
    }
  }
}

// Two to five vacancies in touch.
TEST(PlantedDefect, VacancyClusters) {
  std::mt19937_64 random(5);
  for (const Setting& s : settings()) {
    for (const std::size_t size : {2u, 3u, 4u, 5u}) {
      std::vector<Index> holes{nearest_atom(s.atoms, middle(s.atoms))};
      while (holes.size() < size) {
        // The nearest atom to one of the holes that is not yet one.
        const Vec3 from = s.atoms.positions[holes[random() % std::min<std::size_t>(holes.size(), 2)]];
        Index best = no_index;
        for (Index i = 0; i < s.atoms.size(); ++i) {
          if (std::find(holes.begin(), holes.end(), i) != holes.end()) continue;
          if (best == no_index || box_distance(s.atoms.positions[i], from, s.atoms.box) <
                                      box_distance(s.atoms.positions[best], from, s.atoms.box) - 1e-6) {
            best = i;
          }
        }
        holes.push_back(best);
      }
      std::vector<std::pair<Vec3, std::string>> truth;
      for (const Index hole : holes) truth.emplace_back(s.atoms.positions[hole], s.atoms.species_name(hole));
      const Atoms atoms = without_atoms(s.atoms, holes);
      const Quantified q = quantify(atoms, s.cell);
      expect_vacancies(q, atoms, truth, exact, s.name + " of " + std::to_string(size));
      expect_extras(q, {}, s.name);
    }
  }
}

// One atom in a hundred missing at random, many of them in touch with others.
TEST(PlantedDefect, RandomVacancies) {
  std::mt19937_64 random(17);
  for (const Lattice& lattice : lattices()) {
    const Atoms full = periodic_crystal(lattice, 24.0);
    std::vector<Index> holes;
    std::vector<std::pair<Vec3, std::string>> truth;
    for (Index i = 0; i < full.size(); ++i) {
      if (random() % 100 != 0) continue;
      holes.push_back(i);
      truth.emplace_back(full.positions[i], full.species_name(i));
    }
    const Atoms atoms = without_atoms(full, holes);
    const Quantified q = quantify(atoms, lattice.cell);
    expect_vacancies(q, atoms, truth, exact, lattice.name);
    expect_extras(q, {}, lattice.name);
    EXPECT_EQ(q.report.positional_atoms, 0u) << lattice.name;
  }
}

TEST(PlantedDefect, TwoAtomsOnOneSite) {
  for (const Setting& s : settings()) {
    const Index site = nearest_atom(s.atoms, middle(s.atoms));
    for (const std::string& species : {s.atoms.species_name(site), std::string("Xe")}) {
      for (const double apart : {0.0, 0.1}) {
        Atoms atoms = s.atoms;
        const Index second = static_cast<Index>(atoms.size());
        atoms.positions.push_back(atoms.positions[site] + Vec3(apart, 0, 0));
        atoms.species.push_back(atoms.add_species(species));
        const Quantified q = quantify(atoms, s.cell);
        // Exactly on each other, either of one species can be called the extra one.
        if (q.defects.extras.size() == 1 && apart == 0.0 && species == s.atoms.species_name(site)) {
          EXPECT_TRUE(q.defects.extras[0].atom == site || q.defects.extras[0].atom == second) << s.name;
        } else {
          expect_extras(q, {second}, s.name + ", " + species);
        }
        expect_vacancies(q, atoms, {}, exact, s.name + ", " + species);
      }
    }
  }
}

// A displacement within the tolerance is positional and nothing else; its values are what the definition says.
TEST(PlantedDefect, DisplacedAtomHasPositionalValuesOnly) {
  for (const Setting& s : settings()) {
    Atoms atoms = s.atoms;
    const Index atom = nearest_atom(atoms, middle(atoms));
    const Vec3 shift(0.11, -0.13, 0.07);
    atoms.positions[atom] += shift;
    const Quantified q = quantify(atoms, s.cell);
    EXPECT_EQ(q.report.vacancy_atoms, 0u) << s.name;
    EXPECT_EQ(q.report.extra_atoms, 0u) << s.name;
    expect_vacancies(q, atoms, {}, exact, s.name);
    expect_extras(q, {}, s.name);
    const std::size_t neighbours = count_within(s.atoms, s.atoms.positions[atom], q.report.radius);
    EXPECT_EQ(q.report.positional_atoms, neighbours + 1) << s.name;
    const double one = glm::dot(shift, shift) / (s.nearest * s.nearest);
    EXPECT_NEAR(q.defects.positional[atom], one * static_cast<double>(neighbours), 1e-5) << s.name;
    for (Index i = 0; i < atoms.size(); ++i) {
      if (i == atom || q.defects.positional[i] == 0.0F) continue;
      EXPECT_NEAR(q.defects.positional[i], one, 1e-6) << s.name;
    }
  }
}

// Beyond the tolerance each neighbour misses one atom and has one too many; but the atom is still the site's own, so
// neither is listed, and it does not itself seem to miss all of its neighbours.
TEST(PlantedDefect, FarDisplacedAtomIsNeitherAVacancyNorAnExtra) {
  for (const Setting& s : settings()) {
    Atoms atoms = s.atoms;
    const Index atom = nearest_atom(atoms, middle(atoms));
    const Vec3 shift = 0.42 * s.nearest * glm::normalize(Vec3(0.3, 0.4, 1.0));
    atoms.positions[atom] += shift;
    const Quantified q = quantify(atoms, s.cell);
    expect_vacancies(q, atoms, {}, exact, s.name);
    expect_extras(q, {}, s.name);
    EXPECT_EQ(q.defects.vacancy[atom], 0.0F) << s.name;
    EXPECT_EQ(q.defects.extra[atom], 0.0F) << s.name;
    EXPECT_GT(q.defects.positional[atom], 0.5F) << s.name;
    const std::size_t neighbours = count_within(s.atoms, s.atoms.positions[atom], q.report.radius);
    // Those at the end of whose vectors it sat may have lost sight of it.
    EXPECT_LE(q.report.vacancy_atoms, neighbours) << s.name;
    EXPECT_GE(q.report.vacancy_atoms, 3 * neighbours / 4) << s.name;
    EXPECT_EQ(q.report.extra_atoms, q.report.vacancy_atoms) << s.name;
  }
}

// Thermal-like noise moves values, not verdicts.
TEST(PlantedDefect, VacancyAndInterstitialInAShakenCrystal) {
  const Lattice& fcc = lattice("fcc");
  Atoms full = periodic_crystal(fcc, wanted_edge);
  const double a = fcc.cell.primitive[0].x;
  const Index hole = nearest_atom(full, Vec3(2.0 * a));
  const Vec3 place = full.positions[hole];
  Atoms atoms = without_atoms(full, {hole});
  atoms.positions.push_back(Vec3(4.5 * a, 4.5 * a, 4.5 * a));
  atoms.species.push_back(0);
  shake(atoms, 0.15, 4);
  const Quantified q = quantify(atoms, fcc.cell);
  expect_vacancies(q, atoms, {{place, "Cu"}}, 0.2, "shaken fcc");
  expect_extras(q, {static_cast<Index>(atoms.size() - 1)}, "shaken fcc");
}

TEST(PlantedDefect, WhatSurfacesCutOffIsNotMissing) {
  const Lattice& fcc = lattice("fcc");
  const double a = fcc.cell.primitive[0].x;
  const Atoms full = cut_block(fcc.cell, 6, 6, 6);
  // One layer below the surface everything is still there to tell.
  const Index below = nearest_atom(full, Vec3(3.0 * a, 3.0 * a, a));
  const Atoms atoms = without_atoms(full, {below});
  expect_vacancies(quantify(atoms, fcc.cell), atoms, {{full.positions[below], "Cu"}}, exact, "below the surface");
  const Index corner = nearest_atom(full, Vec3(0.0));
  const Index top = nearest_atom(full, Vec3(3.0 * a, 3.0 * a, 0.0));
  const Atoms rough = without_atoms(full, {corner, top});
  expect_perfect(quantify(rough, fcc.cell), rough.size(), "rough surface");
}

TEST(PlantedDefect, NeighbourhoodFactorWidensWhatADefectTouches) {
  const Lattice& fcc = lattice("fcc");
  const Atoms full = periodic_block(fcc.cell, 6, 6, 6);
  const Atoms atoms = without_atoms(full, {100});
  EXPECT_EQ(quantify(atoms, fcc.cell, {0.71, 0.0}).report.vacancy_atoms, 12u);
  EXPECT_EQ(quantify(atoms, fcc.cell, {1.0, 0.0}).report.vacancy_atoms, 18u);
  EXPECT_EQ(quantify(atoms, fcc.cell, {1.3, 0.0}).report.vacancy_atoms, 42u);
  EXPECT_EQ(quantify(atoms, fcc.cell, {2.0, 0.0}).report.vacancy_atoms, 140u);
}

// Whatever cell describes the crystal, the same atoms have the same values.
TEST(PlantedDefect, SkewAndUnequalCellsSeeTheSame) {
  for (const Lattice& crystal : lattices()) {
    const Setting plain{crystal.name, periodic_crystal(crystal, wanted_edge), crystal.cell, 0.0};
    const Index hole = nearest_atom(plain.atoms, middle(plain.atoms));
    const std::pair<Vec3, std::string> truth(plain.atoms.positions[hole], plain.atoms.species_name(hole));
    const Atoms atoms = without_atoms(plain.atoms, {hole});
    const Quantified reference = quantify(atoms, crystal.cell);
    UnitCell skew = crystal.cell;
    skew.primitive[2] += 4.0 * skew.primitive[0] - 3.0 * skew.primitive[1];
    skew.primitive[1] += 3.0 * skew.primitive[0];
    // Twelve cells in a row as one.
    UnitCell row = crystal.cell;
    for (int n = 1; n < 12; ++n) {
      for (const BasisAtom& atom : crystal.cell.basis) {
        row.basis.push_back({atom.species, atom.position + static_cast<double>(n) * crystal.cell.primitive[0]});
      }
    }
    row.primitive[0] *= 12.0;
    // The radius goes by reduced vectors: a skew cell's are the crystal's own, a long cell's are long.
    const double longest = crystal.cell.longest_primitive();
    for (const auto& [cell, neighbourhood] :
         {std::pair(skew, 1.0),
          std::pair(row, longest / UnitCell{reduce_lattice(row.primitive), {}}.longest_primitive())}) {
      DefectOptions options;
      options.neighbourhood = neighbourhood;
      const Quantified q = quantify(atoms, cell, options);
      expect_vacancies(q, atoms, {truth}, exact, crystal.name);
      expect_extras(q, {}, crystal.name);
      EXPECT_EQ(q.defects.vacancy, reference.defects.vacancy) << crystal.name;
      EXPECT_EQ(q.report.positional_atoms, 0u) << crystal.name;
    }
  }
}

}  // namespace
}  // namespace atomesh::test
