// A vertex as the renderers project it.
#pragma once

namespace atomesh {

struct alignas(32) ProjectedVertex {
  double x, y, z;     // along right, up and forward about the eye, Å
  float column, row;  // in pixels; not a number where behind()
  // Perspective only: it has no place in the image plane, being in the eye's plane or behind it.
  bool behind() const { return column != column; }
};

// Beyond the rounding of a float at column 16,384, and the shift of cell projection's rays.
inline constexpr float pixel_margin = 0.005F;

}  // namespace atomesh
