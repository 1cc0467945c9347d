#include "render/gl/cell_faces.h"

#include <algorithm>
#include <cmath>

namespace atomesh::gl {

namespace {

// On the image plane: by what ramp_cells.vert interpolates across a triangle, a ray is then at most 1/1000 too long.
constexpr double widest_ramps = 0.063;

// To the planes behind a face. The ways to them are linear, and each is 0 at two of the corners: the least of them is
// greatest where they are equal.
double longest_way(std::span<const FaceVertex, 3> face) {
  double inverse = 0.0;
  for (std::size_t n = 0; n < 3; ++n) {
    const auto way = static_cast<double>(face[n].behind[n]);
    if (way > 0.0) inverse += 1.0 / way;
  }
  return 1.0 / std::max(inverse, 1e-30);
}

}  // namespace

CellFaces::CellFaces(const ScreenMesh& mesh, const MapRamps* ramps, bool either_side)
    : mesh_(mesh), ramps_(ramps), either_side_(either_side), perspective_(mesh.view().perspective) {
  if (!perspective_) return;
  const PixelGrid& grid = mesh.view().grid;
  widest_ = static_cast<std::int64_t>(widest_ramps / std::max(grid.dx, grid.dy) * subpixels);
}

CellFaces::Written CellFaces::write(Index part, FaceVertex* vertices, RampVertex* ramps) const {
  const std::array<ScreenVertex, 4> corners = mesh_.corners(part);
  if (ramps_ != nullptr && part < mesh_.cells_of_scene() && small(corners)) {
    const std::optional<Written> written = write_ramps(part, corners, vertices, ramps);
    if (written) return *written;
  }
  return {3 * front_faces(corners, mesh_.view().grid, vertices), CellKind::segment};
}

// None where the cell does not suit ramps.
std::optional<CellFaces::Written> CellFaces::write_ramps(Index part, const std::array<ScreenVertex, 4>& corners,
                                                         FaceVertex* vertices, RampVertex* ramps) const {
  const PixelGrid& grid = mesh_.view().grid;
  FewestFaces faces;
  if (either_side_) {
    faces = fewest_faces(corners, grid, perspective_, vertices);
  } else {
    faces.count = front_faces(corners, grid, vertices);
  }
  const std::span<const FaceVertex> once(vertices, 3 * faces.count);
  if (once.empty()) return Written();
  double longest = 0.0;
  for (std::size_t i = 0; i < once.size(); i += 3) {
    const std::span<const FaceVertex, 3> face = once.subspan(i).first<3>();
    const double way = longest_way(face);
    longest = std::max(longest, longest_segment(face, way, faces.mirrored));
    for (std::size_t n = i; n < i + 3; ++n) ramps[n].longest = static_cast<float>(way);
  }
  if (perspective_) longest *= longest_ray(corners);
  if (longest > static_cast<double>(ramps_->longest(part))) return std::nullopt;
  std::array<std::uint8_t, MapRamps::most_rows> rows;
  const int count = ramps_->rows_of(part, rows.data());
  if (count > most_rows) return std::nullopt;
  if (count > 1 && scalars_rise(once.front()) == faces.mirrored) std::reverse(rows.begin(), rows.begin() + count);
  for (int n = 0; n < count; ++n) {
    const std::size_t at = static_cast<std::size_t>(n) * once.size();
    for (std::size_t i = 0; i < once.size(); ++i) {
      if (n > 0) vertices[at + i] = once[i];
      ramps[at + i] = {static_cast<float>(rows[static_cast<std::size_t>(n)]), ramps[i].longest};
    }
  }
  return Written{static_cast<std::size_t>(count) * once.size(), ramps_->kind_of(part)};
}

bool CellFaces::small(const std::array<ScreenVertex, 4>& corners) const {
  const auto [left, right] = std::minmax({corners[0].column, corners[1].column, corners[2].column, corners[3].column});
  const auto [top, bottom] = std::minmax({corners[0].row, corners[1].row, corners[2].row, corners[3].row});
  return std::max(right - left, bottom - top) <= widest_;
}

// In Å over the cell's longest ray (longest_ray()), or in Å: no ray has more of the cell behind the face.
double CellFaces::longest_segment(std::span<const FaceVertex, 3> face, double way, bool mirrored) const {
  if (!perspective_) return way;
  const auto w = static_cast<double>(std::min({std::abs(face[0].w), std::abs(face[1].w), std::abs(face[2].w)}));
  const double other_w = mirrored ? w + way : w - way;
  return other_w > 0.0 ? way / (w * other_w) : std::numeric_limits<double>::infinity();
}

// Å of the cell's rays for each of depth, times ScreenView::reference.
double CellFaces::longest_ray(const std::array<ScreenVertex, 4>& corners) const {
  const PixelGrid& grid = mesh_.view().grid;
  double longest = 0.0;
  for (const ScreenVertex& corner : corners) {
    const double x = grid.x + grid.dx * (corner.column / double{subpixels} + grid.columns / 2 - 0.5);
    const double y = grid.y - grid.dy * (corner.row / double{subpixels} + grid.rows / 2 - 0.5);
    longest = std::max(longest, x * x + y * y);
  }
  return mesh_.view().reference * std::sqrt(1.0 + longest);
}

// Whether they do from the face to those behind it; where it depends on the ray it hardly matters.
bool CellFaces::scalars_rise(const FaceVertex& at) const {
  if (!perspective_) return at.slope > 0.0F;
  // s = -u / w; of u + slope · way and w + way that is, for small ways, -(slope w - u) / w²
  return at.slope * at.w < at.u;
}

}  // namespace atomesh::gl
