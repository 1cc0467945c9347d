// Colour maps of other programs.
#include <gtest/gtest.h>

#include <cmath>

#include "app/gui/color_map_files.h"
#include "core/error.h"
#include "core/image.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;

TEST(ColorMapFiles, WhatIsWrittenReadsBack) {
  const test::TemporaryFolder folder;
  for (const std::string& name : preset_color_map_names()) {
    const ColorMap map = preset_color_map(name);
    write_color_map_file(folder.file("map.json"), map, name);
    const ColorMapFile file = read_color_map_file(folder.file("map.json"));
    EXPECT_TRUE(file.opacities);
    EXPECT_EQ(file.note, "");
    ASSERT_EQ(file.map.entries.size(), map.entries.size()) << name;
    for (std::size_t i = 0; i < map.entries.size(); ++i) EXPECT_EQ(file.map.entries[i], map.entries[i]) << name << i;
  }
  const ColorMap jump{{{0.0, {0, 0, 0, 0}}, {0.5, {0.25F, 0, 0, 0}}, {0.5, {1, 1, 1, 1}}, {1.0, {0, 1, 1, 0.5F}}}};
  write_color_map_file(folder.file("map.json"), jump, "jump");
  EXPECT_EQ(read_color_map_file(folder.file("map.json")).map, jump);
}

TEST(ColorMapFiles, OfParaViewInItsOwnRange) {
  const test::TemporaryFolder folder;
  const ColorMapFile file = read_color_map_file(folder.file("pv.json", R"([
    {"Name": "group", "Maps": []},
    {"ColorSpace": "Diverging", "Name": "Cool to Warm", "NanColor": [1, 1, 0],
     "RGBPoints": [-4, 0.25, 0.5, 0.75, 0, 1, 1, 1, 12, 0.5, 0, 0]}])"));
  EXPECT_FALSE(file.opacities);
  ASSERT_EQ(file.map.entries.size(), 3U);
  EXPECT_EQ(file.map.entries[0], (ColorMapEntry{0.0, {0.25F, 0.5F, 0.75F, 1}}));
  EXPECT_EQ(file.map.entries[1], (ColorMapEntry{0.25, {1, 1, 1, 1}}));
  EXPECT_EQ(file.map.entries[2], (ColorMapEntry{1.0, {0.5F, 0, 0, 1}}));
  EXPECT_NE(file.note.find("Diverging"), std::string::npos) << file.note;
  EXPECT_NE(file.note.find("2 maps"), std::string::npos) << file.note;
}

TEST(ColorMapFiles, AStripOfManyColorsIsThinnedOut) {
  const test::TemporaryFolder folder;
  // 1,000 pixels of viridis lying, and standing.
  Image lying(1000, 4);
  Image standing(4, 1000);
  const ColorMap viridis = preset_color_map("viridis");
  for (int i = 0; i < 1000; ++i) {
    for (int j = 0; j < 4; ++j) {
      lying.at(i, j) = standing.at(j, 999 - i) = Vec4f(Vec3f(viridis(i / 999.0)), 1.0F);
    }
  }
  write_png(folder.file("lying.png"), lying);
  write_png(folder.file("standing.png"), standing);
  for (const char* name : {"lying.png", "standing.png"}) {
    const ColorMapFile file = read_color_map_file(folder.file(name));
    EXPECT_FALSE(file.opacities);
    EXPECT_LE(file.map.entries.size(), 32U);
    for (int i = 0; i <= 200; ++i) {
      const Vec3f d = glm::abs(Vec3f(file.map(i / 200.0)) - Vec3f(viridis(i / 200.0)));
      EXPECT_LE(std::max({d.r, d.g, d.b}), 0.006F) << name << ' ' << i;  // the strip itself is off by 1/510
    }
  }
}

TEST(ColorMapFiles, OpacitiesOfAStrip) {
  const test::TemporaryFolder folder;
  Image strip(3, 1);
  strip.at(0, 0) = {1, 0, 0, 1};
  strip.at(1, 0) = {1, 0, 0, 0.2F};
  strip.at(2, 0) = {1, 0, 0, 1};
  write_png(folder.file("strip.png"), strip);
  const ColorMapFile file = read_color_map_file(folder.file("strip.png"));
  EXPECT_TRUE(file.opacities);
  EXPECT_NEAR(file.map(0.5).a, 0.2, 1.0 / 510.0);
  // One pixel is a map too.
  Image one(1, 1);
  one.at(0, 0) = {0, 1, 0, 1};
  write_png(folder.file("one.png"), one);
  EXPECT_EQ(read_color_map_file(folder.file("one.png")).map(0.7), Vec4f(0, 1, 0, 1));
}

TEST(ColorMapFiles, DamagedOnesAreRefusedByName) {
  const test::TemporaryFolder folder;
  for (const char* content :
       {"", "[", "[]", "{}", R"([{"RGBPoints": []}])", R"([{"RGBPoints": [0, 1, 1, 1]}])",
        R"([{"RGBPoints": [0, 1, 1, 1, 1, 0, 0]}])", R"([{"RGBPoints": [1, 1, 1, 1, 0, 0, 0, 0]}])",
        R"([{"RGBPoints": [1, 1, 1, 1, 1, 0, 0, 0]}])", R"([{"RGBPoints": [0, 1, "x", 1, 1, 0, 0, 0]}])",
        R"([{"RGBPoints": [0, 1, 1, 1, 1, 0, 0, 0], "Points": [0, 1]}])", "no JSON at all"}) {
    try {
      read_color_map_file(folder.file("map.json", content));
      FAIL() << content;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("map.json"), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(read_color_map_file(folder.file("none.json")), InputError);
}

}  // namespace
