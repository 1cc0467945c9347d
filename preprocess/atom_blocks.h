// Atoms gathered into the blocks of a coarse grid.
#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "core/geometry.h"
#include "core/progress.h"

namespace atomesh {

// Only blocks that hold atoms exist; they are numbered along x first, then y, then z. Four bytes an atom; memory grows
// with the atoms, never with empty space.
class AtomBlocks {
 public:
  // Cubic blocks of `edge` Å. Positions must be finite (throws Error naming the first that is not).
  AtomBlocks(std::span<const Vec3> positions, double edge, const Progress& progress = no_progress());

  std::size_t size() const { return keys_.size(); }
  // Ascending indices.
  std::span<const Index> atoms(std::size_t block) const {
    return std::span<const Index>(order_).subspan(start_[block], start_[block + 1] - start_[block]);
  }
  Vec3 center(std::size_t block) const;
  double edge() const { return edge_; }
  // The block so many blocks away along each axis; no_index where it is empty.
  Index neighbour(std::size_t block, int dx, int dy, int dz) const;

 private:
  std::uint64_t key_of(const Vec3& p) const;
  std::array<std::int64_t, 3> place(std::size_t block) const;

  double edge_ = 1.0;
  Vec3 min_{0.0};
  std::array<std::int64_t, 3> count_{1, 1, 1};
  std::vector<Index> order_;
  std::vector<Index> start_;
  std::vector<std::uint64_t> keys_;  // ascending
  std::vector<Index> table_;         // key → block where the grid is not much larger than the atoms are many
};

// Calls body(dx, dy, dz) for the blocks so many blocks away, counted as a king walks: 1, then 26, then 98 …
template <class Body>
void for_shell(int shell, Body&& body) {
  for (int dz = -shell; dz <= shell; ++dz) {
    for (int dy = -shell; dy <= shell; ++dy) {
      const bool side = std::abs(dz) == shell || std::abs(dy) == shell;
      for (int dx = -shell; dx <= shell; dx += side ? 1 : 2 * shell) body(dx, dy, dz);
    }
  }
}

}  // namespace atomesh
