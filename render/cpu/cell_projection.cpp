#include "render/cpu/cell_projection.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>
#include <vector>

#include "core/parallel.h"
#include "render/cpu/cell_projection_kernel.h"
#include "render/cpu/surface_shader.h"
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

// The colour map as linear intervals that cover every scalar, and how many intervals before each are not transparent.
struct MapIntervals {
  std::vector<MapInterval> intervals;
  std::vector<int> opaque_before;

  std::uint16_t find(float s) const {
    std::size_t n = 0;
    while (n + 1 < intervals.size() && s >= intervals[n + 1].begin) ++n;
    return static_cast<std::uint16_t>(n);
  }
  bool transparent(float low, float high) const {
    return opaque_before[std::size_t{find(high)} + 1] == opaque_before[find(low)];
  }
};

MapIntervals make_intervals(const ColorMap& map) {
  MapIntervals result;
  const auto add = [&](float begin, float end, const Vec4f& first, const Vec4f& slope) {
    MapInterval interval{begin, end, {}, {}};
    for (int k = 0; k < 4; ++k) {
      interval.first[k] = first[k];
      interval.slope[k] = slope[k];
    }
    result.intervals.push_back(interval);
  };
  const std::vector<ColorMapEntry>& entries = map.entries;
  const auto scalar = [&](std::size_t i) { return static_cast<float>(entries[i].scalar); };
  if (scalar(0) > 0.0F) add(-1.0F, scalar(0), entries.front().color, Vec4f(0.0F));
  for (std::size_t i = 0; i + 1 < entries.size(); ++i) {
    if (!(scalar(i) < scalar(i + 1))) continue;  // a jump
    add(scalar(i), scalar(i + 1), entries[i].color,
        (entries[i + 1].color - entries[i].color) / (scalar(i + 1) - scalar(i)));
  }
  add(scalar(entries.size() - 1), 2.0F, entries.back().color, Vec4f(0.0F));
  result.opaque_before.assign(1, 0);
  for (const MapInterval& interval : result.intervals) {
    const bool opaque = interval.first[3] > 0.0F || interval.slope[3] != 0.0F;
    result.opaque_before.push_back(result.opaque_before.back() + (opaque ? 1 : 0));
  }
  return result;
}

// The surface's triangles by the cell and face they are.
class Layers {
 public:
  Layers(const Scene& scene, const Camera& camera, const Parameters& parameters, const View& view)
      : view_(view), shader_(scene, camera, parameters), faces_(scene.tetrahedra.size(), 0) {
    for (std::size_t t = 0; t < scene.surface.size(); ++t) {
      const Index cell = scene.surface_tetrahedron[t];
      const unsigned face = scene.surface_face[t];
      faces_[cell] = static_cast<std::uint8_t>(faces_[cell] | (1U << face));
      triangles_.push_back({key(cell, static_cast<int>(face)), static_cast<Index>(t)});
    }
    if (!std::is_sorted(triangles_.begin(), triangles_.end())) std::sort(triangles_.begin(), triangles_.end());
  }

  const std::uint8_t* faces() const { return faces_.data(); }

  static void shade(const void* context, Index cell, int face, double column, double row, double u, float* rgb) {
    const Layers& self = *static_cast<const Layers*>(context);
    const View& view = self.view_;
    const auto found = std::lower_bound(self.triangles_.begin(), self.triangles_.end(),
                                        std::pair<std::uint64_t, Index>{key(cell, face), 0});
    const double depth = view.perspective ? view.reference / (1.0 - u) : u + view.reference;
    const Vec3f color =
        self.shader_.shade(found->second, view.left + column * view.pixel, view.top - row * view.pixel, depth, false);
    for (int k = 0; k < 3; ++k) rgb[k] = color[k];
  }

 private:
  static std::uint64_t key(Index cell, int face) { return std::uint64_t{cell} * 4 + static_cast<std::uint64_t>(face); }

  const View& view_;
  SurfaceShader shader_;
  std::vector<std::uint8_t> faces_;  // per cell: bit f where face f is on the surface
  std::vector<std::pair<std::uint64_t, Index>> triangles_;
};

// What a thread needs to draw a tile; grows to the largest tile it has seen.
struct TileScratch {
  std::vector<CellPlanes> planes;
  std::vector<CellValues> values;
  std::vector<double> keys;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> sorting;
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> cells;
  std::vector<float> floats;
  std::vector<std::uint32_t> numbers;
  std::vector<std::uint16_t> lanes;

  BlockScratch block(std::size_t longest) {
    floats.resize(std::max(floats.size(), longest * (16 + 16 + 64)));
    numbers.resize(std::max(numbers.size(), longest * 3));
    lanes.resize(std::max(lanes.size(), longest));
    return {floats.data(),
            floats.data() + 16 * longest,
            lanes.data(),
            numbers.data(),
            numbers.data() + longest,
            numbers.data() + 2 * longest,
            floats.data() + 32 * longest};
  }
};

class ScratchPool {
 public:
  std::unique_ptr<TileScratch> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<TileScratch>();
    std::unique_ptr<TileScratch> scratch = std::move(free_.back());
    free_.pop_back();
    return scratch;
  }
  void give_back(std::unique_ptr<TileScratch> scratch) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(scratch));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<TileScratch>> free_;
};

// Orders the tile's cells by key, front to back, equal keys by their place in the tile. Leaves out what cannot be seen.
// Keys are resolved to 2^-33 of their range: a radix sort of three digits.
void sort_cells(TileScratch& scratch, std::size_t count) {
  double low = HUGE_VAL;
  double high = -HUGE_VAL;
  for (std::size_t n = 0; n < count; ++n) {
    if (std::isinf(scratch.keys[n])) continue;
    low = std::min(low, scratch.keys[n]);
    high = std::max(high, scratch.keys[n]);
  }
  constexpr int digit = 11;
  const double scale = high > low ? (std::ldexp(1.0, 3 * digit) - 1.0) / (high - low) : 0.0;
  scratch.sorted.clear();
  std::array<std::array<std::uint32_t, 1 << digit>, 3> places{};
  constexpr std::uint64_t digit_mask = (1U << digit) - 1;
  for (std::size_t n = 0; n < count; ++n) {
    if (std::isinf(scratch.keys[n])) continue;
    const auto key = static_cast<std::uint64_t>((scratch.keys[n] - low) * scale);
    scratch.sorted.push_back({key, static_cast<std::uint32_t>(n)});
    for (std::size_t pass = 0; pass < 3; ++pass) ++places[pass][key >> (digit * pass) & digit_mask];
  }
  scratch.sorting.resize(scratch.sorted.size());
  for (std::size_t pass = 0; pass < 3; ++pass) {
    std::uint32_t place = 0;
    for (std::uint32_t& at : places[pass]) place += std::exchange(at, place);
    for (const auto& entry : scratch.sorted) {
      scratch.sorting[places[pass][entry.first >> (digit * pass) & digit_mask]++] = entry;
    }
    scratch.sorted.swap(scratch.sorting);
  }
}

class Drawing {
 public:
  Drawing(const Scene& scene, const Camera& camera, const Parameters& parameters)
      : scene_(scene), camera_(camera), view_(make_view(scene, camera)), kernel_(kernel()) {
    const bool layered = scene.mode == Mode::volume_surface;
    alpha_length_ = layered ? parameters.volume_surface.alpha_length : parameters.volume.alpha_length;
    if (!layered) intervals_ = make_intervals(parameters.volume.color_map);
    if (layered && parameters.volume_surface.face_alpha > 0.0 && !scene.surface.empty()) {
      layers_ = std::make_unique<Layers>(scene, camera, parameters, view_);
    }
    optics_.alpha_length = static_cast<float>(alpha_length_);
    optics_.samples = parameters.integrator == Integrator::sampled ? parameters.samples_per_cell : 0;
    optics_.map = layered ? nullptr : intervals_.intervals.data();
    optics_.layer = {layers_ ? Layers::shade : nullptr, layers_.get()};
    optics_.layer_alpha = static_cast<float>(parameters.volume_surface.face_alpha);
  }

  void set_up() {
    vertices_ = project_vertices(scene_.vertices, scene_.center, camera_);
    bins_ = bin_to_tiles(scene_.tetrahedra.size(), camera_.width, camera_.height, tile_side, [this](std::size_t cell) {
      return visible(cell) ? pixel_box(vertices_, scene_.tetrahedra[cell], camera_.width, camera_.height) : PixelBox{};
    });
  }

  Image draw(std::uint64_t& steps, Progress& progress) const {
    Image image(camera_.width, camera_.height);
    ScratchPool pool;
    std::atomic<std::uint64_t> all_steps{0};
    std::atomic<std::size_t> done{0};
    parallel_for(bins_.tiles(), 1, [&](std::size_t tile, std::size_t) {
      progress.check();
      if (!bins_.of(tile).empty()) {
        std::unique_ptr<TileScratch> scratch = pool.take();
        all_steps += draw_tile(tile, *scratch, image, progress);
        pool.give_back(std::move(scratch));
      }
      const std::size_t finished = ++done;
      // The listener belongs to the thread that called us.
      if (omp_get_thread_num() == 0)
        progress.update(static_cast<double>(finished) / static_cast<double>(bins_.tiles()));
    });
    steps += all_steps;
    return image;
  }

 private:
  bool visible(std::size_t cell) const {
    if (layers_ && layers_->faces()[cell] != 0) return true;
    if (!(alpha_length_ > 0.0)) return false;
    const Tetrahedron& corners = scene_.tetrahedra[cell];
    if (scene_.mode == Mode::volume_surface) {
      return std::any_of(corners.begin(), corners.end(), [this](Index v) { return scene_.colors[v].a > 0.0F; });
    }
    const auto scalar = [&](std::size_t k) { return scene_.scalars[corners[k]]; };
    return !intervals_.transparent(std::min({scalar(0), scalar(1), scalar(2), scalar(3)}),
                                   std::max({scalar(0), scalar(1), scalar(2), scalar(3)}));
  }

  std::uint64_t draw_tile(std::size_t tile, TileScratch& scratch, Image& image, const Progress& progress) const {
    const std::span<const Index> cells = bins_.of(tile);
    const int tile_column = static_cast<int>(tile % static_cast<std::size_t>(bins_.columns)) * tile_side;
    const int tile_row = static_cast<int>(tile / static_cast<std::size_t>(bins_.columns)) * tile_side;
    if (scratch.planes.size() < cells.size()) {
      scratch.planes.resize(cells.size());
      scratch.values.resize(cells.size());
      scratch.keys.resize(cells.size());
    }
    SetupInput input{};
    input.vertices = vertices_.camera.data();
    input.corners = scene_.tetrahedra.front().data();
    const bool layered = scene_.mode == Mode::volume_surface;
    input.values = layered ? &scene_.colors.front().r : scene_.scalars.data();
    input.value_count = layered ? 4 : 1;
    input.cells = cells.data();
    input.count = cells.size();
    input.surface_faces = layers_ ? layers_->faces() : nullptr;
    input.column = tile_column;
    input.row = tile_row;
    kernel_.setup(view_, input, scratch.planes.data(), scratch.values.data(), scratch.keys.data());
    if (!layered) {
      for (std::size_t n = 0; n < cells.size(); ++n) {
        scratch.values[n].first_interval = intervals_.find(scratch.values[n].low[0]);
        scratch.values[n].last_interval = intervals_.find(scratch.values[n].high[0]);
      }
    }
    sort_cells(scratch, cells.size());
    const std::size_t longest = list_blocks(cells, tile_column, tile_row, scratch);
    const BlockScratch block_scratch = scratch.block(longest);

    std::uint64_t steps = 0;
    for (int b = 0; b < blocks_per_side * blocks_per_side; ++b) {
      const std::uint32_t begin = scratch.begin[static_cast<std::size_t>(b)];
      const std::uint32_t end = scratch.begin[static_cast<std::size_t>(b) + 1];
      if (begin == end) continue;
      progress.check();
      BlockInput block{};
      block.planes = scratch.planes.data();
      block.values = scratch.values.data();
      block.cells = scratch.cells.data() + begin;
      block.count = end - begin;
      block.column = b % blocks_per_side * block_side;
      block.row = b / blocks_per_side * block_side;
      block.tile_column = tile_column;
      block.tile_row = tile_row;
      float rgba[4 * block_pixels];
      steps += kernel_.draw_block(view_, optics_, block, block_scratch, rgba);
      for (int i = 0; i < block_pixels; ++i) {
        const int column = tile_column + block.column + i % block_side;
        const int row = tile_row + block.row + i / block_side;
        if (column >= image.width || row >= image.height) continue;
        image.at(column, row) = {rgba[4 * i], rgba[4 * i + 1], rgba[4 * i + 2], rgba[4 * i + 3]};
      }
    }
    return steps;
  }

  // Lists under each block the cells whose box touches it, front to back; returns the longest list's length.
  std::size_t list_blocks(std::span<const Index> cells, int tile_column, int tile_row, TileScratch& scratch) const {
    constexpr std::size_t blocks = std::size_t{blocks_per_side} * blocks_per_side;
    std::array<std::uint32_t, blocks> fill{};
    const auto for_blocks = [&](std::uint32_t n, auto&& visit) {
      const PixelBox box = pixel_box(vertices_, scene_.tetrahedra[cells[n]], camera_.width, camera_.height);
      const int first_column = std::max(0, (box.first_column - tile_column) / block_side);
      const int last_column = std::min(blocks_per_side - 1, (box.last_column - tile_column) / block_side);
      const int first_row = std::max(0, (box.first_row - tile_row) / block_side);
      const int last_row = std::min(blocks_per_side - 1, (box.last_row - tile_row) / block_side);
      for (int row = first_row; row <= last_row; ++row) {
        for (int column = first_column; column <= last_column; ++column) {
          visit(static_cast<std::size_t>(row * blocks_per_side + column));
        }
      }
    };
    for (const auto& entry : scratch.sorted) for_blocks(entry.second, [&](std::size_t b) { ++fill[b]; });
    scratch.begin.assign(blocks + 1, 0);
    for (std::size_t b = 0; b < blocks; ++b) scratch.begin[b + 1] = scratch.begin[b] + fill[b];
    scratch.cells.resize(scratch.begin[blocks]);
    const std::size_t longest = *std::max_element(fill.begin(), fill.end());
    std::copy_n(scratch.begin.begin(), blocks, fill.begin());
    for (const auto& entry : scratch.sorted) {
      for_blocks(entry.second, [&](std::size_t b) { scratch.cells[fill[b]++] = entry.second; });
    }
    return longest;
  }

  const Scene& scene_;
  const Camera& camera_;
  View view_;
  const Kernel& kernel_;
  double alpha_length_ = 0.0;
  MapIntervals intervals_;
  std::unique_ptr<Layers> layers_;
  CellOptics optics_{};
  ProjectedVertices vertices_;
  TileBins bins_;
};

}  // namespace

Image draw_cell_projection(const Scene& scene, const Camera& camera, const Parameters& parameters, RenderStats& stats,
                           Progress& progress) {
  if (scene.tetrahedra.empty()) return Image(camera.width, camera.height);
  const auto start = std::chrono::steady_clock::now();
  Drawing drawing(scene, camera, parameters);
  drawing.set_up();
  stats.setup_ms += ms_since(start);
  const auto drawn = std::chrono::steady_clock::now();
  Image image = drawing.draw(stats.steps, progress);
  stats.render_ms += ms_since(drawn);
  return image;
}

}  // namespace atomesh
