// The triangles of single cells for drivers that draw by software: those that suit it as sums of ramps (map_ramps.h),
// once for each of their rows, the others as front faces.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "render/gl/front_faces.h"
#include "render/gl/map_ramps.h"
#include "render/gl/screen_mesh.h"

namespace atomesh::gl {

// Beside each FaceVertex of a sum of ramps: the same of all three of a triangle.
struct RampVertex {
  float row;      // of MapRamps
  float longest;  // no way (w) to where the ray leaves is longer but by rounding
};

class CellFaces {
 public:
  // Keeps references. `ramps`: none, and all cells are front faces. `either_side`: a sum of ramps may be drawn by its
  // cell's back faces where they are fewer (fewest_faces()): neither depths nor ends of rays are asked for.
  CellFaces(const ScreenMesh& mesh, const MapRamps* ramps, bool either_side);

  // Of a part of the mesh; `ramps` is written for sums of ramps alone. There is room for most_vertices.
  struct Written {
    std::size_t vertices = 0;
    CellKind kind = CellKind::segment;
  };
  static constexpr int most_rows = 8;
  static constexpr std::size_t most_vertices = 3 * most_faces * most_rows;
  Written write(Index part, FaceVertex* vertices, RampVertex* ramps) const;

 private:
  std::optional<Written> write_ramps(Index part, const std::array<ScreenVertex, 4>& corners, FaceVertex* vertices,
                                     RampVertex* ramps) const;
  bool small(const std::array<ScreenVertex, 4>& corners) const;
  double longest_segment(std::span<const FaceVertex, 3> face, double way, bool mirrored) const;
  double longest_ray(const std::array<ScreenVertex, 4>& corners) const;
  bool scalars_rise(const FaceVertex& at) const;

  const ScreenMesh& mesh_;
  const MapRamps* ramps_;
  bool either_side_;
  bool perspective_;
  std::int64_t widest_ = std::numeric_limits<std::int64_t>::max();  // subpixels
};

}  // namespace atomesh::gl
