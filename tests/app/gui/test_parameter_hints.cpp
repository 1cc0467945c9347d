// What forms show of the parameter table: sliders, labels, messages, and the search.
#include <gtest/gtest.h>

#include <algorithm>

#include "app/gui/parameter_hints.h"
#include "core/error.h"
#include "core/parameter_text.h"

namespace atomesh::gui {
namespace {

const std::vector<std::string> species{"Na", "Cl"};

TEST(SliderScales, LinearRangesStepByRoundNumbers) {
  const auto scale = slider_scale("volume_surface.face_alpha");
  ASSERT_TRUE(scale);
  EXPECT_FALSE(scale->logarithmic);
  EXPECT_EQ(scale->unit, 0.01);
  EXPECT_EQ(scale->value(0), 0.0);
  EXPECT_EQ(scale->value(1000), 1.0);
  EXPECT_EQ(scale->value(150), 0.15);  // the very double that 0.15 is
  EXPECT_EQ(scale->stepped(0.15, 1), 0.16);
  EXPECT_EQ(scale->stepped(0.154, 1), 0.16);
  EXPECT_EQ(scale->stepped(0.154, -1), 0.15);
  EXPECT_EQ(slider_scale("view.azimuth")->unit, 1.0);
  EXPECT_EQ(slider_scale("view.azimuth")->stepped(-30.0, -10), -40.0);
}

TEST(SliderScales, RangesOfDecadesGoByFactors) {
  const auto zoom = slider_scale("view.zoom");
  ASSERT_TRUE(zoom);
  EXPECT_TRUE(zoom->logarithmic);
  EXPECT_EQ(zoom->value(0), 1e-3);
  EXPECT_EQ(zoom->value(SliderScale::positions), 1e4);
  EXPECT_NEAR(zoom->value(SliderScale::positions * 3 / 7), 1.0, 0.02);
  EXPECT_EQ(zoom->stepped(1.0, 1), 1.1);
  EXPECT_EQ(zoom->stepped(1.0, -1), 0.91);

  // About the default, with 0 at the end.
  const auto opacity = slider_scale("xray.alpha_length");
  ASSERT_TRUE(opacity);
  EXPECT_EQ(opacity->value(0), 0.0);
  EXPECT_EQ(opacity->value(500), 0.005);
  EXPECT_EQ(opacity->value(SliderScale::positions), 5.0);
  EXPECT_EQ(opacity->stepped(0.0, 1), 5e-6);
  EXPECT_EQ(opacity->stepped(5e-6, -1), 0.0);

  const auto samples = slider_scale("quality.samples_per_cell");
  ASSERT_TRUE(samples);
  EXPECT_TRUE(samples->integer);
  for (int position = 0; position <= SliderScale::positions; ++position) {
    EXPECT_EQ(samples->value(position), std::round(samples->value(position)));
  }
  EXPECT_EQ(samples->stepped(1, 1), 2);
  EXPECT_EQ(samples->stepped(4, -1), 3);
}

// Every value that a slider or a step makes is one the table takes, and a slider stays where it is put.
TEST(SliderScales, EveryPositionOfEverySliderIsAValue) {
  int sliders = 0;
  for (const std::string& key : parameter_keys(species)) {
    const auto scale = slider_scale(key);
    if (!scale) continue;
    ++sliders;
    Parameters parameters;
    for (int position = 0; position <= SliderScale::positions; ++position) {
      const double value = scale->value(position);
      ASSERT_NO_THROW(set_parameter(parameters, key, real_text(value))) << key << " at " << position;
      ASSERT_LE(std::abs(scale->position(value) - position), scale->integer ? SliderScale::positions / 6 : 6) << key;
      if (position > 0) {
        ASSERT_GE(value, scale->value(position - 1)) << key << " at " << position;
      }
    }
  }
  EXPECT_GT(sliders, 30);
}

TEST(SliderScales, ACutPlanesDistanceGoesOverTheSample) {
  EXPECT_FALSE(slider_scale("cut_plane.1.distance"));
  Bounds bounds;
  bounds.add({-10.0, 0.0, 5.0});
  bounds.add({30.0, 20.0, 25.0});
  Parameters parameters;
  parameters.cut_planes[1].normal = Vec3(0.0, 0.0, -2.0);
  auto scale = slider_scale("cut_plane.2.distance", parameters, bounds);
  ASSERT_TRUE(scale);
  EXPECT_NEAR(scale->low, -50.0, 1e-9);
  EXPECT_NEAR(scale->high, -10.0, 1e-9);
  scale = slider_scale("cut_plane.1.distance", parameters, bounds);
  EXPECT_NEAR(scale->low, -10.0, 1e-9);
  EXPECT_NEAR(scale->high, 30.0, 1e-9);
  EXPECT_FALSE(slider_scale("cut_plane.1.distance", parameters, Bounds{}));
}

TEST(ParameterLabels, AreThoseOfTheTable) {
  EXPECT_EQ(parameter_label("volume_surface.face_alpha"), "Face alpha constant");
  EXPECT_EQ(parameter_label("atoms.color.Na"), "Atom-ball colors Na");
  EXPECT_EQ(short_parameter_label("light.3.position"), "Position");
  EXPECT_EQ(short_parameter_label("cut_plane.2.normal"), "a, b, c");
  EXPECT_EQ(short_parameter_label("cut_plane.2.distance"), "d");
  EXPECT_EQ(short_parameter_label("atoms.visible.Na"), "Visible");
  EXPECT_EQ(parameter_place("light.3.position"), "Lights, light 3");
  EXPECT_EQ(parameter_place("xray.color"), "X-ray");
  EXPECT_EQ(group_of_mode(Mode::volume_surface), "Volume and surface");
  EXPECT_EQ(group_of_mode(Mode::atoms), "Atom balls");
  EXPECT_EQ(mode_of_group("X-ray"), Mode::xray);
  EXPECT_FALSE(mode_of_group("Lights"));
}

TEST(ParameterLabels, EveryToolTipSaysHelpRangeDefaultAndKey) {
  for (const std::string& key : parameter_keys(species)) {
    const QString tip = parameter_tool_tip(key);
    const ParameterRow& row = parameter_row(key);
    EXPECT_TRUE(tip.contains(QString::fromStdString(row.help).toHtmlEscaped())) << key;
    EXPECT_TRUE(tip.contains(QString::fromStdString(key).toHtmlEscaped())) << key;
    EXPECT_TRUE(tip.contains(QString::fromStdString(default_text(key)).toHtmlEscaped())) << key;
    EXPECT_FALSE(short_parameter_label(key).isEmpty()) << key;
  }
  EXPECT_TRUE(parameter_tool_tip("view.field_of_view").contains("A number from 1 to 150 degrees"));
}

TEST(ParameterLabels, AMessageSaysWhatIsAllowed) {
  Parameters parameters;
  const auto message = [&](const char* key, const char* text) {
    try {
      set_parameter(parameters, key, text);
    } catch (const UsageError& error) {
      return field_message(error.what());
    }
    return QString();
  };
  EXPECT_EQ(message("volume_surface.face_alpha", "2"), "Expected a number from 0 to 1");
  EXPECT_EQ(message("volume.range_low", "low"), "Expected auto or a number from -1e+300 to 1e+300");
  EXPECT_EQ(message("volume.color_map", "0:#000000"), "A color map has 2 to 32 entries, not 1");
}

TEST(ParameterSearch, FindsByLabelKeyHelpAndChoice) {
  const auto first = [](const char* query) {
    const auto keys = find_parameters(query, species);
    return keys.empty() ? std::string() : keys.front();
  };
  EXPECT_EQ(first("face alpha"), "volume_surface.face_alpha");
  EXPECT_EQ(first("ALPHA face"), "volume_surface.face_alpha");
  EXPECT_EQ(first("xray.color"), "xray.color");
  EXPECT_EQ(first("preintegrated"), "quality.integrator");
  EXPECT_EQ(first("horizontal"), "");
  EXPECT_EQ(first(""), "");
  EXPECT_EQ(first("  "), "");
  EXPECT_EQ(first("exponent of the specular"), "volume_surface.shininess");
  EXPECT_EQ(first("radii Na"), "atoms.radius.Na");
  EXPECT_EQ(find_parameters("vacancy", species).size(), 3U);
  EXPECT_EQ(find_parameters("light intensity", species).size(), 8U);
  // A word in the label before the same word in a help text.
  const auto colors = find_parameters("background", species);
  ASSERT_FALSE(colors.empty());
  EXPECT_EQ(colors.front(), "background");
}

TEST(ParameterSearch, FindsEveryKeyByItself) {
  for (const std::string& key : parameter_keys(species)) {
    const auto keys = find_parameters(QString::fromStdString(key), species);
    EXPECT_NE(std::find(keys.begin(), keys.end(), key), keys.end()) << key;
  }
}

TEST(ParameterGroups, HoldEveryKeyOnce) {
  std::vector<std::string> all;
  for (const std::string& group : groups()) {
    for (const std::string& key : keys_of_group(group, species)) all.push_back(key);
  }
  EXPECT_EQ(all, parameter_keys(species));
}

}  // namespace
}  // namespace atomesh::gui
