// The Delaunay tetrahedralization of a perfect, endless crystal: what is stamped wherever the crystal is undisturbed.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/unit_cell.h"

namespace atomesh {

// A site of the crystal: basis atom `basis` in cell (i, j, k) away from the cell in question.
struct SiteOffset {
  std::array<std::int8_t, 3> cell{};
  std::uint16_t basis = 0;

  friend bool operator==(const SiteOffset&, const SiteOffset&) = default;
};

// One Delaunay cell of the crystal: the convex polytope of all sites on one empty sphere, and the tetrahedra it is cut
// into. Polytopes that share a face cut it alike.
struct TemplatePolytope {
  std::vector<SiteOffset> corners;                      // corners[0] lies in cell (0, 0, 0)
  std::vector<std::array<std::uint8_t, 4>> tetrahedra;  // indices into corners, positively oriented
  Vec3 center{0.0};                                     // Å, of the sphere, from the origin of the cell
  double radius = 0.0;
};

struct LatticeTemplate {
  UnitCell cell;  // the crystal's, its vectors reduced and right-handed, its basis wrapped into [0, 1)³
  // Of each basis atom of `cell`: which basis atom of the cell given it is.
  std::vector<std::uint16_t> given_basis;
  // One of each class of translates; together with their translates they fill space once. Fixed order.
  std::vector<TemplatePolytope> polytopes;
  // Corners of a polytope, and ties between equal spheres anywhere else, are ordered by this direction: no two sites of
  // one polytope have nearly the same height along it.
  Vec3 pulling_direction{1.0, 0.0, 0.0};
  double largest_void = 0.0;  // Å, the largest polytope's radius

  Vec3 position(const SiteOffset& s) const {
    return cell.matrix() * Vec3(s.cell[0], s.cell[1], s.cell[2]) + cell.basis[s.basis].position;
  }
};

// The periodic Delaunay complex is translation invariant, so one cell's worth of it is all there is. Any primitive or
// conventional cell, skew or long ones too; throws what check_unit_cell throws, and Error for a cell whose polytopes
// have more corners than pull_polytope_corners or reach further than 100 cells.
LatticeTemplate make_lattice_template(const UnitCell& cell);

struct PullingDirection {
  Vec3 direction{1.0, 0.0, 0.0};
  double separation = 0.0;  // Å, the least difference of height of two corners of a polytope; infinite for simplices
};

// The direction along which the corners of each polytope stand furthest apart: templates of several grains must be cut
// along one direction.
PullingDirection find_pulling_direction(std::span<const std::vector<Vec3>> polytopes);

// A polytope cut by pull_polytope() in the order of its corners' heights along the direction: indices into corners.
// Empty for corners that span no volume.
std::vector<std::array<std::uint8_t, 4>> cut_polytope(std::span<const Vec3> corners, const Vec3& direction);

}  // namespace atomesh
