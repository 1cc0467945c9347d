// Sorting on the graphics card against sorting on the CPU.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "render/gl/context.h"
#include "render/gl/radix_sort.h"
#include "tests/render/fixtures.h"

using namespace atomesh;
using namespace atomesh::gl;
using namespace atomesh::test;

namespace {

class RadixSortTest : public testing::Test {
 protected:
  HeadlessContext context_{true};
  HeadlessContext::Current current_{context_};
};

TEST_F(RadixSortTest, IsTheStableOne) {
  RadixSort radix_sort;
  std::mt19937 random(7);
  for (const std::size_t count : {0UL, 1UL, 2UL, 255UL, 2048UL, 2049UL, 100'003UL}) {
    for (const std::uint32_t mask : {0xFFFFFFFFU, 0xFFU, 0xF0000000U, 0U}) {
      std::vector<KeyedCell> cells(count);
      for (std::size_t i = 0; i < count; ++i) {
        cells[i] = {static_cast<std::uint32_t>(random()) & mask, static_cast<Index>(i)};
      }
      Buffer buffer;
      buffer.write(std::span<const KeyedCell>(cells));
      radix_sort.sort(buffer, count);
      glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
      const std::vector<KeyedCell> sorted = buffer.read<KeyedCell>(count);
      std::ranges::stable_sort(cells, {}, &KeyedCell::key);
      for (std::size_t i = 0; i < count; ++i) {
        ASSERT_EQ(sorted[i].key, cells[i].key) << count << " cells, mask " << mask << ", place " << i;
        ASSERT_EQ(sorted[i].cell, cells[i].cell) << count << " cells, mask " << mask << ", place " << i;
      }
    }
  }
  check_errors("sorting");
}

TEST_F(RadixSortTest, LeavesWhatStandsBehindTheCount) {
  RadixSort radix_sort;
  std::vector<KeyedCell> cells(3000);
  for (std::size_t i = 0; i < cells.size(); ++i)
    cells[i] = {static_cast<std::uint32_t>(3000 - i), static_cast<Index>(i)};
  Buffer buffer;
  buffer.write(std::span<const KeyedCell>(cells));
  radix_sort.sort(buffer, 2500);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  const std::vector<KeyedCell> sorted = buffer.read<KeyedCell>(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) ASSERT_EQ(sorted[i].cell, i < 2500 ? 2499 - i : i) << i;
}

TEST_F(RadixSortTest, GivesTheOrderOfTheCpu) {
  Parameters parameters = looking(Mode::volume, "iso", Projection::perspective);
  Scene scene = make_scene(box_material(12, 12, 12, 2.0, shaking(0.3, 5)), parameters);
  std::vector<Index> cells(scene.tetrahedra.size());
  std::iota(cells.begin(), cells.end(), Index{0});
  std::erase_if(cells, [](Index cell) { return cell % 5 == 0; });
  Buffer drawn;
  drawn.write(std::span<const Index>(cells));
  for (const bool delaunay : {false, true}) {
    scene.delaunay = delaunay;
    CellOrder cell_order(scene, false);
    CardOrder card_order(cell_order.points());
    for (const Projection projection : {Projection::parallel, Projection::perspective}) {
      parameters.projection = projection;
      const Camera camera = make_camera(parameters, scene.bounds, 64, 64);
      const KeyScale scale = key_scale(camera, scene);
      std::vector<Index> expected;
      CellOrderStats stats;
      cell_order.sort(camera, cells, {}, expected, stats);
      card_order.sort(scale, drawn, cells.size());
      glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
      const std::vector<KeyedCell> order = card_order.order().read<KeyedCell>(cells.size());
      ASSERT_TRUE(std::ranges::is_sorted(order, {}, &KeyedCell::key));
      std::size_t elsewhere = 0;
      for (std::size_t i = 0; i < order.size(); ++i) {
        const auto key = static_cast<std::int64_t>(key_of(scale, cell_order.points()[order[i].cell]));
        ASSERT_LE(std::abs(key - static_cast<std::int64_t>(order[i].key)), 2) << "cell " << order[i].cell;
        elsewhere += order[i].cell != expected[i] ? 1 : 0;
      }
      EXPECT_LT(elsewhere, order.size() / 1000);
      std::vector<Index> sorted;
      for (const KeyedCell& keyed : order) sorted.push_back(keyed.cell);
      std::ranges::sort(sorted);
      EXPECT_EQ(sorted, cells);
    }
  }
  check_errors("ordering cells");
}

}  // namespace
