// Simple shapes over a finished picture, or over a band of it.
#pragma once

#include <span>
#include <vector>

#include "core/image.h"

namespace atomesh {

// A place between pixels: the picture's upper left corner is (0, 0), the centre of its first pixel (0.5, 0.5).
using CanvasPoint = glm::dvec2;

// Pixels of a rectangle: columns left … right-1 and rows top … bottom-1 of the picture.
struct CanvasBox {
  int left = 0;
  int top = 0;
  int right = 0;
  int bottom = 0;

  int width() const { return right - left; }
  int height() const { return bottom - top; }
};

// Rows first_row … of a picture as wide as `image`; positions are those in the whole picture, and what lies outside the
// band is left out, so that bands drawn one by one are the picture drawn at once.
class Canvas {
 public:
  explicit Canvas(Image& image, int first_row = 0) : image_(image), first_row_(first_row) {}

  // Colour over what is there, weighted with `coverage`; both not premultiplied. Outside the band: nothing.
  void blend(int column, int row, const Vec4f& color, float coverage = 1.0F);
  // The pixel becomes `color` whatever was there.
  void set(int column, int row, const Vec4f& color);

  void fill(const CanvasBox& box, const Vec4f& color);
  // With round corners, antialiased; a square with a radius of half its side is a disc.
  void fill_rounded(const CanvasBox& box, double radius, const Vec4f& color);
  // A frame of that many pixels just outside the box.
  void frame(const CanvasBox& box, int thickness, const Vec4f& color);
  // A line through the points, with round joints and ends, antialiased; each pixel is covered once however often the
  // line comes by. `closed`: back to the first.
  void stroke(std::span<const CanvasPoint> points, bool closed, double width, const Vec4f& color);
  // A convex polygon, antialiased, its corners in either sense.
  void fill_convex(std::span<const CanvasPoint> corners, const Vec4f& color);

  // What of `box` lies in the band.
  CanvasBox clipped(const CanvasBox& box) const;

 private:
  Image& image_;
  int first_row_;
};

}  // namespace atomesh
