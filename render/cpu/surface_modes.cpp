#include "render/cpu/surface_modes.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <limits>

#include "core/parallel.h"
#include "render/cpu/surface_shader.h"
#include "render/cpu/tile_bins.h"
#include "render/cpu/triangle_raster.h"

namespace atomesh {

namespace {

constexpr int tile_side = 32;
constexpr std::size_t tile_pixels = std::size_t{tile_side} * tile_side;

double ms_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

std::size_t in_tile(const PixelBox& tile, int column, int row) {
  return static_cast<std::size_t>((row - tile.first_row) * tile_side + (column - tile.first_column));
}

// Calls cross(pixel of the tile, triangle, crossing) for every crossing in the tile, triangles ascending.
template <class Cross>
void raster_tile(const Scene& scene, const Camera& camera, const ProjectedVertices& vertices,
                 std::span<const Index> triangles, const PixelBox& tile, Cross&& cross) {
  cross_triangles(scene.surface, camera, vertices, triangles, tile,
                  [&](int column, int row, Index triangle, const TriangleRaster&, const Crossing& crossing) {
                    cross(in_tile(tile, column, row), triangle, crossing);
                  });
}

// Bins the surface and calls draw(tile, its triangles) for every tile, in parallel. draw() returns its crossings.
template <class Draw>
void for_tiles(const Scene& scene, const Camera& camera, RenderStats& stats, Progress& progress, Draw&& draw) {
  const auto start = std::chrono::steady_clock::now();
  const ProjectedVertices vertices = project_vertices(scene.vertices, scene.center, camera);
  const auto box = [&](std::size_t t) { return pixel_box(vertices, scene.surface[t], camera.width, camera.height); };
  const TileBins bins = bin_to_tiles(scene.surface.size(), camera.width, camera.height, tile_side, box, progress);
  stats.setup_ms += ms_since(start);
  const auto drawn = std::chrono::steady_clock::now();
  std::atomic<std::uint64_t> steps{0};
  std::atomic<std::size_t> done{0};
  parallel_for(bins.tiles(), 1, [&](std::size_t t, std::size_t) {
    progress.check();
    const PixelBox tile = bins.pixels_of(t, camera.width, camera.height);
    if (!bins.of(t).empty()) steps += draw(vertices, tile, bins.of(t));
    const std::size_t finished = ++done;
    // The listener belongs to the thread that called us.
    if (omp_get_thread_num() == 0) progress.update(static_cast<double>(finished) / static_cast<double>(bins.tiles()));
  });
  progress.update(1.0);
  stats.steps += steps;
  stats.render_ms += ms_since(drawn);
}

std::size_t pixel_index(const Camera& camera, int column, int row) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(column);
}

template <class Visit>
void for_pixels(const PixelBox& tile, Visit&& visit) {
  for (int row = tile.first_row; row <= tile.last_row; ++row) {
    for (int column = tile.first_column; column <= tile.last_column; ++column) {
      visit(column, row, in_tile(tile, column, row));
    }
  }
}

}  // namespace

Image draw_surface(const Scene& scene, const Camera& camera, const Parameters& parameters, RenderStats& stats,
                   const Channels& channels, Progress& progress) {
  Image image(camera.width, camera.height);
  if (channels.depth != nullptr) channels.depth->assign(image.pixels.size(), std::numeric_limits<float>::infinity());
  if (channels.id != nullptr) channels.id->assign(image.pixels.size(), no_index);
  const SurfaceShader shader(scene, camera, parameters);
  for_tiles(scene, camera, stats, progress,
            [&](const ProjectedVertices& vertices, const PixelBox& tile, std::span<const Index> triangles) {
              struct Hit {
                double depth = std::numeric_limits<double>::infinity();
                Index triangle = no_index;
                bool entering = true;
              };
              std::array<Hit, tile_pixels> nearest{};
              std::uint64_t crossings = 0;
              raster_tile(scene, camera, vertices, triangles, tile,
                          [&](std::size_t at, Index triangle, const Crossing& crossing) {
                            ++crossings;
                            if (crossing.depth < nearest[at].depth) {
                              nearest[at] = {crossing.depth, triangle, crossing.entering};
                            }
                          });
              for_pixels(tile, [&](int column, int row, std::size_t at) {
                const Hit& hit = nearest[at];
                if (hit.triangle == no_index) return;
                const Vec3f color =
                    shader.shade(hit.triangle, camera.x_of(column), camera.y_of(row), hit.depth, !hit.entering);
                image.at(column, row) = Vec4f(color, 1.0F);
                const std::size_t pixel = pixel_index(camera, column, row);
                if (channels.depth != nullptr) (*channels.depth)[pixel] = static_cast<float>(hit.depth);
                if (channels.id != nullptr) (*channels.id)[pixel] = hit.triangle;
              });
              return crossings;
            });
  return image;
}

Image draw_xray(const Scene& scene, const Camera& camera, const Parameters& parameters, RenderStats& stats,
                const Channels& channels, Progress& progress) {
  Image image(camera.width, camera.height);
  if (channels.thickness != nullptr) channels.thickness->assign(image.pixels.size(), 0.0F);
  const double alpha_length = parameters.xray.alpha_length;
  for_tiles(
      scene, camera, stats, progress,
      [&](const ProjectedVertices& vertices, const PixelBox& tile, std::span<const Index> triangles) {
        std::array<double, tile_pixels> inside{};  // depth at exits minus depth at entries
        std::uint64_t crossings = 0;
        raster_tile(scene, camera, vertices, triangles, tile, [&](std::size_t at, Index, const Crossing& crossing) {
          ++crossings;
          inside[at] += crossing.entering ? -crossing.depth : crossing.depth;
        });
        for_pixels(tile, [&](int column, int row, std::size_t at) {
          const double length_per_depth = glm::length(ray(camera, camera.x_of(column), camera.y_of(row)).direction);
          const double thickness = std::max(0.0, inside[at]) * length_per_depth;
          const auto opacity = static_cast<float>(std::min(1.0, alpha_length * thickness));
          image.at(column, row) = Vec4f(parameters.xray.color * opacity, opacity);
          if (channels.thickness != nullptr) {
            (*channels.thickness)[pixel_index(camera, column, row)] = static_cast<float>(thickness);
          }
        });
        return crossings;
      });
  return image;
}

}  // namespace atomesh
