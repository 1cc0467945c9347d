// Which primitives lie under which tile of the picture.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "core/camera.h"
#include "core/geometry.h"
#include "core/progress.h"
#include "render/cpu/projected_vertex.h"

namespace atomesh {

// Pixels a primitive may touch, ends included; empty when first > last.
struct PixelBox {
  int first_column = 0;
  int last_column = -1;
  int first_row = 0;
  int last_row = -1;
  bool empty() const { return first_column > last_column || first_row > last_row; }
};

// Primitives of tile (column, row) of tiles of `side` pixels: items[begin[t]] … items[begin[t + 1] - 1] with
// t = row · columns + column, ascending.
struct TileBins {
  int side = 0;
  int columns = 0;
  int rows = 0;
  std::vector<std::size_t> begin;
  std::unique_ptr<Index[]> items;
  std::size_t tiles() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  std::span<const Index> of(std::size_t tile) const {
    return {items.get() + begin[tile], items.get() + begin[tile + 1]};
  }
  // The tile's pixels, cut off at the picture's right and lower edge.
  PixelBox pixels_of(std::size_t tile, int width, int height) const {
    const int column = static_cast<int>(tile % static_cast<std::size_t>(columns)) * side;
    const int row = static_cast<int>(tile / static_cast<std::size_t>(columns)) * side;
    return {column, std::min(column + side, width) - 1, row, std::min(row + side, height) - 1};
  }
};

// `box(i)` is the box of primitive i, clipped to the picture; it is asked once for each, in parallel. Holds 8 bytes
// a primitive meanwhile. Throws CancelledError.
TileBins bin_to_tiles(std::size_t count, int width, int height, int side,
                      const std::function<PixelBox(std::size_t)>& box, const Progress& progress);

using ProjectedVertices = std::vector<ProjectedVertex>;

ProjectedVertices project_vertices(std::span<const Vec3f> vertices, const Vec3& center, const Camera& camera);

// The pixels whose centres a primitive with these corners may cover, clipped to the picture: all of them when some of
// its corners are behind the eye, none when all are.
template <std::size_t N>
PixelBox pixel_box(const ProjectedVertices& vertices, const std::array<Index, N>& corners, int width, int height) {
  float low[2] = {3e38F, 3e38F};
  float high[2] = {-3e38F, -3e38F};
  std::size_t behind = 0;
  for (const Index corner : corners) {
    const ProjectedVertex& vertex = vertices[corner];
    behind += vertex.behind() ? 1U : 0U;
    const float at[2] = {vertex.column, vertex.row};
    for (int axis = 0; axis < 2; ++axis) {
      low[axis] = at[axis] < low[axis] ? at[axis] : low[axis];
      high[axis] = at[axis] > high[axis] ? at[axis] : high[axis];
    }
  }
  if (behind == N) return {};
  if (behind > 0) return {0, width - 1, 0, height - 1};
  // Clamped while they are floats: no rounding down of negative numbers is needed.
  const auto first = [](float x) {
    const float from = std::max(0.0F, x - pixel_margin);
    const int whole = static_cast<int>(from);
    return whole + (static_cast<float>(whole) < from ? 1 : 0);
  };
  const auto last = [](float x, int size) {
    const float to = x + pixel_margin;
    return to < 0.0F ? -1 : static_cast<int>(std::min(to, static_cast<float>(size - 1)));
  };
  return {first(low[0]), last(high[0], width), first(low[1]), last(high[1], height)};
}

// The same of a cell, in fewer instructions. False where one of its corners is behind the eye.
inline bool pixel_box_before_eye(const ProjectedVertices& vertices, const Tetrahedron& corners, int width, int height,
                                 PixelBox& box) {
#if defined(__SSE2__)
  const auto places = [&](std::size_t k) {
    // Column and row, twice.
    return _mm_castpd_ps(_mm_load_sd(reinterpret_cast<const double*>(&vertices[corners[k]].column)));
  };
  const __m128 a = _mm_movelh_ps(places(0), places(1));
  const __m128 b = _mm_movelh_ps(places(2), places(3));
  if (_mm_movemask_ps(_mm_cmpunord_ps(a, b)) != 0) return false;
  const __m128 low = _mm_min_ps(a, b);
  const __m128 high = _mm_max_ps(a, b);
  // -low and high of column and row: rounding down is then right for both.
  const __m128 ends = _mm_movelh_ps(_mm_xor_ps(_mm_min_ps(low, _mm_movehl_ps(low, low)), _mm_set1_ps(-0.0F)),
                                    _mm_max_ps(high, _mm_movehl_ps(high, high)));
  const __m128 limit = _mm_setr_ps(0.0F, 0.0F, static_cast<float>(width - 1), static_cast<float>(height - 1));
  const __m128 within = _mm_min_ps(_mm_add_ps(ends, _mm_set1_ps(pixel_margin)), limit);
  const __m128i whole = _mm_cvttps_epi32(within);
  const __m128i down = _mm_add_epi32(whole, _mm_castps_si128(_mm_cmpgt_ps(_mm_cvtepi32_ps(whole), within)));
  alignas(16) int found[4];
  _mm_store_si128(reinterpret_cast<__m128i*>(found), down);
  box = {-found[0], found[2], -found[1], found[3]};
  return true;
#else
  for (const Index corner : corners) {
    if (vertices[corner].behind()) return false;
  }
  box = pixel_box(vertices, corners, width, height);
  return true;
#endif
}

}  // namespace atomesh
