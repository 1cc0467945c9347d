#include "render/gl/processor_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>

#include "core/error.h"
#include "core/parallel.h"
#include "render/gl/context.h"

namespace atomesh::gl {

namespace {

// A thread's share of a slab. Software sorts triangles into tiles before it fills them, on another core: so many are
// still in the caches then.
constexpr std::size_t cells_per_share = 1024;
static_assert(cells_per_slab % cells_per_share == 0);

// Going from one program to the other and back takes software about as long as ten cells: where more of the scene's
// cells do not suit ramps, none is drawn by them. (Whether a single cell is must not depend on the others: windows of a
// picture show the same.)
constexpr double most_exceptions = 0.25;
constexpr int most_rows_of_cell = 8;
// Room for two rows of every cell; nearly all have one.
constexpr std::size_t room_for_rows = 2;

// On the image plane: by what ramp_cells.vert interpolates across a triangle, a ray is then at most 1/1000 too long.
constexpr double widest_ramps = 0.063;

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
  order_->sort(camera, mesh_->cells(), unseen, order, order_stats);
  parts_ = mesh_->parts(order);
  cells_ = order.size();
  const std::size_t slabs = (parts_.size() + cells_per_slab - 1) / cells_per_slab;
  triangles_.assign(slabs, 0);
  ramp_triangles_.assign(slabs, 0);
  slab_numbers_.assign(keep_slabs() ? slabs : 1, slabs);  // none
  find_outside();
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
  return std::accumulate(triangles_.begin(), triangles_.end(), std::size_t{0});
}

std::size_t ProcessorCells::ramp_triangles() const {
  return std::accumulate(ramp_triangles_.begin(), ramp_triangles_.end(), std::size_t{0});
}

void ProcessorCells::use_no_ramps() {
  if (!ramps_) return;
  ramps_.reset();
  ramps_suit_ = false;
  std::fill(slab_numbers_.begin(), slab_numbers_.end(), triangles_.size());
}

void ProcessorCells::use_ramps(const ColorMap& color_map, double alpha_length) {
  if (ramps_ && ramps_map_ == color_map && ramps_alpha_length_ == alpha_length) return;
  ramps_ = std::make_unique<MapRamps>(scene_, color_map, alpha_length);
  ramps_suit_ =
      static_cast<double>(ramps_->too_deep()) <= most_exceptions * static_cast<double>(scene_.tetrahedra.size());
  ramps_map_ = color_map;
  ramps_alpha_length_ = alpha_length;
  std::fill(slab_numbers_.begin(), slab_numbers_.end(), triangles_.size());
  ramp_rows_.write(ramps_->rows());
  if (!ramp_rows_texture_) {
    GLuint name = 0;
    glGenTextures(1, &name);
    ramp_rows_texture_ = Handle<detail::destroy_texture>(name);
  }
  glActiveTexture(GL_TEXTURE0 + ramp_rows_unit);
  glBindTexture(GL_TEXTURE_BUFFER, ramp_rows_texture_.name());
  glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, ramp_rows_.name());
}

bool ProcessorCells::make_slab(std::size_t begin) {
  const std::size_t n = begin / cells_per_slab;
  slabs_.resize(slab_numbers_.size());
  Slab& slab = slab_at(begin);
  std::size_t& number = slab_numbers_[static_cast<std::size_t>(&slab - slabs_.data())];
  if (number == n) return false;
  const std::size_t first = n * cells_per_slab;
  fill(slab, std::span(parts_).subspan(first, slab_end(begin, parts_.size()) - first),
       ramps_suit_ ? ramps_.get() : nullptr);
  number = n;
  triangles_[n] = ramp_triangles_[n] = 0;
  for (const std::vector<Run>& runs : slab.runs) {
    for (const Run& run : runs) {
      triangles_[n] += static_cast<std::size_t>(run.count) / 3;
      if (run.ramps) ramp_triangles_[n] += static_cast<std::size_t>(run.count) / 3;
    }
  }
  return true;
}

class ProcessorCells::Share {
 public:
  // Room for the front faces of all of `parts`, once each.
  Share(const ScreenMesh& mesh, const MapRamps* ramps, std::span<const Index> parts, FaceVertex* vertices,
        std::uint8_t* rows)
      : mesh_(mesh), ramps_(ramps), parts_(parts), vertices_(vertices), rows_(rows) {
    const ScreenView& view = mesh.view();
    if (!view.perspective) return;
    const PixelGrid& grid = view.grid;
    widest_ = static_cast<std::int64_t>(widest_ramps / std::max(grid.dx, grid.dy) * subpixels);
  }

  // Runs of vertices, counted from `first` on.
  std::vector<Run> fill(GLint first) {
    std::vector<Run> runs;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const std::array<ScreenVertex, 4> corners = mesh_.corners(parts_[i]);
      FaceVertex* const faces = vertices_ + used_;
      const std::size_t count = 3 * front_faces(corners, mesh_.view().grid, faces);
      if (count == 0) continue;
      // those to come have theirs
      const std::size_t room = vertices_per_cell * (room_for_rows * parts_.size() - (parts_.size() - i - 1));
      const bool by_ramps = ramps_ != nullptr && draw_by_ramps(parts_[i], corners, {faces, count}, room);
      if (!by_ramps) used_ += count;
      const GLint end = first + static_cast<GLint>(used_);
      if (runs.empty() || runs.back().ramps != by_ramps) {
        const GLint begin = runs.empty() ? first : runs.back().first + runs.back().count;
        runs.push_back({begin, 0, by_ramps});
      }
      runs.back().count = end - runs.back().first;
    }
    return runs;
  }

 private:
  // The cell's front faces once for each of its rows.
  bool draw_by_ramps(Index part, const std::array<ScreenVertex, 4>& corners, std::span<FaceVertex> faces,
                     std::size_t room) {
    if (part >= mesh_.cells_of_scene() || !small(corners)) return false;
    if (longest_segment(corners, faces) > static_cast<double>(ramps_->longest(part))) return false;
    std::array<std::uint8_t, MapRamps::most_rows> rows;
    const int count = ramps_->rows_of(part, rows.data());
    if (count > most_rows_of_cell || used_ + static_cast<std::size_t>(count) * faces.size() > room) return false;
    if (count > 1 && !scalars_rise(faces)) std::reverse(rows.begin(), rows.begin() + count);
    for (int n = 0; n < count; ++n) {
      if (n > 0) std::copy(faces.begin(), faces.end(), vertices_ + used_);
      std::fill_n(rows_ + used_, faces.size(), rows[static_cast<std::size_t>(n)]);
      used_ += faces.size();
    }
    return true;
  }

  bool small(const std::array<ScreenVertex, 4>& corners) const {
    const auto [left, right] =
        std::minmax({corners[0].column, corners[1].column, corners[2].column, corners[3].column});
    const auto [top, bottom] = std::minmax({corners[0].row, corners[1].row, corners[2].row, corners[3].row});
    return std::max(right - left, bottom - top) <= widest_;
  }

  // Å; no ray has more of the cell.
  double longest_segment(const std::array<ScreenVertex, 4>& corners, std::span<const FaceVertex> faces) const {
    const double ray = mesh_.view().perspective ? longest_ray(corners) : 1.0;
    double longest = 0.0;
    for (std::size_t i = 0; i < faces.size(); i += 3) {
      // The ways to the planes behind are linear, and each is 0 at two of the corners: the least of them is greatest
      // where they are equal.
      double inverse = 0.0;
      float last_w = faces[i].w;
      for (std::size_t n = 0; n < 3; ++n) {
        const auto way = static_cast<double>(faces[i + n].behind[n]);
        if (way > 0.0) inverse += 1.0 / way;
        last_w = std::max(last_w, faces[i + n].w);
      }
      const double way = 1.0 / std::max(inverse, 1e-30);
      const auto w = static_cast<double>(last_w);
      if (!mesh_.view().perspective) {
        longest = std::max(longest, way);
      } else if (w + way < 0.0) {
        longest = std::max(longest, ray * way / (w * (w + way)));
      } else {
        return std::numeric_limits<double>::infinity();
      }
    }
    return longest;
  }

  // Å of the cell's rays for each of depth, times ScreenView::reference.
  double longest_ray(const std::array<ScreenVertex, 4>& corners) const {
    const PixelGrid& grid = mesh_.view().grid;
    double longest = 0.0;
    for (const ScreenVertex& corner : corners) {
      const double x = grid.x + grid.dx * (corner.column / double{subpixels} + grid.columns / 2 - 0.5);
      const double y = grid.y - grid.dy * (corner.row / double{subpixels} + grid.rows / 2 - 0.5);
      longest = std::max(longest, x * x + y * y);
    }
    return mesh_.view().reference * std::sqrt(1.0 + longest);
  }

  // Whether they do along rays; where it depends on the ray it hardly matters.
  bool scalars_rise(std::span<const FaceVertex> faces) const {
    const FaceVertex& at = faces.front();
    if (!mesh_.view().perspective) return at.slope > 0.0F;
    // s = -u / w; of u + slope · way and w + way that is, for small ways, -(slope w - u) / w²
    return at.slope * at.w < at.u;
  }

  const ScreenMesh& mesh_;
  const MapRamps* ramps_;
  std::span<const Index> parts_;
  FaceVertex* vertices_;
  std::uint8_t* rows_;
  std::size_t used_ = 0;                                            // vertices
  std::int64_t widest_ = std::numeric_limits<std::int64_t>::max();  // subpixels
};

void ProcessorCells::fill(Slab& slab, std::span<const Index> parts, const MapRamps* ramps) const {
  const std::size_t shares = (parts.size() + cells_per_share - 1) / cells_per_share;
  const std::size_t room = vertices_per_cell * (ramps != nullptr ? room_for_rows : 1);  // of a cell
  slab.vertices.reserve(cells_per_slab * room * sizeof(FaceVertex), GL_STREAM_DRAW);
  slab.cells = parts.size();
  slab.with_rows = ramps != nullptr;
  slab.runs.resize(shares);
  const std::size_t count = parts.size() * room;
  Mapped<FaceVertex> vertices(slab.vertices, count);
  std::optional<Mapped<std::uint8_t>> rows;
  if (ramps != nullptr) {
    slab.rows.reserve(cells_per_slab * room, GL_STREAM_DRAW);
    rows.emplace(slab.rows, count);
  }
  const auto fill_share = [&](std::size_t begin, std::size_t end) {
    const std::size_t first = begin * room;
    slab.runs[begin / cells_per_share] = Share(*mesh_, ramps, parts.subspan(begin, end - begin),
                                               vertices.data() + first, rows ? rows->data() + first : nullptr)
                                             .fill(static_cast<GLint>(first));
  };
  if (software_) {
    // Its own threads are at work on the slab before.
    for (std::size_t begin = 0; begin < parts.size(); begin += cells_per_share) {
      fill_share(begin, std::min(begin + cells_per_share, parts.size()));
    }
  } else {
    parallel_for(parts.size(), cells_per_share, fill_share);
  }
  if (rows) rows->unmap();
  vertices.unmap();
}

std::size_t ProcessorCells::draw(std::size_t begin, std::size_t most, const UseProgram& use) {
  const std::size_t from = begin % cells_per_slab;
  const std::size_t count = std::min(most, slab_end(begin, parts_.size()) - begin);
  draw_cells(slab_at(begin), from, from + count, use);
  return count;
}

void ProcessorCells::draw_cells(const Slab& slab, std::size_t begin, std::size_t end, const UseProgram& use) const {
  bind_vertices(slab.vertices);
  (slab.with_rows ? glEnableVertexAttribArray : glDisableVertexAttribArray)(2);
  if (slab.with_rows) {
    glBindBuffer(GL_ARRAY_BUFFER, slab.rows.name());
    glVertexAttribPointer(2, 1, GL_UNSIGNED_BYTE, GL_FALSE, 1, nullptr);
    glActiveTexture(GL_TEXTURE0 + ramp_rows_unit);
    glBindTexture(GL_TEXTURE_BUFFER, ramp_rows_texture_.name());
  }
  std::vector<GLint> first;
  std::vector<GLsizei> count;
  std::optional<bool> used;
  for (std::size_t share = begin / cells_per_share; share * cells_per_share < end; ++share) {
    // Of a part of a share so many of its triangles, whosever they are: parts that follow one another make the whole.
    const std::size_t before = share * cells_per_share;
    const std::size_t cells = std::min(cells_per_share, slab.cells - before);
    const std::vector<Run>& runs = slab.runs[share];
    if (runs.empty()) continue;
    const GLint start = runs.front().first;
    const auto triangles = static_cast<std::size_t>(runs.back().first + runs.back().count - start) / 3;
    const GLint from = start + static_cast<GLint>(3 * (triangles * (std::max(begin, before) - before) / cells));
    const GLint to = start + static_cast<GLint>(3 * (triangles * (std::min(end, before + cells) - before) / cells));
    for (const Run& run : runs) {
      const GLint low = std::max(run.first, from);
      const GLint high = std::min(run.first + run.count, to);
      if (low >= high) continue;
      if (used != run.ramps) use(run.ramps);
      used = run.ramps;
      if (software_) {
        glDrawArrays(GL_TRIANGLES, low, high - low);
      } else {
        first.push_back(low);
        count.push_back(high - low);
      }
    }
    // In small portions software's threads have something to do sooner.
    if (software_) glFlush();
  }
  if (!software_) glMultiDrawArrays(GL_TRIANGLES, first.data(), count.data(), static_cast<GLsizei>(first.size()));
}

void ProcessorCells::draw_marked(const MarkedTiles& tiles, const Progress& progress) {
  const PixelGrid& grid = mesh_->view().grid;
  std::vector<std::vector<Index>> found((parts_.size() + cells_per_slab - 1) / cells_per_slab);
  parallel_for(parts_.size(), cells_per_slab, [&](std::size_t begin, std::size_t end) {
    progress.check();
    std::vector<Index>& near = found[begin / cells_per_slab];
    for (std::size_t i = begin; i < end; ++i) {
      const GridBox box = pixels_between(mesh_->corners(parts_[i]), grid);
      if (tiles.meets(box.left, box.right, box.top, box.bottom)) near.push_back(parts_[i]);
    }
  });
  std::vector<Index> near;
  for (std::size_t n = 0; n < found.size(); ++n) {
    near.insert(near.end(), found[n].begin(), found[n].end());
    // A slab that is full, and the last one.
    std::size_t drawn = 0;
    while (near.size() - drawn >= cells_per_slab || (n + 1 == found.size() && near.size() > drawn)) {
      progress.check();
      const std::size_t count = std::min(cells_per_slab, near.size() - drawn);
      fill(marked_, std::span(near).subspan(drawn, count), nullptr);
      draw_cells(marked_, 0, count, [](bool) {});
      drawn += count;
    }
    near.erase(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(drawn));
  }
}

}  // namespace atomesh::gl
