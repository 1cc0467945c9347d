#include "render/gl/processor_cells.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>

#include "core/error.h"
#include "core/parallel.h"
#include "render/gl/context.h"

namespace atomesh::gl {

namespace {

// A thread's share of a slab.
constexpr std::size_t cells_per_share = 4096;
static_assert(cells_per_slab % cells_per_share == 0);

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
  slab_numbers_.assign(keep(parts_.size()) ? slabs : 1, slabs);  // none
}

std::size_t ProcessorCells::triangles() const {
  return std::accumulate(triangles_.begin(), triangles_.end(), std::size_t{0});
}

bool ProcessorCells::make_slab(std::size_t begin) {
  const std::size_t n = begin / cells_per_slab;
  slabs_.resize(slab_numbers_.size());
  Slab& slab = slab_at(begin);
  std::size_t& number = slab_numbers_[static_cast<std::size_t>(&slab - slabs_.data())];
  if (number == n) return false;
  const std::size_t first = n * cells_per_slab;
  fill(slab, std::span(parts_).subspan(first, slab_end(begin, parts_.size()) - first));
  number = n;
  triangles_[n] = 0;
  for (const GLsizei count : slab.count) triangles_[n] += static_cast<std::size_t>(count) / 3;
  return true;
}

void ProcessorCells::fill(Slab& slab, std::span<const Index> parts) const {
  const std::size_t shares = (parts.size() + cells_per_share - 1) / cells_per_share;
  slab.vertices.reserve(slab_bytes, GL_STREAM_DRAW);
  slab.cells = parts.size();
  slab.first.resize(shares);
  slab.count.resize(shares);
  glBindBuffer(GL_ARRAY_BUFFER, slab.vertices.name());
  auto* vertices = static_cast<FaceVertex*>(glMapBufferRange(
      GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(parts.size() * vertices_per_cell * sizeof(FaceVertex)),
      GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT));
  if (vertices == nullptr) {
    check_errors("mapping vertices");
    throw UnavailableError("OpenGL: memory for vertices cannot be mapped");
  }
  parallel_for(parts.size(), cells_per_share, [&](std::size_t begin, std::size_t end) {
    const std::size_t first = begin * vertices_per_cell;
    std::size_t triangles = 0;
    for (std::size_t i = begin; i < end; ++i) {
      triangles += front_faces(mesh_->corners(parts[i]), mesh_->view().grid, vertices + first + 3 * triangles);
    }
    slab.first[begin / cells_per_share] = static_cast<GLint>(first);
    slab.count[begin / cells_per_share] = static_cast<GLsizei>(3 * triangles);
  });
  glUnmapBuffer(GL_ARRAY_BUFFER);
}

std::size_t ProcessorCells::draw(std::size_t begin, std::size_t most) {
  const std::size_t from = begin % cells_per_slab;
  const std::size_t count = std::min(most, slab_end(begin, parts_.size()) - begin);
  draw_cells(slab_at(begin), from, from + count);
  return count;
}

void ProcessorCells::draw_cells(const Slab& slab, std::size_t begin, std::size_t end) const {
  bind_vertices(slab.vertices);
  std::vector<GLint> first;
  std::vector<GLsizei> count;
  for (std::size_t share = begin / cells_per_share; share * cells_per_share < end; ++share) {
    // Of a part of a share so many of its triangles, whosever they are: parts that follow one another make the whole.
    const std::size_t before = share * cells_per_share;
    const std::size_t cells = std::min(cells_per_share, slab.cells - before);
    const std::size_t of_share = static_cast<std::size_t>(slab.count[share]) / 3;
    const std::size_t from = of_share * (std::max(begin, before) - before) / cells;
    const std::size_t to = of_share * (std::min(end, before + cells) - before) / cells;
    first.push_back(slab.first[share] + static_cast<GLint>(3 * from));
    count.push_back(static_cast<GLsizei>(3 * (to - from)));
  }
  if (!software_) {
    glMultiDrawArrays(GL_TRIANGLES, first.data(), count.data(), static_cast<GLsizei>(first.size()));
    return;
  }
  // Software sorts triangles into tiles before it fills them: in small portions they are still in the caches then, and
  // its threads have something to do sooner (a tenth of the time, llvmpipe).
  for (std::size_t i = 0; i < first.size(); ++i) {
    glDrawArrays(GL_TRIANGLES, first[i], count[i]);
    glFlush();
  }
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
      fill(marked_, std::span(near).subspan(drawn, count));
      draw_cells(marked_, 0, count);
      drawn += count;
    }
    near.erase(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(drawn));
  }
}

}  // namespace atomesh::gl
