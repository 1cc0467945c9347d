// Lists of lights and cut planes, and cut planes by Miller indices: known answers.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "app/gui/miller_cut.h"
#include "app/gui/numbered_parts.h"
#include "core/error.h"

namespace atomesh::gui {
namespace {

UnitCell cell_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  UnitCell cell;
  cell.primitive = {a, b, c};
  cell.basis = {{"Cu", Vec3(0.0)}};
  return cell;
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance = 1e-12) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], tolerance) << "component " << k;
}

TEST(MillerCut, OfACubicCell) {
  const UnitCell cell = cell_of({4, 0, 0}, {0, 4, 0}, {0, 0, 4});
  MillerCut cut;
  cut.hkl = {1, 1, 0};
  cut.offset = 3.0;
  cut.side = CutPlane::Side::greater_equal;
  const CutPlane plane = miller_cut(cell, {1, 1, 7}, cut);
  EXPECT_TRUE(plane.enabled);
  EXPECT_EQ(plane.side, CutPlane::Side::greater_equal);
  expect_near(plane.normal, Vec3(std::sqrt(0.5), std::sqrt(0.5), 0.0));
  EXPECT_NEAR(plane.distance, std::sqrt(2.0) + 3.0, 1e-12);
  // d(110) = a / sqrt(2)
  cut.unit = MillerCut::Unit::planes;
  EXPECT_NEAR(miller_cut(cell, {0, 0, 0}, cut).distance, 3.0 * 4.0 / std::sqrt(2.0), 1e-12);
}

TEST(MillerCut, OfAHexagonalCell) {
  const double a = 2.46;
  const double c = 6.71;
  const UnitCell cell = cell_of({a, 0, 0}, {-0.5 * a, 0.5 * std::sqrt(3.0) * a, 0}, {0, 0, c});
  MillerCut cut;
  cut.unit = MillerCut::Unit::planes;
  cut.offset = 2.0;
  cut.hkl = {0, 0, 2};
  expect_near(miller_cut(cell, Vec3(0.0), cut).normal, Vec3(0, 0, 1));
  EXPECT_NEAR(miller_cut(cell, Vec3(0.0), cut).distance, c, 1e-12);
  // (100) is at right angles to b, and d = a sqrt(3) / 2.
  cut.hkl = {1, 0, 0};
  EXPECT_NEAR(glm::dot(miller_cut(cell, Vec3(0.0), cut).normal, cell.primitive[1]), 0.0, 1e-12);
  EXPECT_NEAR(miller_cut(cell, Vec3(0.0), cut).distance, 2.0 * a * std::sqrt(3.0) / 2.0, 1e-12);
}

TEST(MillerCut, RefusesNoPlane) {
  const UnitCell cell = cell_of({4, 0, 0}, {0, 4, 0}, {0, 0, 4});
  MillerCut cut;
  cut.hkl = Vec3(0.0);
  EXPECT_THROW(miller_cut(cell, Vec3(0.0), cut), UsageError);
}

TEST(MillerIndices, AreFoundAgainForEveryCellAndPlane) {
  const UnitCell triclinic = cell_of({3.1, 0.2, -0.4}, {-1.0, 4.7, 0.9}, {0.6, 1.5, 5.2});
  for (int h = -3; h <= 3; ++h) {
    for (int k = -3; k <= 3; ++k) {
      for (int l = -3; l <= 3; ++l) {
        if (std::gcd(std::gcd(h, k), l) != 1) continue;
        MillerCut cut;
        cut.hkl = Vec3(h, k, l);
        const auto found = miller_indices(triclinic, 17.0 * miller_cut(triclinic, Vec3(0.0), cut).normal);
        ASSERT_TRUE(found) << h << k << l;
        EXPECT_EQ(*found, cut.hkl);
      }
    }
  }
  EXPECT_FALSE(miller_indices(triclinic, {1.0, 0.0, 0.0}));
  EXPECT_FALSE(miller_indices(triclinic, Vec3(0.0)));
}

TEST(Lights, TheListGrowsAndShrinks) {
  Parameters parameters;
  EXPECT_EQ(light_count(parameters), 2);
  set_light_count(parameters, 8);
  EXPECT_EQ(light_count(parameters), 8);
  EXPECT_EQ(parameters.lights[0], Parameters().lights[0]);
  EXPECT_EQ(parameters.lights[1], Parameters().lights[1]);
  for (std::size_t i = 2; i < 8; ++i) {
    EXPECT_TRUE(parameters.lights[i].enabled);
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(parameters.lights[i].position, parameters.lights[j].position) << i;
  }
  EXPECT_NO_THROW(check_parameters(parameters));
  const Light third = parameters.lights[2];
  remove_light(parameters, 2);
  EXPECT_EQ(light_count(parameters), 7);
  EXPECT_EQ(parameters.lights[1], third);
  set_light_count(parameters, 1);
  EXPECT_EQ(light_count(parameters), 1);
  EXPECT_FALSE(parameters.lights[1].enabled);
  EXPECT_THROW(set_light_count(parameters, 0), UsageError);
  EXPECT_THROW(set_light_count(parameters, 9), UsageError);
  EXPECT_THROW(remove_light(parameters, 2), UsageError);
}

TEST(CutPlanes, NewOnesCutThroughTheMiddle) {
  Bounds bounds;
  bounds.add({0.0, 2.0, 4.0});
  bounds.add({10.0, 12.0, 24.0});
  Parameters parameters;
  EXPECT_EQ(cut_plane_count(parameters), 0);
  set_cut_plane_count(parameters, 3, bounds);
  EXPECT_EQ(cut_plane_count(parameters), 3);
  EXPECT_EQ(parameters.cut_planes[0].normal, Vec3(1, 0, 0));
  EXPECT_EQ(parameters.cut_planes[0].distance, 5.0);
  EXPECT_EQ(parameters.cut_planes[2].normal, Vec3(0, 0, 1));
  EXPECT_EQ(parameters.cut_planes[2].distance, 14.0);
  flip_cut_plane(parameters, 3);
  EXPECT_EQ(parameters.cut_planes[2].side, CutPlane::Side::greater_equal);
  remove_cut_plane(parameters, 1);
  EXPECT_EQ(cut_plane_count(parameters), 2);
  EXPECT_EQ(parameters.cut_planes[1].side, CutPlane::Side::greater_equal);
  EXPECT_EQ(parameters.cut_planes[2], CutPlane{});
  // Without a sample (no bounds) through the origin.
  Parameters without;
  set_cut_plane_count(without, 8, Bounds{});
  EXPECT_EQ(cut_plane_count(without), 8);
  EXPECT_NO_THROW(check_parameters(without));
  EXPECT_THROW(set_cut_plane_count(parameters, 9, bounds), UsageError);
}

}  // namespace
}  // namespace atomesh::gui
