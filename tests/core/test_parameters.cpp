#include <gtest/gtest.h>

#include <random>
#include <set>

#include "core/error.h"
#include "core/parameters.h"
#include "tests/core/random_parameters.h"

namespace atomesh {
namespace {

const std::vector<std::string> some_species{"Na", "Cl", "1", "O.w"};

std::string refusal(std::string_view key, std::string_view text) {
  Parameters parameters;
  try {
    set_parameter(parameters, key, text);
  } catch (const UsageError& error) {
    EXPECT_EQ(parameters, Parameters()) << "changed by a refused value";
    return error.what();
  }
  return "";
}

TEST(Parameters, TableNamesEveryKeyOnceAndExplainsIt) {
  std::set<std::string> keys;
  for (const ParameterRow& row : parameter_table()) {
    EXPECT_TRUE(keys.insert(row.key).second) << row.key;
    EXPECT_FALSE(row.label.empty()) << row.key;
    EXPECT_FALSE(row.group.empty()) << row.key;
    EXPECT_TRUE(row.help.ends_with('.')) << row.key;
    EXPECT_EQ(row.type == ParameterType::choice, !row.choices.empty()) << row.key;
  }
  EXPECT_EQ(keys.size(), 3U + 8 * 4 + 8 * 4 + 13 + 4 + 9 + 2 + 6 + 7 + 8);
}

TEST(Parameters, DefaultsAreWithinTheirOwnRanges) {
  EXPECT_NO_THROW(check_parameters(Parameters()));
}

TEST(Parameters, EveryKeyReadsBackWhatItWrites) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const Parameters random = test::random_parameters(seed, some_species);
    ASSERT_NO_THROW(check_parameters(random));
    Parameters copy;
    for (const std::string& key : parameter_keys(some_species)) {
      set_parameter(copy, key, get_parameter(random, key));
      EXPECT_EQ(get_parameter(copy, key), get_parameter(random, key)) << key;
    }
    EXPECT_EQ(copy, random) << "seed " << seed;
  }
}

// A key that wrote into a neighbour's field would pass the round trip: change one at a time.
TEST(Parameters, AKeyChangesOneValueOnly) {
  const Parameters random = test::random_parameters(7, some_species);
  const std::vector<std::string> keys = parameter_keys(some_species);
  for (const std::string& key : keys) {
    Parameters one;
    set_parameter(one, key, get_parameter(random, key));
    for (const std::string& other : keys) {
      EXPECT_EQ(get_parameter(one, other), get_parameter(other == key ? random : Parameters(), other))
          << key << " changed " << other;
    }
  }
}

TEST(Parameters, ReadsTheNotationsPeopleWrite) {
  Parameters p;
  set_parameter(p, "background", "#ff000080");
  EXPECT_EQ(p.background, Vec4f(1, 0, 0, 128.0F / 255.0F));
  set_parameter(p, "background", "#00ff00");
  EXPECT_EQ(p.background, Vec4f(0, 1, 0, 1));
  set_parameter(p, "background", " 0.5, 0.25 ,1 ");
  EXPECT_EQ(p.background, Vec4f(0.5F, 0.25F, 1, 1));
  set_parameter(p, "surface.color", "#0000ff");
  EXPECT_EQ(p.surface.color, Vec3f(0, 0, 1));
  set_parameter(p, "cut_plane.3.enabled", "yes");
  set_parameter(p, "cut_plane.3.side", ">=");
  EXPECT_TRUE(p.cut_planes[2].enabled);
  EXPECT_EQ(p.cut_planes[2].side, CutPlane::Side::greater_equal);
  set_parameter(p, "mode", "volume_surface");
  EXPECT_EQ(p.mode, Mode::volume_surface);
  set_parameter(p, "quality.supersampling", "+4");
  EXPECT_EQ(p.supersampling, 4);
  set_parameter(p, "volume.color_map", "0:#00000000 0.5:#ff0000 1:0.1,0.2,0.3,0.4");
  ASSERT_EQ(p.volume.color_map.entries.size(), 3U);
  EXPECT_EQ(p.volume.color_map.entries[2].color, Vec4f(0.1F, 0.2F, 0.3F, 0.4F));
  EXPECT_EQ(p.volume.color_map.entries[1].color, Vec4f(1, 0, 0, 1));
  set_parameter(p, "volume.color_map", "cividis");
  EXPECT_EQ(p.volume.color_map, preset_color_map("cividis"));
  EXPECT_EQ(get_parameter(p, "volume.color_map"), "cividis");
}

TEST(Parameters, SpeciesGoBackToTheirOwnWithAuto) {
  Parameters p;
  EXPECT_EQ(get_parameter(p, "atoms.color.Na"), "auto");
  EXPECT_EQ(get_parameter(p, "atoms.visible.Na"), "true");
  set_parameter(p, "atoms.color.Na", "1,0,0");
  set_parameter(p, "atoms.visible.Na", "false");
  set_parameter(p, "atoms.radius.Na", "1.25");
  EXPECT_EQ(p.atoms.colors.at("Na"), Vec3f(1, 0, 0));
  EXPECT_FALSE(p.atoms.visible.at("Na"));
  EXPECT_EQ(p.atoms.radii.at("Na"), 1.25);
  set_parameter(p, "atoms.color.Na", "auto");
  set_parameter(p, "atoms.visible.Na", "true");
  set_parameter(p, "atoms.radius.Na", "auto");
  EXPECT_EQ(p, Parameters());
}

TEST(Parameters, FieldsAndTheirRangeGoBackToTheirOwnWithAuto) {
  Parameters p;
  EXPECT_EQ(get_parameter(p, "volume.field"), "auto");
  EXPECT_EQ(get_parameter(p, "volume.range_low"), "auto");
  set_parameter(p, "volume.field", "wall distance");
  set_parameter(p, "volume.range_low", "-2.5");
  set_parameter(p, "volume.range_high", "0");
  EXPECT_EQ(p.volume.field, "wall distance");
  EXPECT_EQ(p.volume.range_low, -2.5);
  EXPECT_EQ(p.volume.range_high, 0.0);
  for (const char* key : {"volume.field", "volume.range_low", "volume.range_high"}) set_parameter(p, key, "auto");
  EXPECT_EQ(p, Parameters());
  EXPECT_EQ(refusal("volume.range_low", "low"),
            "volume.range_low = \"low\": expected auto or a number from -1e+300 to 1e+300");
  EXPECT_NE(refusal("volume.field", ""), "");
  EXPECT_NE(refusal("volume.field", "two\nlines"), "");
}

TEST(Parameters, RefusalsNameKeyTextAndWhatWasExpected) {
  EXPECT_EQ(refusal("volume_surface.face_alpha", "1.5"),
            "volume_surface.face_alpha = \"1.5\": expected a number from 0 to 1");
  EXPECT_EQ(refusal("view.elevation", "91"), "view.elevation = \"91\": expected a number from -90 to 90 degrees");
  EXPECT_EQ(refusal("quality.supersampling", "2.5"),
            "quality.supersampling = \"2.5\": expected a whole number from 1 to 16");
  EXPECT_EQ(refusal("shading", "gouraud"), "shading = \"gouraud\": expected flat or smooth");
  for (const char* junk : {"", " ", "nan", "inf", "-inf", "1e999", "0.5x", "0.5 0.5", "0x1", "--1", "+-1", "1,0"}) {
    EXPECT_NE(refusal("volume_surface.face_alpha", junk), "") << junk;
  }
  for (const char* junk : {"", "1.0", "17", "0", "99999999999", "1 ,"}) {
    EXPECT_NE(refusal("quality.supersampling", junk), "") << junk;
  }
  for (const char* junk :
       {"", "#12345", "#gggggg", "#1234567", "1,1", "1,1,1,1,1", "1,1,2", "1,,1", "red", "-0.1,0,0", "#+12-34",
        "#ff0000 "
        "x"}) {
    EXPECT_NE(refusal("background", junk), "") << junk;
  }
  EXPECT_NE(refusal("surface.color", "1,1,1,1"), "");
  EXPECT_NE(refusal("surface.color", "#ffffffff"), "");
  EXPECT_NE(refusal("light.1.enabled", "maybe"), "");
  EXPECT_NE(refusal("cut_plane.1.normal", "0,0,0"), "");
  EXPECT_NE(refusal("cut_plane.1.normal", "1,nan,0"), "");
  EXPECT_NE(refusal("view.pan", "1,2"), "");
  for (const char* junk : {"", "viridiss", "0:#000000", "0:#000000 0.5", "0:#000000 x:#ffffff", "1:#000000 0:#ffffff",
                           "0:#000000 1:#ffffffz"}) {
    EXPECT_NE(refusal("volume.color_map", junk), "") << junk;
  }
  EXPECT_NE(refusal("volume.color_map", "viridiss").find("volume.color_map"), std::string::npos);
  EXPECT_NE(refusal("volume.color_map", "viridiss").find("did you mean viridis"), std::string::npos);
}

TEST(Parameters, UnknownKeysNameTheNearest) {
  EXPECT_NE(refusal("volume_surface.face_alfa", "1").find("did you mean volume_surface.face_alpha"), std::string::npos);
  EXPECT_NE(refusal("face_alpha", "1").find("did you mean volume_surface.face_alpha"), std::string::npos);
  EXPECT_NE(refusal("light.9.color", "1,1,1").find("did you mean light."), std::string::npos);
  EXPECT_NE(refusal("", "1"), "");
  EXPECT_NE(refusal("atoms.color.", "1,1,1"), "");
  EXPECT_NE(refusal("atoms.color.<species>", "1,1,1").find("name of a species"), std::string::npos);
  EXPECT_NE(refusal("atoms.color.a b", "1,1,1"), "");
  EXPECT_EQ(parameter_row("atoms.color.Na").key, "atoms.color.<species>");
}

TEST(Parameters, ModesHaveNames) {
  for (const char* name : {"volume-surface", "volume", "surface", "xray", "atoms"}) {
    EXPECT_EQ(mode_name(mode_from_name(name)), name);
  }
  try {
    mode_from_name("x-ray");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean xray"), std::string::npos) << error.what();
  }
}

TEST(Parameters, CheckFindsWhatAProgramPutThere) {
  Parameters p;
  p.zoom = 0.0;
  EXPECT_THROW(check_parameters(p), UsageError);
  p = {};
  p.volume.color_map.entries.clear();
  EXPECT_THROW(check_parameters(p), UsageError);
  p = {};
  p.atoms.radii["Na"] = -1.0;
  EXPECT_THROW(check_parameters(p), UsageError);
}

TEST(Parameters, DocumentationHasARowForEachKeyAndCountsLightsOnce) {
  const std::string text = parameter_documentation();
  for (const ParameterRow& row : parameter_table()) {
    std::string key = row.key;
    if (key.starts_with("light.") || key.starts_with("cut_plane.")) key[key.find('.') + 1] = 'N';
    const std::size_t at = text.find("| `" + key + "` |");
    ASSERT_NE(at, std::string::npos) << key;
    EXPECT_EQ(text.find("| `" + key + "` |", at + 1), std::string::npos) << key;
  }
  EXPECT_NE(text.find("1 to 2: `true`; 3 to 8: `false`"), std::string::npos);
  EXPECT_NE(text.find("| `viridis` |"), std::string::npos);
}

}  // namespace
}  // namespace atomesh
