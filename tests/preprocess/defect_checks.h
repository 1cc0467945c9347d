// What the tests of defects share.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/unit_cell.h"
#include "preprocess/quantify_defects.h"
#include "tests/support/lattices.h"

namespace atomesh::test {

struct Quantified {
  Defects defects;
  DefectReport report;
};

inline Quantified quantify(const Atoms& atoms, const UnitCell& cell, const DefectOptions& options = {}) {
  Quantified result;
  result.defects = quantify_defects(atoms, cell, options, result.report);
  return result;
}

// Every value exactly zero and no site: what a perfect crystal has.
inline void expect_perfect(const Quantified& q, std::size_t atoms, const std::string& what) {
  ASSERT_EQ(q.defects.positional.size(), atoms) << what;
  ASSERT_EQ(q.defects.vacancy.size(), atoms) << what;
  ASSERT_EQ(q.defects.extra.size(), atoms) << what;
  EXPECT_EQ(q.report.positional_atoms, 0u) << what;
  EXPECT_EQ(q.report.vacancy_atoms, 0u) << what;
  EXPECT_EQ(q.report.extra_atoms, 0u) << what;
  for (std::size_t i = 0; i < atoms; ++i) {
    ASSERT_FALSE(q.defects.defective(i)) << what << ", atom " << i << ": " << q.defects.positional[i] << " "
                                         << q.defects.vacancy[i] << " " << q.defects.extra[i];
  }
  EXPECT_TRUE(q.defects.vacancies.empty()) << what << ": " << q.defects.vacancies.size();
  EXPECT_TRUE(q.defects.extras.empty()) << what << ": " << q.defects.extras.size();
}

// The difference between two places, through the periodic faces of the box.
inline double box_distance(const Vec3& a, const Vec3& b, const Box& box) {
  Vec3 d = a - b;
  if (box.any_periodic()) {
    const Vec3 fraction = glm::inverse(box.matrix()) * d;
    for (int k = 0; k < 3; ++k) {
      if (box.periodic[k]) d -= std::round(fraction[k]) * box.vectors[k];
    }
  }
  return glm::length(d);
}

// The vacancies are these places with these species, each once, within `tolerance` Å, and no others.
inline void expect_vacancies(const Quantified& q, const Atoms& atoms,
                             const std::vector<std::pair<Vec3, std::string>>& truth, double tolerance,
                             const std::string& what) {
  EXPECT_EQ(q.defects.vacancies.size(), truth.size()) << what;
  for (const auto& [place, species] : truth) {
    const auto hits = std::count_if(q.defects.vacancies.begin(), q.defects.vacancies.end(), [&](const VacancySite& v) {
      return atoms.species_table[v.species].name == species && box_distance(v.position, place, atoms.box) <= tolerance;
    });
    EXPECT_EQ(hits, 1) << what << ": " << species << " at " << place.x << " " << place.y << " " << place.z;
  }
}

inline void expect_extras(const Quantified& q, std::vector<Index> truth, const std::string& what) {
  std::sort(truth.begin(), truth.end());
  std::vector<Index> found;
  for (const ExtraAtom& extra : q.defects.extras) found.push_back(extra.atom);
  EXPECT_EQ(found, truth) << what;
}

// The substitutions are these atoms on sites of these species, and no others; each fills a vacancy of that species and
// is an extra atom.
inline void expect_substitutions(const Quantified& q, const Atoms& atoms,
                                 std::vector<std::pair<Index, std::string>> truth, const std::string& what) {
  std::sort(truth.begin(), truth.end());
  std::vector<std::pair<Index, std::string>> found;
  for (const Substitution& s : q.defects.substitutions) {
    found.emplace_back(s.atom, atoms.species_table[s.expected].name);
    ASSERT_LT(s.vacancy, q.defects.vacancies.size()) << what;
    EXPECT_EQ(q.defects.vacancies[s.vacancy].species, s.expected) << what;
    EXPECT_TRUE(std::any_of(q.defects.extras.begin(), q.defects.extras.end(), [&](const ExtraAtom& e) {
      return e.atom == s.atom;
    })) << what;
  }
  EXPECT_EQ(found, truth) << what;
}

// A periodic block of about `edge` Å along each vector.
inline Atoms periodic_crystal(const Lattice& lattice, double edge) {
  std::array<int, 3> n;
  for (int k = 0; k < 3; ++k) {
    n[k] = std::max(1, static_cast<int>(std::lround(edge / glm::length(lattice.cell.primitive[k]))));
  }
  return periodic_block(lattice.cell, n[0], n[1], n[2]);
}

// The atom nearest to `position`, among those of a species unless it is empty.
inline Index nearest_atom(const Atoms& atoms, const Vec3& position, const std::string& species = "") {
  Index best = no_index;
  for (Index i = 0; i < atoms.size(); ++i) {
    if (!species.empty() && atoms.species_name(i) != species) continue;
    if (best == no_index ||
        glm::distance(atoms.positions[i], position) < glm::distance(atoms.positions[best], position)) {
      best = i;
    }
  }
  return best;
}

inline Atoms without_atoms(const Atoms& atoms, std::vector<Index> removed) {
  std::vector<Index> kept;
  for (Index i = 0; i < atoms.size(); ++i) {
    if (std::find(removed.begin(), removed.end(), i) == removed.end()) kept.push_back(i);
  }
  Atoms result;
  result.species_table = atoms.species_table;
  result.box = atoms.box;
  for (const Index i : kept) {
    result.positions.push_back(atoms.positions[i]);
    result.species.push_back(atoms.species[i]);
  }
  return result;
}

// The same cell and atoms seen in turned axes.
inline UnitCell turned(const UnitCell& cell, const Mat3& matrix) {
  UnitCell result = cell;
  for (Vec3& v : result.primitive) v = matrix * v;
  for (BasisAtom& atom : result.basis) atom.position = matrix * atom.position;
  return result;
}

}  // namespace atomesh::test
