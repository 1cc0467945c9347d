#include "render/gl/screen_mesh.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "render/gl/clip_cell.h"

namespace atomesh::gl {

namespace {

constexpr std::size_t vertices_per_range = 16384;
constexpr std::size_t cells_per_range = 16384;
constexpr double near_radii = 1.0 / 2000.0;
constexpr int guard_margin = 64;

// Sides of the guard, and what is too near, as bits.
enum Side : std::int32_t { too_near = 1, left = 2, right = 4, above = 8, below = 16 };

}  // namespace

Vec3 before_eye(const Vec3& p, const Vec3& offset, const Camera& camera) {
  const Vec3 q = p + offset;
  return {glm::dot(q, camera.right), glm::dot(q, camera.up), glm::dot(q, camera.forward)};
}

PixelGrid pixel_grid(const Camera& camera, const PixelWindow& window, const PixelLattice& lattice) {
  const LatticeGrid pixels(lattice, window);
  PixelGrid grid;
  if (pixels.empty()) return grid;
  grid.x = camera.x_of(pixels.column(0));
  grid.y = camera.y_of(pixels.row(0));
  grid.dx = camera.pixel * lattice.column_stride;
  grid.dy = camera.pixel * lattice.row_stride;
  grid.columns = pixels.columns();
  grid.rows = pixels.rows();
  return grid;
}

ScreenView screen_view(const Scene& scene, const Camera& camera, const PixelGrid& grid, int guard) {
  const double radius = std::max(0.5 * scene.bounds.diagonal(), 1e-30);
  const double depth = glm::dot(scene.bounds.center() - camera.eye, camera.forward);
  ScreenView view;
  view.perspective = camera.projection == Projection::perspective;
  view.reference = view.perspective ? std::max(depth, 0.25 * radius) : depth;
  view.near = view.perspective ? near_radii * radius : 0.0;
  view.grid = grid;
  view.guard = guard;
  return view;
}

glm::dvec2 subpixel_place(const ScreenView& view, const Vec3& p) {
  const PixelGrid& grid = view.grid;
  const double scale = view.perspective ? 1.0 / p.z : 1.0;
  return {((p.x * scale - grid.x) / grid.dx + 0.5 - grid.columns / 2) * subpixels,
          ((grid.y - p.y * scale) / grid.dy + 0.5 - grid.rows / 2) * subpixels};
}

double screen_w(const ScreenView& view, const Vec3& p) {
  return view.perspective ? -view.reference * (1.0 / p.z) : p.z - view.reference;
}

ScreenMesh::ScreenMesh(const Scene& scene, const Camera& camera, const PixelGrid& grid,
                       const cell_projection::MapIntervals& map, const Progress& progress)
    : scene_(scene),
      // The smaller the guard is, the less do large triangles cost of what floats hold.
      view_(screen_view(scene, camera, grid,
                        std::min(guard_pixels, std::max(grid.columns, grid.rows) / 2 + guard_margin))) {
  if (grid.columns == 0 || grid.rows == 0 || scene.tetrahedra.empty()) return;
  project(camera);
  find_cells(map, progress);
  clip_cells(camera);
}

ScreenVertex ScreenMesh::on_screen(const Vec3& p, float scalar) const {
  const glm::dvec2 place = subpixel_place(view_, p);
  const double column = place.x;
  const double row = place.y;
  ScreenVertex vertex;
  vertex.w = static_cast<float>(screen_w(view_, p));
  vertex.u = view_.perspective ? -scalar * vertex.w : scalar;
  // Beyond the guard by less than a subpixel is on it.
  const std::int32_t guard = view_.guard * subpixels;
  const double most = guard + 0.75;
  // Where something behind the eye is on the image plane says nothing about its side.
  const std::int32_t sides = p.z < view_.near ? too_near
                                              : (column < -most ? left : 0) | (column > most ? right : 0) |
                                                    (row < -most ? above : 0) | (row > most ? below : 0);
  if (sides != 0) {
    vertex.column = clipped;
    vertex.row = sides;
    return vertex;
  }
  vertex.column = std::clamp(static_cast<std::int32_t>(std::lround(column)), -guard, guard);
  vertex.row = std::clamp(static_cast<std::int32_t>(std::lround(row)), -guard, guard);
  return vertex;
}

void ScreenMesh::project(const Camera& camera) {
  vertices_.resize(scene_.vertices.size());
  const Vec3 offset = scene_.center - camera.eye;
  parallel_for(vertices_.size(), vertices_per_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      vertices_[v] = on_screen(before_eye(Vec3(scene_.vertices[v]), offset, camera), scene_.scalars[v]);
    }
  });
  float first = std::numeric_limits<float>::max();
  float last = std::numeric_limits<float>::lowest();
  for (const ScreenVertex& vertex : vertices_) {
    if (vertex.column == clipped && (vertex.row & too_near) != 0) {
      first = std::min(first, static_cast<float>(view_.perspective ? -view_.reference / view_.near : -view_.reference));
      continue;
    }
    first = std::min(first, vertex.w);
    last = std::max(last, vertex.w);
  }
  view_.first_w = first;
  view_.last_w = last > first ? last : first + 1.0F;
}

void ScreenMesh::find_cells(const cell_projection::MapIntervals& map, const Progress& progress) {
  const std::size_t count = scene_.tetrahedra.size();
  const bool any_transparent = map.any_transparent();
  const auto transparent = [&](const Tetrahedron& t) {
    const auto [a, b, c, d] =
        std::array{scene_.scalars[t[0]], scene_.scalars[t[1]], scene_.scalars[t[2]], scene_.scalars[t[3]]};
    return map.transparent(std::min({a, b, c, d}), std::max({a, b, c, d}));
  };
  struct Found {
    std::vector<Index> cells;
    std::vector<Clipped> clipped;
  };
  std::vector<Found> found((count + cells_per_range - 1) / cells_per_range);
  parallel_for(count, cells_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    Found& part = found[begin / cells_per_range];
    part.cells.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      const auto cell = static_cast<Index>(i);
      const std::array<ScreenVertex, 4> c = corners(cell);
      const bool whole = std::none_of(c.begin(), c.end(), [](const ScreenVertex& v) { return v.column == clipped; });
      if (whole) {
        if (!meets_pixel(c, view_.grid)) continue;
      } else {
        std::int32_t sides = ~0;
        for (const ScreenVertex& v : c) sides &= v.column == clipped ? v.row : 0;
        if (sides != 0) continue;
      }
      if (any_transparent && transparent(scene_.tetrahedra[i])) continue;
      part.cells.push_back(cell);
      if (!whole) part.clipped.push_back({cell, 0, 0});
    }
  });
  std::size_t total = 0;
  for (const Found& part : found) total += part.cells.size();
  cells_.reserve(total);
  for (const Found& part : found) {
    cells_.insert(cells_.end(), part.cells.begin(), part.cells.end());
    clipped_.insert(clipped_.end(), part.clipped.begin(), part.clipped.end());
  }
}

void ScreenMesh::clip_cells(const Camera& camera) {
  if (clipped_.empty()) return;
  const PixelGrid& grid = view_.grid;
  const Vec3 offset = scene_.center - camera.eye;
  // Image-plane coordinates of the guard's sides.
  const double x_low = grid.x + (grid.columns / 2 - 0.5 - view_.guard) * grid.dx;
  const double x_high = grid.x + (grid.columns / 2 - 0.5 + view_.guard) * grid.dx;
  const double y_high = grid.y - (grid.rows / 2 - 0.5 - view_.guard) * grid.dy;
  const double y_low = grid.y - (grid.rows / 2 - 0.5 + view_.guard) * grid.dy;
  const auto side = [&](const Vec3& normal, double at) {
    return view_.perspective ? HalfSpace{{normal.x, normal.y, -at}, 0.0} : HalfSpace{normal, at};
  };
  const std::array<HalfSpace, 5> spaces{{{{0, 0, 1}, view_.near},
                                         side({1, 0, 0}, x_low),
                                         side({-1, 0, 0}, -x_high),
                                         side({0, 1, 0}, y_low),
                                         side({0, -1, 0}, -y_high)}};
  std::vector<std::vector<std::array<ScreenVertex, 4>>> found(clipped_.size());
  parallel_for(clipped_.size(), 64, [&](std::size_t begin, std::size_t end) {
    std::vector<CellCorners> pieces;
    for (std::size_t n = begin; n < end; ++n) {
      const Tetrahedron& t = scene_.tetrahedra[clipped_[n].cell];
      CellCorners cell;
      for (std::size_t k = 0; k < 4; ++k) {
        cell[k] = {before_eye(Vec3(scene_.vertices[t[k]]), offset, camera), scene_.scalars[t[k]]};
      }
      pieces.clear();
      clip_cell(cell, spaces, pieces);
      const auto depth = [](const CellCorners& c) { return c[0].p.z + c[1].p.z + c[2].p.z + c[3].p.z; };
      std::sort(pieces.begin(), pieces.end(),
                [&](const CellCorners& a, const CellCorners& b) { return depth(a) < depth(b); });
      for (CellCorners& piece : pieces) {
        std::array<ScreenVertex, 4> corners;
        bool inside = true;
        for (std::size_t k = 0; k < 4; ++k) {
          piece[k].p.z = std::max(piece[k].p.z, view_.near);
          corners[k] = on_screen(piece[k].p, static_cast<float>(piece[k].scalar));
          inside = inside && corners[k].column != clipped;
        }
        if (inside && meets_pixel(corners, grid)) found[n].push_back(corners);
      }
    }
  });
  for (std::size_t n = 0; n < clipped_.size(); ++n) {
    clipped_[n].first = static_cast<std::uint32_t>(pieces_.size());
    clipped_[n].count = static_cast<std::uint32_t>(found[n].size());
    pieces_.insert(pieces_.end(), found[n].begin(), found[n].end());
  }
}

std::vector<Index> ScreenMesh::parts(std::span<const Index> order) const {
  std::vector<Index> list;
  list.reserve(order.size() + pieces_.size());
  for (const Index cell : order) {
    const auto at = std::lower_bound(clipped_.begin(), clipped_.end(), cell,
                                     [](const Clipped& c, Index wanted) { return c.cell < wanted; });
    if (at == clipped_.end() || at->cell != cell) {
      list.push_back(cell);
      continue;
    }
    for (std::uint32_t n = 0; n < at->count; ++n) {
      list.push_back(static_cast<Index>(scene_.tetrahedra.size() + at->first + n));
    }
  }
  return list;
}

}  // namespace atomesh::gl
