#include "render/gl/front_faces.h"

#include <algorithm>
#include <cmath>

namespace atomesh::gl {

namespace {

// Twice the triangle's area in squared subpixels; positive where it runs clockwise as rows go down.
std::int64_t area(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c) {
  const std::int64_t bx = b.column - a.column;
  const std::int64_t by = b.row - a.row;
  const std::int64_t cx = c.column - a.column;
  const std::int64_t cy = c.row - a.row;
  return bx * cy - by * cx;
}

}  // namespace

std::size_t front_faces(const std::array<ScreenVertex, 4>& corners, const PixelGrid& grid, FaceVertex* vertices) {
  // Of each face, as seen from outside (or from inside all four). With the area as weight of the vertex opposite, sums
  // over the four vertices of what is linear on the screen vanish; of other quantities they are the area times how much
  // the vertex has more than the opposite face there, the same for all four.
  std::array<std::int64_t, 4> areas;
  for (int k = 0; k < 4; ++k) {
    const auto& [a, b, c] = face_corners[k];
    areas[k] = area(corners[a], corners[b], corners[c]);
  }
  double volume = 0.0;  // times the way (w) from a vertex to its face, times -1
  double excess = 0.0;  // the same of u
  double largest = 0.0;
  for (int k = 0; k < 4; ++k) {
    const auto weight = static_cast<double>(areas[k]);
    volume += weight * static_cast<double>(corners[k].w);
    excess += weight * static_cast<double>(corners[k].u);
    largest = std::max(largest, std::abs(weight * static_cast<double>(corners[k].w)));
  }
  // What rounding alone would make; a segment that short adds nothing.
  if (!(std::abs(volume) > 1e-15 * largest)) return 0;
  const auto slope = static_cast<float>(excess / volume);
  std::array<float, 4> behind;  // of each vertex's opposite face, at the vertex
  for (int k = 0; k < 4; ++k)
    behind[k] = areas[k] == 0 ? 0.0F : static_cast<float>(-volume / static_cast<double>(areas[k]));
  std::size_t count = 0;
  for (int k = 0; k < 4; ++k) {
    if (!(behind[k] < 0.0F)) continue;
    const std::array<int, 3>& face = face_corners[k];
    if (!meets_pixel(std::array{corners[face[0]], corners[face[1]], corners[face[2]]}, grid)) continue;
    FaceVertex* triangle = vertices + 3 * count;
    for (int n = 0; n < 3; ++n) {
      const ScreenVertex& corner = corners[face[n]];
      triangle[n].column = static_cast<float>(corner.column) / subpixels;
      triangle[n].row = static_cast<float>(corner.row) / subpixels;
      triangle[n].w = corner.w;
      triangle[n].u = corner.u;
      triangle[n].slope = slope;
      for (int m = 0; m < 3; ++m) {
        const float way = behind[face[m]];
        triangle[n].behind[m] = !(way > 0.0F) ? not_behind : n == m ? way : 0.0F;
      }
    }
    ++count;
  }
  return count;
}

}  // namespace atomesh::gl
