#include <gtest/gtest.h>

#include <cmath>

#include "core/camera.h"
#include "core/error.h"

namespace atomesh {
namespace {

Bounds unit_box() {
  Bounds bounds;
  bounds.add(Vec3(-1, -2, -3));
  bounds.add(Vec3(1, 2, 3));
  return bounds;
}

TEST(Camera, AxesAreOrthonormalAndRightHandedInEveryView) {
  for (const char* view : {"front", "back", "left", "right", "top", "bottom", "iso", "12.5,-33"}) {
    Parameters parameters;
    parameters.roll = 17.0;
    set_view(parameters, view);
    const Camera camera = make_camera(parameters, unit_box(), 640, 480);
    EXPECT_NEAR(glm::dot(camera.right, camera.up), 0.0, 1e-14) << view;
    EXPECT_NEAR(glm::length(camera.up), 1.0, 1e-14) << view;
    EXPECT_NEAR(glm::length(glm::cross(camera.right, camera.up) + camera.forward), 0.0, 1e-14) << view;
  }
}

TEST(Camera, FrontLooksAlongYWithZUpAndTopLooksDownWithYUp) {
  Parameters parameters;
  set_view(parameters, "front");
  Camera camera = make_camera(parameters, unit_box(), 100, 100);
  EXPECT_NEAR(camera.forward.y, 1.0, 1e-14);
  EXPECT_NEAR(camera.right.x, 1.0, 1e-14);
  EXPECT_NEAR(camera.up.z, 1.0, 1e-14);
  set_view(parameters, "top");
  camera = make_camera(parameters, unit_box(), 100, 100);
  EXPECT_NEAR(camera.forward.z, -1.0, 1e-14);
  EXPECT_NEAR(camera.up.y, 1.0, 1e-14);
  set_view(parameters, "right");
  camera = make_camera(parameters, unit_box(), 100, 100);
  EXPECT_NEAR(camera.forward.x, -1.0, 1e-14);
}

TEST(Camera, ProjectInvertsRay) {
  for (const Projection projection : {Projection::perspective, Projection::parallel}) {
    Parameters parameters;
    parameters.projection = projection;
    const Camera camera = make_camera(parameters, unit_box(), 64, 48);
    const Ray r = ray(camera, camera.x_of(10), camera.y_of(20));
    const Vec3 p = project(camera, r.origin + 7.0 * r.direction);
    EXPECT_NEAR(p.x, camera.x_of(10), 1e-12);
    EXPECT_NEAR(p.y, camera.y_of(20), 1e-12);
    EXPECT_NEAR(p.z, 7.0, 1e-12);
  }
}

TEST(Camera, MovedBesideItSeesWhatIsBesideItsRays) {
  for (const Projection projection : {Projection::perspective, Projection::parallel}) {
    Parameters parameters;
    parameters.projection = projection;
    set_view(parameters, "iso");
    const Camera camera = make_camera(parameters, unit_box(), 65, 49);
    const Camera moved = moved_beside(camera, 0.5, -0.25);
    EXPECT_NEAR(glm::length(moved.right), 1.0, 1e-14);
    EXPECT_NEAR(glm::length(moved.up), 1.0, 1e-14);
    EXPECT_NEAR(glm::length(glm::cross(moved.right, moved.up) + moved.forward), 0.0, 1e-14);
    // In the middle and in a corner. A perspective ray moves by 1 / cos² of its angle to the axis.
    for (const auto& [column, row] : {std::pair{32, 24}, {0, 0}}) {
      const double tangent = std::hypot(camera.x_of(column), camera.y_of(row));
      const bool parallel = projection == Projection::parallel;
      const double allowed = parallel ? 1e-12 : 0.6 * (tangent * tangent + 0.01);
      const Ray r = ray(moved, moved.x_of(column), moved.y_of(row));
      const Vec3 seen = project(camera, r.origin + 7.0 * r.direction);
      EXPECT_NEAR((seen.x - camera.x_of(column)) / camera.pixel, 0.5, allowed);
      EXPECT_NEAR((seen.y - camera.y_of(row)) / camera.pixel, -0.25, allowed);
    }
  }
}

TEST(Camera, BoundingSphereFitsTheShorterSide) {
  for (const Projection projection : {Projection::perspective, Projection::parallel}) {
    Parameters parameters;
    parameters.projection = projection;
    const Camera camera = make_camera(parameters, unit_box(), 200, 100);
    const double radius = 0.5 * unit_box().diagonal();
    // The topmost point of the sphere's silhouette.
    Vec3 top = radius * camera.up;
    if (projection == Projection::perspective) {
      const double distance = glm::length(camera.eye);
      const double sine = radius / distance;
      top = radius * (std::sqrt(1 - sine * sine) * camera.up - sine * camera.forward);
    }
    EXPECT_NEAR(project(camera, top).y, camera.y_of(-0.5), 1e-9);
  }
}

// Whatever the unit: the same sample in another one fills the same picture.
TEST(Camera, SmallAndLargeSamplesFillThePictureAlike) {
  const Parameters parameters;
  const Vec3 corner(0.9, 0.1, 1.0);
  Bounds unit;
  unit.add(Vec3(0.0));
  unit.add(Vec3(1.0));
  const Vec3 expected = project(make_camera(parameters, unit, 200, 100), corner);
  for (const double scale : {1e-9, 1e-3, 1e9}) {
    Bounds bounds;
    bounds.add(Vec3(0.0));
    bounds.add(Vec3(scale));
    const Vec3 pixel = project(make_camera(parameters, bounds, 200, 100), scale * corner);
    EXPECT_NEAR(pixel.x, expected.x, 1e-9) << scale;
    EXPECT_NEAR(pixel.y, expected.y, 1e-9) << scale;
  }
  Bounds point;
  point.add(Vec3(5.0));
  EXPECT_GT(make_camera(parameters, point, 200, 100).pixel, 0.0);
}

TEST(Camera, UnknownViewNamesTheNearest) {
  Parameters parameters;
  try {
    set_view(parameters, "frnt");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean front?"), std::string::npos) << error.what();
  }
  EXPECT_THROW(set_view(parameters, "10,95"), UsageError);
  EXPECT_THROW(set_view(parameters, "10,2x"), UsageError);
}

}  // namespace
}  // namespace atomesh
