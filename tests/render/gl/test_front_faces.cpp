// Cells on the rasterizer's grid: which faces are seen, how long the segments behind them are, that no pixel is missed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "render/gl/clip_cell.h"
#include "render/gl/front_faces.h"
#include "render/gl/screen_mesh.h"
#include "tests/render/fixtures.h"

namespace atomesh::gl {
namespace {

using namespace test;

constexpr PixelGrid small_grid{0.0, 0.0, 1.0, 1.0, 64, 64};

ScreenVertex at(double column, double row, float w, float u = 0.0F) {
  return {static_cast<std::int32_t>(column * subpixels), static_cast<std::int32_t>(row * subpixels), w, u};
}

using Corners = std::array<ScreenVertex, 4>;

// What the rasterizer makes of a triangle at a pixel's centre.
struct Hit {
  double w;         // where the ray enters
  double way;       // to the nearest plane behind
  double u, far_u;  // there
};

// The rule of all rasterizers: of pixels on an edge those belong to the triangle for which it is a left or an upper
// one.
bool covers(const FaceVertex* t, double column, double row, std::array<double, 3>& weight) {
  const auto edge = [&](const FaceVertex& a, const FaceVertex& b) {
    return (static_cast<double>(b.column) - a.column) * (row - a.row) -
           (static_cast<double>(b.row) - a.row) * (column - a.column);
  };
  double area = 0.0;
  for (int k = 0; k < 3; ++k) area += weight[k] = edge(t[(k + 1) % 3], t[(k + 2) % 3]);
  if (area == 0.0) return false;
  for (int k = 0; k < 3; ++k) {
    const double dx = (static_cast<double>(t[(k + 2) % 3].column) - t[(k + 1) % 3].column) * area;
    const double dy = (static_cast<double>(t[(k + 2) % 3].row) - t[(k + 1) % 3].row) * area;
    const bool owned = dy < 0.0 || (dy == 0.0 && dx > 0.0);
    weight[k] /= area;
    if (weight[k] < 0.0 || (weight[k] == 0.0 && !owned)) return false;
  }
  return true;
}

std::vector<Hit> hits(const Corners& corners, double column, double row, const PixelGrid& grid = small_grid) {
  std::array<FaceVertex, 3 * most_faces> vertices;
  const std::size_t count = front_faces(corners, grid, vertices.data());
  std::vector<Hit> found;
  for (std::size_t n = 0; n < count; ++n) {
    const FaceVertex* t = &vertices[3 * n];
    std::array<double, 3> weight;
    if (!covers(t, column, row, weight)) continue;
    const auto mean = [&](auto member) {
      return weight[0] * member(t[0]) + weight[1] * member(t[1]) + weight[2] * member(t[2]);
    };
    Hit hit{};
    hit.w = mean([](const FaceVertex& v) { return v.w; });
    hit.u = mean([](const FaceVertex& v) { return v.u; });
    hit.way = not_behind;
    for (int m = 0; m < 3; ++m) hit.way = std::min(hit.way, mean([m](const FaceVertex& v) { return v.behind[m]; }));
    hit.far_u = hit.u + hit.way * t[0].slope;
    found.push_back(hit);
  }
  return found;
}

std::size_t face_count(const Corners& corners) {
  std::array<FaceVertex, 3 * most_faces> vertices;
  return front_faces(corners, small_grid, vertices.data());
}

TEST(FrontFaces, PeakTowardsTheEyeHasThree) {
  // Depth 1 along the outline and 0 at the peak, which is at its centre.
  const Corners cell{at(-12, -12, 1.0F, 2.0F), at(12, -12, 1.0F, 2.0F), at(0, 24, 1.0F, 2.0F), at(0, 0, 0.0F, 1.0F)};
  EXPECT_EQ(face_count(cell), 3U);
  const std::vector<Hit> peak = hits(cell, 0.001, 0.001);
  ASSERT_EQ(peak.size(), 1U);
  EXPECT_NEAR(peak[0].way, 1.0, 1e-3);
  EXPECT_NEAR(peak[0].w, 0.0, 1e-3);
  EXPECT_NEAR(peak[0].far_u, 2.0, 1e-3);
  // Half way to the edge the cell is half as thick.
  const std::vector<Hit> half = hits(cell, 0.0, -6.0);
  ASSERT_EQ(half.size(), 1U);
  EXPECT_NEAR(half[0].way, 0.5, 1e-6);
  EXPECT_NEAR(half[0].w, 0.5, 1e-6);
  EXPECT_NEAR(half[0].u, 1.5, 1e-6);
  EXPECT_NEAR(half[0].far_u, 2.0, 1e-6);
}

TEST(FrontFaces, PeakAwayFromTheEyeHasOne) {
  const Corners cell{at(-12, -12, 1.0F, 2.0F), at(12, -12, 1.0F, 2.0F), at(0, 24, 1.0F, 2.0F), at(0, 0, 3.0F, 1.0F)};
  EXPECT_EQ(face_count(cell), 1U);
  const std::vector<Hit> half = hits(cell, 0.0, -6.0);
  ASSERT_EQ(half.size(), 1U);
  EXPECT_NEAR(half[0].way, 1.0, 1e-6);
  EXPECT_NEAR(half[0].w, 1.0, 1e-6);
  EXPECT_NEAR(half[0].u, 2.0, 1e-6);
  EXPECT_NEAR(half[0].far_u, 1.5, 1e-6);
}

// Drawn by its one back face: the same segments from their other ends.
TEST(FrontFaces, PeakTowardsTheEyeIsOneFaceOfTheMirroredCell) {
  const Corners cell{at(-12, -12, -1.0F, 0.5F), at(12, -12, -1.0F, 0.5F), at(0, 24, -1.0F, 0.5F),
                     at(0, 0, -2.0F, 0.5F)};
  for (const bool perspective : {false, true}) {
    std::array<FaceVertex, 3 * most_faces> t;
    const FewestFaces faces = fewest_faces(cell, small_grid, perspective, t.data());
    ASSERT_EQ(faces.count, 1U);
    EXPECT_TRUE(faces.mirrored);
    std::array<double, 3> weight;
    ASSERT_TRUE(covers(t.data(), 0.0, -6.0, weight));
    double way = not_behind;
    for (std::size_t m = 0; m < 3; ++m) {
      way = std::min(way, weight[0] * t[0].behind[m] + weight[1] * t[1].behind[m] + weight[2] * t[2].behind[m]);
    }
    EXPECT_NEAR(way, 0.5, 1e-6);
    EXPECT_EQ(t[0].w, 1.0F);
    EXPECT_EQ(t[0].u, perspective ? -0.5F : 0.5F);
    // Where the ray enters w is -1.5, and the scalar what it is in the cell as it stands.
    const std::vector<Hit> front = hits(cell, 0.0, -6.0);
    ASSERT_EQ(front.size(), 1U);
    EXPECT_NEAR(-(t[0].w + way), front[0].w, 1e-6);
    EXPECT_NEAR((perspective ? -1.0 : 1.0) * (t[0].u + way * t[0].slope), front[0].u, 1e-6);
  }
}

// Where the back has as many faces or more it is the front.
TEST(FrontFaces, PeakAwayFromTheEyeIsNotMirrored) {
  const Corners cell{at(-12, -12, 1.0F, 2.0F), at(12, -12, 1.0F, 2.0F), at(0, 24, 1.0F, 2.0F), at(0, 0, 3.0F, 1.0F)};
  std::array<FaceVertex, 3 * most_faces> fewest;
  std::array<FaceVertex, 3 * most_faces> front;
  const FewestFaces faces = fewest_faces(cell, small_grid, true, fewest.data());
  EXPECT_FALSE(faces.mirrored);
  ASSERT_EQ(faces.count, front_faces(cell, small_grid, front.data()));
  for (std::size_t i = 0; i < 3 * faces.count; ++i) EXPECT_EQ(fewest[i].w, front[i].w);
}

TEST(FrontFaces, CrossedEdgesHaveTwo) {
  // The near edge runs along the columns at depth 1, the far one along the rows at depth 4.
  const Corners cell{at(-16, 0, 1.0F), at(16, 0, 1.0F), at(0, -16, 4.0F), at(0, 16, 4.0F)};
  EXPECT_EQ(face_count(cell), 2U);
  const std::vector<Hit> near_middle = hits(cell, 0.001, 0.001);
  ASSERT_EQ(near_middle.size(), 1U);
  EXPECT_NEAR(near_middle[0].way, 3.0, 1e-3);
  const std::vector<Hit> quarter = hits(cell, 8.0, 0.001);
  ASSERT_EQ(quarter.size(), 1U);
  EXPECT_NEAR(quarter[0].way, 1.5, 1e-3);
  EXPECT_NEAR(quarter[0].w, 1.0, 1e-3);
}

TEST(FrontFaces, FlippedCellsAreTheSame) {
  Corners cell{at(-13, -7, 1.0F, 0.1F), at(15, -9, 1.5F, 0.3F), at(2, 14, 2.5F, 0.9F), at(1, 1, 0.5F, 0.2F)};
  const std::vector<Hit> one = hits(cell, 3.0, 2.0);
  std::swap(cell[1], cell[2]);
  const std::vector<Hit> other = hits(cell, 3.0, 2.0);
  ASSERT_EQ(one.size(), 1U);
  ASSERT_EQ(other.size(), 1U);
  EXPECT_NEAR(one[0].w, other[0].w, 1e-6);
  EXPECT_NEAR(one[0].way, other[0].way, 1e-6);
  EXPECT_NEAR(one[0].far_u, other[0].far_u, 1e-6);
}

TEST(FrontFaces, FlatCellsHaveNone) {
  // All corners on a line of the screen; all in one plane; all in one point.
  EXPECT_EQ(face_count({at(0, 0, 1.0F), at(4, 4, 2.0F), at(8, 8, 0.0F), at(12, 12, 5.0F)}), 0U);
  EXPECT_EQ(face_count({at(0, 0, 1.0F), at(8, 0, 1.0F), at(0, 8, 1.0F), at(9, 9, 1.0F)}), 0U);
  EXPECT_EQ(face_count({at(3, 3, 1.0F), at(3, 3, 1.0F), at(3, 3, 1.0F), at(3, 3, 1.0F)}), 0U);
}

TEST(FrontFaces, CellsBetweenPixelsHaveNone) {
  EXPECT_EQ(face_count({at(0.6, 0.6, 1.0F), at(1.4, 0.6, 1.0F), at(1.0, 1.4, 1.0F), at(1.0, 1.0, 2.0F)}), 0U);
  EXPECT_EQ(face_count({at(0.4, 0.4, 1.0F), at(1.4, 0.4, 1.0F), at(1.0, 1.4, 1.0F), at(1.0, 1.0, 2.0F)}), 1U);
}

TEST(FrontFaces, EdgeOnFacesLimitNothing) {
  // The face opposite corner 0 is seen from its side: corners 1, 2 and 3 stand in one column.
  const Corners cell{at(-10, 0, 1.0F), at(0, -10, 1.0F), at(0, 10, 1.0F), at(0, 0, 3.0F)};
  const std::vector<Hit> near_face = hits(cell, -0.001, 0.001);
  ASSERT_EQ(near_face.size(), 1U);
  EXPECT_NEAR(near_face[0].way, 2.0, 1e-3);
}

// What the outside of the mesh alone says: where the ray leaves less where it enters, over all of its surface.
double way_through_surface(const Surface& surface, const std::map<Index, ScreenVertex>& vertices, double column,
                           double row) {
  double sum = 0.0;
  for (const Triangle& triangle : surface.triangles) {
    std::array<FaceVertex, 3> t{};
    for (std::size_t k = 0; k < 3; ++k) {
      const ScreenVertex& v = vertices.at(triangle[k]);
      t[k].column = static_cast<float>(v.column) / subpixels;
      t[k].row = static_cast<float>(v.row) / subpixels;
      t[k].w = v.w;
    }
    std::array<double, 3> weight;
    if (!covers(t.data(), column, row, weight)) continue;
    const double area = (static_cast<double>(t[1].column) - t[0].column) * (static_cast<double>(t[2].row) - t[0].row) -
                        (static_cast<double>(t[1].row) - t[0].row) * (static_cast<double>(t[2].column) - t[0].column);
    const double w = weight[0] * t[0].w + weight[1] * t[1].w + weight[2] * t[2].w;
    // Outward triangles run counter-clockwise to who sees them: with a negative area, as rows go down.
    sum += area > 0.0 ? w : -w;
  }
  return sum;
}

class Watertight : public testing::TestWithParam<Projection> {};

TEST_P(Watertight, EveryPixelSumsUpToTheWayThroughTheMesh) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    Subject subject = shaken_box(Mode::volume, GetParam(), 60, 60);
    subject.material = box_material(4, 3, 3, 2.0, shaking(0.35, seed));
    add_defects(subject.material, seed);
    subject.parameters.volume.color_map.entries.front().color.a = 0.5F;
    subject.scene = make_scene(subject.material, subject.parameters);
    subject.camera = make_camera(subject.parameters, subject.scene.bounds, 60, 60);
    const PixelGrid grid = pixel_grid(subject.camera, whole_picture(subject.camera));
    const ScreenMesh mesh(subject.scene, subject.camera, grid,
                          cell_projection::MapIntervals(subject.parameters.volume.color_map), no_progress());
    ASSERT_EQ(mesh.parts(mesh.cells()).size(), mesh.cells().size());
    std::map<Index, ScreenVertex> vertices;
    for (const Index cell : mesh.cells()) {
      for (std::size_t k = 0; k < 4; ++k) vertices[subject.scene.tetrahedra[cell][k]] = mesh.corners(cell)[k];
    }
    ASSERT_EQ(vertices.size(), subject.scene.vertices.size());
    int covered = 0;
    for (int j = 0; j < 60; ++j) {
      for (int i = 0; i < 60; ++i) {
        const double column = i - 30 + 0.5;
        const double row = j - 30 + 0.5;
        double sum = 0.0;
        for (const Index cell : mesh.cells()) {
          const std::vector<Hit> found = hits(mesh.corners(cell), column, row, grid);
          ASSERT_LE(found.size(), 1U) << "cell " << cell << " twice in pixel " << i << ' ' << j;
          if (!found.empty()) sum += found[0].way;
        }
        const double expected = way_through_surface(subject.material.surface, vertices, column, row);
        ASSERT_NEAR(sum, expected, 2e-6 * (1.0 + std::abs(expected))) << "pixel " << i << ' ' << j << " seed " << seed;
        covered += expected > 0.0 ? 1 : 0;
      }
    }
    EXPECT_GT(covered, 500);
  }
}

INSTANTIATE_TEST_SUITE_P(Both, Watertight, testing::Values(Projection::parallel, Projection::perspective));

double volume_of(const std::vector<CellCorners>& pieces) {
  double sum = 0.0;
  for (const CellCorners& c : pieces) {
    const double volume = signed_volume(c[0].p, c[1].p, c[2].p, c[3].p);
    EXPECT_GE(volume, -1e-15);
    sum += volume;
  }
  return sum;
}

TEST(ClipCell, PartsOfACornerHaveTheirVolumes) {
  const CellCorners cell{{{{0, 0, 0}, 0.0}, {{1, 0, 0}, 1.0}, {{0, 1, 0}, 2.0}, {{0, 0, 1}, 3.0}}};
  std::vector<CellCorners> pieces;
  clip_cell(cell, std::array{HalfSpace{{0, 0, 1}, 0.5}}, pieces);  // one corner is left
  EXPECT_NEAR(volume_of(pieces), 0.125 / 6.0, 1e-12);
  pieces.clear();
  clip_cell(cell, std::array{HalfSpace{{0, 0, -1}, -0.5}}, pieces);  // three are
  EXPECT_NEAR(volume_of(pieces), 0.875 / 6.0, 1e-12);
  pieces.clear();
  clip_cell(cell, std::array{HalfSpace{{1, -1, 0}, 0.0}}, pieces);  // cut through an edge: half
  EXPECT_NEAR(volume_of(pieces), 0.5 / 6.0, 1e-12);
  pieces.clear();
  clip_cell(cell, std::array{HalfSpace{{1, 1, -1}, -0.3}, HalfSpace{{-1, -1, 1}, 0.3}}, pieces);  // a plane
  EXPECT_NEAR(volume_of(pieces), 0.0, 1e-12);
  pieces.clear();
  clip_cell(cell, std::array{HalfSpace{{-1, 0, 0}, 0.1}}, pieces);
  EXPECT_TRUE(pieces.empty());
}

TEST(ClipCell, ScalarsStayLinear) {
  const CellCorners cell{{{{0, 0, 0}, 0.0}, {{1, 0, 0}, 1.0}, {{0, 1, 0}, 2.0}, {{0, 0, 1}, 3.0}}};
  std::vector<CellCorners> pieces;
  clip_cell(cell, std::array{HalfSpace{{0.3, -1, 0.2}, -0.2}, HalfSpace{{-1, 0.5, 0.1}, -0.3}}, pieces);
  ASSERT_FALSE(pieces.empty());
  for (const CellCorners& piece : pieces) {
    for (const CellCorner& c : piece) EXPECT_NEAR(c.scalar, c.p.x + 2.0 * c.p.y + 3.0 * c.p.z, 1e-12);
  }
}

TEST(ClipCell, BothSidesOfAPlaneMakeTheWhole) {
  const CellCorners cell{{{{0.1, 0, 0.2}, 0.0}, {{1, 0.3, 0}, 1.0}, {{0, 1, 0.4}, 2.0}, {{0.2, 0.5, 1}, 3.0}}};
  const double whole = signed_volume(cell[0].p, cell[1].p, cell[2].p, cell[3].p);
  ASSERT_GT(whole, 0.0);
  for (const double distance : {0.15, 0.3, 0.45}) {  // one, two and three corners inside
    for (const Vec3& normal : {Vec3(1, 0, 0), Vec3(0.2, 0.9, 0.1), Vec3(-0.1, 0.3, 1)}) {
      std::vector<CellCorners> pieces;
      clip_cell(cell, std::array{HalfSpace{normal, distance}}, pieces);
      clip_cell(cell, std::array{HalfSpace{-normal, -distance}}, pieces);
      EXPECT_NEAR(volume_of(pieces), whole, 1e-12);
    }
  }
}

}  // namespace
}  // namespace atomesh::gl
