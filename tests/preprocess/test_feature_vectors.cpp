// What the perfect crystal has around its sites: shells known from textbooks, and the look-up against looking at all.
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "preprocess/feature_vectors.h"
#include "tests/support/lattices.h"

namespace atomesh::test {
namespace {

FeatureSet features_of(const UnitCell& cell, double neighbourhood = 1.0, double tolerance = 0.0) {
  Atoms atoms;
  for (const BasisAtom& atom : cell.basis) atoms.add_species(atom.species);
  return build_feature_vectors(cell, atoms.species_table, neighbourhood, tolerance);
}

struct Known {
  std::string lattice;
  std::vector<std::size_t> counted;  // of each kind: neighbours within the longest primitive vector
  std::vector<std::size_t> near;     // of each kind: neighbours in the first shells
};

TEST(FeatureVectors, HaveTheShellsOfTheTextbooks) {
  // Within the cubic edge: sc 6; fcc 12 + 6; bcc 8 + 6; diamond 4 + 12 + 12 + 6 (the third shell at 0.83); NaCl
  // 6 + 12 + 8 + 6. One kind of site for each sublattice, however many basis atoms share it.
  const std::vector<Known> known{{"sc", {6}, {18}},
                                 {"fcc", {18}, {18}},
                                 {"bcc", {14}, {14}},
                                 {"diamond", {34, 34}, {16, 16}},
                                 {"nacl", {32, 32}, {18, 18}}};
  for (const Known& expected : known) {
    const Lattice& crystal = lattice(expected.lattice);
    const FeatureSet set = features_of(crystal.cell);
    EXPECT_NEAR(set.nearest, crystal.nearest_neighbour, 1e-12) << expected.lattice;
    EXPECT_NEAR(set.tolerance, 0.3 * set.nearest, 1e-12);
    ASSERT_EQ(set.kinds.size(), expected.counted.size()) << expected.lattice;
    for (std::size_t k = 0; k < set.kinds.size(); ++k) {
      EXPECT_EQ(set.kinds[k].counted, expected.counted[k]) << expected.lattice;
      EXPECT_EQ(set.kinds[k].near, expected.near[k]) << expected.lattice;
      EXPECT_LE(set.kinds[k].enclosed, set.kinds[k].near) << expected.lattice;
    }
  }
  EXPECT_EQ(features_of(lattice("graphite").cell).kinds.size(), 4u);
  EXPECT_EQ(features_of(lattice("perovskite").cell).kinds.size(), 5u);
}

TEST(FeatureVectors, GrowWithTheNeighbourhoodAndNotWithTheCell) {
  const Lattice& fcc = lattice("fcc");
  EXPECT_EQ(features_of(fcc.cell, 0.71).kinds[0].counted, 12u);
  EXPECT_EQ(features_of(fcc.cell, 1.23).kinds[0].counted, 42u);
  const double h = 0.5 * fcc.cell.primitive[0].x;
  const UnitCell primitive{{Vec3(0, h, h), Vec3(h, 0, h), Vec3(h, h, 0)}, {{"Cu", Vec3(0.0)}}};
  EXPECT_EQ(features_of(primitive).kinds[0].counted, 12u);
  EXPECT_NEAR(features_of(primitive).nearest, fcc.nearest_neighbour, 1e-12);
  // A cell whose vectors are all long still has close neighbours.
  UnitCell skewed = primitive;
  skewed.primitive[0] += 7.0 * skewed.primitive[1] - 4.0 * skewed.primitive[2];
  EXPECT_NEAR(features_of(skewed, 0.2).nearest, fcc.nearest_neighbour, 1e-12);
}

// Every entry has its like in the opposite direction, at the site it leads to.
TEST(FeatureVectors, AreMutual) {
  for (const Lattice& crystal : lattices()) {
    const FeatureSet set = features_of(crystal.cell);
    for (std::size_t k = 0; k < set.kinds.size(); ++k) {
      for (std::size_t e = 0; e < set.kinds[k].counted; ++e) {
        const FeatureEntry& entry = set.kinds[k].entries[e];
        const SiteKind& other = set.kinds[entry.kind];
        EXPECT_EQ(other.species, entry.species);
        const auto back = std::count_if(other.entries.begin(), other.entries.end(), [&](const FeatureEntry& b) {
          return b.kind == k && glm::length(b.offset + entry.offset) < 1e-9;
        });
        EXPECT_EQ(back, 1) << crystal.name;
      }
    }
  }
}

// The sites outside a plane are never enclosed: no half-space holds so many.
TEST(FeatureVectors, EnclosedIsMoreThanAnyHalfSpaceHolds) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  for (const Lattice& crystal : lattices()) {
    for (const SiteKind& kind : features_of(crystal.cell).kinds) {
      for (int trial = 0; trial < 2000; ++trial) {
        const double x = normal(random);
        const double y = normal(random);
        const Vec3 direction(x, y, normal(random));
        std::size_t count = 0;
        for (std::size_t e = 0; e < kind.near; ++e) count += glm::dot(kind.entries[e].offset, direction) > 0.0 ? 1 : 0;
        ASSERT_LT(count, kind.enclosed) << crystal.name;
      }
    }
  }
}

TEST(FeatureVectors, LookupAgreesWithLookingAtEveryEntry) {
  std::mt19937_64 random(4);
  for (const Lattice& crystal : lattices()) {
    for (const double tolerance : {0.0, 0.44 * crystal.nearest_neighbour, 0.02}) {
      const FeatureSet set = features_of(crystal.cell, 1.0, tolerance);
      for (const SiteKind& kind : set.kinds) {
        const double reach = 1.2 * kind.entries.back().length;
        std::uniform_real_distribution<double> uniform(-reach, reach);
        std::normal_distribution<double> normal(0.0, 0.5 * set.tolerance);
        for (int trial = 0; trial < 3000; ++trial) {
          const double x = uniform(random);
          const double y = uniform(random);
          Vec3 q(x, y, uniform(random));
          if (trial % 2 == 0) {
            const double dx = normal(random);
            const double dy = normal(random);
            q = kind.entries[random() % kind.entries.size()].offset + Vec3(dx, dy, normal(random));
          }
          int expected = -1;
          for (std::size_t e = 0; e < kind.entries.size(); ++e) {
            if (glm::length(q - kind.entries[e].offset) <= set.tolerance) expected = static_cast<int>(e);
          }
          ASSERT_EQ(kind.lookup.find(kind.entries, q), expected) << crystal.name;
        }
      }
    }
  }
}

TEST(FeatureVectors, SpeciesTheSampleLacksAreNamed) {
  const Lattice& nacl = lattice("nacl");
  Atoms atoms;
  atoms.add_species("Xx");
  atoms.add_species("Cl");
  const FeatureSet set = build_feature_vectors(nacl.cell, atoms.species_table, 1.0, 0.0);
  EXPECT_EQ(set.absent_species, std::vector<std::string>{"Na"});
  ASSERT_EQ(set.kinds_of.size(), 3u);
  EXPECT_TRUE(set.kinds_of[0].empty());
  EXPECT_EQ(set.kinds_of[1].size(), 1u);
  EXPECT_EQ(set.kinds_of[2].size(), 1u);
}

}  // namespace
}  // namespace atomesh::test
