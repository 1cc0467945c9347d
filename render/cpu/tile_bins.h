// Which primitives lie under which tile of the picture.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/geometry.h"

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
  std::vector<Index> items;
  std::size_t tiles() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  std::span<const Index> of(std::size_t tile) const {
    return {items.data() + begin[tile], items.data() + begin[tile + 1]};
  }
};

// `box(i)` is the box of primitive i, clipped to the picture; it is asked twice, in parallel.
TileBins bin_to_tiles(std::size_t count, int width, int height, int side,
                      const std::function<PixelBox(std::size_t)>& box);

// Vertices as the renderers project them.
struct ProjectedVertices {
  std::vector<double> camera;  // three per vertex: along right, up and forward about the eye, Å
  std::vector<float> pixel;    // two per vertex: column and row in pixels; not set where `behind`
  // Perspective only: vertices that have no place in the image plane, being in the eye's plane or behind it.
  std::vector<std::uint8_t> behind;
};

struct Camera;
ProjectedVertices project_vertices(std::span<const glm::vec3> vertices, const Vec3& center, const Camera& camera);

// The pixels whose centres a primitive with these corners may cover, clipped to the picture: all of them when some of
// its corners are behind the eye, none when all are.
PixelBox pixel_box(const ProjectedVertices& vertices, std::span<const Index> corners, int width, int height);

}  // namespace atomesh
