// What is known of an atom, and the shortest way through periodic boundaries.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "app/gui/periodic_images.h"
#include "app/gui/pick.h"
#include "core/error.h"
#include "tests/support/lattices.h"

namespace atomesh::gui {
namespace {

Box box_of(const Vec3& a, const Vec3& b, const Vec3& c, std::array<bool, 3> periodic = {true, true, true}) {
  Box box;
  box.origin = {0.3, -2.0, 1.0};
  box.vectors = {a, b, c};
  box.periodic = periodic;
  return box;
}

// The judge: many images.
double shortest_by_force(const Box& box, const Vec3& d, int reach) {
  double best = glm::length(d);
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) {
      for (int k = -reach; k <= reach; ++k) {
        if ((i != 0 && !box.periodic[0]) || (j != 0 && !box.periodic[1]) || (k != 0 && !box.periodic[2])) continue;
        const Vec3 image = d + 1.0 * i * box.vectors[0] + 1.0 * j * box.vectors[1] + 1.0 * k * box.vectors[2];
        best = std::min(best, glm::length(image));
      }
    }
  }
  return best;
}

TEST(ShortestWay, AgainstAllImagesOfSkewBoxes) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int through = 0;
  for (int n = 0; n < 400; ++n) {
    // Up to very skew: the third vector leans over the others.
    const Vec3 a(4.0 + unit(random), unit(random), unit(random));
    const Vec3 b = Vec3(0, 5, 0) + 3.0 * normal(random) * a / 4.0 + 0.3 * Vec3(unit(random), 0, unit(random));
    const Vec3 c = Vec3(0, 0, 3) + unit(random) * a + 1.5 * unit(random) * b;
    const std::array<bool, 3> periodic{n % 2 == 0, n % 3 != 0, n % 5 < 3};
    const Box box = box_of(a, b, c, periodic);
    const Vec3 from = box.origin + std::abs(unit(random)) * a + std::abs(unit(random)) * b;
    const Vec3 to = box.origin + std::abs(unit(random)) * a + std::abs(unit(random)) * b + std::abs(unit(random)) * c;
    const Vec3 way = shortest_way(box, from, to);
    EXPECT_NEAR(glm::length(way), shortest_by_force(box, to - from, 14), 1e-9);
    // It leads from `from` to an image of `to`.
    const Vec3 images = glm::inverse(box.matrix()) * (from + way - to);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(images[k], std::round(images[k]), 1e-7);
      if (!periodic[k]) {
        EXPECT_NEAR(images[k], 0.0, 1e-7);
      }
    }
    through += glm::length(from + way - to) > 1e-6 ? 1 : 0;
  }
  EXPECT_GT(through, 100);
}

TEST(ShortestWay, KnownAnswers) {
  const Box cube = box_of({10, 0, 0}, {0, 10, 0}, {0, 0, 10}, {true, false, true});
  EXPECT_EQ(shortest_way(cube, {1, 1, 1}, {9, 9, 9}), Vec3(-2, 8, -2));
  // As short both ways: the straight one.
  EXPECT_EQ(shortest_way(cube, {1, 1, 1}, {6, 1, 1}), Vec3(5, 0, 0));
  EXPECT_EQ(shortest_way(cube, {6, 1, 1}, {1, 1, 1}), Vec3(-5, 0, 0));
  EXPECT_EQ(shortest_way(Box{}, {1, 1, 1}, {9, 9, 9}), Vec3(8, 8, 8));
  // Many boxes away, as unwrapped coordinates are.
  EXPECT_NEAR(glm::length(shortest_way(cube, {1, 1, 1}, {1234, 1, 1}) - Vec3(3, 0, 0)), 0.0, 1e-9);
  // A slab: far across it, and periodic within.
  const Box slab = box_of({10, 0, 0}, {3, 10, 0}, {0, 0, 10}, {true, true, false});
  EXPECT_NEAR(glm::length(shortest_way(slab, Vec3(0.0), {12.5, 9.5, 500}) - Vec3(-0.5, -0.5, 500)), 0.0, 1e-9);
}

TEST(PeriodicImages, AllWithinARadius) {
  const Box box = box_of({4, 0, 0}, {1.5, 3, 0}, {-1, 2, 5});
  const PeriodicImages images(box);
  const Vec3 d(0.3, 11.0, -7.0);
  const double radius = 12.0;
  int expected = 0;
  for (int i = -20; i <= 20; ++i) {
    for (int j = -20; j <= 20; ++j) {
      for (int k = -20; k <= 20; ++k) {
        const Vec3 image = d + 1.0 * i * box.vectors[0] + 1.0 * j * box.vectors[1] + 1.0 * k * box.vectors[2];
        expected += glm::length(image) <= radius ? 1 : 0;
      }
    }
  }
  int found = 0;
  images.for_each_within(d, radius, [&](const Vec3& image) {
    EXPECT_LE(glm::length(image), radius);
    ++found;
  });
  EXPECT_EQ(found, expected);
  EXPECT_GT(found, 50);
}

// Every atom of a periodic crystal has the neighbours of the textbook, at the border too.
TEST(PickAtom, NeighboursOfPeriodicCrystals) {
  struct Case {
    const char* name;
    std::size_t neighbours;
  };
  for (const Case& c : {Case{"fcc", 12}, {"bcc", 14}, {"diamond", 4}, {"nacl", 6}, {"sc", 6}}) {
    const test::Lattice& lattice = test::lattice(c.name);
    for (const int cells : {1, 3}) {
      Material material;
      material.atoms = test::periodic_block(lattice.cell, cells, cells, cells);
      for (const std::size_t atom : {std::size_t{0}, material.atoms.size() / 2, material.atoms.size() - 1}) {
        const Pick pick = pick_atom(material, static_cast<Index>(atom));
        ASSERT_EQ(pick.neighbours.size(), c.neighbours) << c.name << " " << cells;
        EXPECT_NEAR(pick.neighbours.front().distance, lattice.nearest_neighbour, 1e-9);
        EXPECT_EQ(pick.position, material.atoms.positions[atom]);
      }
    }
  }
}

TEST(PickAtom, NeighboursAgainstAllPairs) {
  Material material;
  material.atoms = test::random_atoms(300, 12.0, 9);
  material.atoms.box = box_of({12, 0, 0}, {5, 12, 0}, {-4, 3, 12}, {true, false, true});
  for (Index atom = 0; atom < 300; atom += 7) {
    double nearest = 1e9;
    std::vector<double> distances;
    for (Index other = 0; other < 300; ++other) {
      for (int i = -2; i <= 2; ++i) {
        for (int k = -2; k <= 2; ++k) {
          const Vec3 image = material.atoms.positions[other] + 1.0 * i * material.atoms.box.vectors[0] +
                             1.0 * k * material.atoms.box.vectors[2];
          const double distance = glm::length(image - material.atoms.positions[atom]);
          if (distance < 1e-9) continue;
          distances.push_back(distance);
          nearest = std::min(nearest, distance);
        }
      }
    }
    std::erase_if(distances, [nearest](double d) { return d > 1.3 * nearest; });
    std::sort(distances.begin(), distances.end());
    const Pick pick = pick_atom(material, atom);
    ASSERT_EQ(pick.neighbours.size(), distances.size());
    for (std::size_t n = 0; n < distances.size(); ++n) EXPECT_NEAR(pick.neighbours[n].distance, distances[n], 1e-9);
  }
}

TEST(PickAtom, AloneAndTwoAtOnePlace) {
  Material material;
  material.atoms = test::atoms_at({{1, 2, 3}});
  EXPECT_TRUE(pick_atom(material, 0).neighbours.empty());
  EXPECT_THROW(pick_atom(material, 1), UsageError);
  material.atoms = test::atoms_at({{1, 2, 3}, {1, 2, 3}, {2, 2, 3}, {9, 9, 9}});
  const Pick pick = pick_atom(material, 0);
  ASSERT_EQ(pick.neighbours.size(), 2U);
  EXPECT_EQ(pick.neighbours[0].atom, 1U);
  EXPECT_EQ(pick.neighbours[1].atom, 2U);
  // All at one place.
  material.atoms = test::atoms_at({{1, 2, 3}, {1, 2, 3}});
  EXPECT_EQ(pick_atom(material, 0).neighbours.size(), 1U);
}

TEST(Describe, SaysWhatIsKnown) {
  Material material;
  material.atoms = test::cut_block(test::lattice("nacl").cell, 2, 2, 2);
  const std::size_t count = material.atoms.size();
  material.atoms.ids.resize(count);
  for (std::size_t a = 0; a < count; ++a) material.atoms.ids[a] = 100 + static_cast<std::int64_t>(a);
  material.atoms.columns.push_back({"charge", std::vector<double>(count, 0.75)});
  material.defects.positional.assign(count, 0.25F);
  material.defects.extra.assign(count, 1.0F);
  material.defects.vacancy.assign(count, 2.0F);
  material.defects.extras.push_back({3, 4});
  const auto rows = describe(pick_atom(material, 3), material);
  const auto value = [&rows](const std::string& label) {
    for (const auto& [name, text] : rows) {
      if (name == label) return text;
    }
    return std::string("no such row");
  };
  EXPECT_EQ(value("Atom"), "3");
  EXPECT_EQ(value("Id"), "103");
  EXPECT_EQ(value("Species"), material.atoms.species_name(3));
  EXPECT_EQ(value("Positional defect"), "0.25");
  EXPECT_EQ(value("Extra atom defect"), "1");
  EXPECT_EQ(value("Vacancy defect"), "2");
  EXPECT_EQ(value("Defect"), "extra atom");
  EXPECT_EQ(value("charge"), "0.75");
  EXPECT_NE(value("Neighbors").find(" at 2.8"), std::string::npos) << value("Neighbors");
  EXPECT_NE(value("Position").find(" Å"), std::string::npos);
  EXPECT_EQ(value("Tetrahedron"), "no such row");
}

}  // namespace
}  // namespace atomesh::gui
