// The surroundings of one place of a large sample as a free-standing set of points.
#pragma once

#include <vector>

#include "preprocess/neighbour_grid.h"

namespace atomesh {

// Every atom, and every periodic image, within `radius` of `center`.
struct LocalCluster {
  Vec3 center{0.0};                    // Å, in the sample
  double radius = 0.0;                 // Å
  std::vector<Vec3> points;            // Å, from `center`; ascending x, then y, z, species: whatever the atoms' order
  std::vector<std::uint16_t> species;  // index into Atoms::species_table
};

// Cost: one pass over all atoms. Throws Error for a coordinate that is not finite, a periodic axis of a singular box
// and a box so thin that more than 100,000 images of it are met.
LocalCluster collect_cluster(const Atoms& atoms, const Vec3& center, double radius);

// The lengths by which a cluster is judged.
struct LocalScale {
  double nearest = 0.0;   // Å, median distance to the nearest other atom
  double spacing = 0.0;   // Å, edge of the cube an atom has for itself inside the material
  double glance = 0.0;    // Å: a ball of this radius holds about `crowd` atoms inside the material
  std::size_t crowd = 0;  // atoms in that ball
  bool known() const { return nearest > 0.0 && spacing > 0.0; }
};

// From the points that lie at least the glance away from the cluster's border. Not known() for fewer than 16 points.
LocalScale measure_scale(const LocalCluster& cluster);

// The points again, for searches; cells about as wide as an atom's cube.
NeighbourGrid grid_of(const LocalCluster& cluster, const LocalScale& scale);

// The place among the atoms, inwards from `target`: the atom nearest to the middle of the atoms around the atom nearest
// to it, and the points around it: about `wanted` of them where the sample has as many.
LocalCluster probe(const Atoms& atoms, const Vec3& target, std::size_t wanted);

}  // namespace atomesh
