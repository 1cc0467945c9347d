#include "render/cpu/cell_bins.h"

#include <array>
#include <numeric>

namespace atomesh::cell_projection {

void CellBins::fill(const TileGrid& grid, std::span<const Range> ranges, Part& part) {
  const auto for_tiles = [&](auto&& visit) {
    for (const Range& range : ranges) {
      for (int row = range.first_row; row <= range.last_row; ++row) {
        const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns);
        for (int column = range.first_column; column <= range.last_column; ++column) {
          visit(first + static_cast<std::size_t>(column), range.cell);
        }
      }
    }
  };
  // Places are counted one tile further on: filling moves each to the next tile's beginning.
  part.begin.assign(grid.tiles() + 2, 0);
  for_tiles([&](std::size_t tile, Index) { ++part.begin[tile + 2]; });
  std::partial_sum(part.begin.begin(), part.begin.end(), part.begin.begin());
  part.items = std::make_unique_for_overwrite<Index[]>(part.begin.back());
  for_tiles([&](std::size_t tile, Index cell) { part.items[part.begin[tile + 1]++] = cell; });
  part.begin.pop_back();
}

void CellBins::gather(std::size_t tile, std::vector<Index>& cells) const {
  cells.clear();
  for (const Part& part : parts_) {
    cells.insert(cells.end(), part.items.get() + part.begin[tile], part.items.get() + part.begin[tile + 1]);
  }
}

PixelBox clipped_box(const ProjectedVertices& vertices, const Tetrahedron& corners, const Camera& camera) {
  std::array<Vec3, 4> p;
  double depth = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const ProjectedVertex& vertex = vertices[corners[k]];
    p[k] = {vertex.x, vertex.y, vertex.z};
    depth = std::max(depth, std::abs(p[k].z));
  }
  // Nearer than where rays begin by far.
  const double near = 1e-12 * depth;
  double low[2] = {HUGE_VAL, HUGE_VAL};
  double high[2] = {-HUGE_VAL, -HUGE_VAL};
  const auto include = [&](double x, double y, double z) {
    const double at[2] = {x / z, y / z};
    for (int axis = 0; axis < 2; ++axis) {
      low[axis] = std::min(low[axis], at[axis]);
      high[axis] = std::max(high[axis], at[axis]);
    }
  };
  for (std::size_t i = 0; i < 4; ++i) {
    if (p[i].z >= near) include(p[i].x, p[i].y, p[i].z);
    for (std::size_t j = 0; j < 4; ++j) {
      if (p[i].z < near || p[j].z >= near) continue;
      const double t = (p[i].z - near) / (p[i].z - p[j].z);
      include(p[i].x + t * (p[j].x - p[i].x), p[i].y + t * (p[j].y - p[i].y), near);
    }
  }
  const auto pixel = [](double middle, double offset, int size, bool first) {
    const double at = std::clamp(middle + offset, -1.0, static_cast<double>(size));
    return static_cast<int>(first ? std::ceil(at - pixel_margin) : std::floor(at + pixel_margin));
  };
  const double middle_column = 0.5 * camera.width - 0.5;
  const double middle_row = 0.5 * camera.height - 0.5;
  PixelBox box;
  box.first_column = std::max(0, pixel(middle_column, low[0] / camera.pixel, camera.width, true));
  box.last_column = std::min(camera.width - 1, pixel(middle_column, high[0] / camera.pixel, camera.width, false));
  box.first_row = std::max(0, pixel(middle_row, -high[1] / camera.pixel, camera.height, true));
  box.last_row = std::min(camera.height - 1, pixel(middle_row, -low[1] / camera.pixel, camera.height, false));
  return box;
}

}  // namespace atomesh::cell_projection
