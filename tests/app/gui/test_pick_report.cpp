// What is said of picks, and where time goes: known answers.
#include <gtest/gtest.h>

#include "app/gui/pick_report.h"
#include "app/gui/time_table.h"
#include "tests/support/lattices.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;

// 4 × 4 × 4 cells of rock salt in a periodic box; without defects.
Material salt() {
  Material material;
  material.atoms = test::periodic_block(test::lattice("nacl").cell, 4, 4, 4);
  return material;
}

Index nearest_atom(const Material& material, const Vec3& place) {
  Index nearest = 0;
  for (Index a = 0; a < material.atoms.size(); ++a) {
    if (glm::length(material.atoms.positions[a] - place) < glm::length(material.atoms.positions[nearest] - place)) {
      nearest = a;
    }
  }
  return nearest;
}

TEST(PickReport, TheWayGoesThroughTheBoundaryWhereThatIsShorter) {
  const Material material = salt();
  const double edge = test::lattice("nacl").cell.primitive[0].x;
  const double side = material.atoms.box.vectors[0].x;
  ASSERT_NEAR(side, 4.0 * edge, 1e-9);
  const Pick first = pick_atom(material, nearest_atom(material, Vec3(0.0)));
  const Pick last = pick_atom(material, nearest_atom(material, Vec3(side - 0.5 * edge, 0.0, 0.0)));
  const PickDistance distance = distance_between(first, last, material);
  EXPECT_TRUE(distance.through_boundary);
  EXPECT_NEAR(distance.length, 0.5 * edge, 1e-9);
  EXPECT_NEAR(distance.way.x, -0.5 * edge, 1e-9);
  EXPECT_NEAR(distance.straight, 3.5 * edge, 1e-9);
  const std::string text = distance_text(distance, material);
  EXPECT_NE(text.find("through a periodic boundary"), std::string::npos) << text;

  const Pick near = pick_atom(material, nearest_atom(material, Vec3(0.5 * edge, 0.0, 0.0)));
  const PickDistance straight = distance_between(first, near, material);
  EXPECT_FALSE(straight.through_boundary);
  EXPECT_NEAR(straight.length, 0.5 * edge, 1e-9);
  EXPECT_EQ(straight.length, straight.straight);
  EXPECT_EQ(distance_text(straight, material).find("boundary"), std::string::npos);
}

TEST(PickReport, WithoutABoxTheWayIsStraight) {
  Material material = salt();
  material.atoms.box = {};
  Pick a;
  a.position = {1, 2, 3};
  Pick b;
  b.position = {1, 2, 15};
  EXPECT_EQ(distance_text(distance_between(a, b, material), material),
            "Distance 12.000 Å, way (0.000, 0.000, 12.000) Å");
  material.atoms = {};
  EXPECT_EQ(distance_text(distance_between(b, a, material), material), "Distance 12.000, way (0.000, 0.000, -12.000)");
}

TEST(PickReport, RowsOfTwoPicksStandSideBySide) {
  Material material = salt();
  material.atoms.columns.push_back({"charge", std::vector<double>(material.atoms.size(), 0.25)});
  const Pick first = pick_atom(material, 0);
  Pick place;  // no atom: only a position and a cell
  place.position = {1, 1, 1};
  place.tetrahedron = 7;
  const auto rows = pick_rows({first, place}, material);
  const auto value = [&](const std::string& label, std::size_t pick) -> std::string {
    for (const PickRow& row : rows) {
      if (row.label == label) return row.values[pick];
    }
    return "no such row";
  };
  EXPECT_EQ(value("Atom", 0), "0");
  EXPECT_EQ(value("Atom", 1), "");
  EXPECT_EQ(value("Position", 1), "1.000, 1.000, 1.000 Å");
  EXPECT_EQ(value("Tetrahedron", 0), "");
  EXPECT_EQ(value("Tetrahedron", 1), "7");
  EXPECT_EQ(value("charge", 0), "0.25");
  EXPECT_TRUE(pick_rows({}, material).empty());
}

TEST(PickReport, TextForTheClipboard) {
  const Material material = salt();
  const Pick first = pick_atom(material, 0);
  ASSERT_EQ(first.neighbours.size(), 6U) << "rock salt";
  const std::string text = pick_text({first, pick_atom(material, first.neighbours[0].atom)}, material);
  std::size_t neighbours = 0;
  for (std::size_t at = text.find("Neighbor\t"); at != std::string::npos; at = text.find("Neighbor\t", at + 1)) {
    ++neighbours;
  }
  EXPECT_EQ(neighbours, 6U);
  EXPECT_NE(text.find("Species\tNa\tCl\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\nDistance 2.8"), std::string::npos) << text;
  EXPECT_EQ(pick_text({}, material), "");
}

TEST(TimeTable, PartsOfTheWholeAndOfTheLongest) {
  const std::vector<StageTime> stages{{"read", 100.0}, {"tetrahedralize", 300.0}, {"carve", 0.0}};
  const auto rows = time_rows(stages, {1000, 0});
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(total_ms(stages), 400.0);
  EXPECT_DOUBLE_EQ(rows[0].of_all, 0.25);
  EXPECT_DOUBLE_EQ(rows[0].of_longest, 1.0 / 3.0);
  EXPECT_EQ(rows[1].of_longest, 1.0);
  EXPECT_EQ(rows[2].of_all, 0.0);
  EXPECT_EQ(rows[0].memory, 1000U);
  EXPECT_EQ(rows[1].memory, std::nullopt);
  EXPECT_EQ(rows[2].memory, std::nullopt);
  EXPECT_EQ(time_rows({{"nothing", 0.0}}, {})[0].of_longest, 0.0);
}

TEST(TimeTable, TimesAsText) {
  EXPECT_EQ(time_text(0.123), "0.12 ms");
  EXPECT_EQ(time_text(12.34), "12.3 ms");
  EXPECT_EQ(time_text(831.2), "831 ms");
  EXPECT_EQ(time_text(999.6), "1.00 s");
  EXPECT_EQ(time_text(12345.0), "12.3 s");
  EXPECT_EQ(time_text(200400.0), "3 min 20 s");
}

TEST(FrameClock, FirstAndWholePictureOfAnOrder) {
  FrameClock clock;
  FrameTimes frame;
  frame.level = 1;
  frame.levels = 3;
  FrameTimes shown = clock.shown(frame, 1, 20.0, 1000.0);
  EXPECT_EQ(shown.first_ms, 20.0);
  EXPECT_EQ(shown.whole_ms, std::nullopt);
  EXPECT_EQ(shown.per_second, std::nullopt);
  frame.level = 3;
  shown = clock.shown(frame, 1, 180.0, 1160.0);
  EXPECT_EQ(shown.first_ms, 20.0);
  EXPECT_EQ(shown.whole_ms, 180.0);
  EXPECT_EQ(shown.per_second, std::nullopt) << "one order is no movement";
}

TEST(FrameClock, PicturesASecondWhileTheViewMoves) {
  FrameClock clock;
  FrameTimes shown;
  for (std::uint64_t n = 0; n < 50; ++n) shown = clock.shown({}, n + 1, 8.0, 1000.0 + 40.0 * static_cast<double>(n));
  ASSERT_TRUE(shown.per_second);
  EXPECT_NEAR(*shown.per_second, 25.0, 1e-9);
  // A pause ends the movement.
  shown = clock.shown({}, 51, 8.0, 10000.0);
  EXPECT_EQ(shown.per_second, std::nullopt);
  shown = clock.shown({}, 52, 8.0, 10100.0);
  ASSERT_TRUE(shown.per_second);
  EXPECT_NEAR(*shown.per_second, 10.0, 1e-9);
}

}  // namespace
