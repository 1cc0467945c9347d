#include "render/cpu/tile_bins.h"

#include <limits>

#include "core/parallel.h"

namespace atomesh {

namespace {

// Tiles under a primitive, ends included; empty when first_column > last_column.
struct TileRange {
  std::uint16_t first_column;
  std::uint16_t last_column;
  std::uint16_t first_row;
  std::uint16_t last_row;
};

TileRange tile_range(const PixelBox& box, int side) {
  if (box.empty()) return {1, 0, 0, 0};
  const auto tile = [side](int pixel) { return static_cast<std::uint16_t>(pixel / side); };
  return {tile(box.first_column), tile(box.last_column), tile(box.first_row), tile(box.last_row)};
}

}  // namespace

TileBins bin_to_tiles(std::size_t count, int width, int height, int side,
                      const std::function<PixelBox(std::size_t)>& box, const Progress& progress) {
  TileBins bins;
  bins.side = side;
  bins.columns = (width + side - 1) / side;
  bins.rows = (height + side - 1) / side;
  const std::size_t tiles = bins.tiles();
  // A fixed number of consecutive chunks, each with its own place in every tile's list: the lists come out ascending
  // whatever the number of threads.
  const std::size_t chunks = std::clamp<std::size_t>(count / 4096, 1, 64);
  // Finding a box costs more than keeping where it lies from the counting to the filling.
  const auto ranges = std::make_unique_for_overwrite<TileRange[]>(count);
  const auto chunk_begin = [&](std::size_t chunk) { return count * chunk / chunks; };
  const auto for_chunk = [&](std::size_t chunk, auto&& visit) {
    for (std::size_t i = chunk_begin(chunk); i < chunk_begin(chunk + 1); ++i) {
      const TileRange range = ranges[i];
      if (range.first_column > range.last_column) continue;
      for (int row = range.first_row; row <= range.last_row; ++row) {
        for (int column = range.first_column; column <= range.last_column; ++column) {
          visit(static_cast<std::size_t>(row * bins.columns + column), i);
        }
      }
    }
  };
  std::vector<std::uint32_t> counts(chunks * tiles, 0);
  parallel_for(chunks, 1, [&](std::size_t chunk, std::size_t) {
    progress.check();
    for (std::size_t i = chunk_begin(chunk); i < chunk_begin(chunk + 1); ++i) ranges[i] = tile_range(box(i), side);
    std::uint32_t* own = &counts[chunk * tiles];
    for_chunk(chunk, [own](std::size_t tile, std::size_t) { ++own[tile]; });
  });
  bins.begin.resize(tiles + 1);
  std::size_t total = 0;
  std::vector<std::size_t> place(chunks * tiles);
  for (std::size_t tile = 0; tile < tiles; ++tile) {
    bins.begin[tile] = total;
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
      place[chunk * tiles + tile] = total;
      total += counts[chunk * tiles + tile];
    }
  }
  bins.begin[tiles] = total;
  bins.items = std::make_unique_for_overwrite<Index[]>(total);
  parallel_for(chunks, 1, [&](std::size_t chunk, std::size_t) {
    progress.check();
    std::size_t* own = &place[chunk * tiles];
    for_chunk(chunk, [&](std::size_t tile, std::size_t i) { bins.items[own[tile]++] = static_cast<Index>(i); });
  });
  return bins;
}

ProjectedVertices project_vertices(std::span<const Vec3f> vertices, const Vec3& center, const Camera& camera) {
  ProjectedVertices projected(vertices.size());
  const bool perspective = camera.projection == Projection::perspective;
  const Vec3 offset = center - camera.eye;
  const double middle_column = 0.5 * camera.width - 0.5;
  const double middle_row = 0.5 * camera.height - 0.5;
  parallel_for(vertices.size(), 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Vec3 p = Vec3(vertices[v]) + offset;
      const double x = glm::dot(p, camera.right);
      const double y = glm::dot(p, camera.up);
      const double z = glm::dot(p, camera.forward);
      if (perspective && z <= 0.0) {
        projected[v] = {x, y, z, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::quiet_NaN()};
        continue;
      }
      const double scale = 1.0 / (perspective ? z * camera.pixel : camera.pixel);
      // A limit, so that what lies far outside converts to an int.
      projected[v] = {x, y, z, static_cast<float>(std::clamp(middle_column + x * scale, -1e8, 1e8)),
                      static_cast<float>(std::clamp(middle_row - y * scale, -1e8, 1e8))};
    }
  });
  return projected;
}

}  // namespace atomesh
