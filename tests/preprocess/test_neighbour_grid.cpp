// Cell lists against looking at every point and every image.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "preprocess/neighbour_grid.h"
#include "tests/support/lattices.h"

namespace atomesh::test {
namespace {

struct Hit {
  Index point;
  Vec3 position;
};

// Every image of every point within the radius of the centre. The points lie up to 6 boxes outside a small one.
std::vector<Hit> brute_force(std::span<const Vec3> points, const Box& box, const Vec3& centre, double radius) {
  std::array<int, 3> reach{};
  for (int k = 0; k < 3; ++k) reach[k] = !box.periodic[k] ? 0 : box.volume() < 20.0 ? 14 : 5;
  std::vector<Hit> hits;
  for (Index i = 0; i < points.size(); ++i) {
    for (int a = -reach[0]; a <= reach[0]; ++a) {
      for (int b = -reach[1]; b <= reach[1]; ++b) {
        for (int c = -reach[2]; c <= reach[2]; ++c) {
          const Vec3 p = points[i] + box.matrix() * Vec3(a, b, c);
          if (glm::length(p - centre) <= radius) hits.push_back({i, p});
        }
      }
    }
  }
  return hits;
}

void sort_hits(std::vector<Hit>& hits) {
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
    if (a.point != b.point) return a.point < b.point;
    for (int k = 0; k < 3; ++k) {
      if (std::abs(a.position[k] - b.position[k]) > 1e-6) return a.position[k] < b.position[k];
    }
    return false;
  });
}

void expect_same_as_brute_force(std::span<const Vec3> points, const Box& box, double reach, double cell,
                                const std::string& what) {
  const NeighbourGrid grid(points, box, reach, cell);
  EXPECT_EQ(grid.home_slots().size(), points.size()) << what;
  std::vector<Index> slots;
  for (std::size_t h = 0; h < grid.home_slots().size(); h += 7) {
    for (const double radius : {0.4 * reach, reach}) {
      const Vec3 centre = grid.position(grid.home_slots()[h]);
      grid.find(centre, radius, slots);
      ASSERT_LE(slots.size(), grid.count_candidates(centre, radius)) << what;
      std::vector<Hit> found;
      for (const Index slot : slots) found.push_back({grid.point(slot), grid.position(slot)});
      std::vector<Hit> expected = brute_force(points, box, centre, radius);
      sort_hits(found);
      sort_hits(expected);
      ASSERT_EQ(found.size(), expected.size()) << what;
      for (std::size_t n = 0; n < found.size(); ++n) {
        ASSERT_EQ(found[n].point, expected[n].point) << what;
        ASSERT_NEAR(glm::distance(found[n].position, expected[n].position), 0.0, 1e-9) << what;
      }
      grid.find(centre, radius, slots, grid.home_slots()[h]);
      ASSERT_EQ(slots.size() + 1, expected.size()) << what;
    }
  }
}

Box make_box(const Vec3& a, const Vec3& b, const Vec3& c, std::array<bool, 3> periodic) {
  return {Vec3(-3, 1, 2), {a, b, c}, periodic};
}

TEST(NeighbourGrid, FindsWhatLookingAtEveryImageFinds) {
  const Vec3 x(11, 0, 0);
  const Vec3 y(-4, 9, 0);
  const Vec3 z(2, 3, 10);
  const std::vector<Vec3> points = random_atoms(400, 12.0, 5).positions;
  for (const double reach : {1.5, 4.0}) {
    expect_same_as_brute_force(points, Box{}, reach, reach, "open");
    expect_same_as_brute_force(points, Box{}, reach, 0.3 * reach, "open, small cells");
    expect_same_as_brute_force(points, make_box(x, y, z, {true, true, true}), reach, reach, "triclinic");
    expect_same_as_brute_force(points, make_box(x, y, z, {false, true, false}), reach, reach, "one axis");
    expect_same_as_brute_force(points, make_box(y, x, z, {true, false, true}), reach, 2.0 * reach, "left-handed");
  }
  const std::vector<Vec3> few(points.begin(), points.begin() + 9);
  expect_same_as_brute_force(few, make_box(0.2 * x, 0.2 * y, 0.2 * z, {true, true, true}), 4.0, 4.0, "box below reach");
}

TEST(NeighbourGrid, FindsInSamplesOfMostlyEmptySpace) {
  std::vector<Vec3> points = random_atoms(200, 6.0, 8).positions;
  for (int n = 0; n < 100; ++n) points.push_back(Vec3(1e5, -2e6, 3e5) + 0.01 * points[n]);
  for (int n = 0; n < 100; ++n) points.push_back(Vec3(1e4) * static_cast<double>(n));
  expect_same_as_brute_force(points, Box{}, 2.0, 2.0, "clusters far apart");
  expect_same_as_brute_force(std::span(points).first(1), Box{}, 2.0, 2.0, "one point");
  const NeighbourGrid nobody({}, Box{}, 2.0, 2.0);
  std::vector<Index> slots{1, 2};
  nobody.find(Vec3(0.0), 2.0, slots);
  EXPECT_TRUE(slots.empty());
}

TEST(NeighbourGrid, WrapsIntoTheBoxAndNamesItsBorderOnce) {
  const Box box = make_box(Vec3(10, 0, 0), Vec3(2, 8, 0), Vec3(0, 1, 5), {true, true, false});
  const NeighbourGrid grid({}, box, 1.0, 1.0);
  for (const Vec3& f : {Vec3(0.3, 0.7, 0.2), Vec3(0.0), Vec3(-3.7, 12.01, 0.9), Vec3(1.0, -1e-12, 4.5)}) {
    const Vec3 wrapped = grid.wrap(box.origin + box.matrix() * f);
    const Vec3 fraction = glm::inverse(box.matrix()) * (wrapped - box.origin);
    for (int k = 0; k < 2; ++k) {
      EXPECT_GT(fraction[k], -2e-9);
      EXPECT_LT(fraction[k], 1.0 - 0.9e-9);
    }
    EXPECT_NEAR(fraction.z, f.z, 1e-12);  // open: left where it is
  }
  EXPECT_NEAR(glm::length(grid.nearest_image(0.9 * box.vectors[0])), 1.0, 1e-12);
  EXPECT_NEAR(glm::length(grid.nearest_image(0.9 * box.vectors[2])), 0.9 * glm::length(box.vectors[2]), 1e-12);
}

TEST(NeighbourGrid, RefusesWhatItCannotHold) {
  const std::vector<Vec3> bad{Vec3(0.0), Vec3(1, std::nan(""), 0)};
  EXPECT_THROW(NeighbourGrid(bad, Box{}, 1.0, 1.0), Error);
  const std::vector<Vec3> good{Vec3(0.0)};
  const Box flat = make_box(Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0), {true, true, true});
  EXPECT_THROW(NeighbourGrid(good, flat, 1.0, 1.0), Error);
  const Box thin = make_box(Vec3(1e-7, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), {true, false, false});
  EXPECT_THROW(NeighbourGrid(good, thin, 1.0, 1.0), Error);
}

TEST(NeighbourGrid, MedianNearestDistanceOfEveryLattice) {
  for (const Lattice& crystal : lattices()) {
    const Atoms atoms = periodic_block(crystal.cell, 4, 4, 3);
    // Half of perovskite's atoms are oxygen, which see titanium; the median is the nearest distance everywhere.
    EXPECT_NEAR(median_nearest_distance(atoms.positions, atoms.box), crystal.nearest_neighbour, 1e-9) << crystal.name;
  }
  EXPECT_EQ(median_nearest_distance({}, Box{}), 0.0);
  const std::vector<Vec3> pair{Vec3(0.0), Vec3(300, 400, 0)};
  EXPECT_NEAR(median_nearest_distance(pair, Box{}), 500.0, 1e-9);
  EXPECT_EQ(median_nearest_distance(std::span(pair).first(1), Box{}), 0.0);
  // One atom far away does not matter.
  std::vector<Vec3> line;
  for (int n = 0; n < 100; ++n) line.push_back(Vec3(2.5 * n, 0, 0));
  line.push_back(Vec3(1e7, 1e7, 0));
  EXPECT_NEAR(median_nearest_distance(line, Box{}), 2.5, 1e-9);
}

}  // namespace
}  // namespace atomesh::test
