// A whole sample, stamped: its patches, the atoms that belong to none, and what is left open between them.
#pragma once

#include <memory>
#include <vector>

#include "preprocess/neighbour_grid.h"
#include "preprocess/stamp_delaunay.h"
#include "preprocess/stamp_patch.h"

namespace atomesh {

// The points that may be corners of a Delaunay cell (of radius up to largest_radius) that is not stamped.
struct OpenPoints {
  enum Role : std::uint8_t {
    none,    // no corner of any
    unique,  // all its cells are to be found
    model,   // so are this one's, and then they are moved to its copies
    copy,    // the lattice around is its model's, moved
  };
  std::vector<Role> role;                       // of each point
  std::vector<std::pair<Index, Index>> copies;  // (model, copy)
  // The corners of all cells at unique ones and models, ascending, and now and then a few more.
  std::vector<Index> open;
};

class StampedSample {
 public:
  // Stamps all patches. `points` and `sites` must outlive this.
  StampedSample(std::span<const Vec3> points, const LatticeSites& sites, const StampOptions& options,
                Progress& progress);

  std::span<const Vec3> points() const { return points_; }
  // Polytopes anywhere are cut in the order of their corners' heights along it.
  const Vec3& direction() const { return direction_; }
  const StampOptions& options() const { return options_; }
  std::size_t stamped() const { return tetrahedra_; }
  // All stamped tetrahedra, patch by patch; `tetrahedra` as long as stamped().
  void write(std::span<Tetrahedron> tetrahedra, Progress& progress) const;

  OpenPoints open_points(Progress& progress) const;
  // Takes back what is stamped at these points, and at those within `radius` of them.
  void unstamp(std::span<const Index> points, double radius);

  // The atom's patch, or nullptr when it is not in place in any.
  const StampedPatch* patch_of(Index atom) const { return in_place_[atom] != 0 ? patch(atom) : nullptr; }
  // Whether the points are corners of one stamped polytope.
  bool in_one_polytope(const Tetrahedron& tetrahedron) const;
  const LatticeSite& site(Index point) const { return sites_.of[point]; }
  // Calls body(point) for all points within `radius` of a place; stops and returns false when body does. `slots` is
  // scratch space.
  template <class Body>
  bool each_in_ball(const Vec3& center, double radius, std::vector<Index>& slots, Body&& body) const;

 private:
  const StampedPatch* patch(Index atom) const { return patches_[sites_.of[atom].patch].get(); }
  void find_direction();
  void make_patches(Progress& progress);
  void keep_clear(Progress& progress);
  double reach() const;
  // Within this of an atom, all that decides which cells it has and which of them are stamped.
  double sphere_of_influence(const PatchPattern& pattern) const;
  // Fills in role and copies for the points on the edge.
  void find_copies(std::span<const Index> edge, std::span<const std::size_t> first, OpenPoints& result,
                   Progress& progress) const;
  bool is_closed(Index atom, const NeighbourGrid& edge, std::vector<Index>& slots) const;

  std::span<const Vec3> points_;
  const LatticeSites& sites_;
  StampOptions options_;
  Vec3 direction_{1.0, 0.0, 0.0};
  std::vector<std::unique_ptr<StampedPatch>> patches_;  // as sites.patches; nullptr: cannot be stamped
  std::vector<std::uint8_t> in_place_;                  // of each point: it is in its patch's table
  std::vector<Index> loose_;                            // the others
  std::unique_ptr<NeighbourGrid> loose_grid_;
  std::size_t tetrahedra_ = 0;
};

template <class Body>
bool StampedSample::each_in_ball(const Vec3& center, double radius, std::vector<Index>& slots, Body&& body) const {
  for (const auto& patch : patches_) {
    if (patch && !patch->each_in_ball(center, radius, body)) return false;
  }
  loose_grid_->find(center, radius, slots);
  for (const Index slot : slots) {
    if (!body(loose_[loose_grid_->point(slot)])) return false;
  }
  return true;
}

}  // namespace atomesh
