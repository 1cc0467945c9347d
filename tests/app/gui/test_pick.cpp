// What a pixel shows, in every mode: known answers, the renderers' id channel, and the judge's cells.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "app/gui/pick.h"
#include "app/gui/sight_line.h"
#include "core/error.h"
#include "render/cpu/reference_modes.h"
#include "tests/render/fixtures.h"

namespace atomesh::gui {
namespace {

using test::box_material;
using test::looking;

constexpr int size = 121;  // odd: the middle pixel looks along the axis

std::optional<Pick> pick_at(const Material& material, const Parameters& parameters, int column = size / 2,
                            int row = size / 2, double opacity = 0.05) {
  const Scene scene = make_scene(material, parameters);
  const Camera camera = make_camera(parameters, scene.bounds, size, size);
  return pick(material, scene, camera, parameters, column, row, opacity);
}

// A box of 5 × 5 × 5 cubes of 2 Å with one defective atom.
Material box_with_defect(Index defective) {
  Material material = box_material(5, 5, 5, 2.0);
  material.defects.positional.assign(material.atoms.size(), 0.0F);
  material.defects.vacancy.assign(material.atoms.size(), 0.0F);
  material.defects.extra.assign(material.atoms.size(), 0.0F);
  material.defects.positional[defective] = 3.0F;
  return material;
}

Index vertex(int i, int j, int k) {
  return static_cast<Index>((k * 6 + j) * 6 + i);
}

class Picking : public testing::TestWithParam<Projection> {};

INSTANTIATE_TEST_SUITE_P(Projections, Picking, testing::Values(Projection::perspective, Projection::parallel),
                         [](const auto& test) {
                           return test.param == Projection::parallel ? "parallel" : "perspective";
                         });

// The triangle of every pixel is that of the renderer, to the last one.
TEST_P(Picking, SurfacePixelsAreTheRenderersTriangles) {
  for (const bool cut : {false, true}) {
    test::Subject subject = test::shaken_box(Mode::surface, GetParam(), 97, 83);
    if (cut) {
      subject.parameters.cut_planes[0] = {true, Vec3(1, 1, 0.5), CutPlane::Side::less_equal,
                                          glm::dot(Vec3(1, 1, 0.5), subject.scene.bounds.center())};
      subject.scene = make_scene(subject.material, subject.parameters);
    }
    const test::Drawn drawn = test::draw(find_renderer("cpu"), subject.scene, subject.camera, subject.parameters);
    int hits = 0;
    for (int row = 0; row < 83; ++row) {
      for (int column = 0; column < 97; ++column) {
        const auto found = pick(subject.material, subject.scene, subject.camera, subject.parameters, column, row);
        const auto pixel = static_cast<std::size_t>(row * 97 + column);
        ASSERT_EQ(found ? found->triangle : no_index, drawn.id[pixel]) << column << " " << row;
        if (!found) continue;
        ++hits;
        EXPECT_NEAR(found->depth, static_cast<double>(drawn.depth[pixel]), 1e-5 * found->depth);
        const Triangle& corners = subject.scene.surface[found->triangle];
        EXPECT_TRUE(std::find(corners.begin(), corners.end(), found->atom) != corners.end());
        EXPECT_EQ(found->position, subject.material.atoms.positions[found->atom]);
        for (const CutPlane& plane : subject.parameters.cut_planes) EXPECT_TRUE(plane.keeps(found->position));
      }
    }
    EXPECT_GT(hits, 500);
    EXPECT_LT(hits, 97 * 83 - 500);
  }
}

TEST_P(Picking, BallPixelsAreTheRenderersAtoms) {
  for (const double opacity : {1.0, 0.3}) {
    test::Subject subject = test::shaken_box(Mode::atoms, GetParam(), 97, 83);
    subject.parameters.atoms.regular_opacity = opacity;
    subject.scene = make_scene(subject.material, subject.parameters);
    const test::Drawn drawn = test::draw(find_renderer("cpu"), subject.scene, subject.camera, subject.parameters);
    int hits = 0;
    for (int row = 0; row < 83; ++row) {
      for (int column = 0; column < 97; ++column) {
        const auto found = pick(subject.material, subject.scene, subject.camera, subject.parameters, column, row);
        const auto pixel = static_cast<std::size_t>(row * 97 + column);
        ASSERT_EQ(found ? found->atom : no_index, drawn.id[pixel]) << column << " " << row;
        if (!found) continue;
        ++hits;
        EXPECT_NEAR(found->depth, static_cast<double>(drawn.depth[pixel]), 1e-5 * found->depth);
      }
    }
    EXPECT_GT(hits, 500);
  }
}

// Balls that are next to nothing do not hide what is behind them.
TEST(PickBalls, FaintOnesAreLookedThrough) {
  Material material = box_with_defect(vertex(2, 4, 3));
  Parameters parameters = looking(Mode::atoms, "front");
  const Vec3 place = material.atoms.positions[vertex(2, 4, 3)];
  parameters.pan = place - sample_bounds(material, parameters).center();
  parameters.atoms.regular_opacity = 0.01;
  const auto found = pick_at(material, parameters);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->atom, vertex(2, 4, 3));
  EXPECT_EQ(found->defects.positional, 3.0F);
  parameters.atoms.regular_opacity = 0.2;
  EXPECT_EQ(pick_at(material, parameters)->atom, vertex(2, 0, 3));
}

// Every pixel's cells are the judge's.
TEST_P(Picking, CellsAreTheJudges) {
  test::Subject subject = test::shaken_box(Mode::volume_surface, GetParam(), 41, 37);
  subject.camera.eye += 0.2 * (subject.scene.bounds.center() - subject.camera.eye);
  const reference::View view(subject.scene, subject.camera, subject.parameters);
  std::vector<Index> all(std::max(subject.scene.tetrahedra.size(), subject.scene.surface.size()));
  std::iota(all.begin(), all.end(), Index{0});
  const std::span<const Index> cells(all.data(), subject.scene.tetrahedra.size());
  const std::span<const Index> faces(all.data(), subject.scene.surface.size());
  std::size_t met = 0;
  for (int row = 0; row < 37; ++row) {
    for (int column = 0; column < 41; ++column) {
      const reference::PixelRay ray = view.sight.pixel_ray(column, row);
      const SightLine line(subject.scene, subject.camera, column, row);
      const auto ours = line.cells({subject.scene.tetrahedra.data(), subject.scene.tetrahedra.size()}, no_progress());
      const auto theirs = reference::cells_on_ray(view, ray, cells);
      ASSERT_EQ(ours.size(), theirs.size());
      for (std::size_t i = 0; i < ours.size(); ++i) {
        EXPECT_EQ(ours[i].cell, theirs[i].cell);
        EXPECT_NEAR(ours[i].near_depth, theirs[i].segment.near_depth, 1e-6);
        EXPECT_NEAR(ours[i].far_depth, theirs[i].segment.far_depth, 1e-6);
        for (std::size_t k = 0; k < 4; ++k) {
          EXPECT_NEAR(ours[i].near_weights[k], theirs[i].segment.near_weights[k], 1e-5);
        }
      }
      met += ours.size();
      const auto triangles =
          line.triangles({subject.scene.surface.data(), subject.scene.surface.size()}, no_progress());
      const auto their_triangles = reference::triangles_on_ray(view, ray, faces);
      ASSERT_EQ(triangles.size(), their_triangles.size());
      for (std::size_t i = 0; i < triangles.size(); ++i) {
        EXPECT_EQ(triangles[i].triangle, their_triangles[i].triangle);
        EXPECT_EQ(triangles[i].entering, their_triangles[i].crossing.entering);
      }
    }
  }
  EXPECT_GT(met, 2000U);
}

// A picture aligned with the crystal: the middle ray goes along edges and through vertices, and still meets what fills
// the box once.
TEST(SightLine, AlongEdgesTheBoxIsFilledOnce) {
  const Material material = box_material(4, 4, 4, 1.5);
  const Parameters parameters = looking(Mode::volume, "front");
  const Scene scene = make_scene(material, parameters);
  const Camera camera = make_camera(parameters, scene.bounds, size, size);
  const SightLine line(scene, camera, size / 2, size / 2);
  const auto cells = line.cells({scene.tetrahedra.data(), scene.tetrahedra.size()}, no_progress());
  double length = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    length += cells[i].far_depth - cells[i].near_depth;
    if (i > 0) {
      EXPECT_NEAR(cells[i].near_depth, cells[i - 1].far_depth, 1e-6);
    }
  }
  EXPECT_NEAR(length, 6.0, 1e-6);
}

TEST_P(Picking, TheVolumesDefectIsFoundThroughWhatIsClear) {
  const Index defective = vertex(2, 4, 3);
  const Material material = box_with_defect(defective);
  Parameters parameters = looking(Mode::volume, "front", GetParam());
  parameters.volume.alpha_length = 2.0;
  parameters.volume.color_map = ColorMap{{{0.0, Vec4f(0.0F)}, {1.0, Vec4f(1.0F)}}};
  parameters.pan = material.atoms.positions[defective] - sample_bounds(material, parameters).center();
  const auto found = pick_at(material, parameters);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->atom, defective);
  EXPECT_EQ(found->defects.positional, 3.0F);
  ASSERT_NE(found->tetrahedron, no_index);
  const Tetrahedron& cell = material.mesh.tetrahedra[found->tetrahedron];
  EXPECT_TRUE(std::find(cell.begin(), cell.end(), defective) != cell.end());
  EXPECT_EQ(found->triangle, no_index);
  EXPECT_EQ(found->neighbours.size(), 6U);
  // Beside the defect the sample is clear, and beside the sample is nothing.
  parameters.pan += Vec3(-3.9, 0, 0);
  EXPECT_FALSE(pick_at(material, parameters));
  EXPECT_FALSE(pick_at(material, parameters, 0, 0));
  // Cut away, it is not there.
  parameters.pan -= Vec3(-3.9, 0, 0);
  parameters.cut_planes[2] = {true, Vec3(0, 1, 0), CutPlane::Side::less_equal, 7.0};
  EXPECT_FALSE(pick_at(material, parameters));
}

// A face in front is not what one looks at where something inside makes more of the pixel by itself.
TEST_P(Picking, DefectsAreFoundBehindFaces) {
  const Index defective = vertex(2, 4, 3);
  const Material material = box_with_defect(defective);
  Parameters parameters = looking(Mode::volume_surface, "front", GetParam());
  parameters.pan = material.atoms.positions[defective] - sample_bounds(material, parameters).center();
  const auto found = pick_at(material, parameters);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->atom, defective);
  // Where nothing inside stands out, faces and haze together decide: with strong faces the front.
  Parameters beside = parameters;
  beside.pan += Vec3(3.0, 0, -3.5);
  beside.volume_surface.face_alpha = 0.9;
  beside.volume_surface.base_color.a = 0.05F;
  const auto front = pick_at(material, beside);
  ASSERT_TRUE(front);
  EXPECT_NEAR(front->position.y, 0.0, 2.1);
  // All of it nearly nothing: nobody sees it.
  beside.volume_surface.face_alpha = 0.0;
  beside.volume_surface.base_color.a = 1e-5F;
  EXPECT_FALSE(pick_at(material, beside));
}

// Uniform haze of 1 - exp(-σ l): half of that is reached at a known depth.
TEST(PickVolume, OfAUniformHazeTheMiddleOfItsOpacity) {
  const Material material = box_material(8, 8, 8, 1.0);
  Parameters parameters = looking(Mode::volume_surface, "front");
  parameters.volume_surface.face_alpha = 0.0;
  parameters.volume_surface.base_color.a = 0.5F;
  for (const double sigma : {0.02, 0.2}) {
    parameters.volume_surface.alpha_length = sigma / 0.5;
    const Scene scene = make_scene(material, parameters);
    const Camera camera = make_camera(parameters, scene.bounds, size, size);
    const auto found = pick(material, scene, camera, parameters, size / 2 + 3, size / 2 - 5, 0.9);
    ASSERT_TRUE(found);
    const double half = 0.5 * -std::expm1(-8.0 * sigma);
    const double depth = -std::log1p(-half) / sigma + glm::dot(Vec3(0.0) - camera.eye, camera.forward);
    const SightLine line(scene, camera, size / 2 + 3, size / 2 - 5);
    const auto cells = line.cells({scene.tetrahedra.data(), scene.tetrahedra.size()}, no_progress());
    const auto at =
        std::find_if(cells.begin(), cells.end(), [&](const CellCrossing& c) { return c.far_depth >= depth; });
    ASSERT_NE(at, cells.end());
    EXPECT_EQ(found->tetrahedron, at->cell);
    EXPECT_GE(found->depth, at->near_depth);
    EXPECT_LE(found->depth, at->far_depth);
  }
}

TEST(PickHoles, NothingWhereTheRayGoesThrough) {
  const Material material = test::ring_of_bars();
  for (const Mode mode : {Mode::volume_surface, Mode::surface, Mode::xray}) {
    Parameters parameters = looking(mode, "front");
    parameters.xray.alpha_length = 1e6;  // however thin
    const Scene scene = make_scene(material, parameters);
    const Camera camera = make_camera(parameters, scene.bounds, size, size);
    const test::Drawn drawn = test::draw(find_renderer("reference"), scene, camera, parameters);
    int holes = 0;
    int hits = 0;
    for (int row = 0; row < size; row += 3) {
      for (int column = 0; column < size; column += 3) {
        const bool seen = drawn.image.at(column, row).a > 0.5F / 255.0F;
        EXPECT_EQ(pick(material, scene, camera, parameters, column, row).has_value(), seen);
        (seen ? hits : holes) += 1;
      }
    }
    EXPECT_GT(holes, 200);
    EXPECT_GT(hits, 200);
  }
}

// A mesh without atoms: the field where the ray met it.
TEST(PickField, OfAMeshWithoutAtoms) {
  Material material = box_material(4, 4, 4, 1.0);
  material.atoms = {};
  material.mesh.vertex_atom.assign(material.mesh.vertices.size(), no_index);
  VertexField field{"x plus y", {}};
  for (const Vec3& p : material.mesh.vertices) field.values.push_back(static_cast<float>(p.x + p.y));
  material.fields.push_back(field);
  for (const Mode mode : {Mode::volume, Mode::volume_surface, Mode::surface, Mode::xray}) {
    Parameters parameters = looking(mode, "iso", Projection::perspective);
    parameters.volume.color_map = ColorMap{{{0.0, Vec4f(0.8F)}, {1.0, Vec4f(1.0F)}}};
    const auto found = pick_at(material, parameters);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->atom, no_index);
    ASSERT_TRUE(found->field);
    EXPECT_NEAR(*found->field, found->position.x + found->position.y, 1e-5);
    EXPECT_EQ(found->tetrahedron == no_index, mode == Mode::surface || mode == Mode::xray);
    EXPECT_EQ(describe(*found, material).front().first, "Position");
  }
}

TEST_P(Picking, CanBeCancelled) {
  for (const Mode mode : test::all_modes) {
    const test::Subject subject = test::shaken_box(mode, GetParam(), 20, 20);
    Progress progress;
    progress.request_cancel();
    EXPECT_THROW(pick(subject.material, subject.scene, subject.camera, subject.parameters, 10, 10, 0.05, progress),
                 CancelledError);
  }
}

}  // namespace
}  // namespace atomesh::gui
