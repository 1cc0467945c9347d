// Cells as the triangles OpenGL draws of them: every face that is seen from the front, once. A fragment of one is the
// whole segment of a ray in its cell: it enters where the triangle is, and leaves where the nearest of the cell's other
// faces is. (Shirley & Tuchman 1990, "A polygonal approximation to direct scalar volume rendering", cut the outline of
// a cell into 3.5 triangles on average, and need a vertex more where two edges cross; these are 2, and none.)
#pragma once

#include <span>

#include "render/gl/screen_mesh.h"

namespace atomesh::gl {

// Of a front face of a cell; depths and scalars as ScreenVertex has them. All of it is linear on the screen.
struct FaceVertex {
  float column, row;  // pixels from the grid's middle, down; exact
  float w;            // where the ray enters
  float u;
  // How far behind lies the plane of each of the cell's three other faces (w), each opposite one of the triangle's
  // corners; the nearest is where the ray leaves. Zero at the two corners it has in common with the triangle. Of faces
  // that are not seen from behind: not_behind at all three.
  float behind[3];
  float slope;  // where the ray leaves, u is greater by slope times the way (w)
};
static_assert(sizeof(FaceVertex) == 32);
inline constexpr float not_behind = 1e30F;

inline constexpr std::size_t most_faces = 3;  // of a cell

// Writes the front faces of a cell, three vertices each, and returns how many there are: up to most_faces, none of a
// cell without volume or area, or that meets no pixel's centre. Which faces these are is decided by the signs of
// exact integers; it does not matter which way round the cell is (moved vertices may turn it over).
std::size_t front_faces(const std::array<ScreenVertex, 4>& corners, const PixelGrid& grid, FaceVertex* vertices);

// For what of a segment does not depend on which of its ends is nearer: the faces of that side of the cell, front or
// back, that has fewer. Those of the back are the front faces of the mirrored cell, which has every w, and u of
// perspective projection, with the other sign: what is linear along a ray remains so, and so do scalars.
struct FewestFaces {
  std::size_t count = 0;  // up to 2
  bool mirrored = false;
};
FewestFaces fewest_faces(const std::array<ScreenVertex, 4>& corners, const PixelGrid& grid, bool perspective,
                         FaceVertex* vertices);

}  // namespace atomesh::gl
