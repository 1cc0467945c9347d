// The crystal's pattern as it lies in one patch of a sample: what has to be looked at before a polytope is stamped.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "preprocess/lattice_sites.h"
#include "preprocess/lattice_template.h"

namespace atomesh {

// The corners of a polytope, or those of them that are occupied, cut into tetrahedra. All indices into its corners.
struct PatternCut {
  std::vector<std::array<std::uint8_t, 4>> tetrahedra;  // none where the corners lie in one plane
  std::vector<std::array<std::uint8_t, 3>> faces;       // the outside, counter-clockwise seen from there
  std::array<std::uint8_t, 4> frame{};                  // the fattest tetrahedron: its sphere is the polytope's
};

// The polytope behind a face of a whole one: number `polytope`, anchored `cell` cells away.
struct PatternNeighbour {
  Index polytope;
  std::array<int, 3> cell;
};

struct PatternPolytope {
  std::vector<SiteOffset> corners;  // from the anchor, the cell of corners[0]
  PatternCut whole;
  std::vector<PatternNeighbour> neighbours;  // of each face of `whole`
  Vec3 center{0.0};                          // Å, from the origin of the anchor
  Vec3 center_fraction{0.0};                 // the same in cells
  double radius = 0.0;
  // Other sites so near the sphere that atoms in place might lie in it.
  std::vector<SiteOffset> close;

  // Corners off their sites by up to 1 Å, to first order, leave the sphere of the frame by up to `steep` Å, and are
  // `spread` Å off it where they are exactly on their sites.
  double steep = 0.0;
  double spread = 0.0;
  double gap = 0.0;  // Å from the sphere to the nearest other site, which is outside
};

// A basis atom of cell (0, 0, 0) is corner number `corner` of polytope `polytope` anchored at `cell`.
struct PatternCorner {
  Index polytope;
  std::array<int, 3> cell;
  std::uint8_t corner;
};

// Distances in terms of PatchPattern::in_place: how far the sphere of a polytope whose atoms are in place may be from
// the pattern's, and how near the sphere a site must be to count as close. An atom in place on a site that is not close
// is then outside by at least in_place (5 - 3 - 1 = 1).
inline constexpr double sphere_slack = 3.0;
inline constexpr double close_slack = 5.0;

class PatchPattern {
 public:
  // Polytopes are cut along `direction`.
  PatchPattern(const LatticeTemplate& pattern, const LatticePatch& patch, const Vec3& direction);

  // False where the patch is so distorted that the pattern does not hold together.
  bool usable() const { return usable_; }
  // Å within which an atom is in place: well below the distances that decide which polytopes there are and how they are
  // cut.
  double in_place() const { return in_place_; }
  // Å by which atoms may be off their sites so that a polytope of theirs, if nothing foreign is near, is certain to be
  // a Delaunay cell: no corner off the sphere by more than `tolerance` × its radius, no other site in it, the radius up
  // to `largest_radius`. 0 where that is never certain.
  double certain(const PatternPolytope& polytope, double largest_radius, double tolerance) const;
  // The least of these that is not 0; 0 if all are.
  double exact(double largest_radius, double tolerance) const;
  Vec3 position(const std::array<int, 3>& cell, std::size_t basis) const {
    return origin_ + matrix_ * (Vec3(cell[0], cell[1], cell[2]) + fractional_[basis]);
  }
  Vec3 corner(const std::array<int, 3>& cell) const {  // the origin of a cell
    return origin_ + matrix_ * Vec3(cell[0], cell[1], cell[2]);
  }
  Vec3 fraction(const Vec3& position) const { return inverse_ * (position - origin_); }
  // Cells along each axis that a sphere of radius 1 Å reaches over.
  const Vec3& cells_per_length() const { return cells_per_length_; }
  std::size_t basis() const { return fractional_.size(); }
  const std::vector<Vec3>& fractional() const { return fractional_; }
  const std::vector<PatternPolytope>& polytopes() const { return polytopes_; }
  const std::vector<PatternCorner>& around(std::size_t basis) const { return around_[basis]; }
  double largest_void() const { return largest_void_; }
  // The polytope without the corners whose bits are not set in `occupied`.
  PatternCut cut(const PatternPolytope& polytope, std::uint64_t occupied) const;

 private:
  bool place_spheres();
  bool join_faces();
  void find_close_sites();
  double nearest_neighbour() const;
  Vec3 offset_position(const SiteOffset& s) const {
    return matrix_ * (Vec3(s.cell[0], s.cell[1], s.cell[2]) + fractional_[s.basis]);
  }
  // Calls body(cell) for every cell whose origin may be within `radius` of a place, given in cells.
  template <class Body>
  void for_cells(const Vec3& fraction, double radius, Body&& body) const;

  Mat3 matrix_{1.0}, inverse_{1.0};
  Vec3 origin_{0.0};
  Vec3 direction_{1.0, 0.0, 0.0};
  Vec3 cells_per_length_{0.0};
  std::vector<Vec3> fractional_;
  std::vector<PatternPolytope> polytopes_;
  std::vector<std::vector<PatternCorner>> around_;
  double in_place_ = 0.0;
  double largest_void_ = 0.0;
  bool usable_ = false;
};

}  // namespace atomesh
