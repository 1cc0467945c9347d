// Turning, rolling, panning, zooming and looking along directions: known answers.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "app/gui/navigation.h"
#include "core/error.h"

namespace atomesh::gui {
namespace {

constexpr int width = 640;
constexpr int height = 480;

Bounds box() {
  Bounds bounds;
  bounds.add({-3.0, 1.0, 2.0});
  bounds.add({17.0, 12.0, 31.0});
  return bounds;
}

Vec3 pixel_of(const Parameters& parameters, const Vec3& point) {
  const Camera camera = make_camera(parameters, box(), width, height);
  const Vec3 p = project(camera, point);
  return {p.x / camera.pixel + 0.5 * width - 0.5, 0.5 * height - 0.5 - p.y / camera.pixel, p.z};
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], tolerance) << "component " << k;
}

Parameters aslant(Projection projection) {
  Parameters parameters;
  parameters.projection = projection;
  parameters.azimuth = 37.0;
  parameters.elevation = -21.0;
  parameters.roll = 48.0;
  parameters.zoom = 2.5;
  parameters.pan = {1.0, -2.0, 0.7};
  return parameters;
}

class Navigation : public testing::TestWithParam<Projection> {};

INSTANTIATE_TEST_SUITE_P(Projections, Navigation, testing::Values(Projection::perspective, Projection::parallel),
                         [](const auto& test) {
                           return test.param == Projection::parallel ? "parallel" : "perspective";
                         });

TEST_P(Navigation, ThePivotStaysWhileTheViewTurns) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const bool upright : {true, false}) {
    Parameters parameters = aslant(GetParam());
    for (int step = 0; step < 200; ++step) {
      const Vec3 pivot = box().min + Vec3(unit(random), unit(random), unit(random)) * box().extent();
      const Vec3 before = pixel_of(parameters, pivot);
      if (before.z <= 0.0) continue;
      Parameters turned = parameters;
      rotate_view(turned, box(), pivot, unit(random) - 0.5, unit(random) - 0.5, upright);
      roll_view(turned, box(), pivot, 90.0 * unit(random));
      const Vec3 after = pixel_of(turned, pivot);
      EXPECT_NEAR(after.x, before.x, 1e-9 * width);
      EXPECT_NEAR(after.y, before.y, 1e-9 * width);
      EXPECT_NO_THROW(check_parameters(turned));
      parameters.azimuth = turned.azimuth;
      parameters.elevation = turned.elevation;
      parameters.roll = turned.roll;
    }
  }
}

// What lies in front goes with the mouse: to the right, and down.
TEST_P(Navigation, TheFrontFollowsTheMouse) {
  for (const bool upright : {true, false}) {
    for (const double roll : {0.0, 70.0, 180.0}) {
      Parameters parameters;
      parameters.projection = GetParam();
      parameters.roll = roll;
      const Vec3 middle = box().center();
      const Vec3 front = middle - 5.0 * make_camera(parameters, box(), width, height).forward;
      const Vec3 before = pixel_of(parameters, front);
      Parameters right = parameters;
      rotate_view(right, box(), middle, 0.01, 0.0, upright);
      EXPECT_GT(pixel_of(right, front).x, before.x + 0.5);
      EXPECT_NEAR(pixel_of(right, front).y, before.y, 0.3);
      Parameters down = parameters;
      rotate_view(down, box(), middle, 0.0, 0.01, upright);
      EXPECT_GT(pixel_of(down, front).y, before.y + 0.5);
      EXPECT_NEAR(pixel_of(down, front).x, before.x, 0.3);
    }
  }
}

TEST(NavigationUpright, StopsAtThePolesAndKeepsTheRoll) {
  Parameters parameters;
  parameters.elevation = 80.0;
  rotate_view(parameters, box(), box().center(), 0.25, 0.5, true);
  EXPECT_EQ(parameters.elevation, 90.0);
  EXPECT_EQ(parameters.azimuth, 30.0 - 45.0);
  EXPECT_EQ(parameters.roll, 0.0);
  rotate_view(parameters, box(), box().center(), 0.0, -2.0, true);
  EXPECT_EQ(parameters.elevation, -90.0);
}

TEST(NavigationUpright, TheAzimuthWraps) {
  Parameters parameters;
  parameters.azimuth = 170.0;
  rotate_view(parameters, box(), box().center(), -0.125, 0.0, true);
  EXPECT_EQ(parameters.azimuth, 170.0 + 22.5 - 360.0);
  for (int turn = 0; turn < 50; ++turn) rotate_view(parameters, box(), box().center(), 0.9, 0.0, true);
  EXPECT_NO_THROW(check_parameters(parameters));
}

// A side of the picture is half a turn: two sides are none.
TEST(NavigationFree, TurnsOverThePoles) {
  Parameters parameters;
  parameters.azimuth = 0.0;
  parameters.elevation = 0.0;
  rotate_view(parameters, box(), box().center(), 0.0, 2.0 / 3.0, false);  // 120 degrees up: over the pole
  EXPECT_NEAR(parameters.elevation, 60.0, 1e-9);
  EXPECT_NEAR(std::abs(parameters.azimuth), 180.0, 1e-9);
  EXPECT_NEAR(std::abs(parameters.roll), 180.0, 1e-9);
  rotate_view(parameters, box(), box().center(), 0.0, 4.0 / 3.0, false);
  const Camera camera = make_camera(parameters, box(), width, height);
  expect_near(camera.forward, {0, 1, 0}, 1e-12);
  expect_near(camera.up, {0, 0, 1}, 1e-12);
}

TEST_P(Navigation, RollTurnsThePictureCounterClockwise) {
  Parameters parameters;
  parameters.projection = GetParam();
  const Camera camera = make_camera(parameters, box(), width, height);
  const Vec3 to_the_right = box().center() + 4.0 * camera.right;
  roll_view(parameters, box(), box().center(), 90.0);
  const Vec3 pixel = pixel_of(parameters, to_the_right);
  EXPECT_NEAR(pixel.x, 0.5 * width - 0.5, 1e-9 * width);
  EXPECT_LT(pixel.y, 0.5 * height - 20.0);
}

TEST_P(Navigation, PanFollowsTheMouseAtThePivot) {
  Parameters parameters = aslant(GetParam());
  const Vec3 pivot(4.0, 5.0, 9.0);
  const Vec3 before = pixel_of(parameters, pivot);
  pan_view(parameters, box(), pivot, 31.5, -12.25, width, height);
  const Vec3 after = pixel_of(parameters, pivot);
  EXPECT_NEAR(after.x, before.x + 31.5, 1e-9 * width);
  EXPECT_NEAR(after.y, before.y - 12.25, 1e-9 * width);
}

TEST_P(Navigation, ZoomKeepsThePointUnderTheMouse) {
  for (const double factor : {1.25, 0.5, 7.0}) {
    Parameters parameters = aslant(GetParam());
    const Vec3 pivot(4.0, 5.0, 9.0);
    const Camera camera = make_camera(parameters, box(), width, height);
    const double depth = pixel_of(parameters, pivot).z;
    const double column = 123.25;
    const double row = 401.0;
    const Ray line = ray(camera, camera.x_of(column), camera.y_of(row));
    const Vec3 point = line.origin + depth * line.direction;
    zoom_view(parameters, box(), pivot, factor, column, row, width, height);
    EXPECT_DOUBLE_EQ(parameters.zoom, 2.5 * factor);
    const Vec3 after = pixel_of(parameters, point);
    EXPECT_NEAR(after.x, column, 1e-9 * width);
    EXPECT_NEAR(after.y, row, 1e-9 * width);
    // At that depth a pixel is smaller by the factor.
    const Camera now = make_camera(parameters, box(), width, height);
    const double scale = GetParam() == Projection::perspective ? after.z / depth : 1.0;
    EXPECT_NEAR(now.pixel * scale, camera.pixel / factor, 1e-12);
  }
}

TEST_P(Navigation, ZoomInAndOutIsTheSameView) {
  const Parameters before = aslant(GetParam());
  Parameters parameters = before;
  const Vec3 pivot(4.0, 5.0, 9.0);
  for (int i = 0; i < 10; ++i) zoom_view(parameters, box(), pivot, 1.2, 100.0, 50.0, width, height);
  for (int i = 0; i < 10; ++i) zoom_view(parameters, box(), pivot, 1.0 / 1.2, 100.0, 50.0, width, height);
  EXPECT_NEAR(parameters.zoom, before.zoom, 1e-9);
  const Camera a = make_camera(before, box(), width, height);
  const Camera b = make_camera(parameters, box(), width, height);
  for (const Vec3& p : {Vec3(0, 3, 5), Vec3(11, 4, 20)}) expect_near(project(a, p), project(b, p), 1e-8);
}

TEST_P(Navigation, TheTablesRangesHold) {
  Parameters parameters;
  parameters.projection = GetParam();
  for (int i = 0; i < 200; ++i) zoom_view(parameters, box(), box().center(), 1.5, 320, 240, width, height);
  EXPECT_EQ(parameters.zoom, parameter_row("view.zoom").max);
  EXPECT_NO_THROW(check_parameters(parameters));
  for (int i = 0; i < 400; ++i) zoom_view(parameters, box(), box().center(), 0.5, 0, 0, width, height);
  EXPECT_EQ(parameters.zoom, parameter_row("view.zoom").min);
  for (int i = 0; i < 200; ++i) pan_view(parameters, box(), box().center(), 1e9, -1e9, width, height);
  EXPECT_NO_THROW(check_parameters(parameters));
}

// With parallel projection nothing in the picture tells how far the eye is; it must not come into the sample, where
// what is in front of it would vanish.
TEST(NavigationParallel, TheEyeStaysInFrontOfTheSample) {
  Parameters parameters = aslant(Projection::parallel);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int step = 0; step < 300; ++step) {
    const Vec3 corner = step % 2 == 0 ? box().min : box().max;
    rotate_view(parameters, box(), corner, unit(random), unit(random), step % 3 == 0);
    const Camera camera = make_camera(parameters, box(), width, height);
    for (int n = 0; n < 8; ++n) {
      const Vec3 p((n & 1) != 0 ? box().max.x : box().min.x, (n & 2) != 0 ? box().max.y : box().min.y,
                   (n & 4) != 0 ? box().max.z : box().min.z);
      EXPECT_GT(project(camera, p).z, 0.0);
    }
  }
}

TEST(Orientation, MatrixToAnglesAndBack) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 500; ++n) {
    Vec3 forward = glm::normalize(Vec3(normal(random), normal(random), normal(random)));
    if (n % 5 == 0) forward = Vec3(0, 0, n % 2 == 0 ? 1 : -1);
    if (n % 5 == 1) forward = glm::normalize(Vec3(1e-7 * normal(random), 1e-7 * normal(random), 1.0));
    const Vec3 side = glm::normalize(Vec3(normal(random), normal(random), normal(random)));
    const Vec3 up = glm::normalize(glm::cross(side, forward));
    Parameters parameters;
    set_orientation(parameters, forward, up);
    EXPECT_NO_THROW(check_parameters(parameters));
    const Camera camera = make_camera(parameters, box(), width, height);
    expect_near(camera.forward, forward, 1e-11);
    expect_near(camera.up, up, 1e-11);
    expect_near(camera.right, glm::cross(forward, up), 1e-11);
  }
}

TEST(Orientation, OfAnglesGivesTheAngles) {
  for (const double azimuth : {-180.0, -120.5, 0.0, 45.0, 90.0}) {
    for (const double elevation : {-89.0, -30.0, 0.0, 12.5, 90.0}) {
      for (const double roll : {0.0, 33.0, -170.0}) {
        Parameters parameters;
        parameters.azimuth = azimuth;
        parameters.elevation = elevation;
        parameters.roll = roll;
        const Camera camera = make_camera(parameters, box(), width, height);
        Parameters again;
        set_orientation(again, camera.forward, camera.up);
        EXPECT_NEAR(again.elevation, elevation, 1e-9);
        if (elevation == 90.0) {  // all of the turn is the azimuth's: looking down, it goes against the roll
          EXPECT_EQ(again.roll, 0.0);
          EXPECT_NEAR(std::remainder(again.azimuth - (azimuth - roll), 360.0), 0.0, 1e-9);
        } else {
          EXPECT_NEAR(std::remainder(again.azimuth - azimuth, 360.0), 0.0, 1e-9);
          EXPECT_NEAR(again.roll, roll, 1e-9);
        }
      }
    }
  }
}

TEST(LookAlong, AxesGiveTheNamedViews) {
  struct Case {
    const char* name;
    Vec3 direction;
  };
  for (const Case& c : {Case{"front", {0, 1, 0}},
                        {"back", {0, -2, 0}},
                        {"left", {1, 0, 0}},
                        {"right", {-1, 0, 0}},
                        {"top", {0, 0, -3}}}) {
    Parameters looked;
    looked.roll = 12.0;
    look_along(looked, c.direction, Vec3(0, 0, 1));
    Parameters named;
    set_view(named, c.name);
    EXPECT_EQ(std::remainder(looked.azimuth - named.azimuth, 360.0), 0.0) << c.name;
    EXPECT_EQ(looked.elevation, named.elevation) << c.name;
    EXPECT_EQ(looked.roll, 0.0) << c.name;
  }
  Parameters parameters;
  EXPECT_THROW(look_along(parameters, Vec3(0.0), Vec3(0, 0, 1)), UsageError);
}

TEST(LookAlong, UpIsUpAsFarAsItCanBe) {
  const Vec3 direction(1.0, 2.0, -0.5);
  const Vec3 up(0.3, -0.2, 1.7);
  Parameters parameters;
  parameters.zoom = 3.0;
  parameters.pan = {1, 2, 3};
  look_along(parameters, direction, up);
  const Camera camera = make_camera(parameters, box(), width, height);
  expect_near(camera.forward, glm::normalize(direction), 1e-12);
  EXPECT_NEAR(glm::dot(camera.right, up), 0.0, 1e-11);
  EXPECT_GT(glm::dot(camera.up, up), 0.0);
  EXPECT_EQ(parameters.zoom, 3.0);
  EXPECT_EQ(parameters.pan, Vec3(1, 2, 3));
}

// A triclinic cell, right-handed and left-handed.
std::vector<UnitCell> skew_cells() {
  UnitCell cell;
  cell.primitive = {Vec3(4.1, 0.3, -0.2), Vec3(-1.7, 5.2, 0.4), Vec3(0.9, 1.1, 7.3)};
  UnitCell mirrored = cell;
  std::swap(mirrored.primitive[0], mirrored.primitive[1]);
  return {cell, mirrored};
}

TEST(Crystal, LooksAlongTheDirection) {
  for (const UnitCell& cell : skew_cells()) {
    for (const Vec3& uvw : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 1), Vec3(-2, 1, 3)}) {
      Parameters parameters;
      look_along_crystal(parameters, cell, uvw);
      const Camera camera = make_camera(parameters, box(), width, height);
      const Vec3 direction = uvw.x * cell.primitive[0] + uvw.y * cell.primitive[1] + uvw.z * cell.primitive[2];
      EXPECT_LT(glm::length(glm::cross(camera.forward, glm::normalize(direction))), 1e-11);
      EXPECT_GT(glm::dot(camera.forward, direction), 0.0);
      const Vec3 up = uvw == Vec3(0, 0, 1) ? cell.primitive[1] : cell.primitive[2];
      EXPECT_NEAR(glm::dot(camera.right, up), 0.0, 1e-10);
      EXPECT_GT(glm::dot(camera.up, up), 0.0);
    }
    Parameters parameters;
    EXPECT_THROW(look_along_crystal(parameters, cell, Vec3(0.0)), UsageError);
    EXPECT_THROW(look_at_plane(parameters, cell, Vec3(0.0)), UsageError);
  }
}

// Two vectors of the lattice that lie in the plane are at right angles to its normal, and its neighbour is one spacing
// further, whichever hand the cell has.
TEST(Crystal, PlanesOfSkewCells) {
  for (const UnitCell& cell : skew_cells()) {
    const auto& [a, b, c] = cell.primitive;
    const Vec3 hkl(1, 2, 3);
    const Vec3 normal = plane_normal(cell, hkl);
    EXPECT_NEAR(glm::length(normal), 1.0, 1e-12);
    EXPECT_NEAR(glm::dot(normal, 2.0 * a - b), 0.0, 1e-11);
    EXPECT_NEAR(glm::dot(normal, 3.0 * a - c), 0.0, 1e-11);
    EXPECT_NEAR(glm::dot(normal, a), plane_spacing(cell, hkl), 1e-11);
    EXPECT_GT(glm::dot(normal, a), 0.0);
    Parameters parameters;
    look_at_plane(parameters, cell, hkl);
    const Camera camera = make_camera(parameters, box(), width, height);
    expect_near(camera.forward, -normal, 1e-11);
  }
  UnitCell cubic;
  cubic.primitive = {Vec3(4, 0, 0), Vec3(0, 4, 0), Vec3(0, 0, 4)};
  EXPECT_NEAR(plane_spacing(cubic, {1, 1, 1}), 4.0 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(plane_spacing(cubic, {2, 0, 0}), 2.0, 1e-12);
}

TEST_P(Navigation, FlyingBringsTheSphereToTheMiddle) {
  Parameters parameters = aslant(GetParam());
  const Vec3 center(2.0, 10.0, 7.0);
  fly_to(parameters, box(), center, 1.5);
  const Vec3 pixel = pixel_of(parameters, center);
  EXPECT_NEAR(pixel.x, 0.5 * width - 0.5, 1e-9 * width);
  EXPECT_NEAR(pixel.y, 0.5 * height - 0.5, 1e-9 * width);
  EXPECT_EQ(parameters.azimuth, 37.0);
  const Camera camera = make_camera(parameters, box(), width, height);
  const double radius =
      GetParam() == Projection::parallel ? 1.5 / camera.pixel : std::tan(std::asin(1.5 / pixel.z)) / camera.pixel;
  EXPECT_NEAR(radius, 0.25 * height, 0.01 * height);
  const double zoom = parameters.zoom;
  fly_to(parameters, box(), Vec3(0, 5, 9), 0.0);
  EXPECT_EQ(parameters.zoom, zoom);
  fly_to(parameters, box(), center, 1e-9);
  EXPECT_EQ(parameters.zoom, parameter_row("view.zoom").max);
}

TEST(NavigationReset, ResetIsTheDefaultViewAndNothingElse) {
  Parameters parameters = aslant(Projection::parallel);
  parameters.field_of_view = 44.0;
  reset_orientation(parameters);
  Parameters expected;
  expected.projection = Projection::parallel;
  expected.field_of_view = 44.0;
  EXPECT_EQ(parameters, expected);
}

}  // namespace
}  // namespace atomesh::gui
