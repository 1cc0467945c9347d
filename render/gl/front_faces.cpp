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

// What is the same all over a cell's picture.
struct Inside {
  std::array<float, 4>
      behind{};        // of each corner's opposite face, at the corner; below 0: the face is seen from the front
  float slope = 0.0F;  // FaceVertex::slope
  bool empty = true;
};

Inside inside(const std::array<ScreenVertex, 4>& corners) {
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
  Inside of;
  // What rounding alone would make; a segment that short adds nothing.
  if (!(std::abs(volume) > 1e-15 * largest)) return of;
  of.empty = false;
  of.slope = static_cast<float>(excess / volume);
  for (int k = 0; k < 4; ++k) {
    if (areas[k] != 0) of.behind[k] = static_cast<float>(-volume / static_cast<double>(areas[k]));
  }
  return of;
}

std::size_t write_faces(const std::array<ScreenVertex, 4>& corners, const PixelGrid& grid, const Inside& of,
                        FaceVertex* vertices) {
  std::size_t count = 0;
  for (int k = 0; k < 4; ++k) {
    if (!(of.behind[k] < 0.0F)) continue;
    const std::array<int, 3>& face = face_corners[k];
    if (!meets_pixel(std::array{corners[face[0]], corners[face[1]], corners[face[2]]}, grid)) continue;
    FaceVertex* triangle = vertices + 3 * count;
    for (int n = 0; n < 3; ++n) {
      const ScreenVertex& corner = corners[face[n]];
      triangle[n].column = static_cast<float>(corner.column) / subpixels;
      triangle[n].row = static_cast<float>(corner.row) / subpixels;
      triangle[n].w = corner.w;
      triangle[n].u = corner.u;
      triangle[n].slope = of.slope;
      for (int m = 0; m < 3; ++m) {
        const float way = of.behind[face[m]];
        triangle[n].behind[m] = !(way > 0.0F) ? not_behind : n == m ? way : 0.0F;
      }
    }
    ++count;
  }
  return count;
}

}  // namespace

std::size_t front_faces(const std::array<ScreenVertex, 4>& corners, const PixelGrid& grid, FaceVertex* vertices) {
  const Inside of = inside(corners);
  return of.empty ? 0 : write_faces(corners, grid, of, vertices);
}

FewestFaces fewest_faces(const std::array<ScreenVertex, 4>& corners, const PixelGrid& grid, bool perspective,
                         FaceVertex* vertices) {
  Inside of = inside(corners);
  if (of.empty) return {};
  const auto front = std::ranges::count_if(of.behind, [](float way) { return way < 0.0F; });
  const auto back = std::ranges::count_if(of.behind, [](float way) { return way > 0.0F; });
  if (front <= back) return {write_faces(corners, grid, of, vertices), false};
  for (float& way : of.behind) way = -way;
  std::array<ScreenVertex, 4> mirrored = corners;
  for (ScreenVertex& corner : mirrored) {
    corner.w = -corner.w;
    // The scalar is -u / w, or u.
    if (perspective) corner.u = -corner.u;
  }
  if (!perspective) of.slope = -of.slope;
  return {write_faces(mirrored, grid, of, vertices), true};
}

}  // namespace atomesh::gl
