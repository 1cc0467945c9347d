#include "render/cpu/surface_layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "render/cpu/triangle_raster.h"

namespace atomesh::cell_projection {

namespace {

// Whether the triangle turns its inner side to every ray, by far more than rounding: the determinant is the sum of what
// the raster finds on the sides of its edges times the corners' depths, and wrong by some 1e-15 of the corners'
// distances.
bool turned_away(const ProjectedVertices& vertices, const Triangle& corners, bool perspective) {
  std::array<Vec3, 3> p{};
  for (std::size_t k = 0; k < 3; ++k) {
    const ProjectedVertex& v = vertices[corners[k]];
    if (v.behind()) return false;
    p[k] = Vec3(v.x, v.y, perspective ? v.z : 1.0);
  }
  const double size = glm::dot(p[0], p[0]) + glm::dot(p[1], p[1]) + glm::dot(p[2], p[2]);
  return glm::dot(p[0], glm::cross(p[1], p[2])) < -1e-12 * size * std::sqrt(size);
}

}  // namespace

void TileLayers::clear() {
  added_.clear();
  hits_.clear();
  begin_.fill(0);
}

void TileLayers::add(int column, int row, const LayerHit& hit) {
  const int block = row / block_side * blocks_per_side + column / block_side;
  const int lane = row % block_side * block_side + column % block_side;
  const auto ray = static_cast<std::uint32_t>(block * block_pixels + lane);
  added_.push_back({hit, ray});
  ++begin_[ray];
}

void TileLayers::sort() {
  hits_.resize(added_.size());
  std::uint32_t place = 0;
  for (std::uint32_t& at : begin_) place += std::exchange(at, place);
  auto end = begin_;  // of what is under each ray so far
  for (const Added& added : added_) {
    std::uint32_t at = end[added.ray]++;
    for (; at > begin_[added.ray] && hits_[at - 1].depth > added.hit.depth; --at) hits_[at] = hits_[at - 1];
    hits_[at] = added.hit;
  }
}

SurfaceLayers::SurfaceLayers(const Scene& scene, const Camera& camera, const Parameters& parameters, const View& view,
                             const ProjectedVertices& vertices, const TileGrid& grid, bool exits,
                             const Progress& progress)
    : scene_(scene),
      camera_(camera),
      view_(view),
      vertices_(vertices),
      shader_(scene, camera, parameters),
      margin_(0x1p-20 * scene.bounds.diagonal()),
      grid_(grid),
      exits_(exits) {
  const bool perspective = camera.projection == Projection::perspective;
  const int left = grid.first_column * tile_side;
  const int top = grid.first_row * tile_side;
  const int width = grid.columns * tile_side;
  const int height = grid.rows * tile_side;
  const auto box = [&](std::size_t t) {
    const Triangle& corners = scene.surface[t];
    if (!exits && turned_away(vertices, corners, perspective)) return PixelBox{};
    const PixelBox whole = pixel_box(vertices, corners, camera.width, camera.height);
    return PixelBox{std::max(whole.first_column - left, 0), std::min(whole.last_column - left, width - 1),
                    std::max(whole.first_row - top, 0), std::min(whole.last_row - top, height - 1)};
  };
  bins_ = bin_to_tiles(scene.surface.size(), width, height, tile_side, box, progress);
}

void SurfaceLayers::find(std::size_t tile, const PixelLattice& lattice, TileLayers& layers) const {
  layers.clear();
  const int left = grid_.pixel_column(tile);
  const int top = grid_.pixel_row(tile);
  const PixelBox pixels{left, left + tile_side - 1, top, top + tile_side - 1};
  const LatticeGrid rays(lattice, left, left + tile_side, top, top + tile_side);
  cross_triangles(
      scene_.surface, camera_, vertices_, bins_.of(tile), pixels, lattice,
      [&](int column, int row, Index triangle, const TriangleRaster& raster, const Crossing& crossing) {
        if (!crossing.entering) {
          if (exits_) layers.add(rays.i_of(column), rays.j_of(row), {crossing.depth, u_of(crossing.depth), no_index});
          return;
        }
        const double beside = raster.plane_depth(view_.left + view_.pixel * column, view_.top - view_.pixel * row);
        layers.add(rays.i_of(column), rays.j_of(row), {crossing.depth, place(crossing.depth, beside), triangle});
      });
  layers.sort();
}

float SurfaceLayers::place(double depth, double beside) const {
  const double nearer = (beside < depth ? beside : depth) - margin_;
  const double before = std::max(nearer, 0.5 * depth);
  return u_of(before);
}

float SurfaceLayers::u_of(double depth) const {
  return static_cast<float>(view_.perspective ? 1.0 - view_.reference / depth : depth - view_.reference);
}

void SurfaceLayers::shade(const void* layers, const LayerHit& hit, int column, int row, float* rgb) {
  const SurfaceLayers& self = *static_cast<const SurfaceLayers*>(layers);
  const Camera& camera = self.camera_;
  const Vec3f color = self.shader_.shade(hit.triangle, camera.x_of(column), camera.y_of(row), hit.depth, false);
  for (int k = 0; k < 3; ++k) rgb[k] = color[k];
}

}  // namespace atomesh::cell_projection
