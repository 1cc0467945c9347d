// Rotations of a crystal: those that map it onto itself, and the one that maps it onto an atom's surroundings.
#pragma once

#include <optional>
#include <vector>

#include "preprocess/fitted_cell.h"

namespace atomesh {

// Proper rotations that map the crystal onto itself (with any translation), in the sample's frame; the identity first.
// `tolerance` Å, for sites and for vectors as long as the cell's.
std::vector<Mat3> symmetry_rotations(const FittedCell& cell, double tolerance);

// Of rotation·s over the symmetries s, the one that turns least.
Mat3 smallest_rotation(const Mat3& rotation, const std::vector<Mat3>& symmetries);

// Radians that a rotation turns by.
double angle_of(const Mat3& rotation);

// What stands around each site of the crystal: the nearest shells.
class NeighbourShells {
 public:
  explicit NeighbourShells(const FittedCell& cell);
  double radius() const { return radius_; }  // Å

  struct Match {
    Mat3 rotation{1.0};  // of the crystal into the sample
    std::size_t site = 0;
    double share = 0.0;  // of the shells' atoms that are there
  };
  // The rotation that puts most of a site's shells on the atoms around `atom`, which sits on that site. Nothing where
  // less than three quarters are there.
  std::optional<Match> match(const LocalCluster& cluster, const NeighbourGrid& grid, Index atom) const;

 private:
  struct Entry {
    Vec3 offset;
    std::uint16_t species;
  };
  struct Shells {
    std::uint16_t species;
    std::vector<Entry> entries;  // ascending length
    std::size_t second = 0;      // of the pair that fixes the rotation: entries[0] and this
  };
  std::vector<Shells> sites_;
  double radius_ = 0.0;
  double tolerance_ = 0.0;
};

}  // namespace atomesh
