// Which points lie within a distance of a place: cell lists over points and their periodic images.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/atoms.h"
#include "core/progress.h"

namespace atomesh {

// What a search from anywhere in one cell of a grid can meet, copied together for many searches from that cell. Use it
// with one grid only.
struct GridBlock {
  std::array<std::int64_t, 3> cell{-1, -1, -1};
  double radius = 0.0;
  std::size_t count = 0;
  Vec3 origin{0.0};            // a corner of the cell
  std::vector<float> x, y, z;  // Å, from the origin; filled up to whole blocks of 64 with places out of reach
  std::vector<Index> slot;
};

// The points, wrapped into the box along its periodic axes, and as many periodic images of them as a search of
// `reach` Å around any place in the box can meet, sorted into cubic cells. An entry of the sorted list is a *slot*;
// several slots (images) can belong to one point. Memory grows with points and images, never with empty space.
class NeighbourGrid {
 public:
  // `cell` (Å, about the usual search radius) is the edge of the cells. Throws Error for a coordinate that is not
  // finite, a periodic axis of a singular box, and a box so thin that a search meets more than 100,000 images of it.
  NeighbourGrid(std::span<const Vec3> points, const Box& box, double reach, double cell,
                Progress& progress = no_progress());

  double cell_edge() const { return edge_; }  // Å
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

  // Makes `block` that of the slot's cell for searches of `radius` (at most `reach`), unless it is already.
  void gather(Index slot, double radius, GridBlock& block) const;
  // find() around a slot of the block's cell, itself left out: writes to the front of `slots` (made longer where it
  // must) and returns how many. In single precision: a place within 1e-5 of the radius from it may be either. The same
  // on every processor.
  std::size_t find_in(const GridBlock& block, Index slot, double radius, std::vector<Index>& slots) const;

 private:
  struct Range {
    Index begin, end;
  };
  void wrap_points(std::span<const Vec3> points, Progress& progress);
  void add_images(std::size_t points, double reach, Progress& progress);
  void sort_into_cells(std::size_t points, Progress& progress);
  std::array<std::int64_t, 3> cell_of(const Vec3& p) const;
  template <class Body>
  void for_ranges(const Vec3& low, const Vec3& high, Body&& body) const;
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
double median_nearest_distance(std::span<const Vec3> points, const Box& box, Progress& progress = no_progress());

}  // namespace atomesh
