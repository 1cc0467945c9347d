#include "render/cpu/cell_projection.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>

#include "core/parallel.h"
#include "render/cpu/cell_projection_kernel.h"
#include "render/cpu/cell_projection_tile.h"
#include "render/cpu/map_intervals.h"
#include "render/cpu/surface_layers.h"
#include "render/cpu/tile_bins.h"

namespace atomesh {

namespace {

using namespace cell_projection;

double ms_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

View make_view(const Scene& scene, const Camera& camera) {
  View view{};
  view.perspective = camera.projection == Projection::perspective;
  view.pixel = camera.pixel;
  view.left = camera.x_of(ray_shift);
  view.top = camera.y_of(-ray_shift * ray_lift);
  const double radius = std::max(0.5 * scene.bounds.diagonal(), 1e-3);
  const double depth = glm::dot(scene.bounds.center() - camera.eye, camera.forward);
  if (view.perspective) {
    view.reference = std::max(depth, 0.25 * radius);
    view.nearest = -1e6F;  // z_ref / 1e6 before the eye
    view.farthest = 1.0F - 1e-6F;
  } else {
    view.reference = depth;
    view.nearest = static_cast<float>(-depth);
    view.farthest = 1e29F;
  }
  // Cells of a lattice that share a circumsphere have equal powers but for rounding; a little of the centroid's
  // distance brings them into an order that is seldom wrong.
  view.order_blend = scene.delaunay ? 0.02 : 1.0;
  return view;
}

class Drawing {
 public:
  Drawing(const Scene& scene, const Camera& camera, const Parameters& parameters)
      : scene_(scene), camera_(camera), parameters_(parameters), view_(make_view(scene, camera)), kernel_(kernel()) {
    const bool layered = scene.mode == Mode::volume_surface;
    alpha_length_ = layered ? parameters.volume_surface.alpha_length : parameters.volume.alpha_length;
    optics_.alpha_length = static_cast<float>(alpha_length_);
    optics_.samples = parameters.integrator == Integrator::sampled ? parameters.samples_per_cell : 0;
    if (!layered) {
      intervals_ = MapIntervals(parameters.volume.color_map);
      optics_.map = intervals_.data();
      optics_.map_grid = intervals_.grid();
      optics_.map_intervals = static_cast<int>(intervals_.size());
    } else if (parameters.volume_surface.face_alpha > 0.0 && !scene.surface.empty()) {
      optics_.layer_alpha = static_cast<float>(parameters.volume_surface.face_alpha);
    }
  }

  void set_up(const Progress& progress) {
    vertices_ = project_vertices(scene_.vertices, scene_.center, camera_);
    const auto box = [this](std::size_t cell) { return visible(cell) ? box_of(static_cast<Index>(cell)) : PixelBox{}; };
    bins_ = bin_to_tiles(scene_.tetrahedra.size(), camera_.width, camera_.height, tile_side, box, progress);
    if (optics_.layer_alpha > 0.0F) {
      layers_ = std::make_unique<SurfaceLayers>(scene_, camera_, parameters_, view_, vertices_, progress);
      optics_.layer = layers_->shader();
    }
  }

  Image draw(std::uint64_t& steps, Progress& progress) const {
    Image image(camera_.width, camera_.height);
    TilePool pool;
    std::atomic<std::uint64_t> all_steps{0};
    std::atomic<std::size_t> done{0};
    parallel_for(bins_.tiles(), 1, [&](std::size_t tile, std::size_t) {
      progress.check();
      if (!bins_.of(tile).empty() || (layers_ && layers_->any_in(tile))) {
        std::unique_ptr<Tile> cells = pool.take();
        all_steps += draw_tile(tile, *cells, image, progress);
        pool.give_back(std::move(cells));
      }
      const std::size_t finished = ++done;
      // The listener belongs to the thread that called us.
      if (omp_get_thread_num() == 0)
        progress.update(static_cast<double>(finished) / static_cast<double>(bins_.tiles()));
    });
    progress.update(1.0);
    steps += all_steps;
    return image;
  }

 private:
  bool visible(std::size_t cell) const {
    if (!(alpha_length_ > 0.0)) return false;
    const Tetrahedron& corners = scene_.tetrahedra[cell];
    if (scene_.mode == Mode::volume_surface) {
      return std::any_of(corners.begin(), corners.end(), [this](Index v) { return scene_.colors[v].a > 0.0F; });
    }
    const auto scalar = [&](std::size_t k) { return scene_.scalars[corners[k]]; };
    return !intervals_.transparent(std::min({scalar(0), scalar(1), scalar(2), scalar(3)}),
                                   std::max({scalar(0), scalar(1), scalar(2), scalar(3)}));
  }

  PixelBox box_of(Index cell) const {
    return pixel_box(vertices_, scene_.tetrahedra[cell], camera_.width, camera_.height);
  }

  std::uint64_t draw_tile(std::size_t number, Tile& tile, Image& image, const Progress& progress) const {
    const auto [first_column, last_column, first_row, last_row] =
        bins_.pixels_of(number, camera_.width, camera_.height);
    set_up_tile(bins_.of(number), first_column, first_row, tile);
    tile.list_blocks();
    tile.layers.clear();
    if (layers_) layers_->find(number, tile.layers);
    const BlockScratch scratch = tile.scratch();
    std::uint64_t steps = 0;
    for (int b = 0; b < blocks_per_tile; ++b) {
      const std::span<const std::uint32_t> cells = tile.cells_of(b);
      const bool layered = tile.layers.any_in(b);
      if (cells.empty() && !layered) continue;
      progress.check();
      BlockInput block{};
      block.planes = tile.planes.data();
      block.colors = tile.colors.data();
      block.ranges = tile.ranges.data();
      block.scalars = tile.scalars.data();
      block.cells = cells.data();
      block.count = cells.size();
      block.layers = layered ? tile.layers.hits() : nullptr;
      block.layer_begin = layered ? tile.layers.begin_of(b) : nullptr;
      block.column = b % blocks_per_side * block_side;
      block.row = b / blocks_per_side * block_side;
      block.tile_column = first_column;
      block.tile_row = first_row;
      float rgba[4 * block_pixels];
      steps += kernel_.draw_block(view_, optics_, block, scratch, rgba);
      for (int i = 0; i < block_pixels; ++i) {
        const int column = first_column + block.column + i % block_side;
        const int row = first_row + block.row + i / block_side;
        if (column > last_column || row > last_row) continue;
        image.at(column, row) = {rgba[4 * i], rgba[4 * i + 1], rgba[4 * i + 2], rgba[4 * i + 3]};
      }
    }
    return steps;
  }

  void set_up_tile(std::span<const Index> cells, int first_column, int first_row, Tile& tile) const {
    const bool layered = scene_.mode == Mode::volume_surface;
    const SetupOutput output = tile.resize(cells.size(), layered);
    SetupInput input{};
    input.vertices = vertices_.camera.data();
    input.corners = scene_.tetrahedra.front().data();
    input.values = layered ? &scene_.colors.front().r : scene_.scalars.data();
    input.value_count = layered ? 4 : 1;
    input.cells = cells.data();
    input.count = cells.size();
    input.column = first_column;
    input.row = first_row;
    kernel_.setup(view_, input, output);
    if (layered) return;
    for (std::size_t n = 0; n < cells.size(); ++n) {
      if (tile.blocks[n] == 0) continue;
      CellScalar& scalar = tile.scalars[n];
      scalar.first_interval = intervals_.find(scalar.low);
      scalar.last_interval = intervals_.find(scalar.high);
    }
  }

  const Scene& scene_;
  const Camera& camera_;
  const Parameters& parameters_;
  View view_;
  const Kernel& kernel_;
  double alpha_length_ = 0.0;
  MapIntervals intervals_;
  CellOptics optics_{};
  ProjectedVertices vertices_;
  TileBins bins_;
  std::unique_ptr<SurfaceLayers> layers_;  // none where no layer is drawn
};

}  // namespace

Image draw_cell_projection(const Scene& scene, const Camera& camera, const Parameters& parameters, RenderStats& stats,
                           Progress& progress) {
  if (scene.tetrahedra.empty()) return Image(camera.width, camera.height);
  const auto start = std::chrono::steady_clock::now();
  Drawing drawing(scene, camera, parameters);
  drawing.set_up(progress);
  stats.setup_ms += ms_since(start);
  const auto drawn = std::chrono::steady_clock::now();
  Image image = drawing.draw(stats.steps, progress);
  stats.render_ms += ms_since(drawn);
  return image;
}

}  // namespace atomesh
