// Scenes that are numerically hard for a renderer of volumes, each with what is known about it: how far every ray runs
// inside the matter. What is rendered of them is the test's and the bench's affair.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/material.h"

namespace atomesh {

// The points p with dot(normal, p) <= offset.
struct HalfSpace {
  Vec3 normal;
  double offset;
};
using ConvexBody = std::vector<HalfSpace>;

// Convex bodies, less the holes in them. Bodies that overlap count each; holes lie inside one body, side by side.
struct Solid {
  std::vector<ConvexBody> bodies;
  std::vector<ConvexBody> holes;

  // Å of the ray inside, from its origin on.
  double chord(const Ray& ray) const;
  // Depth of the nearest crossing of a boundary in front of the origin, infinity without one. (Bodies that share a
  // boundary, or overlap, have no nearest one: their inner crossings are found too.)
  double first_crossing(const Ray& ray) const;
};

ConvexBody box_body(const Vec3& low, const Vec3& high);
// A positively oriented tetrahedron, or one turned inside out, as the set of its points.
ConvexBody tetrahedron_body(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
// Bounded by the planes of these triangles, whose normals point outward.
ConvexBody convex_hull_body(std::span<const Triangle> outward, std::span<const Vec3> vertices);

struct HardView {
  std::string name;
  Camera camera;
  // Rays run inside cells a few hundred thousandths of a pixel wide, between whose sides values differ by all there
  // is. Floats know a place in a tile of 32 pixels to 2⁻¹⁹ pixel, so that they cannot tell which value holds there; how
  // far the ray runs inside they must.
  bool values_unresolved = false;
};

struct HardCase {
  std::string name;
  std::string group;  // what is hard about it: the heading it is reported under
  // Every vertex an atom with a random defect value, for who wants values that vary; the surface is the mesh's.
  Material material;
  Solid solid;
  std::vector<HardView> views;
  std::vector<double> extinctions;  // 1/Å at which a constant density is to be looked at
  // What can be held against a picture of it.
  enum class Known {
    values,   // every ray's length inside, and of varying values what the judge says
    lengths,  // cells that overlap begin at one face, and which of them comes first nobody has laid down
    nothing,  // cells are inside out, which no stage of preprocessing hands on: nothing terrible may happen
  };
  Known known = Known::values;
};

// Points → the tetrahedra of their Delaunay triangulation.
using DelaunayMesher = std::function<std::vector<Tetrahedron>(std::span<const Vec3>)>;

// The catalogue: rays on a perfect lattice, slivers, offsets, extinctions, one cell and too many, holes, the eye on a
// vertex, level
// with its cell's centroid, rings of visibility, overlapping cells, cells behind the eye, needles.
std::vector<HardCase> hard_cases(const DelaunayMesher& delaunay);

}  // namespace atomesh
