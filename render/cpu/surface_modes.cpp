#include "render/cpu/surface_modes.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <limits>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "render/cpu/surface_shader.h"
#include "render/cpu/tile_bins.h"
#include "render/cpu/triangle_raster.h"

namespace atomesh {

namespace {

constexpr int tile_side = 32;
constexpr std::size_t tile_pixels = std::size_t{tile_side} * tile_side;

using Clock = std::chrono::steady_clock;

// The surface projected and sorted into tiles, which are counted from the window's corner: no pixel's value depends on
// the tile it is in.
class BinnedSurface {
 public:
  BinnedSurface(const Scene& scene, const Camera& camera, const PixelWindow& window, RenderStats& stats,
                const Progress& progress)
      : scene_(scene), camera_(camera), window_(window) {
    const Clock::time_point start = Clock::now();
    vertices_ = project_vertices(scene.vertices, scene.center, camera);
    const auto box = [&](std::size_t t) {
      const PixelBox whole = pixel_box(vertices_, scene.surface[t], camera.width, camera.height);
      return PixelBox{
          std::max(whole.first_column - window.left, 0), std::min(whole.last_column - window.left, window.width - 1),
          std::max(whole.first_row - window.top, 0), std::min(whole.last_row - window.top, window.height - 1)};
    };
    bins_ = bin_to_tiles(scene.surface.size(), window.width, window.height, tile_side, box, progress);
    stats.setup_ms += ms_since(start);
  }

  const Scene& scene() const { return scene_; }
  const Camera& camera() const { return camera_; }
  const PixelWindow& window() const { return window_; }

  // For every tile, in parallel: draw(grid of the lattice's pixels in it, cross_all), where cross_all(cross) calls
  // cross(place, triangle, crossing) for every crossing, triangles ascending; pixel (i, j) of the grid has place
  // tile_side · j + i. Adds the crossings to stats.steps.
  template <class Draw>
  void for_tiles(const PixelLattice& lattice, RenderStats& stats, Progress& progress, Draw&& draw) const {
    const Clock::time_point start = Clock::now();
    std::atomic<std::uint64_t> steps{0};
    std::atomic<std::size_t> done{0};
    parallel_for(bins_.tiles(), 1, [&](std::size_t t, std::size_t) {
      progress.check();
      PixelBox pixels = bins_.pixels_of(t, window_.width, window_.height);
      pixels = {pixels.first_column + window_.left, pixels.last_column + window_.left, pixels.first_row + window_.top,
                pixels.last_row + window_.top};
      const LatticeGrid grid(lattice, pixels.first_column, pixels.last_column + 1, pixels.first_row,
                             pixels.last_row + 1);
      if (!grid.empty()) {
        std::uint64_t crossings = 0;
        draw(grid, [&](auto&& cross) {
          cross_triangles(scene_.surface, camera_, vertices_, bins_.of(t), pixels, lattice,
                          [&](int column, int row, Index triangle, const TriangleRaster&, const Crossing& crossing) {
                            ++crossings;
                            cross(static_cast<std::size_t>(grid.j_of(row) * tile_side + grid.i_of(column)), triangle,
                                  crossing);
                          });
        });
        steps += crossings;
      }
      const std::size_t finished = ++done;
      // The listener belongs to the thread that called us.
      if (omp_get_thread_num() == 0)
        progress.update(static_cast<double>(finished) / static_cast<double>(bins_.tiles()));
    });
    progress.update(1.0);
    stats.steps += steps;
    stats.render_ms += ms_since(start);
  }

 private:
  const Scene& scene_;
  const Camera& camera_;
  PixelWindow window_;
  ProjectedVertices vertices_;
  TileBins bins_;
};

// Calls visit(column, row, place) for the pixels of a tile's grid.
template <class Visit>
void for_pixels(const LatticeGrid& grid, Visit&& visit) {
  for (int j = 0; j < grid.rows(); ++j) {
    for (int i = 0; i < grid.columns(); ++i) {
      visit(grid.column(i), grid.row(j), static_cast<std::size_t>(j * tile_side + i));
    }
  }
}

class SurfaceFrame final : public Frame {
 public:
  SurfaceFrame(const Scene& scene, const Camera& camera, const Parameters& parameters, const PixelWindow& window,
               RenderStats& stats, const Progress& progress)
      : surface_(scene, camera, window, stats, progress),
        shader_(scene, camera, parameters),
        far_walls_(scene.far_walls) {}

  void draw(const PixelLattice& lattice, Image& image, RenderStats& stats, const Channels& channels,
            Progress& progress) const override {
    struct Hit {
      double depth;
      Index triangle;
      bool entering;
    };
    constexpr Hit none{std::numeric_limits<double>::infinity(), no_index, true};
    const PixelWindow& window = surface_.window();
    const Camera& camera = surface_.camera();
    size_channel(channels.depth, window, std::numeric_limits<float>::infinity());
    size_channel(channels.id, window, no_index);
    surface_.for_tiles(lattice, stats, progress, [&](const LatticeGrid& grid, auto&& cross_all) {
      std::array<Hit, tile_pixels> nearest;
      std::fill_n(nearest.begin(), grid.rows() * tile_side, none);
      cross_all([&](std::size_t at, Index triangle, const Crossing& crossing) {
        Hit& hit = nearest[at];
        const bool seen = far_walls_ ? !crossing.entering && (hit.triangle == no_index || crossing.depth > hit.depth)
                                     : crossing.depth < hit.depth;
        if (seen) hit = {crossing.depth, triangle, crossing.entering};
      });
      for_pixels(grid, [&](int column, int row, std::size_t at) {
        const Hit& hit = nearest[at];
        const std::size_t pixel = window.place(column, row);
        image.pixels[pixel] =
            hit.triangle == no_index
                ? Vec4f(0.0F)
                : Vec4f(shader_.shade(hit.triangle, camera.x_of(column), camera.y_of(row), hit.depth, !hit.entering),
                        1.0F);
        if (channels.depth != nullptr) (*channels.depth)[pixel] = static_cast<float>(hit.depth);
        if (channels.id != nullptr) (*channels.id)[pixel] = hit.triangle;
      });
    });
  }

 private:
  BinnedSurface surface_;
  SurfaceShader shader_;
  bool far_walls_;
};

class XrayFrame final : public Frame {
 public:
  XrayFrame(const Scene& scene, const Camera& camera, const Parameters& parameters, const PixelWindow& window,
            RenderStats& stats, const Progress& progress)
      : surface_(scene, camera, window, stats, progress), xray_(parameters.xray) {}

  void draw(const PixelLattice& lattice, Image& image, RenderStats& stats, const Channels& channels,
            Progress& progress) const override {
    const PixelWindow& window = surface_.window();
    const Camera& camera = surface_.camera();
    size_channel(channels.thickness, window, 0.0F);
    surface_.for_tiles(lattice, stats, progress, [&](const LatticeGrid& grid, auto&& cross_all) {
      std::array<double, tile_pixels> inside;  // depth at exits minus depth at entries
      std::fill_n(inside.begin(), grid.rows() * tile_side, 0.0);
      cross_all([&](std::size_t at, Index, const Crossing& crossing) {
        inside[at] += crossing.entering ? -crossing.depth : crossing.depth;
      });
      for_pixels(grid, [&](int column, int row, std::size_t at) {
        const double length_per_depth = glm::length(ray(camera, camera.x_of(column), camera.y_of(row)).direction);
        const double thickness = std::max(0.0, inside[at]) * length_per_depth;
        const auto opacity = static_cast<float>(std::min(1.0, xray_.alpha_length * thickness));
        const std::size_t pixel = window.place(column, row);
        image.pixels[pixel] = Vec4f(xray_.color * opacity, opacity);
        if (channels.thickness != nullptr) (*channels.thickness)[pixel] = static_cast<float>(thickness);
      });
    });
  }

 private:
  BinnedSurface surface_;
  const XrayParameters& xray_;
};

}  // namespace

std::unique_ptr<Frame> prepare_surface(const Scene& scene, const Camera& camera, const Parameters& parameters,
                                       const PixelWindow& window, RenderStats& stats, const Progress& progress) {
  return std::make_unique<SurfaceFrame>(scene, camera, parameters, window, stats, progress);
}

std::unique_ptr<Frame> prepare_xray(const Scene& scene, const Camera& camera, const Parameters& parameters,
                                    const PixelWindow& window, RenderStats& stats, const Progress& progress) {
  return std::make_unique<XrayFrame>(scene, camera, parameters, window, stats, progress);
}

}  // namespace atomesh
