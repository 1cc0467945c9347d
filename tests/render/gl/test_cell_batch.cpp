// What lies on the same pixels is drawn in order, by a program that can.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "render/gl/cell_batch.h"

using namespace atomesh;
using namespace atomesh::gl;

namespace {

constexpr std::array kinds{CellKind::piece, CellKind::ramps, CellKind::segment};

// A triangle that knows its cell.
struct Triangle {
  explicit Triangle(std::size_t cell) {
    for (FaceVertex& vertex : faces) vertex.u = static_cast<float>(cell);
    ramps.fill({static_cast<float>(cell), 0.0F});
  }
  std::array<FaceVertex, 3> faces{};
  std::array<RampVertex, 3> ramps{};
};

bool add(CellBatch& batch, std::size_t cell, const GridBox& box, CellKind kind) {
  const Triangle triangle(cell);
  return batch.add(box, kind, triangle.faces, kind == CellKind::segment ? nullptr : triangle.ramps.data());
}

std::vector<std::size_t> cells_of(const CellBatch::List& list) {
  std::vector<std::size_t> cells;
  for (std::size_t i = 0; i < list.faces.size(); i += 3) cells.push_back(static_cast<std::size_t>(list.faces[i].u));
  return cells;
}

using Cells = std::vector<std::size_t>;

TEST(CellBatch, CellsApartGoToTheListsOfTheirKinds) {
  CellBatch batch(100, 100);
  EXPECT_TRUE(add(batch, 0, {0, 9, 0, 9}, CellKind::segment));
  EXPECT_TRUE(add(batch, 1, {10, 19, 0, 9}, CellKind::ramps));
  EXPECT_TRUE(add(batch, 2, {0, 9, 10, 19}, CellKind::piece));
  EXPECT_TRUE(add(batch, 3, {20, 29, 0, 9}, CellKind::ramps));
  EXPECT_EQ(cells_of(batch.list(CellKind::piece)), (Cells{2}));
  EXPECT_EQ(cells_of(batch.list(CellKind::ramps)), (Cells{1, 3}));
  EXPECT_EQ(cells_of(batch.list(CellKind::segment)), (Cells{0}));
  EXPECT_EQ(batch.cells(), 4U);
  EXPECT_EQ(batch.vertices(), 12U);
  EXPECT_EQ(batch.list(CellKind::ramps).ramps.size(), 6U);
  EXPECT_TRUE(batch.list(CellKind::segment).ramps.empty());
}

TEST(CellBatch, ACellOnALaterListsCellsFollowsThem) {
  CellBatch batch(100, 100);
  EXPECT_TRUE(add(batch, 0, {0, 9, 0, 9}, CellKind::ramps));
  EXPECT_TRUE(add(batch, 1, {9, 12, 9, 12}, CellKind::piece));
  EXPECT_TRUE(add(batch, 2, {12, 14, 12, 14}, CellKind::piece));  // on one that went to the later list itself
  EXPECT_TRUE(add(batch, 3, {15, 16, 12, 14}, CellKind::piece));
  EXPECT_EQ(cells_of(batch.list(CellKind::piece)), (Cells{3}));
  EXPECT_EQ(cells_of(batch.list(CellKind::ramps)), (Cells{0, 1, 2}));
}

// What is not a sum of ramps cannot be drawn as one, nor the other way round: pictures would depend on it.
TEST(CellBatch, ASumOfRampsOnASegmentHasToWait) {
  CellBatch batch(100, 100);
  EXPECT_TRUE(add(batch, 0, {0, 9, 0, 9}, CellKind::segment));
  EXPECT_FALSE(add(batch, 1, {5, 5, 5, 5}, CellKind::piece));
  EXPECT_FALSE(add(batch, 1, {5, 5, 5, 5}, CellKind::ramps));
  EXPECT_EQ(batch.cells(), 1U);
  EXPECT_TRUE(add(batch, 1, {5, 5, 5, 5}, CellKind::segment));
  batch.clear();
  EXPECT_EQ(batch.cells(), 0U);
  EXPECT_EQ(batch.vertices(), 0U);
  EXPECT_TRUE(add(batch, 1, {5, 5, 5, 5}, CellKind::piece));
  EXPECT_EQ(cells_of(batch.list(CellKind::piece)), (Cells{1}));
}

// Boxes of all sizes in pictures of all shapes, also across words of 64 squares and where a square is many pixels.
TEST(CellBatch, WhatMeetsIsDrawnInOrder) {
  std::mt19937 random(5);
  for (const auto& [columns, rows] : {std::pair(256, 256), {1, 1}, {257, 3}, {1024, 700}, {30, 5000}}) {
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    std::vector<GridBox> boxes;
    std::vector<CellKind> own;
    std::vector<std::size_t> drawn;  // cells in order
    std::size_t moved = 0;
    CellBatch batch(columns, rows);
    const auto draw = [&] {
      for (const CellKind kind : kinds) {
        for (const std::size_t cell : cells_of(batch.list(kind))) {
          ASSERT_EQ(kind == CellKind::segment, own[cell] == CellKind::segment);
          ASSERT_GE(kind, own[cell]);
          moved += !drawn.empty() && drawn.back() > cell ? 1 : 0;
          drawn.push_back(cell);
        }
      }
      batch.clear();
    };
    for (std::size_t cell = 0; cell < 1500; ++cell) {
      const int left = below(columns);
      const int top = below(rows);
      const int most = cell % 50 == 0 ? 400 : 20;
      boxes.push_back({left, std::min(left + below(most), columns - 1), top, std::min(top + below(most), rows - 1)});
      own.push_back(kinds[static_cast<std::size_t>(below(20)) % 7 % 3]);
      if (add(batch, cell, boxes.back(), own.back())) continue;
      draw();
      ASSERT_TRUE(add(batch, cell, boxes.back(), own.back()));
    }
    draw();
    ASSERT_EQ(drawn.size(), boxes.size());
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      const GridBox& a = boxes[drawn[i]];
      for (std::size_t j = i + 1; j < drawn.size(); ++j) {
        const GridBox& b = boxes[drawn[j]];
        const bool meet = a.left <= b.right && b.left <= a.right && a.top <= b.bottom && b.top <= a.bottom;
        ASSERT_TRUE(!meet || drawn[i] < drawn[j]) << drawn[i] << " and " << drawn[j] << " of " << columns << " columns";
      }
    }
    if (columns > 1) {
      EXPECT_GT(moved, 20U);
    }
  }
}

}  // namespace
