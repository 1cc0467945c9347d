// Where the picture is taken from, and the ray through each pixel. Shared by every renderer.
#pragma once

#include "core/geometry.h"
#include "core/parameters.h"

namespace atomesh {

// right, up and forward are orthonormal, right × up = -forward (right-handed, looking along forward).
struct Camera {
  Vec3 eye{0.0};  // Å; for parallel projection a point in front of the sample, from which depths count
  Vec3 right{1, 0, 0};
  Vec3 up{0, 0, 1};
  Vec3 forward{0, 1, 0};
  Projection projection = Projection::perspective;
  int width = 1;  // pixels
  int height = 1;
  // Distance between neighbouring pixel centres: at depth 1 (perspective, so a slope) or in Å (parallel).
  double pixel = 1.0;

  // Image-plane coordinates of the centre of pixel (column i from the left, row j from the top).
  double x_of(double i) const { return (i + 0.5 - 0.5 * width) * pixel; }
  double y_of(double j) const { return (0.5 * height - (j + 0.5)) * pixel; }
};

// The ray of image-plane point (x, y): origin + depth · direction, depth > 0 counted along `forward`, so that
// dot(direction, forward) == 1. A length along the ray is depth · |direction|.
struct Ray {
  Vec3 origin;
  Vec3 direction;
};
Ray ray(const Camera& camera, double x, double y);

// Image-plane coordinates (x, y) and depth (z) of a point; perspective divides by depth.
Vec3 project(const Camera& camera, const Vec3& point);

// The camera of `parameters` (azimuth, elevation, roll, zoom, pan, projection, field_of_view) for a sample with these
// bounds: at zoom 1 the bounding sphere fits the shorter side of the picture.
Camera make_camera(const Parameters& parameters, const Bounds& bounds, int width, int height);

// The same view with every ray moved right and up by so many pixels, few or parts of one: in perspective the camera
// turns, by which rays at the picture's edge move by somewhat more.
Camera moved_beside(const Camera& camera, double columns, double rows);

// Sets azimuth and elevation from "front" (looks along +y), "back", "left" (looks along +x), "right", "top" (looks
// along -z), "bottom", "iso" (30°, 20° … see the table in camera.cpp) or "AZ,EL" in degrees. Throws UsageError naming
// the nearest.
void set_view(Parameters& parameters, std::string_view view);

}  // namespace atomesh
