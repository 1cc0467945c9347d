// The tripod of the axes: which arrows, where they point, and how they are drawn.
#include <gtest/gtest.h>

#include <cmath>

#include "render/tripod.h"
#include "tests/render/fixtures.h"

namespace atomesh {
namespace {

std::string names(const std::vector<std::vector<TripodArrow>>& tripods) {
  std::string text;
  for (const auto& tripod : tripods) {
    for (const TripodArrow& arrow : tripod) text += arrow.name;
    text += ' ';
  }
  return text;
}

UnitCell cell(const Vec3& a, const Vec3& b, const Vec3& c) {
  UnitCell result;
  result.primitive = {a, b, c};
  return result;
}

TEST(Tripod, TheCellsVectorsAreThereWhereTheyDiffer) {
  EXPECT_EQ(names(make_tripods(std::nullopt)), "xyz ");
  EXPECT_EQ(names(make_tripods(cell({4, 0, 0}, {0, 5, 0}, {0, 0, 6}))), "xyz ");
  const auto hexagonal = make_tripods(cell({2, 0, 0}, {-1, std::sqrt(3.0), 0}, {0, 0, 6}));
  EXPECT_EQ(names(hexagonal), "xyz abc ");
  EXPECT_NEAR(glm::length(hexagonal[1][1].direction - Vec3(-0.5, std::sqrt(0.75), 0)), 0.0, 1e-12);
  EXPECT_EQ(names(make_tripods(cell({0, 5, 0}, {4, 0, 0}, {0, 0, 6}))), "xyz abc ");
}

// Reddest and bluest pixel of the drawing, without the letters' colours mattering: the places of the tips.
TEST(Tripod, ArrowsPointAsTheCameraSees) {
  Parameters parameters = test::looking(Mode::surface, "front");
  Bounds bounds;
  bounds.add(Vec3(0.0));
  bounds.add(Vec3(10.0));
  for (const double roll : {0.0, 90.0}) {
    parameters.roll = roll;
    const Camera camera = make_camera(parameters, bounds, 400, 400);
    const TripodDrawing drawing(camera, Vec4f(1.0F), make_tripods(std::nullopt), 400);
    ASSERT_TRUE(drawing.box());
    Image image(400, 400);
    std::fill(image.pixels.begin(), image.pixels.end(), Vec4f(1.0F));
    Canvas canvas(image);
    drawing.draw(canvas);
    const CanvasBox box = *drawing.box();
    Vec3 red(0.0);  // Σ column, Σ row, count
    Vec3 blue(0.0);
    for (int row = 0; row < 400; ++row) {
      for (int column = 0; column < 400; ++column) {
        const Vec4f& p = image.at(column, row);
        if (p == Vec4f(1.0F)) continue;
        EXPECT_TRUE(column >= box.left && column < box.right && row >= box.top && row < box.bottom);
        if (p.r > p.b + 0.4F && p.r > p.g + 0.4F) red += Vec3(column, row, 1);
        if (p.b > p.r + 0.4F) blue += Vec3(column, row, 1);
      }
    }
    const Vec3 middle(0.5 * (box.left + box.right), 0.5 * (box.top + box.bottom), 0.0);
    const Vec3 x = red / red.z - middle;
    const Vec3 z = blue / blue.z - middle;
    // Rolled by 90 degrees counter-clockwise x points up and z to the left.
    EXPECT_GT(roll == 0.0 ? x.x : -x.y, 10.0);
    EXPECT_NEAR(roll == 0.0 ? x.y : x.x, 0.0, 3.0);
    EXPECT_GT(roll == 0.0 ? -z.y : -z.x, 10.0);
    EXPECT_NEAR(roll == 0.0 ? z.x : z.y, 0.0, 3.0);
  }
}

TEST(Tripod, BandsMakeThePictureAndSmallOnesGoWithout) {
  Bounds bounds;
  bounds.add(Vec3(0.0));
  bounds.add(Vec3(10.0));
  const Camera camera = make_camera(Parameters{}, bounds, 300, 200);
  const auto tripods = make_tripods(cell({2, 0, 0}, {-1, 2, 0}, {0, 1, 6}));
  const TripodDrawing drawing(camera, Vec4f(0.0F, 0.0F, 0.0F, 1.0F), tripods, 180);
  Image whole(300, 200);
  Canvas canvas(whole);
  drawing.draw(canvas);
  Image together(300, 200);
  for (int first = 0; first < 200; first += 33) {
    Image band(300, std::min(33, 200 - first));
    Canvas part(band, first);
    drawing.draw(part);
    std::copy(band.pixels.begin(), band.pixels.end(), together.pixels.begin() + 300 * first);
  }
  EXPECT_EQ(whole.pixels, together.pixels);
  EXPECT_LE(drawing.box()->bottom, 180);
  const TripodDrawing none(make_camera(Parameters{}, bounds, 60, 60), Vec4f(1.0F), tripods, 60);
  EXPECT_FALSE(none.box());
  Image small(60, 60);
  Canvas nothing(small);
  none.draw(nothing);
  EXPECT_EQ(small.pixels, Image(60, 60).pixels);
}

}  // namespace
}  // namespace atomesh
