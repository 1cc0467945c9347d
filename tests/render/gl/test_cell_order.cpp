// The order of cells: sorting by keys, and no cell before one that hides it.
#include <gtest/gtest.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "render/gl/cell_order.h"
#include "tests/render/fixtures.h"

using namespace atomesh;
using namespace atomesh::gl;
using namespace atomesh::test;

namespace {

std::vector<KeyedCell> random_cells(std::size_t count, std::uint32_t mask) {
  std::mt19937 random(7);
  std::vector<KeyedCell> cells(count);
  for (std::size_t i = 0; i < count; ++i)
    cells[i] = {static_cast<std::uint32_t>(random()) & mask, static_cast<Index>(i)};
  return cells;
}

TEST(KeySort, IsTheStableOne) {
  for (const std::size_t count : {0UL, 1UL, 2UL, 1000UL, 200'000UL}) {
    for (const std::uint32_t mask : {0xFFFFFFFFU, 0xFFU, 0xF0000000U, 0U}) {
      std::vector<KeyedCell> cells = random_cells(count, mask);
      std::vector<KeyedCell> expected = cells;
      std::ranges::stable_sort(expected, {}, &KeyedCell::key);
      std::vector<KeyedCell> scratch;
      sort_by_key(cells, scratch);
      for (std::size_t i = 0; i < count; ++i) {
        ASSERT_EQ(cells[i].cell, expected[i].cell) << count << " cells, mask " << mask << ", place " << i;
        ASSERT_EQ(cells[i].key, expected[i].key);
      }
    }
  }
}

struct View {
  const char* direction;
  Projection projection;
  double zoom = 1.0;  // with 30 the eye is inside
};
constexpr View views[] = {{"front", Projection::parallel},
                          {"front", Projection::perspective},
                          {"iso", Projection::parallel},
                          {"iso", Projection::perspective},
                          {"37,-12", Projection::perspective},
                          {"back", Projection::perspective, 30.0},
                          {"201,45", Projection::perspective, 30.0}};

Scene volume_scene(Material material) {
  Parameters parameters;
  parameters.mode = Mode::volume;
  return make_scene(std::move(material), parameters);
}

Camera camera_of(const Scene& scene, const View& view) {
  Parameters parameters;
  parameters.projection = view.projection;
  parameters.zoom = view.zoom;
  set_view(parameters, view.direction);
  Camera camera = make_camera(parameters, scene.bounds, 40, 40);
  if (view.zoom > 1.0) camera.eye = scene.bounds.center() + 0.1 * camera.right;
  return camera;
}

std::vector<Index> all_cells(const Scene& scene) {
  std::vector<Index> cells(scene.tetrahedra.size());
  std::iota(cells.begin(), cells.end(), Index{0});
  return cells;
}

struct Stretch {
  double in, out;
  Index cell;
};

// Where the ray is in the cell and before the eye, in Å of depth.
bool stretch_of(const Scene& scene, Index cell, const Ray& ray, Stretch& stretch) {
  stretch = {0.0, 1e300, cell};
  const Tetrahedron& t = scene.tetrahedra[cell];
  for (const auto& face : face_corners) {
    const Vec3 a = Vec3(scene.vertices[t[face[0]]]) + scene.center;
    const Vec3 b = Vec3(scene.vertices[t[face[1]]]) + scene.center;
    const Vec3 c = Vec3(scene.vertices[t[face[2]]]) + scene.center;
    const Vec3 outward = glm::cross(b - a, c - a);
    const double along = glm::dot(outward, ray.direction);
    const double ahead = glm::dot(outward, a - ray.origin);
    if (along < 0.0) stretch.in = std::max(stretch.in, ahead / along);
    if (along > 0.0) stretch.out = std::min(stretch.out, ahead / along);
    if (along == 0.0 && ahead < 0.0) return false;
  }
  return stretch.out - stretch.in > 1e-6;
}

// Whether on the ray a cell is drawn before one that lies in front of it.
bool wrong_on(const Scene& scene, const Ray& ray, const std::vector<Index>& order) {
  double last = 0.0;
  for (const Index cell : order) {
    Stretch stretch{};
    if (!stretch_of(scene, cell, ray, stretch)) continue;
    if (stretch.in < last - 1e-6) return true;
    last = stretch.in;
  }
  return false;
}

// Rays of the picture on which that is so.
int wrong_rays(const Scene& scene, const Camera& camera, const std::vector<Index>& order) {
  int wrong = 0;
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      wrong += wrong_on(scene, ray(camera, camera.x_of(column + 1.3e-5), camera.y_of(row + 2.1e-5)), order) ? 1 : 0;
    }
  }
  return wrong;
}

int wrong_rays(const Scene& scene, const View& view, bool by_faces, std::span<const Index> cells,
               std::span<const Index> unseen = {}) {
  CellOrder cell_order(scene, by_faces);
  EXPECT_EQ(cell_order.by_faces(), by_faces);
  const Camera camera = camera_of(scene, view);
  std::vector<Index> order;
  CellOrderStats stats;
  cell_order.sort(camera, cells, unseen, order, stats);
  std::vector<Index> sorted = order;
  std::ranges::sort(sorted);
  EXPECT_TRUE(std::ranges::equal(sorted, cells)) << "not every cell comes once";
  EXPECT_EQ(stats.circles, 0U);
  return wrong_rays(scene, camera, order);
}

// Kuhn's six tetrahedra of a cube are Delaunay, and share one sphere.
TEST(CellOrder, ByFacesIsExactInAPerfectLattice) {
  Scene scene = volume_scene(box_material(4, 4, 4, 2.0));
  for (const bool delaunay : {false, true}) {
    scene.delaunay = delaunay;
    for (const View& view : views) EXPECT_EQ(wrong_rays(scene, view, true, all_cells(scene)), 0) << view.direction;
  }
}

TEST(CellOrder, ByFacesIsExactInAShakenBox) {
  const Scene scene = volume_scene(box_material(4, 4, 4, 2.0, shaking(0.3, 5)));
  for (const View& view : views) EXPECT_EQ(wrong_rays(scene, view, true, all_cells(scene)), 0) << view.direction;
  // The test can fail.
  EXPECT_GT(wrong_rays(scene, views[2], false, all_cells(scene)), 20);
}

TEST(CellOrder, GoesAcrossCellsThatAreNotDrawn) {
  const Scene scene = volume_scene(box_material(4, 4, 4, 2.0, shaking(0.6, 5)));
  std::vector<Index> cells;
  std::vector<Index> unseen;
  for (const Index cell : all_cells(scene)) (cell % 7 < 3 ? cells : unseen).push_back(cell);
  int without = 0;
  for (const View& view : views) {
    EXPECT_EQ(wrong_rays(scene, view, true, cells, unseen), 0) << view.direction;
    without += wrong_rays(scene, view, true, cells);
  }
  EXPECT_GT(without, 0);
}

// Two Delaunay cells that share a leaning face; the centroid of the one behind is the nearer one.
TEST(CellOrder, PowerKnowsWhatCentroidsDoNot) {
  Scene scene;
  scene.vertices = {{0, 0, -5}, {0, 0, 5}, {10, 10, 0}, {12, 4, 0}, {-4, 3, 0}};
  scene.tetrahedra = std::vector<Tetrahedron>{{0, 2, 1, 3}, {0, 1, 2, 4}};
  scene.bounds = {Vec3(-5), Vec3(12)};
  for (const Tetrahedron& t : scene.tetrahedra) {
    const auto point = [&](int k) { return Vec3(scene.vertices[t[k]]); };
    ASSERT_GT(signed_volume(point(0), point(1), point(2), point(3)), 0.0);
  }
  Camera camera;  // looks along +y
  camera.eye = {4, -100, 0};
  for (const Projection projection : {Projection::parallel, Projection::perspective}) {
    camera.projection = projection;
    const auto order_of = [&](bool delaunay, bool by_faces) {
      scene.delaunay = delaunay;
      CellOrder cell_order(scene, by_faces);
      std::vector<Index> order;
      CellOrderStats stats;
      cell_order.sort(camera, all_cells(scene), {}, order, stats);
      return order;
    };
    EXPECT_EQ(order_of(true, false), (std::vector<Index>{0, 1}));
    EXPECT_EQ(order_of(false, false), (std::vector<Index>{1, 0}));
    EXPECT_EQ(order_of(false, true), (std::vector<Index>{0, 1}));
  }
}

// The power of a point is its squared distance from the circumcentre less the squared radius; keys grow with it.
TEST(CellOrder, PointIsTheCircumcentre) {
  Scene scene;
  scene.vertices = {{3, 0, 0}, {0, 3, 0}, {0, 0, 3}, {-3, 0, 0}};  // on the sphere of radius 3 about the origin
  scene.tetrahedra = std::vector<Tetrahedron>{{0, 1, 2, 3}};
  scene.bounds = {Vec3(-3), Vec3(3)};
  scene.delaunay = true;
  const CellOrder circumcentre(scene, false);
  const OrderPoint point = circumcentre.points()[0];
  EXPECT_NEAR(glm::length(point.p), 0.0, 3e-5);
  EXPECT_NEAR(point.weight, -9.0, 3e-4);
  scene.delaunay = false;
  const CellOrder centroid(scene, false);
  EXPECT_NEAR(glm::length(centroid.points()[0].p - Vec3f(0.0F, 0.75F, 0.75F)), 0.0, 1e-6);
}

TEST(CellOrder, KeysGrowFarBeyondTheScene) {
  Scene scene;
  scene.bounds = {Vec3(-1), Vec3(1)};
  Camera camera;
  camera.eye = {0, -10, 0};
  camera.projection = Projection::parallel;
  const KeyScale scale = key_scale(camera, scene);
  std::int64_t last = -1;
  for (const float depth : {-1e30F, -1e6F, -50.0F, -1.001F, -1.0F, -0.3F, -0.2999F, 0.0F, 1.0F, 1.001F, 50.0F, 1e6F}) {
    const std::int64_t key = key_of(scale, {{0.0F, depth, 0.0F}, 0.0F});
    EXPECT_GT(key, last) << depth;
    last = key;
  }
}

// Three bars before one another in a circle share no face: whatever the order, each comes once.
TEST(CellOrder, EndsInACircle) {
  const Scene scene = volume_scene(ring_of_bars());
  const Camera camera = camera_of(scene, views[0]);
  CellOrder cell_order(scene, true);
  std::vector<Index> order;
  CellOrderStats stats;
  cell_order.sort(camera, all_cells(scene), {}, order, stats);
  EXPECT_EQ(order.size(), 3U);
  EXPECT_GT(wrong_rays(scene, camera, order), 0);
}

// Sectors of a ring seen along its axis, parted by faces that all lean the same way round: each hides some of the next.
TEST(CellOrder, BreaksCirclesAndCountsThem) {
  constexpr int sectors = 8;
  Scene scene;
  const auto vertex = [](int sector, int ring, int level) {
    return static_cast<Index>(4 * (sector % sectors) + 2 * ring + level);
  };
  for (int corner = 0; corner < 4 * sectors; ++corner) {
    const double turn = 2.0 * std::numbers::pi / sectors * (corner / 4 + 0.8 * (corner % 2));
    const double radius = corner / 2 % 2 == 0 ? 2.0 : 4.0;
    scene.vertices.emplace_back(radius * std::cos(turn), 0.8 * (corner % 2), radius * std::sin(turn));
  }
  std::vector<Tetrahedron> tetrahedra;
  for (int sector = 0; sector < sectors; ++sector) {
    std::array<int, 3> axis{0, 1, 2};
    do {  // Kuhn: each way along the box's edges from one corner to the one opposite
      std::array<int, 3> at{};
      Tetrahedron t{vertex(sector, 0, 0)};
      for (int step = 0; step < 3; ++step) {
        at[axis[step]] = 1;
        t[step + 1] = vertex(sector + at[0], at[1], at[2]);
      }
      const auto point = [&](int k) { return Vec3(scene.vertices[t[k]]); };
      if (signed_volume(point(0), point(1), point(2), point(3)) < 0.0) std::swap(t[0], t[1]);
      tetrahedra.push_back(t);
    } while (std::next_permutation(axis.begin(), axis.end()));
  }
  scene.tetrahedra = tetrahedra;
  scene.bounds = {Vec3(-4), Vec3(4)};
  CellOrder cell_order(scene, true);
  std::vector<Index> order;
  CellOrderStats stats;
  cell_order.sort(camera_of(scene, views[0]), all_cells(scene), {}, order, stats);
  EXPECT_GT(stats.circles, 0U);
  EXPECT_LE(stats.circles, 8U);
  std::ranges::sort(order);
  EXPECT_EQ(order, all_cells(scene));
}

// Depths where the ray goes through outside faces, in their order, descend somewhere.
bool outside_descends(const Scene& scene, std::span<const OutsideFace> outside, const Ray& ray) {
  double last = -1e300;
  for (const auto& [cell, face] : outside) {
    const Tetrahedron& t = scene.tetrahedra[cell];
    const auto& [i, j, k] = face_corners[face];
    const Vec3 a = Vec3(scene.vertices[t[i]]) + scene.center - ray.origin;
    const Vec3 b = Vec3(scene.vertices[t[j]]) + scene.center - ray.origin;
    const Vec3 c = Vec3(scene.vertices[t[k]]) + scene.center - ray.origin;
    const std::array<double, 3> side{glm::dot(glm::cross(a, b), ray.direction),
                                     glm::dot(glm::cross(b, c), ray.direction),
                                     glm::dot(glm::cross(c, a), ray.direction)};
    const auto [low, high] = std::minmax_element(side.begin(), side.end());
    if (*low < 0.0 && *high > 0.0) continue;
    const Vec3 normal = glm::cross(b - a, c - a);
    const double depth = glm::dot(normal, a) / glm::dot(normal, ray.direction);
    if (depth < 0.0) continue;
    if (depth < last - 1e-6) return true;
    last = depth;
  }
  return false;
}

// Where cells that share faces stand right, rays that meet cells in a wrong order are those on which the outside does.
TEST(CellOrder, OutsideTellsOfEveryWrongRay) {
  int wrong = 0;
  int told = 0;
  const std::vector<Scene> scenes{volume_scene(ring_of_bars()), volume_scene(box_material(3, 3, 3, 2.0)),
                                  volume_scene(box_material(4, 3, 3, 2.0, shaking(0.3, 5)))};
  for (const Scene& scene : scenes) {
    for (const View& view : views) {
      const Camera camera = camera_of(scene, view);
      CellOrder cell_order(scene, true);
      std::vector<Index> order;
      CellOrderStats stats;
      cell_order.sort(camera, all_cells(scene), {}, order, stats);
      ASSERT_FALSE(cell_order.outside().empty());
      for (int row = 0; row < camera.height; ++row) {
        for (int column = 0; column < camera.width; ++column) {
          const Ray r = ray(camera, camera.x_of(column + 1.3e-5), camera.y_of(row + 2.1e-5));
          const bool is_wrong = wrong_on(scene, r, order);
          const bool tells = outside_descends(scene, cell_order.outside(), r);
          ASSERT_TRUE(tells || !is_wrong) << view.direction << ", pixel " << column << ' ' << row;
          wrong += is_wrong ? 1 : 0;
          told += tells ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(wrong, 20);
  EXPECT_LE(told, 2 * wrong);  // not of all rays
}

// Of a box: two triangles for each square of its six sides. None where it proves nothing.
TEST(CellOrder, OutsideIsKnownOfSoundMeshesAlone) {
  Material material = box_material(4, 3, 2, 2.0);
  const auto outside_of = [](const Material& of) {
    const Scene scene = volume_scene(of);
    CellOrder cell_order(scene, true);
    std::vector<Index> order;
    CellOrderStats stats;
    cell_order.sort(camera_of(scene, views[3]), all_cells(scene), {}, order, stats);
    return std::vector<OutsideFace>(cell_order.outside().begin(), cell_order.outside().end());
  };
  const std::vector<OutsideFace> outside = outside_of(material);
  EXPECT_EQ(outside.size(), 2U * 2U * (4U * 3U + 3U * 2U + 4U * 2U));
  std::swap(material.mesh.tetrahedra[5][0], material.mesh.tetrahedra[5][1]);
  EXPECT_TRUE(outside_of(material).empty());
}

TEST(CellOrder, IsTheSameOnAnyNumberOfThreads) {
  const Scene scene = volume_scene(box_material(24, 24, 24, 2.0, shaking(0.3, 5)));
  std::vector<Index> expected;
  for (const int count : {1, 2, 3, 7}) {
    set_threads(count);
    CellOrder cell_order(scene, true);
    std::vector<Index> order;
    CellOrderStats stats;
    cell_order.sort(camera_of(scene, views[3]), all_cells(scene), {}, order, stats);
    if (expected.empty()) expected = order;
    EXPECT_EQ(order, expected) << count;
  }
  set_threads(0);
}

// Of this thread, ms: what others do on the machine does not count.
double cpu_ms() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

// Cancelled at any time it ends soon; the next order is the right one.
TEST(CellOrder, IsCancelledInTheMiddle) {
  Scene scene = volume_scene(box_material(40, 40, 40, 2.0, shaking(0.3, 5)));
  scene.delaunay = false;  // looking behind faces then takes longer
  const Camera camera = camera_of(scene, views[3]);
  const std::vector<Index> cells = all_cells(scene);
  set_threads(1);
  for (const bool by_faces : {false, true}) {
    CellOrder cell_order(scene, by_faces);
    CellOrderStats stats;
    std::vector<Index> expected;
    double whole = 1e300;
    for (int i = 0; i < 5; ++i) {
      const double start = cpu_ms();
      cell_order.sort(camera, cells, {}, expected, stats);
      whole = std::min(whole, cpu_ms() - start);
    }
    EXPECT_EQ(cell_order.outside().empty(), !by_faces);
    // Where it was when it ended: from none of these to the next is a long way.
    std::vector<double> ends{0.0, whole};
    double longest = whole;
    std::mt19937 random(11);
    std::uniform_real_distribution<double> part(0.0, 1.0);
    for (int i = 0; i < 1000 && longest > 0.1 * whole; ++i) {
      // Cancelled by the clock and not by another thread, whose turn may come late. A busy machine may take several
      // times as long as the thread counts.
      const double start = cpu_ms();
      const std::chrono::duration<double, std::milli> until(part(random) * (1.0 + 5.0 * part(random)) * whole);
      const auto deadline = Progress::Clock::now() + std::chrono::duration_cast<Progress::Clock::duration>(until);
      const Progress progress(no_progress(), 0.0, 1.0, deadline);
      std::vector<Index> order;
      bool cancelled = false;
      try {
        cell_order.sort(camera, cells, {}, order, stats, progress);
      } catch (const CancelledError&) {
        cancelled = true;
      }
      const double end = cpu_ms() - start;
      if (!cancelled) {
        whole = std::min(whole, end);
        continue;
      }
      EXPECT_TRUE(cell_order.outside().empty());
      ends.push_back(end);
      std::ranges::sort(ends);
      longest = ends.front();
      for (std::size_t n = 1; n < ends.size() && ends[n - 1] < whole; ++n) {
        longest = std::max(longest, std::min(ends[n], whole) - ends[n - 1]);
      }
    }
    EXPECT_LE(longest, 0.1 * whole) << (by_faces ? "by faces" : "by keys") << " of " << whole << " ms";
    std::vector<Index> order;
    cell_order.sort(camera, cells, {}, order, stats);
    EXPECT_EQ(order, expected);
  }
  set_threads(0);
}

}  // namespace
