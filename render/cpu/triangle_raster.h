// Which rays cross a triangle, and where: watertight, so that a ray through a closed surface enters as often as it
// leaves, whatever it meets on the way (vertices, edges, triangles seen edge-on or reaching behind the eye).
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "core/camera.h"
#include "core/geometry.h"
#include "render/cpu/tile_bins.h"
#include "render/pixel_lattice.h"

namespace atomesh {

// Rays pass this much of a pixel right of the pixel's centre, and ray_lift of that above it: far beyond the rounding of
// double and far below what can be seen. Of a picture aligned with a crystal no ray then meets an edge or a vertex
// exactly, where rounding would decide triangle by triangle.
inline constexpr double surface_ray_shift = 0x1p-28;
inline constexpr double surface_ray_lift = 0x1p-6;

// A crossing of the ray's half in front of the eye.
struct Crossing {
  double depth;
  bool entering;  // through the triangle's outer side
};

// With h the vertices' homogeneous image-plane coordinates, (x, y, 1) · (h_i × h_j) tells on which side of the edge ij
// the ray through (x, y) passes. Seen from the triangle beyond the edge all of it is negated, to the last bit (products
// commute, differences turn round, and the build allows no fused ones): both triangles at an edge see the same number.
// A zero is resolved as if the ray stood an infinitely small ε further right and ε² further up.
class TriangleRaster {
 public:
  TriangleRaster(const ProjectedVertices& vertices, const Triangle& corners, bool perspective);

  // What is constant along a row of rays.
  struct Row {
    std::array<double, 3> constant;
  };
  Row row(double y) const {
    Row row;
    for (std::size_t k = 0; k < 3; ++k) row.constant[k] = edges_[k].y * y + edges_[k].constant;
    return row;
  }

  bool crosses(const Row& row, double x, Crossing& crossing) const {
    std::array<double, 3> side;
    int left = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      side[k] = edges_[k].x * x + row.constant[k];
      // No branches: which way it goes is not to be foreseen.
      left += static_cast<int>(side[k] > 0.0) | (static_cast<int>(side[k] == 0.0) & edges_[k].tie_left);
    }
    if (left != 0 && left != 3) return false;
    // The crossing's barycentric weights are the sides' shares, so its depth lies between the corners'.
    const double sum = side[0] + side[1] + side[2];
    if (sum == 0.0) return false;
    crossing.depth = (side[0] * depths_[0] + side[1] * depths_[1] + side[2] * depths_[2]) / sum;
    crossing.entering = left == 3;
    return crossing.depth > 0.0;
  }
  // Depth at which the ray meets the triangle's plane, inside the triangle or beside it, kept between the corners'
  // depths; NaN where it runs in the plane.
  double plane_depth(double x, double y) const {
    double sum = 0.0;
    double depth = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double side = edges_[k].x * x + edges_[k].y * y + edges_[k].constant;
      sum += side;
      depth += side * depths_[k];
    }
    const auto [nearest, farthest] = std::minmax({depths_[0], depths_[1], depths_[2]});
    return std::clamp(depth / sum, nearest, farthest);
  }

 private:
  struct Edge {
    double x, y, constant;
    int tie_left;  // 1 where a zero counts as positive
  };
  std::array<Edge, 3> edges_;  // opposite corner 0, 1, 2
  std::array<double, 3> depths_;
};

// Sides of `pixels` below are at most this.
inline constexpr int raster_side = 32;

// Calls cross(column, row, triangle, its raster, crossing) for every crossing of a ray of the lattice's pixels within
// `pixels` with one of the triangles (indices into the surface), triangle by triangle.
template <class Cross>
void cross_triangles(std::span<const Triangle> surface, const Camera& camera, const ProjectedVertices& vertices,
                     std::span<const Index> triangles, const PixelBox& pixels, const PixelLattice& lattice,
                     Cross&& cross) {
  const bool perspective = camera.projection == Projection::perspective;
  std::array<double, raster_side> x;  // of the rays in each column
  std::array<double, raster_side> y;
  for (int i = 0; i < raster_side; ++i) {
    x[static_cast<std::size_t>(i)] = camera.x_of(pixels.first_column + i + surface_ray_shift);
    y[static_cast<std::size_t>(i)] = camera.y_of(pixels.first_row + i - surface_ray_shift * surface_ray_lift);
  }
  for (const Index triangle : triangles) {
    const Triangle& corners = surface[triangle];
    const PixelBox box = pixel_box(vertices, corners, camera.width, camera.height);
    const int first_column = lattice.column_from(std::max(pixels.first_column, box.first_column));
    const int first_row = lattice.row_from(std::max(pixels.first_row, box.first_row));
    const int last_column = std::min(pixels.last_column, box.last_column);
    const int last_row = std::min(pixels.last_row, box.last_row);
    if (first_column > last_column || first_row > last_row) continue;
    const TriangleRaster raster(vertices, corners, perspective);
    for (int row = first_row; row <= last_row; row += lattice.row_stride) {
      const TriangleRaster::Row sides = raster.row(y[static_cast<std::size_t>(row - pixels.first_row)]);
      for (int column = first_column; column <= last_column; column += lattice.column_stride) {
        Crossing crossing{};
        if (raster.crosses(sides, x[static_cast<std::size_t>(column - pixels.first_column)], crossing))
          cross(column, row, triangle, raster, crossing);
      }
    }
  }
}

}  // namespace atomesh
