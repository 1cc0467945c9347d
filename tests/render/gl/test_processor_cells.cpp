// Cells prepared by the processor: in slabs, as cards get them, the triangles of portions, as software does; and the
// limits of what is drawn as sums of ramps.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "render/gl/context.h"
#include "render/gl/map_ramps.h"
#include "render/gl/objects.h"
#include "render/gl/processor_cells.h"
#include "render/gl/volume.h"
#include "tests/render/fixtures.h"

using namespace atomesh;
using namespace atomesh::gl;
using namespace atomesh::test;

namespace {

constexpr int side = 128;

// Counts the fragments of cells that it draws.
class Counting {
 public:
  Counting() {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, picture_.name(), 0);
    glViewport(side / 2 - guard_pixels, side / 2 - guard_pixels, 2 * guard_pixels, 2 * guard_pixels);
    glBindVertexArray(vertex_array_.name());
    program_.use();
    glUniform1f(program_.uniform("pixel_scale"), 1.0F / guard_pixels);
  }

  // Of so many places at once, at most.
  GLuint64 fragments(PreparedCells& cells, std::size_t most) const {
    glBeginQuery(GL_SAMPLES_PASSED, query_.name());
    std::size_t slabs = 0;
    for (std::size_t begin = 0; begin < cells.places();) {
      slabs += cells.make_slab(begin) ? 1 : 0;
      begin += cells.draw(begin, most, [this](CellKind kind) {
        EXPECT_EQ(kind, CellKind::segment);
        program_.use();
      });
    }
    glEndQuery(GL_SAMPLES_PASSED);
    GLuint64 count = 0;
    glGetQueryObjectui64v(query_.name(), GL_QUERY_RESULT, &count);
    slabs_ = slabs;
    return count;
  }
  std::size_t slabs() const { return slabs_; }

 private:
  Texture picture_ = Texture::make_2d(GL_RGBA8, side, side);
  Framebuffer framebuffer_ = make_framebuffer();
  VertexArray vertex_array_ = make_vertex_array();
  Query query_ = make_query();
  Program program_ = Program::draw("cells.vert", "nothing.frag");
  mutable std::size_t slabs_ = 0;
};

Scene box_seen(Subject& subject, int cubes) {
  subject.material = box_material(cubes, cubes, cubes, 2.0, shaking(0.3, 5));
  add_defects(subject.material, 3);
  subject.parameters = looking(Mode::volume, "iso", Projection::perspective);
  Scene scene = make_scene(subject.material, subject.parameters);
  subject.camera = make_camera(subject.parameters, scene.bounds, side, side);
  return scene;
}

TEST(ProcessorCells, SlabsHoldTheTrianglesOfPortions) {
  HeadlessContext context(true);
  const HeadlessContext::Current current(context);
  Subject subject;
  const Scene scene = box_seen(subject, 24);
  ASSERT_GT(scene.tetrahedra.size(), cells_per_slab);
  const Counting counting;
  const PixelGrid grid = pixel_grid(subject.camera, whole_picture(subject.camera), {});
  // By the centroids alone software draws front faces, too.
  const auto prepared = [&](bool software) {
    auto cells = std::make_unique<ProcessorCells>(scene, false, software);
    Progress progress(no_progress(), 0.0, 0.0);
    cells->project(subject.camera, grid, {{{0.0, Vec4f(1)}, {1.0, Vec4f(1)}}}, no_progress());
    cells->order(subject.camera, progress);
    return cells;
  };
  const auto portions = prepared(true);
  const GLuint64 fragments = counting.fragments(*portions, cells_per_slab);
  EXPECT_EQ(counting.slabs(), 0U);
  EXPECT_GT(fragments, GLuint64{side} * side);
  const auto slabs = prepared(false);
  EXPECT_EQ(counting.fragments(*slabs, cells_per_slab), fragments);
  EXPECT_EQ(counting.slabs(), 2U);
  EXPECT_EQ(slabs->triangles(), portions->triangles());
  // In parts; of a view that rests slabs are there already.
  EXPECT_EQ(counting.fragments(*slabs, 1000), fragments);
  EXPECT_EQ(counting.slabs(), 0U);
  EXPECT_EQ(counting.fragments(*portions, 1000), fragments);
  EXPECT_EQ(slabs->triangles(), portions->triangles());
  EXPECT_NO_THROW(check_errors("counting fragments"));
}

struct Counted {
  std::size_t triangles, by_ramps;
};

Counted drawn(const Scene& scene, const Camera& camera, Parameters parameters, const ColorMap& map, double extinction) {
  parameters.volume.color_map = map;
  parameters.volume.alpha_length = extinction;
  Volume volume;
  volume.set_scene(scene);
  RenderStats stats;
  volume.draw(camera, parameters, whole_picture(camera), {}, stats, no_progress());
  return {volume.last().triangles, volume.last().ramp_triangles};
}

// Where more than a quarter of the cells do not suit ramps, none is drawn so.
TEST(ProcessorCells, RampsAreForScenesThatMostlySuitThem) {
  HeadlessContext context(true);
  const HeadlessContext::Current current(context);
  Subject subject;
  Scene scene = box_seen(subject, 12);
  // Deep beyond a plane.
  const ColorMap map{{{0.0, Vec4f(1, 1, 1, 0.01)}, {0.5, Vec4f(1, 1, 1, 0.01)}, {1.0, Vec4f(1)}}};
  const double extinction = 5.0;
  bool some = false;
  bool none = false;
  for (const float share : {0.1F, 0.2F, 0.25F, 0.3F, 0.5F}) {
    for (std::size_t i = 0; i < scene.vertices.size(); ++i) {
      const double x = (static_cast<double>(scene.vertices[i].x) + scene.center.x - scene.bounds.min.x) /
                       (scene.bounds.max.x - scene.bounds.min.x);
      scene.scalars[i] = x < static_cast<double>(share) ? 1.0F : 0.0F;
    }
    const std::size_t deep = MapRamps(scene, map, extinction).too_deep();
    const Counted counted = drawn(scene, subject.camera, subject.parameters, map, extinction);
    EXPECT_EQ(counted.by_ramps == 0, 4 * deep > scene.tetrahedra.size()) << deep;
    EXPECT_LT(counted.by_ramps, counted.triangles);
    (counted.by_ramps == 0 ? none : some) = true;
  }
  EXPECT_TRUE(some && none);
}

TEST(ProcessorCells, ACellOfManyRowsIsASegment) {
  HeadlessContext context(true);
  const HeadlessContext::Current current(context);
  Subject subject;
  subject.material = one_tetrahedron();
  subject.parameters = looking(Mode::volume, "iso");
  Scene scene = make_scene(subject.material, subject.parameters);
  scene.scalars = {0.0F, 1.0F, 0.4F, 0.7F};
  const Camera camera = make_camera(subject.parameters, scene.bounds, side, side);
  for (const int pieces : {20, 31}) {
    ColorMap map;
    for (int i = 0; i <= pieces; ++i) {
      const double scalar = static_cast<double>(i) / pieces;
      map.entries.push_back({scalar, Vec4f(1, 1, 1, i % 2 == 0 ? 0.2 : 0.4)});
    }
    const MapRamps ramps(scene, map, 0.05);
    std::array<std::uint8_t, MapRamps::most_rows> rows;
    const int count = ramps.rows_of(0, rows.data());
    const bool many = count > CellFaces::most_rows;
    EXPECT_EQ(many, pieces == 31);
    const Counted counted = drawn(scene, camera, subject.parameters, map, 0.05);
    EXPECT_GT(counted.triangles, 0U);
    EXPECT_EQ(counted.by_ramps, many ? 0U : counted.triangles);
    if (!many) {
      EXPECT_EQ(counted.triangles % static_cast<std::size_t>(count), 0U);
    }
  }
}

}  // namespace
