#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/color_map.h"
#include "core/error.h"

namespace atomesh {
namespace {

TEST(ColorMap, InterpolatesBetweenEntriesAndIsConstantOutside) {
  const ColorMap map{{{0.25, {0, 0, 0, 0}}, {0.75, {1, 0.5F, 0, 1}}}};
  EXPECT_EQ(map(0.0), Vec4f(0, 0, 0, 0));
  EXPECT_EQ(map(0.5), Vec4f(0.5F, 0.25F, 0, 0.5F));
  EXPECT_EQ(map(1.0), Vec4f(1, 0.5F, 0, 1));
  EXPECT_EQ(map(0.25), Vec4f(0, 0, 0, 0));
  EXPECT_EQ(map(0.75), Vec4f(1, 0.5F, 0, 1));
}

TEST(ColorMap, LaterOfTwoEntriesOfOneScalarHoldsFromThereOn) {
  const ColorMap map{{{0.0, {0, 0, 0, 0}}, {0.5, {0, 0, 0, 0}}, {0.5, {1, 1, 1, 1}}, {1.0, {1, 1, 1, 1}}}};
  EXPECT_EQ(map(std::nextafter(0.5, 0.0)).x, 0.0F);
  EXPECT_EQ(map(0.5).x, 1.0F);
  const ColorMap at_the_ends{{{0.0, {0, 0, 0, 0}}, {0.0, {1, 0, 0, 1}}, {1.0, {0, 1, 0, 1}}, {1.0, {0, 0, 1, 1}}}};
  EXPECT_EQ(at_the_ends(0.0), Vec4f(1, 0, 0, 1));
  EXPECT_EQ(at_the_ends(1.0), Vec4f(0, 0, 1, 1));
}

TEST(ColorMap, EveryPresetIsValidAndRisesInOpacityFromNothing) {
  ASSERT_EQ(preset_color_map_names().size(), 5U);
  for (const std::string& name : preset_color_map_names()) {
    const ColorMap map = preset_color_map(name);
    EXPECT_NO_THROW(check_color_map(map)) << name;
    for (int i = 0; i <= 100; ++i) EXPECT_NEAR(map(i / 100.0).w, i / 100.0, 1e-6) << name;
  }
}

// Values of the published 256-colour tables at places where the presets have no entry.
TEST(ColorMap, ViridisFollowsThePublishedTable) {
  const struct {
    int index;
    Vec3f color;
  } published[] = {{8, {0.277018F, 0.050344F, 0.375715F}},   {24, {0.282884F, 0.135920F, 0.453427F}},
                   {40, {0.270595F, 0.214069F, 0.507052F}},  {72, {0.214298F, 0.355619F, 0.551184F}},
                   {104, {0.160665F, 0.478540F, 0.558115F}}, {136, {0.120565F, 0.596422F, 0.543611F}}};
  const ColorMap map = preset_color_map("viridis");
  for (const auto& sample : published) {
    const Vec4f color = map(sample.index / 255.0);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(color[c], sample.color[c], 0.01F) << sample.index;
  }
}

TEST(ColorMap, SeedFigureSpendsItsColorsOnTheMiddleFifth) {
  const ColorMap map = preset_color_map("seed-figure-5.8");
  ASSERT_EQ(map.entries.size(), 5U);
  double length = 0.0;
  double middle = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double s = (i + 0.5) / 1000.0;
    const double step = glm::length(Vec3f(map(s + 0.0005)) - Vec3f(map(s - 0.0005)));
    length += step;
    if (s > 0.4 && s < 0.6) middle += step;
  }
  EXPECT_NEAR(middle / length, 0.5, 0.02);  // half of all change in a fifth of the range
}

TEST(ColorMap, WhatIsWrongIsNamed) {
  const auto message = [](const ColorMap& map) {
    try {
      check_color_map(map);
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const ColorMapEntry black{0.0, {0, 0, 0, 0}};
  EXPECT_NE(message({{black}}).find("2 to 32"), std::string::npos);
  EXPECT_NE(message({std::vector<ColorMapEntry>(33, black)}).find("33"), std::string::npos);
  EXPECT_NE(message({{{0.5, {}}, {0.25, {}}}}).find("entry 2"), std::string::npos);
  EXPECT_NE(message({{black, {1.5, {}}}}).find("entry 2"), std::string::npos);
  EXPECT_NE(message({{{0.0, {0, 2, 0, 0}}, black}}).find("entry 1"), std::string::npos);
  EXPECT_NE(message({{{std::numeric_limits<double>::quiet_NaN(), {}}, black}}).find("entry 1"), std::string::npos);
  EXPECT_EQ(message({std::vector<ColorMapEntry>(32, black)}), "");
  try {
    preset_color_map("viridi");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean viridis"), std::string::npos);
  }
}

}  // namespace
}  // namespace atomesh
