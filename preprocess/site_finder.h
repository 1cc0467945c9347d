// Which site of a crystal a place is nearest to.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/unit_cell.h"

namespace atomesh {

// Where the crystal lies near some place: site (c, b) is at origin + matrix · (c + fractional position of b).
struct LatticeFrame {
  Mat3 matrix{1.0};
  Vec3 origin{0.0};
};

// Looks up the nearest site in a table over the unit cell, so that the time does not depend on how many atoms the cell
// holds nor on how skew it is.
class SiteFinder {
 public:
  // `cell`: reduced vectors, basis inside the cell. Sites further than `reach` Å from a place need not be found.
  SiteFinder(const UnitCell& cell, double reach);

  struct Found {
    std::array<std::int32_t, 3> cell{};
    std::uint16_t basis = 0;
    double squared = 0.0;  // Å², distance from the site; infinity when no site is in reach
    Vec3 offset{0.0};      // Å, from the site to the place
  };
  // `to_fraction` is the inverse of frame.matrix, which may be strained by some per cent against the cell.
  Found find(const LatticeFrame& frame, const Mat3& to_fraction, const Vec3& place) const;

  const std::vector<Vec3>& fractional() const { return fractional_; }

 private:
  struct Candidate {
    Vec3 fraction;  // of the site, cell shift included
    std::array<std::int8_t, 3> shift;
    std::uint16_t basis;
  };
  std::vector<Vec3> fractional_;
  std::array<int, 3> bins_{};
  std::vector<std::uint32_t> first_;  // of each bin's candidates
  std::vector<Candidate> candidates_;
};

// The shortest distance between two sites of the crystal, Å.
double shortest_distance(const UnitCell& cell);

}  // namespace atomesh
