#include <gtest/gtest.h>

#include <set>

#include "core/elements.h"

namespace atomesh {
namespace {

TEST(Elements, KnownRows) {
  struct Row {
    int number;
    const char* symbol;
    std::array<std::uint8_t, 3> color;
    double radius;
    double mass;
  };
  const Row rows[] = {{1, "H", {255, 255, 255}, 0.31, 1.008},   {6, "C", {144, 144, 144}, 0.76, 12.011},
                      {8, "O", {255, 13, 13}, 0.66, 15.999},    {11, "Na", {171, 92, 242}, 1.66, 22.990},
                      {17, "Cl", {31, 240, 31}, 1.02, 35.45},   {29, "Cu", {200, 128, 51}, 1.32, 63.546},
                      {46, "Pd", {0, 105, 133}, 1.39, 106.42},  {74, "W", {33, 148, 214}, 1.62, 183.84},
                      {79, "Au", {255, 209, 35}, 1.36, 196.97}, {92, "U", {0, 143, 255}, 1.96, 238.03},
                      {109, "Mt", {235, 0, 38}, 1.5, 0.0}};
  for (const Row& row : rows) {
    const Element* element = find_element(row.symbol);
    ASSERT_NE(element, nullptr) << row.symbol;
    EXPECT_EQ(element, find_element(row.number));
    EXPECT_EQ(element->number, row.number);
    EXPECT_EQ(element->color, row.color) << row.symbol;
    EXPECT_EQ(element->radius, row.radius) << row.symbol;
    EXPECT_EQ(element->mass, row.mass) << row.symbol;
  }
}

TEST(Elements, TheTableIsCompleteAndInOrder) {
  std::set<std::string_view> symbols;
  for (int number = 1; number <= 109; ++number) {
    const Element* element = find_element(number);
    ASSERT_NE(element, nullptr);
    EXPECT_EQ(element->number, number);
    symbols.insert(element->symbol);
    EXPECT_GE(element->radius, 0.28);
    EXPECT_LE(element->radius, 2.60);
    // No two neighbours are nearer than the tolerance of find_element_by_mass.
    if (element->mass > 0.0) {
      EXPECT_EQ(find_element_by_mass(element->mass), element) << element->symbol;
    }
  }
  EXPECT_EQ(symbols.size(), 109u);
  EXPECT_EQ(find_element(0), nullptr);
  EXPECT_EQ(find_element(110), nullptr);
  EXPECT_EQ(find_element("na"), nullptr);
  EXPECT_EQ(find_element(""), nullptr);
}

TEST(Elements, MassesAsLammpsFilesWriteThem) {
  const std::pair<double, const char*> masses[] = {{28.0855, "Si"}, {72.64, "Ge"}, {12.0107, "C"}, {12.0, "C"},
                                                   {15.9994, "O"},  {95.94, "Mo"}, {63.55, "Cu"},  {26.98, "Al"},
                                                   {58.71, "Ni"},   {58.93, "Co"}};
  for (const auto& [mass, symbol] : masses) {
    ASSERT_NE(find_element_by_mass(mass), nullptr) << mass;
    EXPECT_EQ(find_element_by_mass(mass)->symbol, symbol);
  }
  for (const double none : {0.0, -1.0, 2.0, 100.0, 1e9}) EXPECT_EQ(find_element_by_mass(none), nullptr) << none;
}

TEST(Elements, DefaultsOfSpecies) {
  EXPECT_EQ(default_species_color("Si", 5), (std::array<std::uint8_t, 3>{240, 200, 160}));
  EXPECT_EQ(default_species_radius("Si"), 1.11);
  EXPECT_EQ(default_species_radius("Ow"), 1.0);
  // Types without an element: twelve colours that differ, then again from the first.
  std::set<std::array<std::uint8_t, 3>> colors;
  for (std::size_t i = 0; i < 12; ++i) colors.insert(default_species_color("1", i));
  EXPECT_EQ(colors.size(), 12u);
  EXPECT_EQ(default_species_color("1", 12), default_species_color("1", 0));
}

}  // namespace
}  // namespace atomesh
