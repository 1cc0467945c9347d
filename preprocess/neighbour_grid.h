// Which points lie within a distance of a place: cell lists over points and their periodic images.
#pragma once

#include <span>
#include <vector>

#include "core/atoms.h"

namespace atomesh {

// The points, wrapped into the box along its periodic axes, and as many periodic images of them as a search of
// `reach` Å around any place in the box can meet, sorted into cubic cells. An entry of the sorted list is a *slot*;
// several slots (images) can belong to one point. Memory grows with points and images, never with empty space.
class NeighbourGrid {
 public:
  // `cell` (Å, about the usual search radius) is the edge of the cells. Throws Error for a coordinate that is not
  // finite, a periodic axis of a singular box, and a box so thin that a search meets more than 100,000 images of it.
  NeighbourGrid(std::span<const Vec3> points, const Box& box, double reach, double cell);

  std::size_t slot_count() const { return point_.size(); }
  Index point(Index slot) const { return point_[slot]; }  // index into `points`
  Vec3 position(Index slot) const { return {x_[slot], y_[slot], z_[slot]}; }
  // The slots of the points themselves (no images) in the order of the cells: visiting them in this order stays in
  // the processor's caches.
  std::span<const Index> home_slots() const { return home_; }

  // The place inside the box (along periodic axes) equivalent to p; fractions within 1e-9 of 1 become 0, so that a
  // site on the border has one name.
  Vec3 wrap(const Vec3& p) const;

  // The shortest difference equivalent to d where the box is much larger than d: periodic axes reduced to half a box.
  Vec3 nearest_image(const Vec3& d) const;

  // How many slots a search would test: an upper bound of what it finds.
  std::size_t count_candidates(const Vec3& centre, double radius) const;
  // Replaces `slots` by those within `radius` of `centre` (a place in the box; radius at most `reach`), `except`
  // left out, in a fixed order.
  void find(const Vec3& centre, double radius, std::vector<Index>& slots, Index except = no_index) const;

 private:
  struct Range {
    Index begin, end;
  };
  void add_images(std::span<const Vec3> points, double reach);
  void sort_into_cells(std::size_t points);
  template <class Body>
  void for_ranges(const Vec3& centre, double radius, Body&& body) const;
  Range sparse_cell(std::uint64_t key) const;

  bool periodic_ = false;
  Box box_;
  Mat3 to_fraction_{1.0};
  Vec3 min_{0.0};
  double edge_ = 1.0;
  std::array<std::int64_t, 3> cells_{1, 1, 1};
  std::vector<double> x_, y_, z_;
  std::vector<Index> point_;
  std::vector<Index> home_;
  // Few empty cells: start_[cell] .. start_[cell + 1] are its slots. Otherwise only the occupied cells are kept, in a
  // hash table with linear probing.
  std::vector<Index> start_;
  std::vector<std::uint64_t> table_key_;
  std::vector<Range> table_range_;
};

// The median over the points of the distance to the nearest other one, Å, images included (at most 20,000 points are
// asked, evenly chosen); 0 for fewer than two points.
double median_nearest_distance(std::span<const Vec3> points, const Box& box);

}  // namespace atomesh
