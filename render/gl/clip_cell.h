// A tetrahedron cut down to what lies before the eye and within some pixels of the picture.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/geometry.h"

namespace atomesh::gl {

struct CellCorner {
  Vec3 p;  // along right, up and forward about the eye, Å
  double scalar;
};
using CellCorners = std::array<CellCorner, 4>;

// The half-space normal · p >= distance.
struct HalfSpace {
  Vec3 normal;
  double distance;
};

// Appends tetrahedra, oriented like `cell`, that fill what lies in all half-spaces. Where an edge is cut depends on the
// edge alone, so that cells that share it go on doing so.
void clip_cell(const CellCorners& cell, std::span<const HalfSpace> spaces, std::vector<CellCorners>& pieces);

}  // namespace atomesh::gl
