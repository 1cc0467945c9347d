// Cells that share a sphere: found, and put in order on the card so that of two cells with a common face the one on the
// eye's side comes first, which keys alone do not achieve.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/tet_mesh.h"
#include "preprocess/tetrahedralize.h"
#include "render/gl/card_cells.h"
#include "render/gl/cell_clusters.h"
#include "render/gl/context.h"
#include "tests/render/fixtures.h"

namespace atomesh::gl {
namespace {

using namespace test;

constexpr double step = 4.0;

// n³ cubic cells of a lattice with these sites, each point moved by up to `noise` along each axis; without the cells of
// the hull that no lattice has. Å
Material lattice(int n, const std::vector<Vec3>& sites, double noise, double largest_radius) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> move(-noise, noise);
  Material material;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) {
        for (const Vec3& site : sites) {
          material.mesh.vertices.push_back(step * (Vec3(i, j, k) + site) +
                                           Vec3(move(random), move(random), move(random)));
        }
      }
    }
  }
  const std::vector<Vec3>& p = material.mesh.vertices;
  material.mesh.tetrahedra = delaunay_cgal(p, no_progress());
  std::erase_if(material.mesh.tetrahedra, [&](const Tetrahedron& t) {
    const Vec3 a = p[t[1]] - p[t[0]];
    const Vec3 b = p[t[2]] - p[t[0]];
    const Vec3 c = p[t[3]] - p[t[0]];
    const Vec3 to_center =
        (glm::dot(a, a) * glm::cross(b, c) + glm::dot(b, b) * glm::cross(c, a) + glm::dot(c, c) * glm::cross(a, b)) /
        (2.0 * glm::dot(a, glm::cross(b, c)));
    return !(glm::length(to_center) < largest_radius);
  });
  return material;
}
const std::vector<Vec3> simple_cubic{{0, 0, 0}};
const std::vector<Vec3> face_centred{{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}};

Scene scene_of(const Material& material) {
  Scene scene;
  scene.mode = Mode::volume;
  scene.bounds = bounds_of(material.mesh.vertices);
  scene.center = scene.bounds.center();
  std::mt19937 random(3);
  for (const Vec3& p : material.mesh.vertices) {
    scene.vertices.push_back(Vec3f(p - scene.center));
    scene.scalars.push_back(std::uniform_real_distribution<float>(0.0F, 1.0F)(random));
  }
  scene.tetrahedra = std::vector<Tetrahedron>(material.mesh.tetrahedra.begin(), material.mesh.tetrahedra.end());
  scene.delaunay = true;
  return scene;
}

// Of the pairs of cells in `order` that share a face which is not seen from the side: how many there are, and how many
// come the wrong way round.
struct Pairs {
  std::size_t all = 0, wrong = 0;
};
Pairs pairs_of(const Scene& scene, const Material& material, const Camera& camera, std::span<const Index> order) {
  std::vector<Index> rank(scene.tetrahedra.size(), no_index);
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = static_cast<Index>(i);
  const std::vector<std::array<Index, 4>> neighbours = face_neighbours(material.mesh);
  Pairs pairs;
  for (const Index cell : order) {
    for (std::size_t f = 0; f < 4; ++f) {
      const Index other = neighbours[cell][f];
      if (other == no_index || rank[other] == no_index) continue;
      std::array<Vec3, 3> p;
      for (std::size_t k = 0; k < 3; ++k) {
        p[k] = Vec3(scene.vertices[scene.tetrahedra[cell][static_cast<std::size_t>(face_corners[f][k])]]);
      }
      const Vec3 normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
      const bool perspective = camera.projection == Projection::perspective;
      const Vec3 to_eye = perspective ? camera.eye - scene.center - p[0] : -camera.forward;
      const double side = glm::dot(normal, to_eye) / glm::length(to_eye);
      if (side < 1e-3) continue;  // the other cell counts it
      ++pairs.all;
      pairs.wrong += rank[other] > rank[cell] ? 1 : 0;
    }
  }
  return pairs;
}

TEST(CellClusters, AreTheCubesOfALattice) {
  for (const double noise : {0.0, 1e-6, 1e-5}) {
    const Material material = lattice(5, simple_cubic, noise, 0.9 * step);
    const Scene scene = scene_of(material);
    const CellOrder order(scene, false);
    std::vector<OrderPoint> points(order.points().begin(), order.points().end());
    const CellClusters clusters = find_cell_clusters(scene, points);
    // Each cube one, with the flat cells between two cubes in one of them.
    ASSERT_EQ(clusters.count(), 64U) << noise;
    EXPECT_EQ(clusters.cells.size(), scene.tetrahedra.size());
    std::vector<Index> cells = clusters.cells;
    std::ranges::sort(cells);
    EXPECT_TRUE(std::ranges::adjacent_find(cells) == cells.end());
    for (std::size_t n = 0; n < clusters.count(); ++n) {
      const auto [first, face] = clusters.starts[n];
      const auto [end, end_face] = clusters.starts[n + 1];
      EXPECT_GE(end - first, 5U);
      EXPECT_LE(end - first, 12U);
      const Vec3 center(points[clusters.cells[first]].p);
      Vec3 mean(0.0);
      for (std::uint32_t at = first; at < end; ++at) {
        const Index cell = clusters.cells[at];
        EXPECT_EQ(points[cell].p, points[clusters.cells[first]].p);
        for (const Index v : scene.tetrahedra[cell]) mean += Vec3(scene.vertices[v]) / (4.0 * (end - first));
      }
      EXPECT_LT(glm::distance(center, mean), 0.5 * step);
      for (std::uint32_t at = face; at < end_face; ++at) {
        const auto& [plane, pair] = clusters.faces[at];
        const Index far = clusters.cells[first + (pair >> 16)];
        double beyond = 0.0;  // of the far cell's fourth corner
        for (const Index v : scene.tetrahedra[far]) {
          const double way = glm::dot(glm::dvec4(plane), glm::dvec4(Vec3(scene.vertices[v]), 1.0));
          if (std::abs(way) > std::abs(beyond)) beyond = way;
        }
        EXPECT_GT(beyond, -1e-5);
      }
    }
  }
}

TEST(CellClusters, AreNoneWhereNoCellsShareASphere) {
  const Scene scene = scene_of(lattice(5, simple_cubic, 0.3, 1e9));
  const CellOrder order(scene, false);
  std::vector<OrderPoint> points(order.points().begin(), order.points().end());
  EXPECT_EQ(find_cell_clusters(scene, points).count(), 0U);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(points[i].p, order.points()[i].p);
}

TEST(CellClusters, ComeInTheOrderOfTheirFaces) {
  HeadlessContext context{true};
  const HeadlessContext::Current current(context);
  ColorMap opaque;
  opaque.entries = {{0.0, Vec4f(1.0F)}, {1.0, Vec4f(1.0F)}};
  ColorMap partly;
  partly.entries = {{0.0, Vec4f(0.0F)}, {0.8, Vec4f(0.0F)}, {1.0, Vec4f(1.0F)}};
  std::size_t wrong_keys = 0;
  for (const auto& [sites, radius] : {std::pair(simple_cubic, 0.9), std::pair(face_centred, 0.55)}) {
    for (const double noise : {0.0, 1e-6}) {
      const Material material = lattice(5, sites, noise, radius * step);
      const Scene scene = scene_of(material);
      CellOrder keys(scene, false);
      CardCells cells(scene, guard_pixels);
      for (const char* view : {"iso", "27,13", "front"}) {
        for (const Projection projection : {Projection::parallel, Projection::perspective}) {
          const Parameters parameters = looking(Mode::volume, view, projection);
          const Camera camera = make_camera(parameters, scene.bounds, 100, 100);
          for (const ColorMap& map : {opaque, partly}) {
            cells.project(camera, pixel_grid(camera, whole_picture(camera)), map, no_progress());
            cells.order(camera, no_progress());
            glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
            std::vector<Index> order;
            for (const KeyedCell& keyed : cells.keyed().read<KeyedCell>(cells.places())) order.push_back(keyed.cell);
            EXPECT_EQ(order.size() == scene.tetrahedra.size(), map == opaque);
            const Pairs pairs = pairs_of(scene, material, camera, order);
            EXPECT_GT(pairs.all, 10U);
            // Floats turn over a flat cell here and there, whose sides are then nobody's.
            EXPECT_LE(pairs.wrong, noise == 0.0 ? 0 : pairs.all / 400)
                << sites.size() << ' ' << noise << ' ' << view << " of " << pairs.all;
            std::vector<Index> drawn = order;
            std::ranges::sort(drawn);
            EXPECT_TRUE(std::ranges::adjacent_find(drawn) == drawn.end());
            CellOrderStats stats;
            keys.sort(camera, drawn, {}, order, stats);
            wrong_keys += pairs_of(scene, material, camera, order).wrong;
          }
        }
      }
    }
  }
  EXPECT_GT(wrong_keys, 200U);  // it is something to find an order
  check_errors("the test");
}

}  // namespace
}  // namespace atomesh::gl
