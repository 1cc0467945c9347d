#include "render/cpu/cell_projection.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <memory>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "render/cpu/cell_bins.h"
#include "render/cpu/cell_projection_kernel.h"
#include "render/cpu/cell_projection_tile.h"
#include "render/cpu/map_intervals.h"
#include "render/cpu/surface_layers.h"
#include "render/cpu/tile_bins.h"
#include "render/cpu/uniform_medium.h"
#include "render/shared/preintegration.h"

namespace atomesh {

namespace {

using namespace cell_projection;

// Faces whose depth changes by more than so many of the sample's radii across a tile have their coefficients split.
constexpr double plain_radii = 5.0;

// A thread sets up at most so many cells of a tile at once, unless a single block has more.
constexpr std::size_t cells_at_once = 32768;

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
  view.order_blend = 0.02;
  // Where the mesh is a crystal's, and the crystal strained, circumspheres are as they were but for those of flat
  // cells. A few thousandths put the fewest cells of the quantum dots into a wrong order.
  view.order_doubt = scene.delaunay ? 0.0 : 0.003;
  // Rounding moves a face by at most a few 2^-24 of this: about a millionth of the sample's radius.
  view.plain_reach = static_cast<float>(plain_radii * (view.perspective ? radius / view.reference : radius));
  return view;
}

// Blocks of a tile: columns and rows of them, ends not included.
struct BlockRegion {
  int left, right, top, bottom;

  BlockSet blocks() const {
    BlockSet row = 0;
    for (int b = left; b < right; ++b) row |= BlockSet{1} << b;
    BlockSet set = 0;
    for (int b = top; b < bottom; ++b) set |= row << (blocks_per_side * b);
    return set;
  }
};

// Which rays are drawn, and where each of the window's ends (Channels::ray_end).
struct Rays {
  PixelLattice lattice;
  const std::vector<float>* end;
};

class CellProjectionFrame final : public Frame {
 public:
  CellProjectionFrame(const Scene& scene, const Camera& camera, const Parameters& parameters, const PixelWindow& window,
                      const Progress& progress)
      : scene_(scene), camera_(camera), window_(window), view_(make_view(scene, camera)), kernel_(kernel()) {
    const bool layered = scene.mode == Mode::volume_surface;
    const double alpha_length = layered ? parameters.volume_surface.alpha_length : parameters.volume.alpha_length;
    optics_.alpha_length = static_cast<float>(alpha_length);
    optics_.integrator = parameters.integrator;
    optics_.samples = parameters.samples_per_cell;
    if (parameters.integrator == Integrator::preintegrated) optics_.psi = optics::psi_table();
    if (!layered) {
      intervals_ = MapIntervals(parameters.volume.color_map);
      optics_.map = intervals_.data();
      optics_.map_grid = intervals_.grid();
    } else if (parameters.volume_surface.face_alpha > 0.0 && !scene.surface.empty()) {
      optics_.layer_alpha = static_cast<float>(parameters.volume_surface.face_alpha);
    }
    if (window.width < 1 || window.height < 1) return;
    grid_ = TileGrid(window);
    if (scene.tetrahedra.empty()) return;
    vertices_ = project_vertices(scene.vertices, scene.center, camera);
    const UniformMedium medium = layered && alpha_length > 0.0 ? UniformMedium(scene) : UniformMedium();
    const bool all_visible = alpha_length > 0.0 && all_opaque();
    const bool none_visible = !(alpha_length > 0.0) || medium.everywhere();
    bins_ = CellBins(none_visible ? 0 : scene.tetrahedra.size(), grid_, progress, [&](std::size_t cell) {
      if (medium.holds(scene.tetrahedra[cell])) return PixelBox{};
      const PixelBox box = box_of(static_cast<Index>(cell));
      return box.empty() || all_visible || visible(cell) ? box : PixelBox{};
    });
    optics_.has_medium = medium.present();
    for (int k = 0; k < 4; ++k) optics_.medium[k] = medium.color()[k];
    if (optics_.layer_alpha > 0.0F || optics_.has_medium) {
      layers_ = std::make_unique<SurfaceLayers>(scene, camera, parameters, view_, vertices_, grid_, optics_.has_medium,
                                                progress);
      optics_.layer = layers_->shader();
    }
  }

  void draw(const PixelLattice& lattice, Image& image, RenderStats& stats, const Channels& channels,
            Progress& progress) const override {
    const auto start = std::chrono::steady_clock::now();
    std::atomic<std::uint64_t> steps{0};
    std::atomic<std::size_t> done{0};
    parallel_for(grid_.tiles(), 1, [&](std::size_t tile, std::size_t) {
      progress.check();
      clear_tile(tile, lattice, image);
      if (bins_.any_in(tile) || (layers_ && layers_->any_in(tile))) {
        std::unique_ptr<Tile> cells = pool_.take();
        steps += draw_tile(tile, {lattice, channels.ray_end}, *cells, image, progress);
        pool_.give_back(std::move(cells));
      }
      const std::size_t finished = ++done;
      // The listener belongs to the thread that called us.
      if (omp_get_thread_num() == 0)
        progress.update(static_cast<double>(finished) / static_cast<double>(grid_.tiles()));
    });
    progress.update(1.0);
    stats.steps += steps;
    stats.render_ms += ms_since(start);
  }

 private:
  // u (cell_projection_kernel.h) of a depth.
  float end_of_ray(float depth) const {
    const auto z = static_cast<double>(depth);
    const double u = view_.perspective ? 1.0 - view_.reference / z : z - view_.reference;
    return std::min(static_cast<float>(u), view_.farthest);
  }

  // Whether no cell can be invisible.
  bool all_opaque() const {
    if (scene_.mode == Mode::volume) return !intervals_.any_transparent();
    return std::none_of(scene_.colors.begin(), scene_.colors.end(), [](const Vec4f& color) { return color.a <= 0.0F; });
  }

  bool visible(std::size_t cell) const {
    const Tetrahedron& corners = scene_.tetrahedra[cell];
    if (scene_.mode == Mode::volume_surface) {
      return std::any_of(corners.begin(), corners.end(), [this](Index v) { return scene_.colors[v].a > 0.0F; });
    }
    const auto scalar = [&](std::size_t k) { return scene_.scalars[corners[k]]; };
    return !intervals_.transparent(std::min({scalar(0), scalar(1), scalar(2), scalar(3)}),
                                   std::max({scalar(0), scalar(1), scalar(2), scalar(3)}));
  }

  PixelBox box_of(Index cell) const {
    const Tetrahedron& corners = scene_.tetrahedra[cell];
    PixelBox box;
    if (pixel_box_before_eye(vertices_, corners, camera_.width, camera_.height, box)) return box;
    const bool all_behind =
        std::all_of(corners.begin(), corners.end(), [this](Index v) { return vertices_[v].behind(); });
    return all_behind ? PixelBox{} : clipped_box(vertices_, corners, camera_);
  }

  // Calls visit(pixel's place in the image, column, row of the lattice's grid) for the lattice's pixels of a region
  // that lie in the window.
  template <class Visit>
  void for_pixels(std::size_t tile, const PixelLattice& lattice, const BlockRegion& region, Visit&& visit) const {
    const int left = grid_.pixel_column(tile) + lattice.column_phase - window_.left;
    const int top = grid_.pixel_row(tile) + lattice.row_phase - window_.top;
    for (int j = region.top * block_side; j < region.bottom * block_side; ++j) {
      const int row = top + j * lattice.row_stride;
      if (row < 0 || row >= window_.height) continue;
      for (int i = region.left * block_side; i < region.right * block_side; ++i) {
        const int column = left + i * lattice.column_stride;
        if (column < 0 || column >= window_.width) continue;
        visit(
            static_cast<std::size_t>(row) * static_cast<std::size_t>(window_.width) + static_cast<std::size_t>(column),
            i, j);
      }
    }
  }

  static BlockRegion all_blocks(const PixelLattice& lattice) {
    return {0, blocks_per_side / lattice.column_stride, 0, blocks_per_side / lattice.row_stride};
  }

  void clear_tile(std::size_t tile, const PixelLattice& lattice, Image& image) const {
    for_pixels(tile, lattice, all_blocks(lattice),
               [&](std::size_t place, int, int) { image.pixels[place] = Vec4f(0.0F); });
  }

  std::uint64_t draw_tile(std::size_t number, const Rays& rays, Tile& tile, Image& image,
                          const Progress& progress) const {
    const PixelLattice& lattice = rays.lattice;
    tile.layers.clear();
    if (layers_) layers_->find(number, lattice, tile.layers);
    std::vector<Index> cells;
    bins_.gather(number, cells);
    const BlockRegion region = all_blocks(lattice);
    if (lattice.column_stride > 1 || lattice.row_stride > 1) keep_cells_of(number, lattice, region, cells);
    return draw_region(number, rays, region, cells, tile, image, progress);
  }

  // Leaves out the cells that lie beside all of the region's pixels.
  void keep_cells_of(std::size_t tile, const PixelLattice& lattice, const BlockRegion& region,
                     std::vector<Index>& cells) const {
    const int left = grid_.pixel_column(tile) + lattice.column_phase;
    const int top = grid_.pixel_row(tile) + lattice.row_phase;
    // Whether there is a pixel begin + n · stride, n from 0 on, at most `end`, from first to last.
    const auto meets = [](int first, int last, int begin, int end, int stride) {
      const int next = first <= begin ? begin : begin + (first - begin + stride - 1) / stride * stride;
      return next <= std::min(last, end);
    };
    std::erase_if(cells, [&](Index cell) {
      const Tetrahedron& corners = scene_.tetrahedra[cell];
      PixelBox box;
      if (!pixel_box_before_eye(vertices_, corners, camera_.width, camera_.height, box)) return false;
      const int column_step = block_side * lattice.column_stride;
      const int row_step = block_side * lattice.row_stride;
      return !meets(box.first_column, box.last_column, left + region.left * column_step,
                    left + region.right * column_step - 1, lattice.column_stride) ||
             !meets(box.first_row, box.last_row, top + region.top * row_step, top + region.bottom * row_step - 1,
                    lattice.row_stride);
    });
  }

  // Cells that are too many at once are drawn in parts of the tile.
  std::uint64_t draw_region(std::size_t number, const Rays& rays, const BlockRegion& region,
                            const std::vector<Index>& cells, Tile& tile, Image& image, const Progress& progress) const {
    const PixelLattice& lattice = rays.lattice;
    const int columns = region.right - region.left;
    const int rows = region.bottom - region.top;
    if (cells.size() <= cells_at_once || columns * rows == 1) {
      set_up_tile(number, lattice, region, cells, tile);
      return draw_blocks(number, rays, region, tile, image, progress);
    }
    BlockRegion parts[2] = {region, region};
    if (columns >= rows) {
      parts[0].right = parts[1].left = region.left + columns / 2;
    } else {
      parts[0].bottom = parts[1].top = region.top + rows / 2;
    }
    std::uint64_t steps = 0;
    for (const BlockRegion& part : parts) {
      std::vector<Index> kept = cells;
      keep_cells_of(number, lattice, part, kept);
      steps += draw_region(number, rays, part, kept, tile, image, progress);
    }
    return steps;
  }

  std::uint64_t draw_blocks(std::size_t number, const Rays& rays, const BlockRegion& region, Tile& tile, Image& image,
                            const Progress& progress) const {
    const PixelLattice& lattice = rays.lattice;
    tile.list_blocks();
    const BlockScratch scratch = tile.scratch();
    std::uint64_t steps = 0;
    for (BlockSet rest = region.blocks(); rest != 0; rest &= rest - 1) {
      const int b = std::countr_zero(rest);
      const std::span<const std::uint32_t> cells = tile.cells_of(b);
      const bool layered = tile.layers.any_in(b);
      if (cells.empty() && !layered) continue;
      progress.check();
      BlockInput block{};
      block.planes = tile.planes.data();
      block.refinements = tile.refinements.data();
      block.colors = tile.colors.data();
      block.ranges = tile.ranges.data();
      block.scalars = tile.scalars.data();
      block.cells = cells.data();
      block.count = cells.size();
      block.layers = layered ? tile.layers.hits() : nullptr;
      block.layer_begin = layered ? tile.layers.begin_of(b) : nullptr;
      block.column = b % blocks_per_side * block_side;
      block.row = b / blocks_per_side * block_side;
      block.tile_column = grid_.pixel_column(number);
      block.tile_row = grid_.pixel_row(number);
      block.lattice = lattice;
      float farthest[block_pixels];
      if (rays.end != nullptr) {
        std::fill_n(farthest, block_pixels, view_.farthest);
        const int column = b % blocks_per_side;
        const int row = b / blocks_per_side;
        for_pixels(number, lattice, {column, column + 1, row, row + 1}, [&](std::size_t place, int i, int j) {
          farthest[j % block_side * block_side + i % block_side] = end_of_ray((*rays.end)[place]);
        });
        block.farthest = farthest;
      }
      float rgba[4 * block_pixels];
      steps += kernel_.draw_block(view_, optics_, block, scratch, rgba);
      const int column = b % blocks_per_side;
      const int row = b / blocks_per_side;
      for_pixels(number, lattice, {column, column + 1, row, row + 1}, [&](std::size_t place, int i, int j) {
        const float* from = rgba + 4 * (j % block_side * block_side + i % block_side);
        image.pixels[place] = {from[0], from[1], from[2], from[3]};
      });
    }
    return steps;
  }

  void set_up_tile(std::size_t number, const PixelLattice& lattice, const BlockRegion& region,
                   const std::vector<Index>& cells, Tile& tile) const {
    const bool layered = scene_.mode == Mode::volume_surface;
    const SetupOutput output = tile.resize(cells.size(), layered);
    SetupInput input{};
    input.vertices = vertices_.data();
    input.corners = scene_.tetrahedra.front().data();
    input.values = layered ? &scene_.colors.front().r : scene_.scalars.data();
    input.value_count = layered ? 4 : 1;
    input.cells = cells.data();
    input.count = cells.size();
    input.column = grid_.pixel_column(number);
    input.row = grid_.pixel_row(number);
    input.lattice = lattice;
    input.wanted = region.blocks();
    kernel_.setup(view_, input, output);
    if (layered) return;
    for (std::size_t n = 0; n < cells.size(); ++n) {
      if (tile.blocks[n] == 0) continue;
      CellScalar& scalar = tile.scalars[n];
      scalar.first_interval = intervals_.find(scalar.low);
      scalar.last_interval = intervals_.find(scalar.high, scalar.first_interval);
      const MapInterval& next = intervals_.data()[scalar.first_interval + 1];
      // The difference of two floats that are near each other is exact.
      scalar.knot = next.begin - scalar.reference + next.begin_rest;
      scalar.thin_length = intervals_.thin_length(scalar.first_interval, scalar.last_interval);
    }
  }

  const Scene& scene_;
  const Camera& camera_;
  const PixelWindow window_;
  const View view_;
  const Kernel& kernel_;
  MapIntervals intervals_;
  CellOptics optics_{};
  TileGrid grid_;
  ProjectedVertices vertices_;
  CellBins bins_;
  std::unique_ptr<SurfaceLayers> layers_;  // none where no layer is drawn
  mutable TilePool pool_;
};

}  // namespace

std::unique_ptr<Frame> prepare_cell_projection(const Scene& scene, const Camera& camera, const Parameters& parameters,
                                               const PixelWindow& window, RenderStats& stats,
                                               const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  auto frame = std::make_unique<CellProjectionFrame>(scene, camera, parameters, window, progress);
  stats.setup_ms += ms_since(start);
  return frame;
}

}  // namespace atomesh
