// Lines and polygons over pictures: known coverage, and bands that make the picture.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "render/canvas.h"

namespace atomesh {
namespace {

const Vec4f black(0.0F, 0.0F, 0.0F, 1.0F);

double covered(const Image& image) {
  double sum = 0.0;
  for (const Vec4f& pixel : image.pixels) sum += static_cast<double>(pixel.a);
  return sum;
}

TEST(CanvasStroke, CoversLengthTimesWidthAndItsRoundEnds) {
  for (const double angle : {0.0, 0.3, 1.1, 1.5707963, 2.5}) {
    for (const double width : {1.0, 3.0, 7.5}) {
      Image image(100, 90);
      const CanvasPoint from(50.3, 44.1);
      const CanvasPoint way(std::cos(angle), std::sin(angle));
      const std::array<CanvasPoint, 2> ends{from - 15.0 * way, from + 20.0 * way};
      Canvas(image).stroke(ends, false, width, black);
      const double expected = 35.0 * width + std::numbers::pi * width * width / 4.0;
      EXPECT_NEAR(covered(image), expected, 0.02 * expected + 0.5) << angle << " " << width;
    }
  }
}

// A half-transparent ring of many short pieces is as transparent at their joints as between them.
TEST(CanvasStroke, CoversEachPixelOnce) {
  Image image(120, 120);
  std::vector<CanvasPoint> ring;
  for (int i = 0; i < 300; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 300;
    ring.push_back(CanvasPoint(60, 60) + 40.0 * CanvasPoint(std::cos(angle), std::sin(angle)));
  }
  Canvas(image).stroke(ring, true, 5.0, Vec4f(1.0F, 0.0F, 0.0F, 0.5F));
  float most = 0.0F;
  for (const Vec4f& pixel : image.pixels) most = std::max(most, pixel.a);
  EXPECT_EQ(most, 0.5F);
  EXPECT_NEAR(covered(image), 0.5 * 5.0 * 2.0 * std::numbers::pi * 40.0, 5.0);
  EXPECT_EQ(image.at(60, 60).a, 0.0F);
  EXPECT_EQ(image.at(100, 60).a, 0.5F);
}

TEST(CanvasFill, ConvexPolygonsHaveTheirArea) {
  const std::array<CanvasPoint, 4> corners{CanvasPoint(10.2, 5.7), {60.9, 20.3}, {50.4, 70.8}, {20.1, 60.6}};
  double area = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const CanvasPoint& a = corners[i];
    const CanvasPoint& b = corners[(i + 1) % 4];
    area += 0.5 * (a.x * b.y - a.y * b.x);
  }
  Image image(80, 80);
  Canvas(image).fill_convex(corners, black);
  EXPECT_NEAR(covered(image), area, 0.005 * area);
  Image reversed(80, 80);
  const std::array<CanvasPoint, 4> backward{corners[3], corners[2], corners[1], corners[0]};
  Canvas(reversed).fill_convex(backward, black);
  EXPECT_NEAR(covered(reversed), area, 0.005 * area);
}

TEST(Canvas, BandsMakeThePicture) {
  const std::array<CanvasPoint, 3> path{CanvasPoint(-20.0, 10.0), {70.5, 33.0}, {15.0, 200.0}};
  const auto draw = [&path](Canvas canvas) {
    canvas.stroke(path, true, 4.3, Vec4f(0.2F, 0.4F, 0.6F, 0.7F));
    canvas.fill_convex(path, Vec4f(0.9F, 0.1F, 0.3F, 0.4F));
  };
  Image whole(64, 50);
  draw(Canvas(whole));
  Image together(64, 50);
  for (int first = 0; first < 50; first += 7) {
    Image band(64, std::min(7, 50 - first));
    draw(Canvas(band, first));
    std::copy(band.pixels.begin(), band.pixels.end(), together.pixels.begin() + 64 * first);
  }
  EXPECT_EQ(whole.pixels, together.pixels);
  EXPECT_GT(covered(whole), 100.0);
}

TEST(Canvas, PlacesThatAreNoNumbersAreLeftOut) {
  Image image(20, 20);
  const std::array<CanvasPoint, 3> path{CanvasPoint(3.0, 4.0), {std::nan(""), 5.0}, {15.0, 19.0}};
  Canvas(image).stroke(path, false, 3.0, black);
  Canvas(image).fill_convex(path, black);
  const std::array<CanvasPoint, 2> far{CanvasPoint(-1e12, 10.0), {1e12, 10.5}};
  Canvas(image).stroke(far, false, 2.0, black);
  EXPECT_EQ(image.at(10, 10).a, 1.0F);
  EXPECT_EQ(image.at(10, 15).a, 0.0F);
}

}  // namespace
}  // namespace atomesh
