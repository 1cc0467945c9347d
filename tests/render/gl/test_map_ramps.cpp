// Rows of a map and ramps.glsl: the light of segments against the judge's quadrature, and which cells they suit.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "render/cpu/reference_optics.h"
#include "render/gl/context.h"
#include "render/gl/map_ramps.h"
#include "render/gl/objects.h"
#include "tests/render/gl/shader_harness.h"

using namespace atomesh;
using namespace atomesh::gl;

namespace {

// ramps_light() of every segment with its row.
class RampsShader {
 public:
  // With `defines` before it.
  explicit RampsShader(const std::string& defines = {})
      : function_(defines + R"glsl(
struct Row { vec4 texel[8]; };
layout(std430, binding = 2) readonly buffer Rows { Row rows[]; };
vec4 piece = vec4(0.0), piece_slope = piece, piece_square = piece, knot = piece, knot_square = piece, next_knot = piece,
     next_knot_square = piece;
float highest = 0.0;
)glsl" + shader_source("ramps.glsl") +
                  R"glsl(
vec4 result_of(vec4 segment) {
  Row row = rows[int(segment.w)];
  piece = row.texel[0];
  piece_slope = row.texel[1];
  piece_square = row.texel[2];
  knot = row.texel[3];
  knot_square = row.texel[4];
  next_knot = row.texel[5];
  next_knot_square = row.texel[6];
  highest = knot_square.a;
  return ramps_light(segment.x, segment.y, row.texel[7].x, segment.z);
})glsl") {}

  std::vector<Vec4f> lights(std::span<const RampRow> rows, const std::vector<Segment>& segments) const {
    Buffer table;
    table.write(rows);
    table.bind_storage(2);
    return function_(segments);
  }

 private:
  ShaderFunction function_;
};

// Cells of which only the scalars matter.
Scene scene_of(const std::vector<std::array<float, 4>>& cells) {
  Scene scene;
  std::vector<Tetrahedron> tetrahedra;
  for (const std::array<float, 4>& cell : cells) {
    const auto first = static_cast<Index>(scene.scalars.size());
    for (const float scalar : cell) {
      scene.vertices.emplace_back(0.0F);
      scene.scalars.push_back(scalar);
    }
    tetrahedra.push_back({first, first + 1, first + 2, first + 3});
  }
  scene.tetrahedra = tetrahedra;
  return scene;
}

NamedMap peaks() {
  return {"peaks",
          {{{0.0, {0.05F, 0.1F, 0.5F, 0.0F}},
            {0.2, {0.1F, 0.4F, 0.9F, 0.12F}},
            {0.35, {0.1F, 0.8F, 0.6F, 0.0F}},
            {0.5, {0.3F, 0.8F, 0.2F, 0.25F}},
            {0.58, {0.9F, 0.85F, 0.1F, 0.05F}},
            {0.8, {0.9F, 0.4F, 0.05F, 0.6F}},
            {1.0, {0.8F, 0.0F, 0.1F, 1.0F}}}}};
}

// Of many and few pieces, of one scalar, with ends at knots.
std::vector<std::array<float, 4>> some_cells(const ColorMap& map) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> one(0.0F, 1.0F);
  std::vector<std::array<float, 4>> cells;
  for (int i = 0; i < 60; ++i) {
    const float s = one(random);
    cells.push_back({one(random), one(random), one(random), one(random)});
    cells.push_back({s, std::min(s + 0.02F, 1.0F), s, s});
    cells.push_back({s, s, s, s});
  }
  for (const ColorMapEntry& entry : map.entries) {
    const auto s = static_cast<float>(entry.scalar);
    cells.push_back({s, s, s, s});
    cells.push_back({s, std::min(s + 0.1F, 1.0F), s, s});
    cells.push_back({s, std::max(s - 0.1F, 0.0F), s, s});
  }
  return cells;
}

class MapRampsShader : public testing::Test {
 protected:
  // What is seen of a segment of the cell: its rows, one behind the other.
  Vec4f light_of(const MapRamps& ramps, Index cell, float near, float far, float length) {
    std::array<std::uint8_t, MapRamps::most_rows> rows;
    const int count = ramps.rows_of(cell, rows.data());
    std::vector<Segment> segments;
    for (int n = 0; n < count; ++n) {
      segments.push_back({near, far, length, static_cast<float>(rows[static_cast<std::size_t>(n)])});
    }
    if (far < near) std::reverse(segments.begin(), segments.end());
    Vec4f sum(0.0F);
    if (segments.empty()) return sum;
    for (const Vec4f& light : shader_.lights(ramps.rows(), segments)) sum += (1.0F - sum.a) * light;
    return sum;
  }

  HeadlessContext context_{true};
  HeadlessContext::Current current_{context_};
  RampsShader shader_;
};

TEST_F(MapRampsShader, ASegmentOfOneColorIsTheExponential) {
  const Vec4f color(0.2, 0.4, 0.8, 0.5);
  const MapRamps ramps(scene_of({{0.1F, 0.4F, 0.9F, 0.2F}}), {{{0.0, color}, {1.0, color}}}, 3.0);
  EXPECT_FLOAT_EQ(ramps.longest(0), static_cast<float>(deepest_ramps / 1.5));
  for (const auto& [near, far] : {std::pair{0.1F, 0.9F}, {0.9F, 0.1F}, {0.5F, 0.5F}}) {
    for (const float length : {0.0F, 0.01F, 0.3F, 0.66F}) {
      const double opacity = -std::expm1(-1.5 * static_cast<double>(length));
      const Vec4f light = light_of(ramps, 0, near, far, length);
      EXPECT_NEAR(light.a, opacity, 2e-4);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(light[k], static_cast<double>(color[k]) * opacity, 2e-4);
    }
  }
}

// Opacity from 0 to 1 and back between scalars 1/4, 1/2 and 3/4 of colour 1: the mean extinction of all of it is 1/4.
TEST_F(MapRampsShader, APeakIsItsArea) {
  const MapRamps ramps(scene_of({{0.0F, 1.0F, 0.5F, 0.5F}}),
                       {{{0.25, Vec4f(1, 1, 1, 0)}, {0.5, Vec4f(1)}, {0.75, Vec4f(1, 1, 1, 0)}}}, 1.0);
  const Vec4f light = light_of(ramps, 0, 0.0F, 1.0F, 0.1F);
  EXPECT_NEAR(light.a, -std::expm1(-0.025), 1e-6);
  EXPECT_NEAR(light.r, -std::expm1(-0.025), 1e-6);
  EXPECT_NEAR(light_of(ramps, 0, 0.75F, 0.25F, 0.1F).a, -std::expm1(-0.05), 1e-6);
  // widened by 2^-14 to either side, down slopes of 4
  EXPECT_NEAR(light_of(ramps, 0, 0.5F, 0.5F, 0.1F).a, -std::expm1(-0.1 * (1.0 - 0x1p-13)), 1e-6);
  EXPECT_EQ(light_of(ramps, 0, 0.0F, 0.25F, 0.1F).a, 0.0F);
}

// Its opacity to 2e-4, its colour to what map_ramps.h says.
TEST_F(MapRampsShader, IsTheJudgeUpToTheLongestSegment) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> one(0.0F, 1.0F);
  for (const NamedMap& map : segment_maps(peaks())) {
    const std::vector<std::array<float, 4>> cells = some_cells(map.map);
    const double alpha_length = 4.0;
    const MapRamps ramps(scene_of(cells), map.map, alpha_length);
    double worst_color = 0.0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto [low, high] = std::minmax_element(cells[i].begin(), cells[i].end());
      const auto cell = static_cast<Index>(i);
      ASSERT_GT(ramps.longest(cell), 0.0F) << map.name;
      for (int n = 0; n < 6; ++n) {
        float near = *low + (*high - *low) * one(random);
        float far = *low + (*high - *low) * one(random);
        if (n == 0) near = *low;
        if (n == 1) far = *high;
        if (n == 2) far = near;
        const float length = std::min(ramps.longest(cell), 2.0F) * one(random);
        const Vec4f light = light_of(ramps, cell, near, far, length);
        const reference::Contribution exact = reference::integrate_mapped(
            map.map, static_cast<double>(near), static_cast<double>(far), alpha_length, static_cast<double>(length));
        const std::string where = map.name + ", " + std::to_string(near) + " to " + std::to_string(far) + " along " +
                                  std::to_string(length) + " of " + std::to_string(*low) + " to " +
                                  std::to_string(*high);
        const double opacity = 1.0 - exact.transmittance;
        // Segments whose scalars are closer than 2^-13 are widened to that.
        const double widened = 4.0 * static_cast<double>(length) / 8192.0 / 0.05;
        ASSERT_NEAR(light.a, opacity, 2e-4 * opacity + widened + 1e-6) << where;
        for (int k = 0; k < 3; ++k) {
          const double error = std::abs(static_cast<double>(light[k]) - exact.color[k]);
          ASSERT_LE(error, (most_ramps_change / 12.0 + 1e-3) * opacity + widened + 1e-6) << where;
          worst_color = std::max(worst_color, error);
        }
      }
    }
    if (map.name == "peaks") {
      EXPECT_GT(worst_color, 1e-5);  // it is an approximation
    }
  }
  EXPECT_NO_THROW(check_errors("summing ramps"));
}

// Cells of a single piece, by the program for them, also where nothing is widened.
TEST_F(MapRampsShader, OfOnePieceIsTheJudge) {
  const RampsShader one_piece("#define ONE_PIECE\n");
  std::mt19937 random(7);
  std::uniform_real_distribution<float> one(0.0F, 1.0F);
  for (const NamedMap& map : segment_maps(peaks())) {
    std::vector<std::array<float, 4>> cells;
    for (int i = 0; i < 300; ++i) {
      const float s = one(random);
      const float width = i % 3 == 0 ? 0.0F : 0.01F * one(random);
      cells.push_back({s, std::min(s + width, 1.0F), s, s});
    }
    const double alpha_length = 4.0;
    const MapRamps ramps(scene_of(cells), map.map, alpha_length);
    std::size_t tested = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto cell = static_cast<Index>(i);
      std::array<std::uint8_t, MapRamps::most_rows> rows;
      const int count = ramps.rows_of(cell, rows.data());
      if (ramps.kind_of(cell) != CellKind::piece || count == 0 || ramps.longest(cell) == 0.0F) continue;
      ASSERT_EQ(count, 1);
      const auto [near, far] = i % 2 == 0 ? std::pair(cells[i][0], cells[i][1]) : std::pair(cells[i][1], cells[i][0]);
      const float length = std::min(ramps.longest(cell), 2.0F) * one(random);
      const Segment segment{near, far, length, static_cast<float>(rows[0])};
      const Vec4f light = one_piece.lights(ramps.rows(), {segment}).front();
      const reference::Contribution exact = reference::integrate_mapped(
          map.map, static_cast<double>(near), static_cast<double>(far), alpha_length, static_cast<double>(length));
      const double opacity = 1.0 - exact.transmittance;
      // what the series leaves out
      const double series = std::pow(-std::log(exact.transmittance), 7.0) / 5040.0;
      ASSERT_NEAR(light.a, opacity, series + 1e-6) << map.name << ", " << near << " to " << far;
      for (int k = 0; k < 3; ++k) {
        ASSERT_NEAR(light[k], exact.color[k], (most_ramps_change / 12.0) * opacity + series + 1e-6) << map.name;
      }
      // Below the piece it counts no further.
      const RampRow& row = ramps.rows()[rows[0]];
      const auto row_number = static_cast<float>(rows[0]);
      const std::vector<Vec4f> kept = one_piece.lights(
          ramps.rows(), {{near - 10.0F, far, length, row_number}, {row.zero.x + row.lowest, far, length, row_number}});
      for (int k = 0; k < 4; ++k) ASSERT_NEAR(kept[0][k], kept[1][k], 1e-4) << map.name;
      ++tested;
    }
    EXPECT_GT(tested, 20U) << map.name;
  }
  EXPECT_NO_THROW(check_errors("summing ramps"));
}

TEST(MapRamps, APieceIsWorthAProgramWhereMostCellsHaveOne) {
  const ColorMap map{{{0.0, Vec4f(1, 0, 0, 0)}, {0.5, Vec4f(1)}, {1.0, Vec4f(1, 0, 0, 0)}}};
  const std::array<float, 4> low{0.1F, 0.2F, 0.3F, 0.4F};
  const std::array<float, 4> across{0.4F, 0.6F, 0.5F, 0.5F};
  const MapRamps most(scene_of({low, across, low}), map, 1.0);
  EXPECT_EQ(most.kind_of(0), CellKind::piece);
  EXPECT_EQ(most.kind_of(1), CellKind::ramps);
  const MapRamps few(scene_of({low, across}), map, 1.0);
  EXPECT_EQ(few.kind_of(0), CellKind::ramps);
}

TEST(MapRamps, LeavesOutWhatIsTransparent) {
  const MapRamps ramps(scene_of({{0.0F, 0.1F, 0.05F, 0.2F}, {0.0F, 1.0F, 0.5F, 0.5F}, {0.45F, 0.5F, 0.5F, 0.5F}}),
                       {{{0.3, Vec4f(1, 0, 0, 0)}, {0.4, Vec4f(1, 0, 0, 1)}, {0.5, Vec4f(1, 0, 0, 0)}}}, 1.0);
  std::array<std::uint8_t, MapRamps::most_rows> rows;
  EXPECT_EQ(ramps.rows_of(0, rows.data()), 0);
  EXPECT_EQ(ramps.rows_of(1, rows.data()), 1);
  EXPECT_EQ(ramps.rows_of(2, rows.data()), 1);
}

TEST(MapRamps, NarrowPiecesAreNotForThem) {
  const MapRamps ramps(
      scene_of({{0.0F, 0.4F, 0.2F, 0.3F}, {0.4F, 0.6F, 0.5F, 0.5F}, {0.49998F, 0.49998F, 0.49998F, 0.49998F}}),
      {{{0.5, Vec4f(1, 0, 0, 0)}, {0.5001, Vec4f(1)}, {1.0, Vec4f(1)}}}, 1.0);
  EXPECT_GT(ramps.longest(0), 0.0F);
  EXPECT_EQ(ramps.longest(1), 0.0F);
  EXPECT_EQ(ramps.longest(2), 0.0F);  // widened into it
}

// Of a cell as wide as that, float's rounding would be more than what is left.
TEST(MapRamps, SteepPiecesAreNotForWideCells) {
  const double w = 1.0 / 1500.0;
  const MapRamps ramps(scene_of({{0.2F, 0.9F, 0.5F, 0.4F}, {0.49F, 0.51F, 0.5F, 0.5F}, {0.2F, 0.3F, 0.2F, 0.3F}}),
                       {{{0.5 - w, Vec4f(1, 0, 0, 0)}, {0.5, Vec4f(1)}, {0.5 + w, Vec4f(1, 0, 0, 0)}}}, 1.0);
  EXPECT_EQ(ramps.longest(0), 0.0F);
  EXPECT_GT(ramps.longest(1), 0.0F);
  EXPECT_GT(ramps.longest(2), 0.0F);
}

// The denser, and the more the colour changes, the shorter.
TEST(MapRamps, LongestSegmentsFollowFromDepthAndChange) {
  const Scene scene = scene_of({{0.0F, 1.0F, 0.5F, 0.5F}, {0.5F, 0.5F, 0.5F, 0.5F}});
  const MapRamps ramps(scene, {{{0.0, Vec4f(0, 0, 0, 0.5)}, {1.0, Vec4f(1, 0, 0, 0.5)}}}, 8.0);
  EXPECT_NEAR(ramps.longest(0), most_ramps_change / 4.0, 1e-6);
  EXPECT_NEAR(ramps.longest(1), deepest_ramps / 4.0, 1e-6);
}

}  // namespace
