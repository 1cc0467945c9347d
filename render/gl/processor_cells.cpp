#include "render/gl/processor_cells.h"

#include <omp.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <optional>

#include "core/error.h"
#include "core/parallel.h"
#include "render/gl/context.h"

namespace atomesh::gl {

namespace {

// A thread's share of a slab.
constexpr std::size_t cells_per_share = 4096;
static_assert(cells_per_slab % cells_per_share == 0);

// Software sorts triangles into tiles before it fills them, on other threads, which get a core between portions.
constexpr std::size_t cells_per_portion = 256;
// Nearly all cells have at most two triangles.
constexpr std::size_t portion_vertices = cells_per_portion * 6;

// Going from one program to the other and back takes software about as long as ten cells: where more of the scene's
// cells do not suit ramps, none is drawn by them. (Whether a single cell is must not depend on the others: windows of a
// picture show the same.)
constexpr double most_exceptions = 0.25;

constexpr GLuint ramp_rows_unit = 7;

// A buffer's memory, to be written from its beginning; unmapped at the latest when it goes.
template <class T>
class Mapped {
 public:
  Mapped(const Buffer& buffer, std::size_t count) : buffer_(buffer) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
    data_ = static_cast<T*>(glMapBufferRange(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(count * sizeof(T)),
                                             GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT));
    if (data_ != nullptr) return;
    check_errors("mapping vertices");
    throw UnavailableError("OpenGL: memory for vertices cannot be mapped");
  }
  ~Mapped() {
    if (data_ != nullptr) free();
  }
  Mapped(const Mapped&) = delete;
  Mapped& operator=(const Mapped&) = delete;

  T* data() const { return data_; }
  // Throws UnavailableError where what was written is lost.
  void unmap() {
    if (!free()) throw UnavailableError("OpenGL: memory for vertices was lost");
  }

 private:
  bool free() {
    data_ = nullptr;
    glBindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    return glUnmapBuffer(GL_ARRAY_BUFFER) == GL_TRUE;
  }

  const Buffer& buffer_;
  T* data_ = nullptr;
};

// Threads of parallel loops look out for more to do for some milliseconds, on cores that software draws with.
void end_waiting_threads() {
  omp_pause_resource_all(omp_pause_soft);
}

// Those of `count` cells that are not among `cells`, which ascend.
std::vector<Index> cells_beside(std::span<const Index> cells, std::size_t count) {
  std::vector<Index> others;
  others.reserve(count - cells.size());
  std::size_t next = 0;
  for (std::size_t cell = 0; cell < count; ++cell) {
    if (next < cells.size() && cells[next] == cell) {
      ++next;
    } else {
      others.push_back(static_cast<Index>(cell));
    }
  }
  return others;
}

}  // namespace

void ProcessorCells::project(const Camera& camera, const PixelGrid& grid, const ColorMap& color_map,
                             const Progress& progress) {
  mesh_ = std::make_unique<ScreenMesh>(scene_, camera, grid, cell_projection::MapIntervals(color_map), progress);
}

void ProcessorCells::order(const Camera& camera, Progress& progress) {
  if (!order_) order_ = std::make_unique<CellOrder>(scene_, by_faces_, progress);
  std::vector<Index> order;
  CellOrderStats order_stats;
  const std::vector<Index> unseen =
      order_->by_faces() ? cells_beside(mesh_->cells(), scene_.tetrahedra.size()) : std::vector<Index>();
  order_->sort(camera, mesh_->cells(), unseen, order, order_stats, progress);
  parts_ = mesh_->parts(order);
  cells_ = order.size();
  const std::size_t slabs = (parts_.size() + cells_per_slab - 1) / cells_per_slab;
  slab_triangles_.assign(slabs, 0);
  triangles_ = ramp_triangles_ = 0;
  slab_numbers_.assign(keep_slabs() ? slabs : 1, slabs);  // none
  find_outside();
  if (software_) end_waiting_threads();
}

// Where none is clipped: pieces of cells have other faces.
void ProcessorCells::find_outside() {
  outside_.clear();
  outside_sent_ = false;
  const std::span<const OutsideFace> faces = order_->outside();
  outside_.reserve(3 * faces.size());
  for (const auto& [cell, face] : faces) {
    const std::array<ScreenVertex, 4> corners = mesh_->corners(cell);
    const auto& [a, b, c] = face_corners[face];
    const std::array triangle{corners[a], corners[b], corners[c]};
    if (std::ranges::any_of(triangle, ScreenMesh::is_clipped)) {
      outside_.clear();
      return;
    }
    if (!meets_pixel(triangle, mesh_->view().grid)) continue;
    for (const ScreenVertex& corner : triangle) {
      outside_.emplace_back(static_cast<float>(corner.column) / subpixels, static_cast<float>(corner.row) / subpixels,
                            corner.w, 0.0F);
    }
  }
}

void ProcessorCells::draw_outside() {
  if (!outside_sent_) outside_buffer_.write(std::span<const Vec4f>(outside_), GL_STREAM_DRAW);
  outside_sent_ = true;
  glBindBuffer(GL_ARRAY_BUFFER, outside_buffer_.name());
  glEnableVertexAttribArray(0);
  glDisableVertexAttribArray(1);
  glDisableVertexAttribArray(2);
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(outside_.size()));
}

std::size_t ProcessorCells::triangles() const {
  return std::accumulate(slab_triangles_.begin(), slab_triangles_.end(), triangles_);
}

void ProcessorCells::use_no_ramps() {
  ramps_.reset();
  ramps_suit_ = false;
}

void ProcessorCells::use_ramps(const ColorMap& color_map, double alpha_length, bool rays_end) {
  rays_end_ = rays_end;
  if (ramps_ && ramps_map_ == color_map && ramps_alpha_length_ == alpha_length) return;
  ramps_ = std::make_unique<MapRamps>(scene_, color_map, alpha_length);
  ramps_suit_ =
      static_cast<double>(ramps_->too_deep()) <= most_exceptions * static_cast<double>(scene_.tetrahedra.size());
  ramps_map_ = color_map;
  ramps_alpha_length_ = alpha_length;
  ramp_rows_.write(ramps_->rows());
}

bool ProcessorCells::make_slab(std::size_t begin) {
  if (software_) return false;
  const std::size_t n = begin / cells_per_slab;
  slabs_.resize(slab_numbers_.size());
  Slab& slab = slab_at(begin);
  std::size_t& number = slab_numbers_[static_cast<std::size_t>(&slab - slabs_.data())];
  if (number == n) return false;
  const std::size_t first = n * cells_per_slab;
  fill(slab, std::span(parts_).subspan(first, slab_end(begin, parts_.size()) - first));
  number = n;
  slab_triangles_[n] = 0;
  for (const Share& share : slab.shares) slab_triangles_[n] += share.triangles;
  return true;
}

void ProcessorCells::fill(Slab& slab, std::span<const Index> parts) const {
  slab.vertices.reserve(cells_per_slab * vertices_per_cell * sizeof(FaceVertex), GL_STREAM_DRAW);
  slab.shares.resize((parts.size() + cells_per_share - 1) / cells_per_share);
  Mapped<FaceVertex> vertices(slab.vertices, parts.size() * vertices_per_cell);
  const PixelGrid& grid = mesh_->view().grid;
  parallel_for(parts.size(), cells_per_share, [&](std::size_t begin, std::size_t end) {
    std::size_t triangles = 0;
    FaceVertex* const first = vertices.data() + begin * vertices_per_cell;
    for (std::size_t i = begin; i < end; ++i) {
      triangles += front_faces(mesh_->corners(parts[i]), grid, first + 3 * triangles);
    }
    slab.shares[begin / cells_per_share] = {end - begin, triangles};
  });
  vertices.unmap();
  if (software_) end_waiting_threads();
}

std::size_t ProcessorCells::draw(std::size_t begin, std::size_t most, const UseProgram& use) {
  const std::size_t count = std::min(most, slab_end(begin, parts_.size()) - begin);
  if (software_) {
    if (begin == 0) triangles_ = ramp_triangles_ = 0;
    draw_portions(std::span(parts_).subspan(begin, count), use);
  } else {
    use(CellKind::segment);
    const std::size_t from = begin % cells_per_slab;
    draw_slab(slab_at(begin), from, from + count);
  }
  return count;
}

void ProcessorCells::draw_slab(const Slab& slab, std::size_t begin, std::size_t end) {
  bind_vertices(slab.vertices);
  glDisableVertexAttribArray(2);
  std::vector<GLint> first;
  std::vector<GLsizei> count;
  std::size_t before = 0;
  for (const auto& [cells, triangles] : slab.shares) {
    // Of a part of a share so many of its triangles, whosever they are: parts that follow one another make the whole.
    const auto triangle = [&](std::size_t cell) {
      return triangles * (std::clamp(cell, before, before + cells) - before) / cells;
    };
    if (triangle(end) > triangle(begin)) {
      first.push_back(static_cast<GLint>(before * vertices_per_cell + 3 * triangle(begin)));
      count.push_back(static_cast<GLsizei>(3 * (triangle(end) - triangle(begin))));
    }
    before += cells;
  }
  glMultiDrawArrays(GL_TRIANGLES, first.data(), count.data(), static_cast<GLsizei>(first.size()));
}

void ProcessorCells::draw_portions(std::span<const Index> parts, const UseProgram& use) {
  const PixelGrid& grid = mesh_->view().grid;
  const MapRamps* const ramps = ramps_suit_ ? ramps_.get() : nullptr;
  const CellFaces faces(*mesh_, ramps, outside_shows_order() && !rays_end_);
  std::array<FaceVertex, CellFaces::most_vertices> of_cell;
  std::array<RampVertex, CellFaces::most_vertices> beside;
  CellBatch batch(grid.columns, grid.rows);
  std::optional<CellKind> used;
  for (std::size_t i = 0; i < parts.size();) {
    batch.clear();
    for (; i < parts.size() && batch.cells() < cells_per_portion && batch.vertices() < portion_vertices; ++i) {
      const auto [count, kind] = faces.write(parts[i], of_cell.data(), beside.data());
      if (count == 0) continue;
      const GridBox box = pixels_between(mesh_->corners(parts[i]), grid);
      if (!batch.add(box, kind, std::span(of_cell).first(count), beside.data())) break;
    }
    if (batch.vertices() == 0) continue;
    send_portion(batch);
    std::size_t first = 0;
    for (const CellKind kind : {CellKind::piece, CellKind::ramps, CellKind::segment}) {
      const std::size_t count = batch.list(kind).faces.size();
      if (count == 0) continue;
      if (used != kind) use(kind);
      used = kind;
      glDrawArrays(GL_TRIANGLES, static_cast<GLint>(first), static_cast<GLsizei>(count));
      first += count;
      triangles_ += count / 3;
      if (kind != CellKind::segment) ramp_triangles_ += count / 3;
    }
    ahead_.go_on(batch.cells());
  }
}

// And binds it.
void ProcessorCells::send_portion(const CellBatch& batch) {
  const std::size_t room = std::max(batch.vertices(), portion_vertices + CellFaces::most_vertices);
  const std::size_t segments = batch.list(CellKind::segment).faces.size();
  portion_.vertices.reserve(room * sizeof(FaceVertex), GL_STREAM_DRAW);
  portion_.ramps.reserve(room * sizeof(RampVertex), GL_STREAM_DRAW);
  Mapped<FaceVertex> vertices(portion_.vertices, batch.vertices());
  FaceVertex* vertex = vertices.data();
  for (std::size_t kind = 0; kind < cell_kinds; ++kind) {
    vertex = std::ranges::copy(batch.list(static_cast<CellKind>(kind)).faces, vertex).out;
  }
  vertices.unmap();
  bind_vertices(portion_.vertices);
  if (segments == batch.vertices()) {
    glDisableVertexAttribArray(2);
    return;
  }
  Mapped<RampVertex> ramps(portion_.ramps, batch.vertices());
  RampVertex* ramp = ramps.data();
  for (std::size_t kind = 0; kind < cell_kinds; ++kind) {
    ramp = std::ranges::copy(batch.list(static_cast<CellKind>(kind)).ramps, ramp).out;
  }
  ramps.unmap();
  glEnableVertexAttribArray(2);
  glBindBuffer(GL_ARRAY_BUFFER, portion_.ramps.name());
  glVertexAttribPointer(2, 2, GL_FLOAT, GL_FALSE, sizeof(RampVertex), nullptr);
  ramp_rows_.bind(ramp_rows_unit);
}

void ProcessorCells::draw_marked(const MarkedTiles& tiles, const Progress& progress) {
  const PixelGrid& grid = mesh_->view().grid;
  // Looked at in the mesh's order, in which cells that follow one another share vertices.
  marks_.assign(mesh_->parts_end(), 0);
  const auto look_at = [&](Index part) {
    const std::array<ScreenVertex, 4> corners = mesh_->corners(part);
    if (std::ranges::any_of(corners, ScreenMesh::is_clipped)) return;  // its pieces are drawn
    const GridBox box = pixels_between(corners, grid);
    marks_[part] = tiles.meets(box.left, box.right, box.top, box.bottom) ? 1 : 0;
  };
  const std::span<const Index> cells = mesh_->cells();
  parallel_for(cells.size(), cells_per_share, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t i = begin; i < end; ++i) look_at(cells[i]);
  });
  for (std::size_t piece = mesh_->cells_of_scene(); piece < marks_.size(); ++piece) look_at(static_cast<Index>(piece));
  std::vector<Index> near;
  const auto draw = [&] {
    progress.check();
    fill(marked_, near);
    draw_slab(marked_, 0, near.size());
    near.clear();
  };
  for (const Index part : parts_) {
    if (marks_[part] != 0) near.push_back(part);
    if (near.size() == cells_per_slab) draw();
  }
  if (!near.empty()) draw();
}

}  // namespace atomesh::gl
