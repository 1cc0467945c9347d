// What each crystalline sample shows, measured on its atoms.
#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <set>

#include "samples/samples.h"
#include "tests/samples/sample_checks.h"

namespace atomesh {
namespace {

using test::NearGrid;

TEST(NaclCracked, PartsOnlyAcrossTheCrack) {
  const Sample sample = make_sample("nacl-cracked");
  // Neighbours of the perfect crystal are 2.82 Å apart. On one side of the crack they stay within 0.2 Å of that; across
  // it, at the mouth, they part by 1.4 Å.
  double widest = 0.0;
  const NearGrid grid(sample.atoms.positions, 4.4);
  for (std::size_t i = 0; i < sample.atoms.size(); ++i) {
    const Vec3& p = sample.atoms.positions[i];
    grid.near(p, [&](Index j, double) {
      const Vec3 step = sample.atoms.positions[j] - p;
      if (step.y > 2.0 && std::abs(step.x) < 0.5 && std::abs(step.z) < 0.5) widest = std::max(widest, step.y);
    });
  }
  EXPECT_NEAR(widest, 2.82 + 1.4, 0.02);
  EXPECT_GT(sample.truth.displaced.size(), sample.atoms.size() / 20);
  EXPECT_LT(sample.truth.displaced.size(), sample.atoms.size() / 2);
}

TEST(Diamond, PlantsEighteenVacanciesOfThreeKinds) {
  const Sample sample = make_sample("diamond-vacancy");
  ASSERT_EQ(sample.truth.vacancies.size(), 18);
  std::map<std::size_t, int> vacancies_by_empty_neighbours;
  for (const auto& a : sample.truth.vacancies) {
    std::size_t empty = 0;
    for (const auto& b : sample.truth.vacancies) {
      const double d = glm::distance(a.position, b.position);
      if (d > 0.0 && d < 1.6) ++empty;
    }
    ++vacancies_by_empty_neighbours[empty == 0 ? 0 : 1];
  }
  EXPECT_EQ(vacancies_by_empty_neighbours[0], 8);
  EXPECT_EQ(vacancies_by_empty_neighbours[1], 10);
}

TEST(Diamond, PairsItsNitrogen) {
  const Sample sample = make_sample("diamond-a-centers");
  ASSERT_EQ(sample.truth.extras.size(), 18);
  ASSERT_EQ(sample.truth.vacancies.size(), 18);
  for (const Index i : sample.truth.extras) {
    EXPECT_EQ(sample.atoms.species_name(i), "N");
    int partners = 0;
    for (const Index j : sample.truth.extras) {
      const double d = glm::distance(sample.atoms.positions[i], sample.atoms.positions[j]);
      if (i != j && d < 2.0) {
        ++partners;
        EXPECT_NEAR(d, 3.567 * std::sqrt(3.0) / 4.0 + 0.1, 1e-9);
      }
    }
    EXPECT_EQ(partners, 1);
  }
}

TEST(CuLineDefect, HasItsBurgersVector) {
  const Sample sample = make_sample("cu-line-defect", {20000, 1});
  const NearGrid grid(sample.atoms.positions, 2.0);
  const auto atom_at = [&](const Vec3& p) {
    Index best = no_index;
    double distance = 1e9;
    grid.near(p, [&](Index i, double d) {
      if (d < distance) {
        best = i;
        distance = d;
      }
    });
    EXPECT_NE(best, no_index) << "the circuit leaves the crystal";
    return best == no_index ? 0 : best;
  };
  const double a = 3.615;
  const double b = a / std::numbers::sqrt2;
  const Vec3 middle = bounds_of(sample.atoms.positions).center();
  // Follows the same lattice steps in a circle, always to the atom where the perfect crystal has one.
  const auto closure = [&](const Vec3& from) {
    const Index start = atom_at(from);
    Index at = start;
    const std::array<std::pair<Vec3, int>, 4> sides{{{{a, 0, 0}, 8}, {{0, b, 0}, 8}, {{-a, 0, 0}, 8}, {{0, -b, 0}, 8}}};
    for (const auto& [step, count] : sides) {
      for (int n = 0; n < count; ++n) at = atom_at(sample.atoms.positions[at] + step);
    }
    return sample.atoms.positions[at] - sample.atoms.positions[start];
  };
  const Vec3 around = closure(middle - Vec3(4 * a, 4 * b, 0));
  EXPECT_LT(glm::distance(around, Vec3(0, 0, b)), 1e-9) << "circuit around the line";
  const Vec3 beside = closure(middle + Vec3(-4 * a, 1.6 * b, 0));
  EXPECT_LT(glm::length(beside), 1e-9) << "circuit beside the line";
}

TEST(GraphiteSlided, SlidesWholeLayers) {
  const Sample sample = make_sample("graphite-slided", {12000, 1});
  const std::set<Index> slid(sample.truth.displaced.begin(), sample.truth.displaced.end());
  std::map<long, std::set<bool>> slid_by_layer;
  for (std::size_t i = 0; i < sample.atoms.size(); ++i) {
    slid_by_layer[std::lround(sample.atoms.positions[i].z / 3.354)].insert(slid.contains(static_cast<Index>(i)));
  }
  std::vector<bool> layers;
  for (const auto& [layer, states] : slid_by_layer) {
    ASSERT_EQ(states.size(), 1) << "layer " << layer;
    layers.push_back(*states.begin());
  }
  EXPECT_FALSE(layers.front());
  EXPECT_FALSE(layers.back());
  int interfaces = 0;
  for (std::size_t k = 1; k < layers.size(); ++k) interfaces += layers[k] != layers[k - 1] ? 1 : 0;
  EXPECT_EQ(interfaces, 4);  // two stacks, each with a lower and an upper interface
  // Every atom still has its three bonds of 1.42 Å.
  const NearGrid grid(sample.atoms.positions, 1.5);
  std::map<int, int> bonds;
  for (const Vec3& p : sample.atoms.positions) {
    int count = 0;
    grid.near(p, [&](Index, double d) { count += d > 0.0 ? 1 : 0; });
    ++bonds[count];
  }
  EXPECT_GT(bonds[3], 9 * static_cast<int>(sample.atoms.size()) / 10);
  EXPECT_EQ(bonds.rbegin()->first, 3);
}

TEST(PalladiumHydrogen, ThinsOutAsDiffusionDoes) {
  const Sample sample = make_sample("palladium-hydrogen");
  const Bounds bounds = bounds_of(sample.atoms.positions);
  const double depth = bounds.extent().x + 3.89 / 2;
  // Hydrogen per octahedral site in eight slabs, against 0.6 erfc(x / 0.3 depth) at the planes of sites they hold.
  constexpr int slabs = 8;
  std::array<double, slabs> found{};
  for (const Index i : sample.truth.extras) {
    const Vec3& p = sample.atoms.positions[i];
    EXPECT_EQ(sample.atoms.species_name(i), "H");
    EXPECT_TRUE(glm::all(glm::greaterThan(p, bounds.min + 1.9)) && glm::all(glm::lessThan(p, bounds.max - 1.9)));
    ++found[static_cast<std::size_t>(slabs * p.x / depth)];
  }
  const auto planes = static_cast<int>(std::lround(depth / (3.89 / 2)));
  const double sites_on_a_plane = 0.5 * std::pow(bounds.extent().y / (3.89 / 2), 2);
  std::array<double, slabs> expected{};
  for (int i = 1; i + 1 < planes; ++i) {
    const double x = static_cast<double>(i) / planes;
    expected[static_cast<std::size_t>(slabs * x)] += sites_on_a_plane * 0.6 * std::erfc(x / 0.3);
  }
  for (std::size_t s = 0; s < slabs; ++s) {
    EXPECT_NEAR(found[s], expected[s], 4.0 * std::sqrt(expected[s]) + 0.06 * expected[s] + 3.0) << "slab " << s;
  }
  EXPECT_GT(found[0], 100.0 * (found[6] + found[7]));
}

TEST(Cacuo2Spiral, IsACylinderWithAHelicalChannel) {
  const Sample sample = make_sample("cacuo2-spiral");
  std::map<std::string, std::size_t> count;
  for (std::size_t i = 0; i < sample.atoms.size(); ++i) ++count[sample.atoms.species_name(i)];
  EXPECT_EQ(count["Ca"], count["Cu"]);
  EXPECT_EQ(count["O"], 2 * count["Cu"]);

  const Bounds bounds = bounds_of(sample.atoms.positions);
  const double radius = 0.5 * bounds.extent().x;
  // In each slice across the axis there is one empty place; its angle turns steadily with height.
  const NearGrid grid(sample.atoms.positions, 7.0);
  double last = 0.0;
  double turned = 0.0;
  const int slices = 40;
  for (int k = 1; k < slices; ++k) {
    const double z = bounds.min.z + bounds.extent().z * k / slices;
    double emptiest = 0.0;
    double angle = 0.0;
    for (int step = 0; step < 360; ++step) {
      const double t = step * std::numbers::pi / 180.0;
      double nearest = 7.0;
      grid.near(Vec3(0.54 * radius * std::cos(t), 0.54 * radius * std::sin(t), z),
                [&](Index, double d) { nearest = std::min(nearest, d); });
      if (nearest > emptiest) {
        emptiest = nearest;
        angle = t;
      }
    }
    EXPECT_GT(emptiest, 6.5) << "slice " << k;
    if (k > 1) turned += std::remainder(angle - last, 2.0 * std::numbers::pi);
    last = angle;
  }
  const double pitch = bounds.extent().z * (slices - 2) / slices * 2.0 * std::numbers::pi / turned;
  EXPECT_NEAR(pitch / radius, 0.9, 0.1);
}

}  // namespace
}  // namespace atomesh
