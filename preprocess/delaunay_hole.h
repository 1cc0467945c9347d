// The Delaunay tetrahedra that fill the hole a vertex leaves.
#pragma once

#include <vector>

#include "preprocess/star_mesh.h"

namespace atomesh {

// How tetrahedra are cut where more than four vertices lie on one empty sphere, to 1e-7 of its radius.
//   push_last:  as if the sphere's last vertex (in the order of coordinates), then the one before it… were a little
//               further out (Devillers & Teillaud 2003, INRIA RR-4870, as in CGAL)
//   pull_first: as if the first, then the second… were a little further in, as remove_slivers() does
//   to_the_ulp: as the coordinates say exactly, push_last where they say nothing: what CGAL makes of rounded crystals
enum class SphereTies { push_last, pull_first, to_the_ulp };

class DelaunayHole {
 public:
  // False when the hole defies the rule: the fill does not end at its triangles, or would be flat, inverted or not
  // Delaunay (beyond half of delaunay_tolerance) against each other and what lies behind the triangles.
  bool fill(const StarMesh& mesh, const Star& star, SphereTies ties);
  const std::vector<Tetrahedron>& tetrahedra() const { return fill_; }

 private:
  // Of a triangle (places in the link, outward): the link vertex behind it whose sphere with it is empty, or no_index.
  Index apex_behind(const Triangle& triangle, SphereTies ties);
  bool inside_perturbed(const Tetrahedron& tet, Index place, SphereTies ties) const;
  const Vec3& position(Index place) const { return mesh_->position(star_->link[place]); }
  int side(Index a, Index b, Index c, Index d) const;
  bool fills_the_star() const;
  bool spheres_are_empty() const;

  const StarMesh* mesh_ = nullptr;
  const Star* star_ = nullptr;
  std::vector<Vec3> points_;  // of the link, about the star's vertex
  std::vector<Index> rank_;   // of the link, in the order of coordinates
  std::vector<Triangle> front_;
  std::vector<std::uint64_t> front_name_;  // of each, to find it by
  std::vector<double> reach_;              // of each link vertex, along the pencil of spheres through a triangle
  std::vector<Index> order_;
  std::vector<Tetrahedron> fill_;
};

}  // namespace atomesh
