#include <gtest/gtest.h>

#include "core/surface.h"
#include "preprocess/simplify_certificate.h"
#include "preprocess/star_mesh.h"
#include "tests/support/lattices.h"
#include "tests/support/meshes.h"

namespace atomesh {
namespace {

std::size_t least(const TetMesh& mesh) {
  return least_tetrahedra(0, extract_surface(mesh).triangles, mesh.vertices);
}

TEST(LeastTetrahedra, KnownAnswers) {
  EXPECT_EQ(least({}), 0U);
  EXPECT_EQ(least(test::regular_tetrahedron()), 1U);
  EXPECT_EQ(least(test::two_at_an_edge()), 2U);
  // A cube whose sides' diagonals all start at two opposite corners cannot be cut into five as others can: six it is.
  EXPECT_EQ(least(test::cube_of_six()), 6U);
  // Two tetrahedra on one triangle: three outer triangles each.
  const TetMesh two =
      test::mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, 1}, {0.2, 0.2, -1}}, {{0, 1, 2, 3}, {0, 2, 1, 4}});
  EXPECT_EQ(validate(two), std::vector<std::string>{});
  EXPECT_EQ(least(two), 2U);
  EXPECT_EQ(least_tetrahedra(7, {}, {}), 7U);
}

TEST(LeastTetrahedra, FlatSidesShareNothing) {
  // Of 12 n² triangles, only those at the cube's edges can share a tetrahedron with another side's.
  for (const int n : {4, 8, 16}) {
    const std::size_t bound = least(test::cubes(n, [](int, int, int) { return false; }));
    EXPECT_LE(bound, static_cast<std::size_t>(12 * n * n));
    EXPECT_GE(bound, static_cast<std::size_t>(12 * n * n - 16 * n));
  }
}

TEST(LeastTetrahedra, TurnedInsideOutNothingIsConvex) {
  Surface inward = extract_surface(test::regular_tetrahedron());
  for (Triangle& t : inward.triangles) std::swap(t[1], t[2]);
  EXPECT_EQ(least_tetrahedra(0, inward.triangles, test::regular_tetrahedron().vertices), 4U);
}

TEST(InterpolationError, KnownAnswers) {
  const TetMesh mesh = test::corner_tetrahedron();
  std::vector<DefectValues> values(4);
  const std::vector<Vec3> centroid{Vec3(0.25)};
  const std::vector<DefectValues> nothing(1);
  EXPECT_EQ(interpolation_error(mesh, values, centroid, nothing, no_progress()), 0.0);
  values[2].vacancy = 4.0F;
  EXPECT_NEAR(interpolation_error(mesh, values, centroid, nothing, no_progress()), 1.0, 1e-15);
  EXPECT_NEAR(interpolation_error(mesh, values, centroid, {{{0.0F, 0.0F, 1.0F}}}, no_progress()), 0.0, 1e-15);
  EXPECT_NEAR(interpolation_error(mesh, values, centroid, {{{0.5F, 0.0F, 1.0F}}}, no_progress()), 0.5, 1e-15);
  // Outside of every tetrahedron with a defect the mesh's value is 0.
  EXPECT_EQ(interpolation_error(mesh, values, std::vector<Vec3>{Vec3(2.0)}, nothing, no_progress()), 0.0);
  EXPECT_EQ(interpolation_error(mesh, values, std::vector<Vec3>{Vec3(2.0)}, {{{3.0F, 0.0F, 0.0F}}}, no_progress()),
            3.0);
  EXPECT_EQ(interpolation_error(mesh, values, {}, {}, no_progress()), 0.0);
}

TEST(InterpolationError, FindsTheOneWrongPlaceAmongMany) {
  const TetMesh mesh = test::cubes(6, [](int, int, int) { return false; });
  std::vector<DefectValues> values(mesh.vertices.size());
  for (std::size_t v = 0; v < values.size(); ++v) values[v].extra = static_cast<float>(mesh.vertices[v].x);
  // The field is x, which linear interpolation reproduces.
  const Atoms places = test::random_atoms(5000, 6.0, 3);
  std::vector<DefectValues> right(places.size());
  for (std::size_t i = 0; i < right.size(); ++i) right[i].extra = static_cast<float>(places.positions[i].x);
  EXPECT_LT(interpolation_error(mesh, values, places.positions, right, no_progress()), 1e-6);
  right[3210].extra += 0.25F;
  EXPECT_NEAR(interpolation_error(mesh, values, places.positions, right, no_progress()), 0.25, 1e-6);
}

TEST(StarMesh, StarsAndRefills) {
  const TetMesh mesh = test::cubes(2, [](int, int, int) { return false; });
  StarMesh stars(mesh.tetrahedra, mesh.vertices);
  const Index centre = 13;
  EXPECT_FALSE(stars.on_surface(centre));
  EXPECT_TRUE(stars.on_surface(0));
  Star star;
  stars.gather(centre, star);
  EXPECT_EQ(star.corners.size(), 24U);
  EXPECT_EQ(star.link.size(), 14U);
  for (const Triangle& t : star.triangles) {
    EXPECT_GT(signed_volume(mesh.vertices[star.link[t[2]]], mesh.vertices[star.link[t[1]]],
                            mesh.vertices[star.link[t[0]]], mesh.vertices[centre]),
              0.0);
  }
  // The star's own tetrahedra are a fill; without one of them they are none.
  std::vector<Index> cells;
  std::vector<Tetrahedron> fill;
  for (const Corner corner : star.corners) {
    cells.push_back(corner / 4);
    fill.push_back(stars.tetrahedron(corner));
  }
  const Tetrahedron last = fill.back();
  fill.pop_back();
  EXPECT_FALSE(stars.refill(cells, star.corners, fill));
  fill.push_back(fill.front());
  EXPECT_FALSE(stars.refill(cells, star.corners, fill));
  fill.back() = last;
  EXPECT_TRUE(stars.refill(cells, star.corners, fill));
  EXPECT_EQ(stars.tetrahedra(), mesh.tetrahedra.size());
  Star again;
  stars.gather(centre, again);
  EXPECT_EQ(again.corners.size(), 24U);
}

}  // namespace
}  // namespace atomesh
