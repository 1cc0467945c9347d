// Some tetrahedra of a mesh taken together, to be filled anew from one of their vertices.
#pragma once

#include <span>
#include <vector>

#include "preprocess/star_mesh.h"

namespace atomesh {

// Volume over the cube of the longest edge, scaled to 1 for the regular tetrahedron.
double shape_of(double six_volumes, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

class Cavity {
 public:
  // `kept` is 1 for the vertices whose tetrahedra no cavity may take in.
  Cavity(const StarMesh& mesh, const std::vector<std::uint8_t>& kept) : mesh_(&mesh), kept_(&kept) {}

  // Begins with the star's tetrahedra and takes in what lies behind every triangle of the border that `apex` does not
  // see from within, or sees so obliquely that its tetrahedron would be worse than `floor`, until it sees them all.
  // Returns the worst shape of the tetrahedra the apex makes with the border; 0 when the cavity grows too large, meets
  // the surface or a tetrahedron that is kept, swallows another vertex than the star's, or when a shape is found that
  // is no better than `beat`. The floor must be at least 1e-9: then every sign is right, for rounding changes a shape
  // by less than 1e-14.
  double grow(const Star& star, Index apex, double floor, double beat);

  std::span<const Index> cells() const { return cells_; }      // tetrahedra
  std::span<const Corner> faces() const { return faces_; }     // of them, the border
  std::span<const Index> border() const { return border_; }    // vertices of the faces
  std::span<const Tetrahedron> fill() const { return fill_; }  // from the apex, one for each face without it

 private:
  // Of the tetrahedron that the apex makes with a face from within; negative when it is on the other side.
  double shape(Corner face, Index apex) const;
  bool swallows(Index vertex);

  const StarMesh* mesh_;
  const std::vector<std::uint8_t>* kept_;
  std::vector<Index> cells_;
  std::vector<Corner> faces_;
  std::vector<Tetrahedron> fill_;
  std::vector<Index> border_;  // vertices of the faces
};

}  // namespace atomesh
