// segment.glsl: the light of a ray's segment, exact and from the table, against the judge's quadrature; and the table.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "render/cpu/reference_optics.h"
#include "render/gl/context.h"
#include "render/gl/objects.h"
#include "render/gl/preintegration_map.h"
#include "render/gl/preintegration_table.h"
#include "tests/render/gl/shader_harness.h"

using namespace atomesh;
using namespace atomesh::gl;

namespace {

// segment_light() of every segment, with EXACT or TABLE.
class SegmentShader {
 public:
  explicit SegmentShader(const std::string& define)
      : function_("#define " + define + "\n" + shader_source("segment.glsl") + R"glsl(
vec4 result_of(vec4 segment) { return segment_light(segment.x, segment.y, segment.z); })glsl") {}

  std::vector<Vec4f> lights(const PreintegrationTable& table, const std::vector<Segment>& segments) const {
    table.bind();
    return function_(segments);
  }

 private:
  ShaderFunction function_;
};

std::vector<NamedMap> maps() {
  const Vec4f red(1, 0, 0, 1);
  const Vec4f green(0, 1, 0, 0.5);
  const Vec4f blue(0, 0, 1, 0);
  std::vector<NamedMap> all =
      segment_maps({"steep", {{{0.5, blue}, {0.50390625, red}, {0.5078125, green}, {0.75, green}, {0.7578125, blue}}}});
  // As floats, 0.35 lies just below where tables have entries.
  all.push_back({"valley",
                 {{{0.0, Vec4f(0.05, 0.1, 0.5, 0)},
                   {0.2F, Vec4f(0.1, 0.4, 0.9, 0.12)},
                   {0.35F, Vec4f(0.1, 0.8, 0.6, 0)},
                   {0.5, Vec4f(0.3, 0.8, 0.2, 0.25)},
                   {1.0, Vec4f(0.8, 0, 0.1, 1)}}}});
  return all;
}

// Everywhere, in small ranges, at and about knots, of equal scalars, of length 0.
std::vector<Segment> segments(const ColorMap& map) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> one(0.0F, 1.0F);
  std::vector<Segment> all;
  const auto add = [&](float near, float far) {
    all.push_back({std::clamp(near, 0.0F, 1.0F), std::clamp(far, 0.0F, 1.0F), 2.0F * one(random) * one(random)});
  };
  for (int i = 0; i < 120; ++i) {
    add(one(random), one(random));
    const float about = one(random);
    add(about, about + 0.02F * (one(random) - 0.5F));
    add(about, about);
  }
  std::uniform_int_distribution<std::size_t> entry(0, map.entries.size() - 1);
  for (int i = 0; i < 100; ++i) {
    const auto x = static_cast<float>(map.entries[entry(random)].scalar);
    const auto y = static_cast<float>(map.entries[entry(random)].scalar);
    add(x, y);
    add(x, x);
    add(x, y + 0.01F * (one(random) - 0.5F));
    add(x + 0.01F * (one(random) - 0.5F), y);
    // across a single knot, as long as can be
    add(x + 0.02F * (one(random) - 0.5F), x + 0.02F * (one(random) - 0.5F));
    all.back().length = 2.0F;
  }
  for (int i = 0; i < 50; ++i) all.push_back({one(random), one(random), 0.0F});
  all.push_back({0.0F, 1.0F, 1.0F});
  all.push_back({1.0F, 0.0F, 1.0F});
  return all;
}

// The largest error of a channel, and where.
struct Worst {
  double error = 0.0;
  std::string where;
};

Worst worst_of(const ColorMap& map, double alpha_length, const std::vector<Segment>& segments,
               const std::vector<Vec4f>& lights) {
  Worst worst;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& s = segments[i];
    const reference::Contribution exact = reference::integrate_mapped(
        map, static_cast<double>(s.near), static_cast<double>(s.far), alpha_length, static_cast<double>(s.length));
    const std::array<double, 4> expected{exact.color.r, exact.color.g, exact.color.b, 1.0 - exact.transmittance};
    for (int k = 0; k < 4; ++k) {
      const double error = std::abs(static_cast<double>(lights[i][k]) - expected[static_cast<std::size_t>(k)]);
      if (!(error <= worst.error)) {
        worst.error = std::isnan(error) ? 1e30 : error;
        worst.where = std::to_string(s.near) + " to " + std::to_string(s.far) + " along " + std::to_string(s.length) +
                      ", channel " + std::to_string(k);
      }
    }
  }
  return worst;
}

class Preintegration : public testing::Test {
 protected:
  HeadlessContext context_{true};
  HeadlessContext::Current current_{context_};
};

TEST_F(Preintegration, ASegmentOfOneColorIsTheExponential) {
  PreintegrationTable table;
  const SegmentShader shader("EXACT");
  table.update({{{0.0, Vec4f(0.2, 0.4, 0.8, 0.5)}, {1.0, Vec4f(0.2, 0.4, 0.8, 0.5)}}}, 3.0);
  const std::vector<Segment> some{{0.3F, 0.9F, 0.01F}, {0.9F, 0.1F, 0.5F}, {0.5F, 0.5F, 2.0F}, {0.0F, 1.0F, 100.0F}};
  const std::vector<Vec4f> lights = shader.lights(table, some);
  for (std::size_t i = 0; i < some.size(); ++i) {
    const double opacity = -std::expm1(-1.5 * static_cast<double>(some[i].length));
    EXPECT_NEAR(lights[i].a, opacity, 1e-6);
    EXPECT_NEAR(lights[i].r, 0.2 * opacity, 1e-6);
    EXPECT_NEAR(lights[i].g, 0.4 * opacity, 1e-6);
    EXPECT_NEAR(lights[i].b, 0.8 * opacity, 1e-6);
  }
  EXPECT_NO_THROW(check_errors("integrating segments"));
}

TEST_F(Preintegration, ExactIsTheJudge) {
  PreintegrationTable table;
  const SegmentShader shader("EXACT");
  for (const NamedMap& map : maps()) {
    for (const double alpha_length : {1e-6, 0.25, 10.0, 1e3, 1e6}) {
      std::vector<Segment> all = segments(map.map);
      // The judge takes its time where it is dense.
      if (alpha_length > 1e5) {
        for (std::size_t i = 0; 30 * i < all.size(); ++i) all[i] = all[30 * i];
        all.resize((all.size() + 29) / 30);
      }
      table.update(map.map, alpha_length);
      const Worst worst = worst_of(map.map, alpha_length, all, shader.lights(table, all));
      EXPECT_LE(worst.error, 1e-5) << map.name << ", " << alpha_length << "/Å: " << worst.where;
    }
  }
  EXPECT_NO_THROW(check_errors("integrating segments"));
}

TEST(PreintegrationEntry, IsTheJudge) {
  for (const NamedMap& map : maps()) {
    for (const double alpha_length : {1e-6, 0.25, 10.0, 1e3}) {
      const std::vector<MapPiece> pieces = map_pieces(map.map, alpha_length);
      std::vector<Vec4f> lights;
      const std::vector<Segment> all = segments(map.map);
      for (const Segment& s : all) {
        const auto length = static_cast<double>(s.length);
        lights.emplace_back(
            light_of(table_entry(pieces, static_cast<double>(s.near), static_cast<double>(s.far), length), length));
      }
      const Worst worst = worst_of(map.map, alpha_length, all, lights);
      EXPECT_LE(worst.error, 1e-7) << map.name << ", " << alpha_length << "/Å: " << worst.where;
    }
  }
}

TEST(PreintegrationSize, IsLargerTheSmallerTheError) {
  const std::vector<MapPiece> pieces = map_pieces(preset_color_map("viridis"), 0.25);
  const TableSize rough = choose_size(pieces, 4.0, 1e-2);
  const TableSize fine = choose_size(pieces, 4.0, 3e-3);
  EXPECT_LE(rough.estimated, 1e-2);
  EXPECT_LE(fine.estimated, 3e-3);
  EXPECT_GT(rough.scalars, 0);
  EXPECT_GT(fine.scalars, rough.scalars);
  EXPECT_GE(fine.layers, rough.layers);
  // Of a map that is the same everywhere there is nothing to resolve.
  const ColorMap constant{{{0.0, Vec4f(0.2, 0.4, 0.8, 0.5)}, {1.0, Vec4f(0.2, 0.4, 0.8, 0.5)}}};
  EXPECT_EQ(choose_size(map_pieces(constant, 1.0), 100.0, 1e-6).scalars, 16);
  // Nothing lies between the entries of a jump.
  const ColorMap jump{{{0.5, Vec4f(0, 0, 0, 0)}, {0.5, Vec4f(1, 1, 1, 1)}}};
  const TableSize none = choose_size(map_pieces(jump, 1.0), 1.0, 1e-2);
  EXPECT_EQ(none.scalars, 0);
  EXPECT_GT(none.estimated, 1e-2);
}

TEST(PreintegrationSize, LayersAreWhereTheirLengthsAre) {
  TableSize size;
  size.layers = 9;
  size.longest = 50.0;
  size.bend = 3.0;
  EXPECT_DOUBLE_EQ(size.length_of(0.0), 0.0);
  EXPECT_DOUBLE_EQ(size.length_of(8.0), 50.0);
  for (const double layer : {0.5, 1.0, 3.7, 7.99}) EXPECT_NEAR(size.layer_of(size.length_of(layer)), layer, 1e-12);
}

TEST_F(Preintegration, EntriesAreThoseOfTheProcessor) {
  PreintegrationTable table;
  for (const char* name : {"gray", "viridis", "seed-figure-5.8"}) {
    for (const double alpha_length : {1e-6, 0.25, 10.0, 1e6}) {
      const double longest = 1.0 / alpha_length;
      table.update(preset_color_map(name), alpha_length);
      ASSERT_TRUE(table.make_table(longest, 1e-2)) << name;
      const TableSize size = table.stats().size;
      const std::vector<Vec4f> entries = table.read();
      ASSERT_EQ(entries.size(), static_cast<std::size_t>(size.scalars * size.scalars * size.layers));
      const std::vector<MapPiece> pieces = map_pieces(preset_color_map(name), alpha_length);
      double worst = 0.0;
      for (std::size_t i = 0; i < entries.size(); ++i) {
        const auto n = static_cast<std::size_t>(size.scalars);
        const TableEntry expected = table_entry(pieces, static_cast<double>(i % n) / (size.scalars - 1),
                                                static_cast<double>(i / n % n) / (size.scalars - 1),
                                                size.length_of(static_cast<double>(i / n / n)));
        const glm::dvec4 difference(glm::dvec4(entries[i]) - glm::dvec4(expected.emission, expected.extinction));
        for (int k = 0; k < 4; ++k) worst = std::max(worst, std::abs(difference[k]) / alpha_length);
      }
      EXPECT_LE(worst, 1e-6) << name << ", " << alpha_length << "/Å";
    }
  }
  EXPECT_NO_THROW(check_errors("filling tables"));
}

// error_of_segment() by the judge.
double error_by_judge(const ColorMap& map, double alpha_length, const Segment& s, const Vec4f& light) {
  const reference::Contribution exact = reference::integrate_mapped(
      map, static_cast<double>(s.near), static_cast<double>(s.far), alpha_length, static_cast<double>(s.length));
  const double opacity = 1.0 - exact.transmittance;
  const glm::dvec4 difference = glm::abs(glm::dvec4(light) - glm::dvec4(exact.color, opacity));
  bool knot = false;
  for (const ColorMapEntry& entry : map.entries) {
    const auto scalar = static_cast<float>(entry.scalar);
    knot = knot || (std::min(s.near, s.far) < scalar && scalar < std::max(s.near, s.far));
  }
  return std::max({difference.r, difference.g, difference.b, difference.a}) / (opacity + (knot ? 0.25 : 1.0 / 256.0));
}

TEST_F(Preintegration, TheTableKeepsItsError) {
  PreintegrationTable table;
  const SegmentShader shader("TABLE");
  for (const NamedMap& map : maps()) {
    for (const double alpha_length : {1e-6, 0.25, 2.0, 5.0}) {
      for (const double error : {1e-2, 4e-3}) {
        table.update(map.map, alpha_length);
        const bool made = table.make_table(2.0, error);
        // Thin segments need none of what lies between a table's entries; of others no table has jumps.
        const bool sharp = map.name == "jumps" || map.name == "steep" ||
                           (map.name == "windows" && alpha_length > 1.0) ||
                           (map.name == "valley" && alpha_length > 2.0 && error < 5e-3);
        EXPECT_EQ(made, alpha_length < 1e-3 || !sharp) << map.name << ", " << alpha_length << "/Å";
        if (!made) continue;
        const std::vector<Segment> all = segments(map.map);
        const std::vector<Vec4f> lights = shader.lights(table, all);
        double worst = 0.0;
        for (std::size_t i = 0; i < all.size(); ++i) {
          worst = std::max(worst, error_by_judge(map.map, alpha_length, all[i], lights[i]));
        }
        EXPECT_LE(worst, error) << map.name << ", " << alpha_length << "/Å";
      }
    }
  }
  EXPECT_NO_THROW(check_errors("looking segments up"));
}

TEST_F(Preintegration, TheTableIsMadeAnewOnlyWhereSomethingChanged) {
  PreintegrationTable table;
  table.update(preset_color_map("viridis"), 0.25);
  ASSERT_TRUE(table.make_table(1.0, 1e-2));
  const std::vector<Vec4f> entries = table.read();
  const double build_ms = table.stats().build_ms;
  table.update(preset_color_map("viridis"), 0.25);
  ASSERT_TRUE(table.make_table(1.0, 1e-2));
  EXPECT_EQ(table.stats().build_ms, build_ms);  // the same measurement
  table.update(preset_color_map("gray"), 0.25);
  ASSERT_TRUE(table.make_table(1.0, 1e-2));
  EXPECT_NE(table.read(), entries);
  // Where no table will do, there is none.
  table.update({{{0.5, Vec4f(0, 0, 0, 0)}, {0.5, Vec4f(1, 1, 1, 1)}}}, 0.25);
  EXPECT_FALSE(table.make_table(1.0, 1e-2));
  EXPECT_FALSE(table.make_table(1.0, 1e-2));
  EXPECT_TRUE(table.read().empty());
  EXPECT_NO_THROW(check_errors("making tables"));
}

}  // namespace
