// Cells prepared by the card against those of the processor, step by step; and whole pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>

#include "core/error.h"
#include "render/gl/card_cells.h"
#include "render/gl/context.h"
#include "render/gl/front_faces.h"
#include "render/gl/volume.h"
#include "tests/render/fixtures.h"
#include "tests/render/gl/instead.h"

namespace atomesh::gl {
namespace {

using namespace test;

// To be moved, not copied: the scene borrows of the material.
struct Case {
  std::string name;
  Subject subject;
};

ColorMap half_transparent() {
  ColorMap map;
  map.entries = {{0.0, {0.1F, 0.2F, 0.8F, 0.0F}},
                 {0.3, {0.2F, 0.9F, 0.4F, 0.5F}},
                 {0.6, {0.9F, 0.7F, 0.1F, 0.1F}},
                 {1.0, {0.9F, 0.1F, 0.1F, 1.0F}}};
  return map;
}

Subject subject_of(Material material, Projection projection, std::string_view view, int width, int height,
                   double extinction = 0.6) {
  Subject subject;
  subject.material = std::move(material);
  add_defects(subject.material, 3);
  subject.parameters = looking(Mode::volume, view, projection);
  subject.parameters.volume.color_map = half_transparent();
  subject.parameters.volume.alpha_length = extinction;
  subject.scene = make_scene(subject.material, subject.parameters);
  subject.camera = make_camera(subject.parameters, subject.scene.bounds, width, height);
  return subject;
}

// Cells of an annulus, as those of a combustor: curved, of very different size, and not Delaunay.
Vec3 round_the_axis(const Vec3& p) {
  const double angle = 0.08 * p.x;
  const double radius = 3.0 + 0.02 * p.y * p.y + 0.3 * p.y;
  return {radius * std::cos(angle), radius * std::sin(angle), p.z};
}

std::vector<Case> cases(Projection projection, int width, int height) {
  std::vector<Case> all;
  const auto add = [&](const char* name, Subject subject) { all.push_back({name, std::move(subject)}); };
  for (const bool delaunay : {false, true}) {
    Subject shaken = subject_of(box_material(7, 6, 5, 2.0, shaking(0.35, 1)), projection, "iso", width, height);
    shaken.scene.delaunay = delaunay;  // keys by circumspheres that are not empty
    add(delaunay ? "shaken box, keys of a Delaunay mesh" : "shaken box", std::move(shaken));
  }
  Subject lattice = subject_of(box_material(6, 6, 6, 2.0), projection, "front", width, height);
  lattice.scene.delaunay = true;
  add("perfect lattice along its axis", std::move(lattice));
  add("annulus", subject_of(box_material(20, 5, 6, 1.5, round_the_axis), projection, "iso", width, height));
  const auto flattened = [](const Vec3& p) { return Vec3(p.x, p.y, 1e-2 * p.z); };
  add("slivers", subject_of(box_material(6, 6, 3, 2.0, flattened), projection, "iso", width, height, 20.0));
  Subject one = subject_of(one_tetrahedron(), projection, "iso", width, height, 4.0);
  one.scene.scalars = {0.1F, 0.9F, 0.4F, 0.7F};
  add("one cell", std::move(one));
  add("ring of bars", subject_of(ring_of_bars(), projection, "front", width, height));
  return all;
}

std::vector<Case> all_cases(int width, int height) {
  std::vector<Case> all = cases(Projection::perspective, width, height);
  for (Case& of : cases(Projection::parallel, width, height))
    all.push_back({of.name + ", parallel", std::move(of.subject)});
  return all;
}

// Order of floats by how many there are between them.
std::int64_t place_of(float x) {
  const auto bits = std::bit_cast<std::int32_t>(x);
  return bits < 0 ? -static_cast<std::int64_t>(bits & 0x7FFFFFFF) : bits;
}
std::int64_t floats_between(float a, float b) {
  return std::abs(place_of(a) - place_of(b));
}

class CardCellsTest : public testing::Test {
 protected:
  std::vector<ScreenVertex> projected(const CardCells& cells, const Scene& scene) {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    return cells.projected().read<ScreenVertex>(scene.vertices.size());
  }
  std::vector<KeyedCell> order(const CardCells& cells) {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    return cells.keyed().read<KeyedCell>(cells.places());
  }
  void prepare(CardCells& cells, const Subject& subject) {
    const PixelGrid grid = pixel_grid(subject.camera, whole_picture(subject.camera));
    ASSERT_TRUE(cells.fits(subject.camera, grid));
    cells.project(subject.camera, grid, subject.parameters.volume.color_map, no_progress());
    cells.order(subject.camera, no_progress());
  }
  ScreenMesh mesh_of(const Subject& subject) {
    return ScreenMesh(subject.scene, subject.camera, pixel_grid(subject.camera, whole_picture(subject.camera)),
                      cell_projection::MapIntervals(subject.parameters.volume.color_map), no_progress());
  }
  // What front_faces() makes of the same cells in the same order at the same places.
  std::vector<FaceVertex> expected_faces(const CardCells& cells, const Scene& scene, std::size_t begin,
                                         std::size_t end) {
    const std::vector<ScreenVertex> vertices = projected(cells, scene);
    const std::vector<KeyedCell> keyed = order(cells);
    std::vector<FaceVertex> faces;
    for (std::size_t i = begin; i < end; ++i) {
      const Tetrahedron& t = scene.tetrahedra[keyed[i].cell];
      std::array<FaceVertex, vertices_per_cell> of_cell{};
      const std::size_t count = front_faces({vertices[t[0]], vertices[t[1]], vertices[t[2]], vertices[t[3]]},
                                            cells.view().grid, of_cell.data());
      faces.insert(faces.end(), of_cell.begin(), of_cell.begin() + static_cast<std::ptrdiff_t>(3 * count));
    }
    return faces;
  }

  HeadlessContext context_{true};
  HeadlessContext::Current current_{context_};
};

// In double both compute the same to its last places: another subpixel only where that falls on a half.
TEST_F(CardCellsTest, VerticesAreWhereTheProcessorPutsThem) {
  std::size_t compared = 0;
  std::size_t elsewhere = 0;
  for (const Case& of : all_cases(201, 150)) {
    const Subject& subject = of.subject;
    CardCells cells(subject.scene, guard_pixels);
    prepare(cells, subject);
    const std::vector<ScreenVertex> card = projected(cells, subject.scene);
    const ScreenMesh mesh = mesh_of(subject);
    for (const Index cell : mesh.cells()) {
      const std::array<ScreenVertex, 4> corners = mesh.corners(cell);
      for (std::size_t k = 0; k < 4; ++k) {
        const ScreenVertex& vertex = card[subject.scene.tetrahedra[cell][k]];
        ASSERT_LE(std::abs(vertex.column - corners[k].column), 1) << of.name;
        ASSERT_LE(std::abs(vertex.row - corners[k].row), 1) << of.name;
        ASSERT_LE(floats_between(vertex.w, corners[k].w), 1) << of.name;
        ASSERT_LE(floats_between(vertex.u, corners[k].u), 2) << of.name;
        elsewhere += vertex.column != corners[k].column || vertex.row != corners[k].row ? 1 : 0;
        ++compared;
      }
    }
    EXPECT_GE(mesh.view().first_w, cells.view().first_w) << of.name;
    EXPECT_LE(mesh.view().last_w, cells.view().last_w) << of.name;
    EXPECT_EQ(mesh.view().reference, cells.view().reference) << of.name;
  }
  EXPECT_GT(compared, 10000U);
  EXPECT_LE(elsewhere, compared / 10000);
  check_errors("the test");
}

TEST_F(CardCellsTest, CellsAreThoseTheProcessorDraws) {
  for (const Case& of : all_cases(61, 50)) {
    const Subject& subject = of.subject;
    CardCells cells(subject.scene, guard_pixels);
    prepare(cells, subject);
    for (std::size_t begin = 0; begin < cells.places(); begin += cells_per_slab) cells.make_slab(begin);
    const ScreenMesh mesh = mesh_of(subject);
    EXPECT_EQ(cells.cells(), mesh.cells().size()) << of.name;
    // All that are drawn are there, each once.
    std::vector<Index> drawn;
    for (const KeyedCell& keyed : order(cells)) drawn.push_back(keyed.cell);
    std::ranges::sort(drawn);
    EXPECT_TRUE(std::ranges::adjacent_find(drawn) == drawn.end()) << of.name;
    EXPECT_TRUE(std::ranges::includes(drawn, mesh.cells())) << of.name;
  }
}

// Of the same places bit by bit.
TEST_F(CardCellsTest, FacesAreThoseOfTheProcessor) {
  std::size_t triangles = 0;
  for (const Case& of : all_cases(201, 150)) {
    const Subject& subject = of.subject;
    CardCells cells(subject.scene, guard_pixels);
    prepare(cells, subject);
    ASSERT_LE(cells.places(), cells_per_slab);
    EXPECT_TRUE(cells.make_slab(0));
    EXPECT_FALSE(cells.make_slab(0));
    const std::vector<FaceVertex> card = cells.faces(0);
    const std::vector<FaceVertex> expected = expected_faces(cells, subject.scene, 0, cells.places());
    ASSERT_EQ(card.size(), expected.size()) << of.name;
    EXPECT_EQ(std::memcmp(card.data(), expected.data(), card.size() * sizeof(FaceVertex)), 0) << of.name;
    EXPECT_EQ(3 * cells.triangles(), card.size()) << of.name;
    triangles += cells.triangles();
  }
  EXPECT_GT(triangles, 10000U);
  check_errors("the test");
}

// More cells than a slab has; kept, and two in turn.
TEST_F(CardCellsTest, SlabsAreMadeOneAfterAnother) {
  Subject subject = subject_of(box_material(30, 30, 26, 2.0, shaking(0.35, 1)), Projection::perspective, "iso", 90, 70);
  for (ColorMapEntry& entry : subject.parameters.volume.color_map.entries) entry.color.a += 0.01F;
  for (const std::size_t kept : {kept_bytes, std::size_t{0}}) {
    CardCells cells(subject.scene, guard_pixels, kept);
    prepare(cells, subject);
    ASSERT_EQ(cells.places(), subject.scene.tetrahedra.size());
    ASSERT_GT(cells.places(), 2 * cells_per_slab);
    for (int pass = 0; pass < 2; ++pass) {
      int made = 0;
      for (std::size_t begin = 0; begin < cells.places(); begin += cells_per_slab) {
        made += cells.make_slab(begin) ? 1 : 0;
        const std::vector<FaceVertex> card = cells.faces(begin);
        const std::size_t end = PreparedCells::slab_end(begin, cells.places());
        const std::vector<FaceVertex> expected = expected_faces(cells, subject.scene, begin, end);
        ASSERT_EQ(card.size(), expected.size());
        EXPECT_EQ(std::memcmp(card.data(), expected.data(), card.size() * sizeof(FaceVertex)), 0);
      }
      // Of three in two places the second is still there.
      EXPECT_EQ(made, pass == 0 ? 3 : kept == 0 ? 2 : 0);
    }
  }
}

// As many groups as one dimension may not have: they come in rows.
TEST_F(CardCellsTest, GroupsMayComeInRows) {
  const Subject subject =
      subject_of(box_material(12, 11, 10, 2.0, shaking(0.35, 1)), Projection::perspective, "iso", 90, 70);
  CardCells cells(subject.scene, guard_pixels);
  prepare(cells, subject);
  const std::vector<ScreenVertex> vertices = projected(cells, subject.scene);
  static PFNGLDISPATCHCOMPUTEPROC real;
  static int rows;
  real = epoxy_glDispatchCompute;
  rows = 0;
  const auto in_rows = [&](PFNGLDISPATCHCOMPUTEPROC other) {
    const Instead instead(epoxy_glDispatchCompute, other);
    const PixelGrid grid = pixel_grid(subject.camera, whole_picture(subject.camera));
    cells.project(subject.camera, grid, subject.parameters.volume.color_map, no_progress());
  };
  // Wiped first, by a dispatch of nothing and another view.
  Subject other = subject;
  other.camera.eye += 0.5 * other.camera.right;
  prepare(cells, other);
  in_rows(+[](GLuint x, GLuint y, GLuint z) {
    EXPECT_EQ(y, 1U);
    rows = static_cast<int>(x + 1) / 2;
    real(2, static_cast<GLuint>(rows), z);
  });
  EXPECT_GT(rows, 2);
  const std::vector<ScreenVertex> again = projected(cells, subject.scene);
  EXPECT_EQ(std::memcmp(again.data(), vertices.data(), again.size() * sizeof(ScreenVertex)), 0);

  static std::array<std::size_t, 3> groups;
  const Instead counted(
      epoxy_glDispatchCompute, +[](GLuint x, GLuint y, GLuint z) {
        groups = {x, y, z};
      });
  for (const std::size_t count : {1UL, 65535UL, 65536UL, 131071UL, 1'000'000UL, 4'000'000'000UL / 256}) {
    dispatch(count);
    EXPECT_LE(std::max({groups[0], groups[1], groups[2]}), 65535U);
    EXPECT_GE(groups[0] * groups[1] * groups[2], count);
    EXPECT_LT(groups[0] * groups[1] * groups[2], count + groups[1]);
  }
}

TEST_F(CardCellsTest, ViewsThatNeedClippingDoNotFit) {
  Subject subject = subject_of(box_material(4, 4, 4, 2.0), Projection::perspective, "front", 64, 64);
  const auto fits = [&](int guard) {
    const CardCells cells(subject.scene, guard);
    return cells.fits(subject.camera, pixel_grid(subject.camera, whole_picture(subject.camera)));
  };
  EXPECT_TRUE(fits(guard_pixels));
  EXPECT_TRUE(fits(32));
  EXPECT_FALSE(fits(8));
  const Camera camera = subject.camera;
  subject.camera.eye = subject.scene.bounds.center();  // inside
  EXPECT_FALSE(fits(guard_pixels));
  subject.camera = camera;
  subject.camera.pixel /= 4000.0;
  EXPECT_FALSE(fits(guard_pixels));
}

class CardPictures : public CardCellsTest {
 protected:
  Image drawn(Volume& volume, const Subject& subject) {
    RenderStats stats;
    volume.draw(subject.camera, subject.parameters, whole_picture(subject.camera), {}, stats, no_progress());
    return volume.read();
  }
  Volume volume_;
};

TEST_F(CardPictures, AreTheProcessorsAndTheJudges) {
  volume_.set_prepare_on_card(true);
  Volume processor;
  processor.set_prepare_on_card(false);
  for (const Case& of : all_cases(160, 120)) {
    Subject subject = of.subject;
    volume_.set_scene(subject.scene);
    processor.set_scene(subject.scene);
    const Image judged =
        test::draw(find_renderer("reference"), subject.scene, subject.camera, subject.parameters).image;
    for (const HavsOrder order : {HavsOrder::lists, HavsOrder::k_buffer}) {
      subject.parameters.havs.order = order;
      const Image card = drawn(volume_, subject);
      EXPECT_TRUE(volume_.last().on_card) << of.name;
      EXPECT_EQ(volume_.last().repair.wrong_pixels, 0U) << of.name;
      const Image of_processor = drawn(processor, subject);
      EXPECT_FALSE(processor.last().on_card);
      EXPECT_EQ(volume_.last().cells, processor.last().cells) << of.name;
      EXPECT_EQ(volume_.last().triangles, processor.last().triangles) << of.name;
      const ImageDifference difference = compare_images(card, judged);
      EXPECT_LE(difference.max, 4.0 / 255.0) << of.name;
      EXPECT_GE(difference.psnr, 45.0) << of.name;
      EXPECT_LE(compare_images(card, of_processor).max, 2e-3) << of.name;
    }
    const auto light = std::ranges::count_if(judged.pixels, [](const Vec4f& pixel) { return pixel.a > 0.05F; });
    EXPECT_GT(light, 100) << of.name;
  }
}

// Zoomed in so far that most cells lie beside the picture, and cells are large.
TEST_F(CardPictures, OfPartsOfTheSampleAreTheJudges) {
  volume_.set_prepare_on_card(true);
  for (const Projection projection : {Projection::parallel, Projection::perspective}) {
    for (const double zoom : {3.0, 12.0}) {
      Subject subject = subject_of(box_material(7, 6, 5, 2.0, shaking(0.35, 1)), projection, "iso", 160, 120);
      subject.camera.pixel /= zoom;
      volume_.set_scene(subject.scene);
      const Image card = drawn(volume_, subject);
      EXPECT_TRUE(volume_.last().on_card);
      EXPECT_LT(volume_.last().cells, subject.scene.tetrahedra.size());
      const ImageDifference difference = compare_images(
          card, test::draw(find_renderer("reference"), subject.scene, subject.camera, subject.parameters).image);
      EXPECT_LE(difference.max, 4.0 / 255.0) << zoom;
      EXPECT_GE(difference.psnr, 45.0) << zoom;
    }
  }
}

// Views that stay are not prepared again; other colours are.
TEST_F(CardPictures, StayAndChangeColors) {
  volume_.set_prepare_on_card(true);
  Subject subject =
      subject_of(box_material(30, 22, 20, 2.0, shaking(0.35, 1)), Projection::perspective, "iso", 120, 90);
  volume_.set_scene(subject.scene);
  const Image first = drawn(volume_, subject);
  EXPECT_GT(volume_.last().cells, cells_per_slab);
  static PFNGLDISPATCHCOMPUTEPROC real;
  static int dispatches;
  real = epoxy_glDispatchCompute;
  const Instead counted(
      epoxy_glDispatchCompute, +[](GLuint x, GLuint y, GLuint z) {
        ++dispatches;
        real(x, y, z);
      });
  subject.parameters.havs.order = HavsOrder::none;  // nothing is repaired
  const Image unrepaired = drawn(volume_, subject);
  dispatches = 0;
  EXPECT_EQ(drawn(volume_, subject).pixels, unrepaired.pixels);
  EXPECT_EQ(dispatches, 0);
  subject.parameters.havs.order = HavsOrder::lists;
  EXPECT_EQ(drawn(volume_, subject).pixels, first.pixels);

  const std::size_t cells = volume_.last().cells;
  std::vector<ColorMapEntry>& entries = subject.parameters.volume.color_map.entries;
  entries[0].color.a = 0.4F;
  const Image recolored = drawn(volume_, subject);
  EXPECT_GT(dispatches, 0);
  EXPECT_GT(compare_images(recolored, first).max, 0.05);
  EXPECT_GE(volume_.last().cells, cells);
  for (ColorMapEntry& entry : entries) entry.color.a = entry.scalar < 0.5 ? 0.0F : entry.color.a;
  const Image fewer = drawn(volume_, subject);
  EXPECT_LT(volume_.last().cells, cells);
  volume_.set_scene(subject.scene);
  EXPECT_EQ(drawn(volume_, subject).pixels, fewer.pixels);
  // Nothing to be seen at all.
  for (ColorMapEntry& entry : entries) entry.color.a = 0.0F;
  for (const Vec4f& pixel : drawn(volume_, subject).pixels) ASSERT_EQ(pixel, Vec4f(0.0F));
  EXPECT_EQ(volume_.last().cells, 0U);
  EXPECT_TRUE(volume_.last().on_card);
}

TEST_F(CardPictures, AreTheSameInSlicesOfTime) {
  volume_.set_prepare_on_card(true);
  const Subject subject =
      subject_of(box_material(30, 22, 20, 2.0, shaking(0.35, 1)), Projection::perspective, "iso", 120, 90);
  volume_.set_scene(subject.scene);
  const Image whole = drawn(volume_, subject);
  volume_.set_scene(subject.scene);
  RenderStats stats;
  volume_.begin(subject.camera, subject.parameters, whole_picture(subject.camera), {});
  int calls = 1;
  for (; !volume_.proceed(0.0, stats, no_progress()); ++calls) glUseProgram(0);
  EXPECT_GT(calls, 60);
  EXPECT_EQ(volume_.read().pixels, whole.pixels);
}

TEST_F(CardPictures, AreTheProcessorsWhereTheCardCannot) {
  volume_.set_prepare_on_card(true);
  Subject subject = subject_of(box_material(7, 6, 5, 2.0, shaking(0.35, 1)), Projection::perspective, "iso", 96, 96);
  volume_.set_scene(subject.scene);
  const Image outside = drawn(volume_, subject);
  EXPECT_TRUE(volume_.last().on_card);
  const Camera camera = subject.camera;
  // Inside the sample, and back.
  subject.camera.eye = subject.scene.bounds.center();
  const Image inside = drawn(volume_, subject);
  EXPECT_FALSE(volume_.last().on_card);
  EXPECT_LE(compare_images(
                inside, test::draw(find_renderer("reference"), subject.scene, subject.camera, subject.parameters).image)
                .max,
            4.0 / 255.0);
  subject.camera = camera;
  EXPECT_EQ(drawn(volume_, subject).pixels, outside.pixels);
  EXPECT_TRUE(volume_.last().on_card);
  // No memory for a moment: until there is another scene, the processor prepares its cells.
  volume_.set_scene(subject.scene);
  {
    static PFNGLBUFFERDATAPROC real;
    static bool full;
    real = epoxy_glBufferData;
    full = false;
    const Instead buffers(
        epoxy_glBufferData, +[](GLenum target, GLsizeiptr size, const void* data, GLenum usage) {
          full = full || size > 20000;
          if (size <= 20000) real(target, size, data, usage);
        });
    const Instead error(
        epoxy_glGetError, +[]() -> GLenum { return std::exchange(full, false) ? GL_OUT_OF_MEMORY : GL_NO_ERROR; });
    volume_.begin(subject.camera, subject.parameters, whole_picture(subject.camera), {});
    RenderStats stats;
    volume_.proceed(0.0, stats, no_progress());
  }
  while (glGetError() != GL_NO_ERROR) {
  }
  take_messages();
  const Image without = drawn(volume_, subject);
  EXPECT_FALSE(volume_.last().on_card);
  EXPECT_LE(compare_images(without, outside).max, 2e-3);
  volume_.set_scene(subject.scene);
  EXPECT_EQ(drawn(volume_, subject).pixels, outside.pixels);
  EXPECT_TRUE(volume_.last().on_card);
  // Empty.
  subject.scene.tetrahedra = {};
  volume_.set_scene(subject.scene);
  for (const Vec4f& pixel : drawn(volume_, subject).pixels) ASSERT_EQ(pixel, Vec4f(0.0F));
  EXPECT_FALSE(volume_.last().on_card);
}

TEST_F(CardPictures, AreNotSoftwaresChoice) {
  const Subject subject = subject_of(one_tetrahedron(), Projection::parallel, "iso", 20, 20);
  volume_.set_scene(subject.scene);
  drawn(volume_, subject);
  EXPECT_EQ(volume_.last().on_card, !current_driver().software);
}

TEST_F(CardPictures, LeaveBuffersAsTheyWere) {
  volume_.set_prepare_on_card(true);
  const Subject subject = subject_of(ring_of_bars(), Projection::parallel, "front", 60, 60);
  volume_.set_scene(subject.scene);
  Buffer mine;
  mine.reserve(1024);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, mine.name());
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 5, mine.name(), 256, 512);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, mine.name());
  drawn(volume_, subject);
  EXPECT_GT(volume_.last().repair.pixels, 0U);  // which binds buffers, too
  const auto at = [](GLenum name, GLuint n) {
    GLint64 value = 0;
    glGetInteger64i_v(name, n, &value);
    return value;
  };
  for (GLuint n = 0; n < 8; ++n) {
    const bool bound = n == 2 || n == 5;
    EXPECT_EQ(at(GL_SHADER_STORAGE_BUFFER_BINDING, n), bound ? mine.name() : 0) << n;
    EXPECT_EQ(at(GL_SHADER_STORAGE_BUFFER_START, n), n == 5 ? 256 : 0) << n;
    EXPECT_EQ(at(GL_SHADER_STORAGE_BUFFER_SIZE, n), n == 5 ? 512 : 0) << n;
  }
  GLint value = 0;
  glGetIntegerv(GL_SHADER_STORAGE_BUFFER_BINDING, &value);
  EXPECT_EQ(value, 0);
  glGetIntegerv(GL_DRAW_INDIRECT_BUFFER_BINDING, &value);
  EXPECT_EQ(static_cast<GLuint>(value), mine.name());
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
}

}  // namespace
}  // namespace atomesh::gl
