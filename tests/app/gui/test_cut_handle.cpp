// Handles of cut planes: outlines, gripping, dragging and tilting, with known answers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "app/gui/cut_handle.h"
#include "app/gui/overlay.h"
#include "tests/render/fixtures.h"

namespace atomesh::gui {
namespace {

Bounds box() {
  Bounds bounds;
  bounds.add(Vec3(0, 0, 0));
  bounds.add(Vec3(10, 20, 30));
  return bounds;
}

Parameters with_plane(const Vec3& normal, double distance, CutPlane::Side side = CutPlane::Side::less_equal,
                      Projection projection = Projection::parallel) {
  Parameters parameters = test::looking(Mode::surface, "iso", projection);
  parameters.cut_planes[3] = {true, normal, side, distance};
  return parameters;
}

Camera camera_of(const Parameters& parameters) {
  return make_camera(parameters, box(), 600, 500);
}

CutHandle only_handle(const Parameters& parameters) {
  const auto handles = cut_handles(parameters, box(), camera_of(parameters));
  EXPECT_EQ(handles.size(), 1U);
  return handles.at(0);
}

double area(const std::vector<Vec3>& polygon) {
  Vec3 sum(0.0);
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    sum += 0.5 * glm::cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
  }
  return glm::length(sum);
}

TEST(CutHandle, OutlinesAreThePlaneInTheBox) {
  EXPECT_TRUE(cut_handles(Parameters{}, box(), camera_of(Parameters{})).empty());
  const CutHandle x = only_handle(with_plane({2, 0, 0}, 8.0));  // x = 4
  EXPECT_EQ(x.plane, 3U);
  EXPECT_EQ(x.outline.size(), 4U);
  EXPECT_NEAR(area(x.outline), 600.0, 1e-9);
  EXPECT_NEAR(glm::length(x.foot - Vec3(4, 10, 15)), 0.0, 1e-9);
  EXPECT_NEAR(glm::length(glm::normalize(x.tip - x.foot) - Vec3(1, 0, 0)), 0.0, 1e-9);
  // What is kept lies behind the arrow.
  const CutHandle other = only_handle(with_plane({2, 0, 0}, 8.0, CutPlane::Side::greater_equal));
  EXPECT_NEAR(glm::length(glm::normalize(other.tip - other.foot) - Vec3(-1, 0, 0)), 0.0, 1e-9);
  // A corner cut off: a triangle with the intercepts 3, 3, 3, its area √3/4 · (3√2)².
  const CutHandle corner = only_handle(with_plane({1, 1, 1}, 3.0));
  EXPECT_EQ(corner.outline.size(), 3U);
  EXPECT_NEAR(area(corner.outline), std::sqrt(3.0) / 4.0 * 18.0, 1e-9);
  EXPECT_NEAR(glm::length(corner.foot - Vec3(1.0)), 0.0, 1e-9);
  // Through the middle: a hexagon.
  EXPECT_EQ(only_handle(with_plane({3, 1.5, 1}, 45.0)).outline.size(), 6U);
  // Beside the sample: no outline, and an arrow nevertheless.
  const CutHandle beside = only_handle(with_plane({0, 1, 0}, 50.0));
  EXPECT_TRUE(beside.outline.empty());
  EXPECT_NEAR(glm::length(beside.foot - Vec3(5, 50, 15)), 0.0, 1e-9);
}

TEST(CutHandle, ArrowsAreGrippedWhereTheyAre) {
  Parameters parameters = with_plane({1, 0, 0}, 4.0);
  parameters.cut_planes[5] = {true, Vec3(0, 0, 1), CutPlane::Side::less_equal, 27.0};
  for (const double zoom : {0.5, 3.0}) {
    parameters.zoom = zoom;
    const Camera camera = camera_of(parameters);
    const auto handles = cut_handles(parameters, box(), camera);
    ASSERT_EQ(handles.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
      const CanvasPoint foot = *canvas_point(camera, handles[i].foot);
      const CanvasPoint tip = *canvas_point(camera, handles[i].tip);
      EXPECT_GT(glm::length(tip - foot), 15.0);
      EXPECT_LT(glm::length(tip - foot), 60.0);
      const CanvasPoint on = 0.3 * foot + 0.7 * tip;
      const CanvasPoint across = glm::normalize(CanvasPoint(foot.y - tip.y, tip.x - foot.x));
      EXPECT_EQ(handle_at(handles, camera, on.x, on.y), i);
      EXPECT_EQ(handle_at(handles, camera, on.x + 5.0 * across.x, on.y + 5.0 * across.y), i);
      const CanvasPoint away = on + 15.0 * across;
      EXPECT_NE(handle_at(handles, camera, away.x, away.y), i);
    }
  }
}

// The place of the arrow that was gripped stays under a mouse that goes along the arrow.
TEST(CutHandle, DraggingFollowsTheMouse) {
  for (const Projection projection : {Projection::parallel, Projection::perspective}) {
    for (const CutPlane::Side side : {CutPlane::Side::less_equal, CutPlane::Side::greater_equal}) {
      for (const double scale : {1.0, 5.0}) {
        const Parameters parameters = with_plane(scale * Vec3(0.8, 0, 0.6), scale * 12.0, side, projection);
        const Camera camera = camera_of(parameters);
        const CutHandle handle = only_handle(parameters);
        const Vec3 grip = handle.foot + 0.6 * (handle.tip - handle.foot);
        for (const double way : {2.5, -3.25}) {
          const CanvasPoint from = *canvas_point(camera, grip);
          const CanvasPoint to = *canvas_point(camera, grip + way * Vec3(0.8, 0, 0.6));
          const CutPlane moved = moved_plane(parameters.cut_planes[3], handle, box(), camera, from, to);
          EXPECT_NEAR(moved.distance / scale, 12.0 + way, 0.51e-3);
          EXPECT_EQ(moved.normal, parameters.cut_planes[3].normal);
          EXPECT_EQ(moved.side, side);
        }
      }
    }
  }
}

TEST(CutHandle, DragsEndWithinReach) {
  const Parameters parameters = with_plane({0, 0, 1}, 12.0);
  const Camera camera = camera_of(parameters);
  const CutHandle handle = only_handle(parameters);
  const CanvasPoint from = *canvas_point(camera, handle.foot);
  const CutPlane top = moved_plane(parameters.cut_planes[3], handle, box(), camera, from, from - CanvasPoint(0, 5000));
  EXPECT_GT(top.distance, 30.0);
  EXPECT_LT(top.distance, 31.0);
  const CutPlane low = moved_plane(parameters.cut_planes[3], handle, box(), camera, from, from + CanvasPoint(0, 5000));
  EXPECT_LT(low.distance, 0.0);
  EXPECT_GT(low.distance, -1.0);
}

// Numbers that people read, as short as they are written anywhere.
TEST(CutHandle, DragsLeaveFewDigits) {
  for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(0.8968, 0.133, 0.422), Vec3(1, 1, 1)}) {
    const Parameters parameters = with_plane(normal, 12.0);
    const Camera camera = camera_of(parameters);
    const CutHandle handle = only_handle(parameters);
    const CanvasPoint from = *canvas_point(camera, handle.foot);
    for (int pixels = 1; pixels < 60; pixels += 7) {
      const CanvasPoint to = from + CanvasPoint(0.5 * pixels, pixels);
      const CutPlane moved = moved_plane(parameters.cut_planes[3], handle, box(), camera, from, to);
      EXPECT_LE(fmt::format("{}", moved.distance).size(), 7U) << moved.distance;
      const CutPlane tilted = tilted_plane(parameters.cut_planes[3], handle, box(), camera, from, to);
      EXPECT_LE(fmt::format("{}", tilted.distance).size(), 7U) << tilted.distance;
    }
  }
}

// Seen along the arrow: upwards is outwards, a pixel for a pixel.
TEST(CutHandle, SeenAlongTheArrow) {
  Parameters parameters = with_plane({0, -1, 0}, -8.0);
  parameters.azimuth = 0.0;
  parameters.elevation = 0.0;
  const Camera camera = camera_of(parameters);
  const CutHandle handle = only_handle(parameters);
  const CanvasPoint from = *canvas_point(camera, handle.foot);
  const CutPlane moved = moved_plane(parameters.cut_planes[3], handle, box(), camera, from, from - CanvasPoint(0, 20));
  EXPECT_NEAR(moved.distance, -8.0 + 20.0 * camera.pixel, 0.51e-3);
}

TEST(CutHandle, TiltingTurnsAboutTheFoot) {
  for (const CutPlane::Side side : {CutPlane::Side::less_equal, CutPlane::Side::greater_equal}) {
    const Parameters parameters = with_plane({0, 0, 2}, 20.0, side);
    const Camera camera = camera_of(parameters);
    const CutHandle handle = only_handle(parameters);
    const CanvasPoint from = *canvas_point(camera, handle.tip);
    // As far to the right as the arrow is long: 45 degrees.
    const double length = glm::length(handle.tip - handle.foot) / camera.pixel;
    const CutPlane tilted =
        tilted_plane(parameters.cut_planes[3], handle, box(), camera, from, from + CanvasPoint(length, 0));
    const Vec3 arrow = side == CutPlane::Side::less_equal ? tilted.normal : -tilted.normal;
    EXPECT_NEAR(glm::length(tilted.normal), 2.0, 1e-3);
    const double z = side == CutPlane::Side::less_equal ? 1.0 : -1.0;
    EXPECT_NEAR(glm::dot(glm::normalize(arrow), Vec3(0, 0, z)), std::sqrt(0.5), 1e-3);
    EXPECT_GT(glm::dot(arrow, camera.right), 0.0);
    EXPECT_NEAR(glm::dot(tilted.normal, handle.foot), tilted.distance, 2e-3);
    EXPECT_EQ(tilted.side, side);
    EXPECT_EQ(tilted_plane(parameters.cut_planes[3], handle, box(), camera, from, from).normal, Vec3(0, 0, 2));
  }
}

TEST(CutHandle, DrawsInBandsAndWithPartsBehindTheEye) {
  Parameters parameters = with_plane({0.3, 0.2, 1}, 15.0, CutPlane::Side::less_equal, Projection::perspective);
  parameters.cut_planes[0] = {true, Vec3(1, 0, 0), CutPlane::Side::greater_equal, 5.0};
  for (const double zoom : {1.0, 9.0}) {  // the nearer eye is within the sample
    parameters.zoom = zoom;
    const Camera camera = camera_of(parameters);
    const auto handles = cut_handles(parameters, box(), camera);
    Image whole(600, 500);
    draw_cut_handles(whole, 0, camera, Vec4f(1.0F), handles, 3);
    Image together(600, 500);
    for (int first = 0; first < 500; first += 77) {
      Image band(600, std::min(77, 500 - first));
      draw_cut_handles(band, first, camera, Vec4f(1.0F), handles, 3);
      std::copy(band.pixels.begin(), band.pixels.end(), together.pixels.begin() + 600 * first);
    }
    EXPECT_EQ(whole.pixels, together.pixels);
    EXPECT_GT(std::count_if(whole.pixels.begin(), whole.pixels.end(), [](const Vec4f& p) { return p.a > 0.5F; }), 800);
  }
}

// With ATOMESH_PICTURES a picture is written there, to be looked at.
TEST(CutHandle, OverAPicture) {
  Material material = test::box_material(5, 10, 15, 2.0);
  Parameters parameters = with_plane({0.3, -0.2, 1}, 19.0, CutPlane::Side::less_equal, Projection::perspective);
  parameters.cut_planes[0] = {true, Vec3(1, 0, 0), CutPlane::Side::less_equal, 7.0};
  const Scene scene = make_scene(material, parameters);
  const Camera camera = make_camera(parameters, scene.bounds, 600, 500);
  RenderStats stats;
  Image image = render(find_renderer("cpu"), scene, camera, parameters, stats);
  const Image before = image;
  draw_cut_handles(image, 0, camera, parameters.background, cut_handles(parameters, scene.bounds, camera), 0);
  EXPECT_NE(before.pixels, image.pixels);
  if (const char* folder = std::getenv("ATOMESH_PICTURES")) write_png(std::string(folder) + "/cut-handles.png", image);
}

}  // namespace
}  // namespace atomesh::gui
