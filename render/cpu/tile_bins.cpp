#include "render/cpu/tile_bins.h"

#include "core/parallel.h"

namespace atomesh {

namespace {

struct TileRange {
  int first_column;
  int last_column;
  int first_row;
  int last_row;
};

TileRange tile_range(const PixelBox& box, int side) {
  return {box.first_column / side, box.last_column / side, box.first_row / side, box.last_row / side};
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
  const auto for_chunk = [&](std::size_t chunk, auto&& visit) {
    progress.check();
    const std::size_t end = count * (chunk + 1) / chunks;
    for (std::size_t i = count * chunk / chunks; i < end; ++i) {
      const PixelBox pixels = box(i);
      if (pixels.empty()) continue;
      const TileRange range = tile_range(pixels, side);
      for (int row = range.first_row; row <= range.last_row; ++row) {
        for (int column = range.first_column; column <= range.last_column; ++column) {
          visit(static_cast<std::size_t>(row * bins.columns + column), i);
        }
      }
    }
  };
  std::vector<std::uint32_t> counts(chunks * tiles, 0);
  parallel_for(chunks, 1, [&](std::size_t chunk, std::size_t) {
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
  bins.items.resize(total);
  parallel_for(chunks, 1, [&](std::size_t chunk, std::size_t) {
    std::size_t* own = &place[chunk * tiles];
    for_chunk(chunk, [&](std::size_t tile, std::size_t i) { bins.items[own[tile]++] = static_cast<Index>(i); });
  });
  return bins;
}

ProjectedVertices project_vertices(std::span<const Vec3f> vertices, const Vec3& center, const Camera& camera) {
  ProjectedVertices projected;
  projected.camera.resize(3 * vertices.size());
  projected.pixel.resize(2 * vertices.size());
  const bool perspective = camera.projection == Projection::perspective;
  projected.behind.assign(vertices.size(), 0);
  const Vec3 offset = center - camera.eye;
  const double middle_column = 0.5 * camera.width - 0.5;
  const double middle_row = 0.5 * camera.height - 0.5;
  parallel_for(vertices.size(), 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Vec3 p = Vec3(vertices[v]) + offset;
      const double x = glm::dot(p, camera.right);
      const double y = glm::dot(p, camera.up);
      const double z = glm::dot(p, camera.forward);
      projected.camera[3 * v] = x;
      projected.camera[3 * v + 1] = y;
      projected.camera[3 * v + 2] = z;
      if (perspective && z <= 0.0) {
        projected.behind[v] = 1;
        continue;
      }
      const double scale = 1.0 / (perspective ? z * camera.pixel : camera.pixel);
      // A limit, so that what lies far outside converts to an int.
      projected.pixel[2 * v] = static_cast<float>(std::clamp(middle_column + x * scale, -1e8, 1e8));
      projected.pixel[2 * v + 1] = static_cast<float>(std::clamp(middle_row - y * scale, -1e8, 1e8));
    }
  });
  return projected;
}

}  // namespace atomesh
