#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "core/error.h"
#include "core/split_cells.h"
#include "core/surface.h"
#include "tests/support/meshes.h"

namespace atomesh {
namespace {

using test::mesh_of;

struct Cell {
  CellShape shape;
  std::vector<Index> corners;
};

// Points and cells; numbers are handed out in the order of asking, so that shuffle() alone decides who is smallest.
struct Cells {
  std::vector<Vec3> points;
  std::vector<Cell> cells;

  Index at(const Vec3& p) {
    const auto [place, fresh] = numbers.try_emplace({p.x, p.y, p.z}, static_cast<Index>(points.size()));
    if (fresh) points.push_back(p);
    return place->second;
  }
  void add(CellShape shape, const std::vector<Vec3>& corners) {
    Cell cell{shape, {}};
    for (const Vec3& p : corners) cell.corners.push_back(at(p));
    cells.push_back(cell);
  }
  void shuffle(std::mt19937& random) {
    std::vector<Index> to(points.size());
    std::iota(to.begin(), to.end(), Index{0});
    std::shuffle(to.begin(), to.end(), random);
    std::vector<Vec3> moved(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) moved[to[i]] = points[i];
    points = moved;
    for (Cell& cell : cells) {
      for (Index& corner : cell.corners) corner = to[corner];
    }
    numbers.clear();
  }
  TetMesh mesh() const {
    std::vector<Tetrahedron> tetrahedra;
    for (const Cell& cell : cells) split_cell(cell.shape, cell.corners, tetrahedra);
    return mesh_of(points, tetrahedra);
  }

 private:
  std::map<std::array<double, 3>, Index> numbers;
};

std::vector<Vec3> cube_corners(const Vec3& o = Vec3(0.0)) {
  return {o,
          o + Vec3(1, 0, 0),
          o + Vec3(1, 1, 0),
          o + Vec3(0, 1, 0),
          o + Vec3(0, 0, 1),
          o + Vec3(1, 0, 1),
          o + Vec3(1, 1, 1),
          o + Vec3(0, 1, 1)};
}

std::vector<Vec3> prism(int sides) {
  std::vector<Vec3> corners;
  for (int z = 0; z < 2; ++z) {
    for (int i = 0; i < sides; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / sides;
      corners.emplace_back(std::cos(angle), std::sin(angle), z);
    }
  }
  return corners;
}

// Area of a regular polygon with corners on the unit circle.
double polygon_area(int sides) {
  return 0.5 * sides * std::sin(2.0 * std::numbers::pi / sides);
}

TEST(SplitCells, EveryShapeKeepsItsVolumeHoweverItIsNumbered) {
  const std::vector<Vec3> wedge{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  struct Known {
    CellShape shape;
    std::vector<Vec3> corners;
    double volume;
    double area;
    std::set<std::size_t> counts;
  };
  const double pentagon_edge = 2.0 * std::sin(std::numbers::pi / 5.0);
  const std::vector<Known> shapes{
      {CellShape::tetrahedron, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 1.0 / 6, 1.5 + std::sqrt(3.0) / 2, {1}},
      {CellShape::pyramid,
       {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0.5}},
       1.0 / 6,
       1.0 + std::sqrt(2.0),
       {2}},
      {CellShape::wedge, wedge, 0.5, 3.0 + std::sqrt(2.0), {3}},
      {CellShape::hexahedron, cube_corners(), 1.0, 6.0, {5, 6}},
      {CellShape::pentagonal_prism, prism(5), polygon_area(5), 2 * polygon_area(5) + 5 * pentagon_edge, {9}},
      {CellShape::hexagonal_prism, prism(6), polygon_area(6), 2 * polygon_area(6) + 6.0, {12}},
  };
  std::mt19937 random(1);
  for (const Known& known : shapes) {
    std::set<std::size_t> counts;
    for (int i = 0; i < 500; ++i) {
      Cells cells;
      cells.add(known.shape, known.corners);
      cells.shuffle(random);
      const TetMesh mesh = cells.mesh();
      ASSERT_TRUE(validate(mesh).empty()) << validate(mesh)[0] << ", shape " << static_cast<int>(known.shape);
      ASSERT_NEAR(volume(mesh), known.volume, 1e-14);
      const Surface surface = extract_surface(mesh);
      ASSERT_TRUE(is_closed(surface));
      ASSERT_NEAR(area(surface, mesh.vertices), known.area, 1e-14);
      counts.insert(mesh.tetrahedra.size());
    }
    EXPECT_EQ(counts, known.counts) << "shape " << static_cast<int>(known.shape);
  }
}

// Cubes as hexahedra, as six pyramids about their centre, or (in whole columns, so that triangles meet triangles) as
// two wedges; points moved a little, so that no four of a face lie in a plane.
TEST(SplitCells, NeighboursOfEveryKindAgreeOnWarpedFaces) {
  constexpr int n = 4;
  std::mt19937 random(2);
  for (int trial = 0; trial < 20; ++trial) {
    Cells cells;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const bool wedges = random() % 3 == 0;
        for (int k = 0; k < n; ++k) {
          const std::vector<Vec3> c = cube_corners({i, j, k});
          if (wedges) {
            cells.add(CellShape::wedge, {c[4], c[5], c[6], c[0], c[1], c[2]});
            cells.add(CellShape::wedge, {c[4], c[6], c[7], c[0], c[2], c[3]});
          } else if (random() % 2 == 0) {
            cells.add(CellShape::hexahedron, c);
          } else {
            const Vec3 centre = c[0] + Vec3(0.5);
            for (const auto& f : hexahedron_faces) {
              // A pyramid's base is seen from its apex.
              cells.add(CellShape::pyramid, {c[f[3]], c[f[2]], c[f[1]], c[f[0]], centre});
            }
          }
        }
      }
    }
    cells.shuffle(random);
    std::uniform_real_distribution<double> shift(-0.1, 0.1);
    for (Vec3& p : cells.points) {
      for (int axis = 0; axis < 3; ++axis) {
        if (p[axis] != 0.0 && p[axis] != n) p[axis] += shift(random);
      }
    }
    const TetMesh mesh = cells.mesh();
    EXPECT_EQ(validate(mesh), std::vector<std::string>()) << trial;
    EXPECT_NEAR(volume(mesh), n * n * n, 1e-10) << trial;
    const Surface surface = extract_surface(mesh);
    EXPECT_TRUE(is_closed(surface));
    EXPECT_NEAR(area(surface, mesh.vertices), 6.0 * n * n, 1e-10) << "a face inside is not shared";
  }
}

TEST(SplitCells, PrismsOfManySidesMeetHexahedra) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 100; ++trial) {
    Cells cells;
    const double h = std::sqrt(3.0) / 2.0;
    for (int z = 0; z < 3; ++z) {
      std::vector<Vec3> c;
      const Vec3 ring[6] = {{1, 0, 0}, {0.5, h, 0}, {-0.5, h, 0}, {-1, 0, 0}, {-0.5, -h, 0}, {0.5, -h, 0}};
      for (int top = 0; top < 2; ++top) {
        for (const Vec3& p : ring) c.push_back(p + Vec3(0, 0, z + top));
      }
      cells.add(CellShape::hexagonal_prism, c);
      const Vec3 out(1.0, 0.0, 0.0);
      cells.add(CellShape::hexahedron, {c[0], c[0] + out, c[1] + out, c[1], c[6], c[6] + out, c[7] + out, c[7]});
    }
    cells.shuffle(random);
    const TetMesh mesh = cells.mesh();
    EXPECT_EQ(validate(mesh), std::vector<std::string>());
    EXPECT_NEAR(volume(mesh), 3.0 * (polygon_area(6) + h), 1e-12);
    EXPECT_NEAR(enclosed_volume(extract_surface(mesh), mesh.vertices), volume(mesh), 1e-12);
  }
}

TEST(SplitCells, PolyhedraAreSplitLikeTheShapesTheyAre) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 100; ++trial) {
    Cells cells;
    cells.add(CellShape::hexahedron, cube_corners());
    cells.add(CellShape::hexahedron, cube_corners({1, 0, 0}));
    cells.shuffle(random);
    std::vector<Tetrahedron> tetrahedra;
    split_cell(CellShape::hexahedron, cells.cells[0].corners, tetrahedra);
    std::vector<std::vector<Index>> faces;
    for (const auto& face : hexahedron_faces) {
      faces.emplace_back();
      for (const int corner : face) faces.back().push_back(cells.cells[1].corners[static_cast<std::size_t>(corner)]);
    }
    split_polyhedron(faces, tetrahedra);
    const TetMesh mesh = mesh_of(cells.points, tetrahedra);
    EXPECT_EQ(validate(mesh), std::vector<std::string>());
    EXPECT_NEAR(volume(mesh), 2.0, 1e-14);
    EXPECT_NEAR(area(extract_surface(mesh), mesh.vertices), 10.0, 1e-14);
  }
}

TEST(SplitCells, EveryChoiceOfDiagonalsIsMetOrRefused) {
  const std::vector<Vec3> corners = cube_corners();
  std::array<Index, 8> numbers{};
  std::iota(numbers.begin(), numbers.end(), Index{0});
  std::size_t refused = 0;
  for (unsigned odd = 0; odd < 64; ++odd) {
    std::vector<Tetrahedron> tetrahedra;
    if (!split_hexahedron(numbers, odd, tetrahedra)) {
      EXPECT_TRUE(tetrahedra.empty());
      ++refused;
      continue;
    }
    EXPECT_EQ(tetrahedra.size(), odd == 0 || odd == 63 ? 5U : 6U);
    const TetMesh mesh = mesh_of(corners, tetrahedra);
    EXPECT_EQ(validate(mesh), std::vector<std::string>()) << odd;
    EXPECT_NEAR(volume(mesh), 1.0, 1e-15) << odd;
    // Of each face's triangles, the edge that both have.
    for (std::size_t f = 0; f < 6; ++f) {
      const auto& face = hexahedron_faces[f];
      std::map<Index, int> uses;
      for (const Triangle& t : extract_surface(mesh).triangles) {
        const auto on_face = [&](Index v) { return std::find(face.begin(), face.end(), int(v)) != face.end(); };
        if (!std::all_of(t.begin(), t.end(), on_face)) continue;
        for (const Index v : t) ++uses[v];
      }
      for (const auto& [v, count] : uses) {
        const bool odd_corner = v == 1 || v == 3 || v == 4 || v == 6;
        EXPECT_EQ(count, odd_corner == ((odd >> f & 1U) != 0) ? 2 : 1) << odd << " face " << f << " corner " << v;
      }
    }
  }
  // Opposite faces with crossed diagonals all the way round cannot be met (Schönhardt's case).
  EXPECT_LT(refused, 24U);
}

TEST(SplitCells, StructuredGridsInFivesConformWithAlternatingParity) {
  constexpr int n = 5;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(-0.1, 0.1);
  std::vector<Vec3> points;
  for (int k = 0; k <= n; ++k) {
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) {
        points.emplace_back(i, j, k);
        for (int axis = 0; axis < 3; ++axis) {
          double& x = points.back()[axis];
          if (x != 0.0 && x != n) x += shift(random);
        }
      }
    }
  }
  std::vector<Tetrahedron> tetrahedra;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const auto at = [&](int x, int y, int z) {
          return static_cast<Index>(i + x + (n + 1) * (j + y + (n + 1) * (k + z)));
        };
        const std::array<Index, 8> c{at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0),
                                     at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)};
        ASSERT_TRUE(split_hexahedron(c, (i + j + k) % 2 == 0 ? 0 : 63, tetrahedra));
      }
    }
  }
  EXPECT_EQ(tetrahedra.size(), 5U * n * n * n);
  const TetMesh mesh = mesh_of(points, tetrahedra);
  EXPECT_EQ(validate(mesh), std::vector<std::string>());
  EXPECT_NEAR(volume(mesh), n * n * n, 1e-11);
  EXPECT_NEAR(area(extract_surface(mesh), mesh.vertices), 6.0 * n * n, 1e-11);
}

TEST(SplitCells, CollapsedHexahedraAreTheShapesTheyLookLike) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 200; ++trial) {
    // Corners named twice: a wedge (edges 3 on 2, 7 on 6), a pyramid (the top in one point), a tetrahedron.
    for (const auto& [same, expected] :
         std::vector<std::pair<std::array<std::size_t, 8>, double>>{{{0, 1, 2, 2, 4, 5, 6, 6}, 0.5},
                                                                    {{0, 1, 2, 3, 4, 4, 4, 4}, 1.0 / 3.0},
                                                                    {{0, 1, 3, 3, 4, 4, 4, 4}, 1.0 / 6.0}}) {
      const std::vector<Vec3> c = cube_corners();
      Cells cells;
      std::vector<Vec3> corners;
      for (const std::size_t i : same) corners.push_back(c[i]);
      cells.add(CellShape::hexahedron, corners);
      cells.shuffle(random);
      const TetMesh mesh = cells.mesh();
      std::vector<std::string> complaints = validate(mesh);
      EXPECT_EQ(complaints, std::vector<std::string>()) << expected;
      EXPECT_NEAR(volume(mesh), expected, 1e-15);
      EXPECT_TRUE(is_closed(extract_surface(mesh)));
    }
  }
}

TEST(SplitCells, ACellWithTheWrongNumberOfCornersIsRefused) {
  std::vector<Tetrahedron> tetrahedra;
  const std::vector<Index> five{0, 1, 2, 3, 4};
  EXPECT_THROW(split_cell(CellShape::hexahedron, five, tetrahedra), Error);
  EXPECT_THROW(split_cell(CellShape::tetrahedron, five, tetrahedra), Error);
}

}  // namespace
}  // namespace atomesh
