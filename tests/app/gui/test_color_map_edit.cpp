// Whatever is done to a colour map's entries, it stays a map that can be drawn, and does what was meant.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "app/gui/color_map_edit.h"
#include "core/error.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;

// red 0 … green 0.5 … blue 1, opacity as the scalar.
ColorMap three() {
  return {{{0.0, {1, 0, 0, 0}}, {0.5, {0, 1, 0, 0.5F}}, {1.0, {0, 0, 1, 1}}}};
}

float difference(const Vec4f& a, const Vec4f& b) {
  const Vec4f d = glm::abs(a - b);
  return std::max({d.r, d.g, d.b, d.a});
}

TEST(ColorMapEdit, AnInsertedEntryChangesNothing) {
  ColorMap map = three();
  EXPECT_EQ(insert_entry(map, 0.25), 1U);
  ASSERT_EQ(map.entries.size(), 4U);
  EXPECT_EQ(map.entries[1], (ColorMapEntry{0.25, {0.5F, 0.5F, 0, 0.25F}}));
  for (int i = 0; i <= 64; ++i) EXPECT_LE(difference(map(i / 64.0), three()(i / 64.0)), 1e-6F) << i;
}

TEST(ColorMapEdit, AnEntryInsertedAtAnothersPlaceComesBehindIt) {
  ColorMap map = three();
  EXPECT_EQ(insert_entry(map, 0.5), 2U);
  set_entry_color(map, 2, {1, 1, 1});
  check_color_map(map);
  EXPECT_EQ(map(0.5), Vec4f(1, 1, 1, 0.5F)) << "a jump: the later entry holds";
  EXPECT_LE(difference(map(0.5 - 1e-9), Vec4f(0, 1, 0, 0.5F)), 1e-6F);
}

TEST(ColorMapEdit, InsertClampsAndTakesAnOpacity) {
  ColorMap map = three();
  EXPECT_EQ(insert_entry(map, 7.0, 2.0F), 3U);
  EXPECT_EQ(map.entries[3], (ColorMapEntry{1.0, {0, 0, 1, 1}}));
  EXPECT_EQ(insert_entry(map, std::nan("")), 1U);
  check_color_map(map);
}

TEST(ColorMapEdit, NoMoreThan32AndNoFewerThan2) {
  ColorMap map = three();
  while (map.entries.size() < 32) insert_entry(map, 0.3);
  check_color_map(map);
  const ColorMap full = map;
  EXPECT_THROW(insert_entry(map, 0.3), UsageError);
  EXPECT_EQ(map, full);
  while (map.entries.size() > 2) remove_entry(map, 1);
  EXPECT_THROW(remove_entry(map, 0), UsageError);
  EXPECT_THROW(remove_entry(map, 2), UsageError);
  check_color_map(map);
  EXPECT_EQ(map.entries.front(), three().entries.front());
  EXPECT_EQ(map.entries.back(), three().entries.back());
}

TEST(ColorMapEdit, ADraggedEntryStopsAtItsNeighbours) {
  ColorMap map = three();
  move_entry(map, 1, 0.7, 0.25F);
  EXPECT_EQ(map.entries[1], (ColorMapEntry{0.7, {0, 1, 0, 0.25F}}));
  move_entry(map, 1, 3.0, 9.0F);
  EXPECT_EQ(map.entries[1], (ColorMapEntry{1.0, {0, 1, 0, 1}}));
  move_entry(map, 1, -3.0, -9.0F);
  EXPECT_EQ(map.entries[1], (ColorMapEntry{0.0, {0, 1, 0, 0}}));
  check_color_map(map);
  move_entry(map, 0, 0.5, 0.0F);  // its neighbour came to 0
  EXPECT_EQ(map.entries[0].scalar, 0.0);
  move_entry(map, 2, 0.25, 1.0F);
  EXPECT_EQ(map.entries[2].scalar, 0.25);
  move_entry(map, 2, std::nan(""), std::nanf(""));
  check_color_map(map);
  EXPECT_EQ(map.entries[2].scalar, 0.25);
}

TEST(ColorMapEdit, ATypedScalarMovesTheEntryPastOthers) {
  ColorMap map = three();
  EXPECT_EQ(set_entry_scalar(map, 0, 0.75), 1U);
  check_color_map(map);
  EXPECT_EQ(map.entries[1], (ColorMapEntry{0.75, {1, 0, 0, 0}}));
  EXPECT_EQ(set_entry_scalar(map, 1, 0.75), 1U);
  EXPECT_EQ(set_entry_scalar(map, 0, 1.0), 2U) << "behind the one that is there";
  check_color_map(map);
  const ColorMap before = map;
  EXPECT_THROW(set_entry_scalar(map, 0, 1.5), UsageError);
  EXPECT_THROW(set_entry_scalar(map, 0, std::nan("")), UsageError);
  EXPECT_THROW(set_entry_scalar(map, 3, 0.5), UsageError);
  EXPECT_THROW(set_entry_color(map, 0, {2, 0, 0}), UsageError);
  EXPECT_THROW(set_entry_opacity(map, 0, -0.1F), UsageError);
  EXPECT_EQ(map, before);
}

TEST(ColorMapEdit, ReversedTwiceIsTheSame) {
  for (const std::string& name : preset_color_map_names()) {
    ColorMap map = preset_color_map(name);
    reverse_color_map(map);
    check_color_map(map);
    for (int i = 0; i <= 32; ++i) {
      EXPECT_LE(difference(map(i / 32.0), preset_color_map(name)(1.0 - i / 32.0)), 1e-5F) << name << ' ' << i;
    }
    reverse_color_map(map);
    ASSERT_EQ(map.entries.size(), preset_color_map(name).entries.size());
    for (int i = 0; i <= 32; ++i) {
      EXPECT_LE(difference(map(i / 32.0), preset_color_map(name)(i / 32.0)), 1e-5F) << name << ' ' << i;
    }
  }
}

TEST(ColorMapEdit, AReversedJumpStaysAJump) {
  ColorMap map{{{0.0, {0, 0, 0, 0}}, {0.25, {0, 0, 0, 0}}, {0.25, {1, 1, 1, 1}}, {1.0, {1, 1, 1, 1}}}};
  reverse_color_map(map);
  check_color_map(map);
  EXPECT_EQ(map(0.74), Vec4f(1, 1, 1, 1));
  EXPECT_EQ(map(0.76), Vec4f(0, 0, 0, 0));
}

TEST(ColorMapEdit, ColorsOfOneMapOpacitiesOfAnother) {
  const ColorMap bumps{{{0.0, {1, 1, 1, 0}}, {0.3, {1, 1, 1, 0.9F}}, {0.35, {1, 1, 1, 0.1F}}, {1.0, {1, 1, 1, 0.4F}}}};
  const ColorMap both = combined_map(preset_color_map("viridis"), bumps);
  check_color_map(both);
  for (int i = 0; i <= 1000; ++i) {
    const double s = i / 1000.0;
    const Vec4f expected{Vec3f(preset_color_map("viridis")(s)), bumps(s).a};
    EXPECT_LE(difference(both(s), expected), 1.0F / 4096.0F + 1e-6F) << s;
  }
  ColorMap map = bumps;
  apply_color_map(map, preset_color_map("viridis"), ColorMapPart::color);
  EXPECT_EQ(map, both);
  apply_color_map(map, preset_color_map("gray"), ColorMapPart::all);
  EXPECT_EQ(map, preset_color_map("gray"));
}

TEST(ColorMapEdit, EntriesThatSayNothingGo) {
  ColorMap map = preset_color_map("gray");
  apply_color_map(map, preset_color_map("viridis"), ColorMapPart::color);
  EXPECT_EQ(map.entries.size(), preset_color_map("viridis").entries.size());
  apply_color_map(map, preset_color_map("gray"), ColorMapPart::color);
  ASSERT_EQ(map.entries.size(), 2U);
  EXPECT_EQ(map, preset_color_map("gray"));
}

TEST(ColorMapEdit, JumpsOfEitherMapAreKept) {
  ColorMap map = preset_color_map("blue-white-red");
  apply_color_map(map, opacity_curve("threshold"), ColorMapPart::opacity);
  check_color_map(map);
  EXPECT_EQ(map(0.4999).a, 0.0F);
  EXPECT_EQ(map(0.5).a, 1.0F);
  EXPECT_EQ(map.entries.size(), 4U);
  EXPECT_EQ(preset_of_colors(map), "blue-white-red");
}

TEST(ColorMapEdit, ThirtyTwoEntriesHoldWhatMattersMost) {
  // 18 of viridis between 31 others, each a bump of opacity but one small one: 49 places for 32 entries.
  ColorMap bumps;
  for (int i = 0; i <= 30; ++i) bumps.entries.push_back({i / 30.0, {0, 0, 0, i % 2 == 0 ? 0.0F : 1.0F}});
  const ColorMap both = combined_map(preset_color_map("viridis"), bumps);
  check_color_map(both);
  EXPECT_EQ(both.entries.size(), 32U);
  EXPECT_EQ(both.entries.front().scalar, 0.0);
  EXPECT_EQ(both.entries.back().scalar, 1.0);
  for (int i = 0; i <= 1000; ++i) EXPECT_LE(std::abs(both(i / 1000.0).a - bumps(i / 1000.0).a), 0.05F) << i;
}

TEST(ColorMapEdit, OpacityCurvesAreWhatTheirNamesSay) {
  ASSERT_EQ(opacity_curve_names().size(), 5U);
  for (const std::string& name : opacity_curve_names()) check_color_map(opacity_curve(name));
  for (int i = 0; i <= 100; ++i) {
    const double s = i / 100.0;
    EXPECT_EQ(opacity_curve("opaque")(s).a, 1.0F);
    EXPECT_NEAR(opacity_curve("ramp")(s).a, s, 1e-6);
    EXPECT_NEAR(opacity_curve("square")(s).a, s * s, 1.0 / 256.0 + 1e-6);
    EXPECT_EQ(opacity_curve("threshold")(s).a, i < 50 ? 0.0F : 1.0F);
    EXPECT_NEAR(opacity_curve("upper-half")(s).a, std::max(0.0, 2.0 * s - 1.0), 1e-6);
  }
  try {
    opacity_curve("threshhold");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("threshold"), std::string::npos) << error.what();
  }
}

TEST(ColorMapEdit, PresetsAreKnownByTheirColors) {
  for (const std::string& name : preset_color_map_names()) {
    ColorMap map = preset_color_map(name);
    EXPECT_EQ(preset_of_colors(map), name);
    apply_color_map(map, opacity_curve("square"), ColorMapPart::opacity);
    EXPECT_EQ(preset_of_colors(map), name);
    set_entry_color(map, map.entries.size() / 2, {0.123F, 0.9F, 0.5F});
    EXPECT_EQ(preset_of_colors(map), std::nullopt) << name;
  }
}

TEST(ColorMapEdit, Snapping) {
  EXPECT_DOUBLE_EQ(snapped(0.234, 0.05), 0.25);
  EXPECT_DOUBLE_EQ(snapped(0.224, 0.05), 0.2);
  EXPECT_DOUBLE_EQ(snapped(0.224, 0.0), 0.224);
}

TEST(ColorMapEdit, TheEntryUnderTheMouse) {
  const ColorMap map = three();  // handles at (0,0), (200,50), (400,100) of 400 × 100
  EXPECT_EQ(entry_at(map, 203, 52, 400, 100, 8), 1U);
  EXPECT_EQ(entry_at(map, 203, 62, 400, 100, 8), std::nullopt);
  EXPECT_EQ(entry_at(map, 398, 97, 400, 100, 8), 2U);
  EXPECT_EQ(entry_at(map, 0, 8, 400, 100, 8), 0U) << "at the very reach";
  // Two at one place: the one that has somewhere to go.
  ColorMap twins = map;
  insert_entry(twins, 0.5);
  EXPECT_EQ(entry_at(twins, 200, 50, 400, 100, 8), 2U);
  insert_entry(twins, 1.0);
  EXPECT_EQ(entry_at(twins, 400, 100, 400, 100, 8), 3U);
}

TEST(ColorMapEdit, AThousandRandomEditsLeaveAValidMap) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-0.2, 1.2);
  ColorMap map = three();
  for (int step = 0; step < 1000; ++step) {
    const std::size_t index = random() % map.entries.size();
    try {
      switch (random() % 6) {
        case 0:
          insert_entry(map, unit(random), static_cast<float>(unit(random)));
          break;
        case 1:
          remove_entry(map, index);
          break;
        case 2:
          move_entry(map, index, unit(random), static_cast<float>(unit(random)));
          break;
        case 3:
          set_entry_scalar(map, index, unit(random));
          break;
        case 4:
          reverse_color_map(map, static_cast<ColorMapPart>(random() % 3));
          break;
        case 5:
          if (step % 7 == 0) apply_color_map(map, preset_color_map("cividis"), ColorMapPart::color);
          break;
      }
    } catch (const UsageError&) {
      // refused; the map must still be one
    }
    ASSERT_NO_THROW(check_color_map(map)) << "step " << step;
  }
}

}  // namespace
