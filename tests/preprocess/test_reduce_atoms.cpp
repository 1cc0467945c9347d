// Masking and thinning: what is kept, for which reason, and that the sample stays even.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/error.h"
#include "core/parallel.h"
#include "preprocess/reduce_atoms.h"
#include "tests/support/lattices.h"

namespace atomesh::test {
namespace {

// A simple cubic block of edge n, unit spacing, with a ball of In in the middle of Ga, and As beside each atom.
Atoms quantum_dot(int n) {
  Atoms atoms;
  const std::uint16_t ga = atoms.add_species("Ga");
  const std::uint16_t in = atoms.add_species("In");
  const std::uint16_t as = atoms.add_species("As");
  const Vec3 centre(0.5 * (n - 1));
  for (int x = 0; x < n; ++x) {
    for (int y = 0; y < n; ++y) {
      for (int z = 0; z < n; ++z) {
        const Vec3 p(x, y, z);
        atoms.positions.push_back(p);
        atoms.species.push_back(glm::length(p - centre) < 0.2 * n ? in : ga);
        atoms.positions.push_back(p + Vec3(0.25));
        atoms.species.push_back(as);
      }
    }
  }
  Column column{"number", {}};
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    atoms.ids.push_back(static_cast<std::int64_t>(i));
    column.values.push_back(static_cast<double>(i));
  }
  atoms.columns.push_back(column);
  return atoms;
}

TEST(ReduceAtoms, MaskDropsTheSpeciesAndNothingElse) {
  const Atoms atoms = quantum_dot(10);
  ReduceOptions options;
  options.mask = {"As"};
  ReduceReport report;
  const Atoms reduced = reduce_atoms(atoms, options, report);
  ASSERT_EQ(reduced.size(), 1000u);
  EXPECT_EQ(report.masked, 1000u);
  EXPECT_EQ(report.kept_sample, 1000u);
  for (std::size_t i = 0; i < reduced.size(); ++i) {
    EXPECT_EQ(reduced.ids[i], static_cast<std::int64_t>(2 * i));
    EXPECT_EQ(reduced.columns[0].values[i], 2.0 * static_cast<double>(i));
    EXPECT_EQ(reduced.positions[i], atoms.positions[2 * i]);
  }
}

TEST(ReduceAtoms, KeepsBoundaryTransitionsAndAShareOfTheRest) {
  const int n = 20;
  const Atoms atoms = quantum_dot(n);
  ReduceOptions options;
  options.mask = {"As"};
  options.keep_every = 8;
  ReduceReport report;
  const Atoms reduced = reduce_atoms(atoms, options, report);
  std::vector<bool> kept(atoms.size(), false);
  for (const std::int64_t id : reduced.ids) kept[static_cast<std::size_t>(id)] = true;

  // By the definition, atom by atom: the nearest-neighbour distance is 1, so both distances are 1.1.
  std::size_t boundary = 0;
  std::size_t transition = 0;
  std::size_t rest = 0;
  for (std::size_t i = 0; i < atoms.size(); i += 2) {
    const Vec3 p = atoms.positions[i];
    const double low = std::min({p.x, p.y, p.z});
    const double high = std::max({p.x, p.y, p.z});
    bool other = false;
    for (std::size_t j = 0; j < atoms.size() && !other; j += 2) {
      other = atoms.species[j] != atoms.species[i] && glm::length(atoms.positions[j] - p) <= 1.1;
    }
    if (low <= 1.1 || high >= n - 1 - 1.1) {
      ++boundary;
      EXPECT_TRUE(kept[i]);
    } else if (other) {
      ++transition;
      EXPECT_TRUE(kept[i]);
    } else {
      ++rest;
    }
  }
  EXPECT_EQ(report.masked, atoms.size() / 2);
  EXPECT_EQ(report.kept_boundary, boundary);
  EXPECT_EQ(report.kept_transition, transition);
  EXPECT_EQ(report.kept_sample, (rest + 7) / 8);
  EXPECT_EQ(report.dropped, rest - report.kept_sample);
  EXPECT_EQ(reduced.size(), boundary + transition + report.kept_sample);
  EXPECT_TRUE(std::is_sorted(reduced.ids.begin(), reduced.ids.end()));
}

TEST(ReduceAtoms, TheSampleIsEvenInSpace) {
  // No box, one species: thinned everywhere but at the boundary. In every one of 4³ regions of the inside, between
  // half and twice the share of the mean.
  const Atoms atoms = cut_block(lattice("sc").cell, 34, 34, 34);
  const double spacing = lattice("sc").nearest_neighbour;
  for (const std::size_t keep_every : {3u, 8u, 20u}) {
    ReduceOptions options;
    options.keep_every = keep_every;
    ReduceReport report;
    const Atoms reduced = reduce_atoms(atoms, options, report);
    std::map<std::array<int, 3>, int> regions;
    for (const Vec3& p : reduced.positions) {
      const Vec3 cell = glm::floor((p / spacing - Vec3(2.0 - 1e-6)) / 7.5);
      const bool inside = std::min({p.x, p.y, p.z}) > 1.5 * spacing && std::max({p.x, p.y, p.z}) < 31.5 * spacing;
      if (inside) ++regions[{static_cast<int>(cell.x), static_cast<int>(cell.y), static_cast<int>(cell.z)}];
    }
    ASSERT_EQ(regions.size(), 64u);
    const double mean = static_cast<double>(report.kept_sample) / 64.0;
    for (const auto& [region, count] : regions) {
      EXPECT_GT(count, 0.5 * mean) << keep_every;
      EXPECT_LT(count, 2.0 * mean) << keep_every;
    }
  }
}

TEST(ReduceAtoms, BoundaryFollowsATiltedBox) {
  Atoms atoms;
  atoms.add_species("C");
  const std::array<Vec3, 3> edges{Vec3(1, 0, 0), Vec3(0.5, 1, 0), Vec3(0.3, 0.4, 1)};
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      for (int k = 0; k < 10; ++k) {
        atoms.positions.push_back(double(i) * edges[0] + double(j) * edges[1] + double(k) * edges[2]);
        atoms.species.push_back(0);
      }
    }
  }
  atoms.box.vectors = {10.0 * edges[0], 10.0 * edges[1], 10.0 * edges[2]};
  ReduceOptions options;
  options.keep_every = 1000;
  options.boundary_distance = 0.01;
  ReduceReport report;
  reduce_atoms(atoms, options, report);
  EXPECT_EQ(report.kept_boundary, 1000u - 8 * 8 * 8);
  EXPECT_EQ(report.kept_sample, 1u);
}

TEST(ReduceAtoms, DoesNotDependOnThreadsOrOrder) {
  Atoms atoms = random_atoms(20000, 50.0, 5);
  atoms.add_species("N");
  for (std::size_t i = 0; i < atoms.size(); ++i) atoms.species[i] = atoms.positions[i].x > 25.0 ? 1 : 0;
  ReduceOptions options;
  options.keep_every = 10;
  ReduceReport report;
  set_threads(1);
  const Atoms one = reduce_atoms(atoms, options, report);
  set_threads(3);
  const Atoms three = reduce_atoms(atoms, options, report);
  set_threads(0);
  EXPECT_EQ(one.positions, three.positions);
  const auto sorted = [](std::vector<Vec3> points) {
    std::sort(points.begin(), points.end(), [](const Vec3& a, const Vec3& b) {
      return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
    });
    return points;
  };
  options.transition_distance = 1.0;  // the automatic one looks at some atoms only, chosen by their place in the file
  const Atoms straight = reduce_atoms(atoms, options, report);
  const Atoms mixed = reduce_atoms(shuffled(atoms, 3), options, report);
  EXPECT_EQ(sorted(straight.positions), sorted(mixed.positions));
}

TEST(ReduceAtoms, HardCases) {
  ReduceOptions options;
  options.keep_every = 5;
  ReduceReport report;
  EXPECT_EQ(reduce_atoms(atoms_at({Vec3(1, 2, 3)}), options, report).size(), 1u);
  EXPECT_EQ(reduce_atoms(Atoms{}, options, report).size(), 0u);
  // Two clusters a million Å apart, and everything in one place.
  Atoms far = random_atoms(500, 3.0, 1);
  for (std::size_t i = 0; i < 250; ++i) far.positions[i] += Vec3(1e6, -1e6, 1e6);
  EXPECT_GT(reduce_atoms(far, options, report).size(), 100u);
  EXPECT_EQ(report.kept_boundary + report.kept_transition + report.kept_sample + report.dropped, 500u);
  EXPECT_EQ(reduce_atoms(atoms_at(std::vector<Vec3>(10, Vec3(4.0))), options, report).size(), 10u);
}

TEST(ReduceAtoms, RefusesWrongOptions) {
  const Atoms atoms = quantum_dot(3);
  ReduceReport report;
  const auto refused = [&](ReduceOptions options) {
    try {
      reduce_atoms(atoms, options, report);
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused({.mask = {"as"}}), "species \"as\" cannot be masked: the atoms are Ga, In, As; did you mean As?");
  EXPECT_FALSE(refused({.mask = {"Ga", "In", "As"}}).empty());
  EXPECT_FALSE(refused({.mask = {}, .keep_every = 0}).empty());
  EXPECT_FALSE(refused({.mask = {}, .keep_every = 2, .transition_distance = -1.0}).empty());
  EXPECT_FALSE(
      refused({.mask = {}, .keep_every = 2, .boundary_distance = std::numeric_limits<double>::quiet_NaN()}).empty());
}

}  // namespace
}  // namespace atomesh::test
