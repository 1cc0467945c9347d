// The histogram counts what the colour map is asked for; its file reads back to the same numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "app/gui/scalar_histogram.h"
#include "core/error.h"
#include "core/text_file.h"
#include "preprocess/pipeline.h"
#include "preprocess/write_atoms.h"
#include "render/scene.h"
#include "render/scene_parts.h"
#include "samples/samples.h"
#include "tests/support/meshes.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;

Material with_field(std::vector<float> values) {
  Material material;
  material.mesh = test::cubes(1, [](int, int, int) { return false; });
  values.resize(material.mesh.vertices.size(), values.back());
  material.fields.push_back({"pressure", std::move(values)});
  return material;
}

// Eight atoms at a cube's corners with these positional values.
Material with_defects(const std::vector<float>& positional) {
  Material material;
  material.mesh = test::cube_of_six(2.0);
  material.atoms.positions = material.mesh.vertices;
  material.atoms.species.assign(8, material.atoms.add_species("Cu"));
  material.defects.positional = positional;
  material.defects.extra.assign(8, 0.0F);
  material.defects.vacancy.assign(8, 0.0F);
  return material;
}

TEST(ScalarHistogram, CountsOfAFieldWithItsOwnRange) {
  const Material material = with_field({10, 20, 11, 14, 15, 19, 12, 12});
  const ScalarHistogram h = scalar_histogram(material, {}, 10);
  EXPECT_EQ(h.name, "pressure");
  EXPECT_FALSE(h.of_atoms);
  EXPECT_EQ(h.low, 10.0);
  EXPECT_EQ(h.high, 20.0);
  EXPECT_EQ(h.counts, (std::vector<std::uint64_t>{1, 1, 2, 0, 1, 1, 0, 0, 0, 2})) << "the last bin holds its end";
  EXPECT_EQ(h.below, 0U);
  EXPECT_EQ(h.above, 0U);
  EXPECT_EQ(h.total(), 8U);
  EXPECT_EQ(h.largest(), 2U);
  EXPECT_DOUBLE_EQ(h.value(0.25), 12.5);
  EXPECT_DOUBLE_EQ(h.scalar(12.5), 0.25);
}

TEST(ScalarHistogram, WhatLiesOutsideOfASetRangeIsCountedApart) {
  const Material material = with_field({10, 20, 11, 14, 15, 19, 12, 12});
  VolumeParameters parameters;
  parameters.range_low = 12.0;
  parameters.range_high = 16.0;
  const ScalarHistogram h = scalar_histogram(material, parameters, 4);
  EXPECT_EQ(h.counts, (std::vector<std::uint64_t>{2, 0, 1, 1}));
  EXPECT_EQ(h.below, 2U);
  EXPECT_EQ(h.above, 2U);
  EXPECT_EQ(h.total(), 8U);
  parameters.range_high = 3.0;
  EXPECT_THROW(scalar_histogram(material, parameters, 4), UsageError);
  parameters = {};
  parameters.field = "presure";
  EXPECT_THROW(scalar_histogram(material, parameters, 4), UsageError);
}

TEST(ScalarHistogram, OneValueEverywhereIsTheMapsMiddle) {
  const ScalarHistogram h = scalar_histogram(with_field({3}), {}, 8);
  EXPECT_EQ(h.counts, (std::vector<std::uint64_t>{0, 0, 0, 0, 8, 0, 0, 0}));
  EXPECT_EQ(h.scalar(3.0), 0.5);
  EXPECT_EQ(h.value(0.5), 3.0);
}

TEST(ScalarHistogram, HugeRangesDoNotOverflow) {
  const float huge = 3e38F;
  const ScalarHistogram h = scalar_histogram(with_field({-huge, huge, 0, 0, 0, 0, 0, 0}), {}, 3);
  EXPECT_EQ(h.counts, (std::vector<std::uint64_t>{1, 6, 1}));
  EXPECT_EQ(h.value(1.0), huge);
  EXPECT_EQ(h.value(0.0), -huge);
}

TEST(ScalarHistogram, DefectsAreWeightedAndDividedByTheLargest) {
  Material material = with_defects({0, 0, 0, 0, 0, 1, 2, 0});
  material.defects.vacancy = {0, 0, 0, 0, 0, 0, 0, 2};
  VolumeParameters parameters;
  parameters.positional_multiplier = 1.0;
  parameters.vacancy_multiplier = 2.0;
  const ScalarHistogram h = scalar_histogram(material, parameters, 4);
  EXPECT_TRUE(h.of_atoms);
  EXPECT_EQ(h.low, 0.0);
  EXPECT_EQ(h.high, 4.0);
  EXPECT_EQ(h.counts, (std::vector<std::uint64_t>{5, 1, 1, 1}));
  parameters.vacancy_multiplier = 0.0;
  EXPECT_EQ(scalar_histogram(material, parameters, 4).high, 2.0);
}

TEST(ScalarHistogram, PerfectCrystalsAndThoseWithoutDefectsAreAllZero) {
  Material material = with_defects(std::vector<float>(8, 0.0F));
  EXPECT_EQ(scalar_histogram(material, {}, 4).counts.front(), 8U);
  material.defects = {};
  const ScalarHistogram h = scalar_histogram(material, {}, 4);
  EXPECT_EQ(h.counts.front(), 8U);
  EXPECT_EQ(h.high, 0.0);
}

TEST(ScalarHistogram, BinsAreBounded) {
  const Material material = with_field({1, 2});
  EXPECT_THROW(scalar_histogram(material, {}, 0), UsageError);
  EXPECT_THROW(scalar_histogram(material, {}, max_bins + 1), UsageError);
  EXPECT_EQ(scalar_histogram(material, {}, max_bins).counts.size(), static_cast<std::size_t>(max_bins));
}

TEST(ScalarHistogram, CanBeCancelled) {
  Progress progress;
  progress.request_cancel();
  EXPECT_THROW(scalar_histogram(with_field({1, 2}), {}, 4, progress), CancelledError);
}

// More than one piece of work, against a plain loop over what the renderers show.
TEST(ScalarHistogram, IsThatOfTheScene) {
  Material material;
  material.mesh = test::cubes(44, [](int, int, int) { return false; });
  std::vector<float> values(material.mesh.vertices.size());
  ASSERT_GT(values.size(), 85000U);
  for (std::size_t v = 0; v < values.size(); ++v) values[v] = static_cast<float>((v * 7919) % 10007) * 0.01F;
  material.fields.push_back({"f", values});
  const VolumeParameters parameters;
  const ScalarHistogram h = scalar_histogram(material, parameters, 64);
  std::vector<std::uint64_t> expected(64, 0);
  const std::vector<float> scalars = vertex_scalars(material, parameters);
  // Scalars of the scene are float: those within its rounding of a bin's edge may stand on its other side.
  std::uint64_t at_edges = 0;
  for (const float s : scalars) {
    ++expected[std::min(static_cast<std::size_t>(s * 64.0F), std::size_t{63})];
    const float in_bins = s * 64.0F;
    if (std::abs(in_bins - std::round(in_bins)) < 1e-5F) ++at_edges;
  }
  std::uint64_t moved = 0;
  for (std::size_t b = 0; b < 64; ++b) {
    moved += expected[b] > h.counts[b] ? expected[b] - h.counts[b] : h.counts[b] - expected[b];
  }
  EXPECT_LE(moved, 2 * at_edges);
  EXPECT_LT(at_edges, values.size() / 100);
  EXPECT_EQ(h.total(), values.size());
}

TEST(ScalarHistogram, OfASampleCountsEachAtomAlsoWhenSimplified) {
  const test::TemporaryFolder folder;
  const Sample sample = make_sample("diamond-vacancy", {.atoms = 3000});
  const std::string path = folder.file("sample.dat");
  write_atoms(path, sample.atoms, sample.unit_cell);
  PipelineOptions options;
  PipelineReport report;
  const Material whole = preprocess(path, options, report);
  options.simplify = true;
  const Material simplified = preprocess(path, options, report);
  ASSERT_LT(simplified.mesh.vertices.size(), whole.mesh.vertices.size());

  const ScalarHistogram h = scalar_histogram(whole, {}, 32);
  EXPECT_EQ(h.total(), sample.atoms.size());
  EXPECT_EQ(h.counts, scalar_histogram(simplified, {}, 32).counts);
  std::size_t regular = 0;
  for (std::size_t a = 0; a < whole.atoms.size(); ++a) regular += whole.defects.defective(a) ? 0 : 1;
  EXPECT_GE(h.counts.front(), regular);
  EXPECT_GT(regular, sample.atoms.size() / 2);
  EXPECT_GT(h.counts.back(), 0U) << "the largest is in the last bin";
}

std::vector<std::vector<std::string>> read_csv(const std::string& path) {
  std::ifstream in(path);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> cells;
    std::stringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    rows.push_back(cells);
  }
  return rows;
}

TEST(ScalarHistogram, TheFileReadsBack) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("histogram.csv");
  VolumeParameters parameters;
  parameters.range_low = 0.1;
  parameters.range_high = 0.7;
  const ScalarHistogram h =
      scalar_histogram(with_field({0.05F, 0.1F, 0.2F, 0.3F, 0.4F, 0.69F, 0.9F, 1.0F}), parameters, 3);
  write_histogram_csv(path, h);
  const auto rows = read_csv(path);
  ASSERT_EQ(rows.size(), 6U);
  EXPECT_EQ(rows[0], (std::vector<std::string>{"scalar_from", "scalar_to", "value_from", "value_to", "count"}));
  EXPECT_EQ(rows[1], (std::vector<std::string>{"-inf", "0", "-inf", "0.1", "1"}));
  EXPECT_EQ(rows[5], (std::vector<std::string>{"1", "inf", "0.7", "inf", "2"}));
  std::uint64_t sum = 0;
  for (std::size_t b = 0; b < 3; ++b) {
    const auto& row = rows[b + 2];
    EXPECT_EQ(std::stod(row[0]), static_cast<double>(b) / 3.0);
    EXPECT_EQ(std::stod(row[1]), static_cast<double>(b + 1) / 3.0);
    EXPECT_EQ(std::stod(row[2]), h.value(static_cast<double>(b) / 3.0));
    EXPECT_EQ(row[4], std::to_string(h.counts[b]));
    sum += std::stoull(row[4]);
    EXPECT_EQ(row[0], rows[b + 1][1]) << "no gap";
  }
  EXPECT_EQ(sum + 3, 8U);
  EXPECT_THROW(write_histogram_csv(folder.file("none/histogram.csv"), h), Error);
}

TEST(ScalarHistogram, BarHeights) {
  EXPECT_EQ(bar_height(0, 10, false), 0.0);
  EXPECT_EQ(bar_height(0, 10, true), 0.0);
  EXPECT_EQ(bar_height(10, 10, true), 1.0);
  EXPECT_DOUBLE_EQ(bar_height(5, 10, false), 0.5);
  EXPECT_NEAR(bar_height(1, 1023, true), 0.1, 1e-12);
  EXPECT_EQ(bar_height(0, 0, true), 0.0);
}

}  // namespace
