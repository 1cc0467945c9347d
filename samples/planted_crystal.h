// A crystal of any common structure with point defects where the truth says, cut to a shape, turned and shaken: what
// the search for defects and for unit cells is judged by.
#pragma once

#include <string>

#include "samples/samples.h"

namespace atomesh {

enum class PlantedShape {
  block,           // whole conventional cells, edges about equally long
  sphere,          // every site within a radius, centred between the sites
  periodic_block,  // the block in a box that is periodic along all three vectors
};

struct PlantedCrystalOptions {
  std::string structure = "fcc";  // see structure_types.h
  std::size_t atoms = 20000;      // about
  PlantedShape shape = PlantedShape::block;

  std::size_t vacancies = 0;
  std::size_t interstitials = 0;  // of the structure's first species, in its largest voids
  std::size_t substitutions = 0;  // StructureType::impurity on sites of any species
  // Å that defects keep from each other at least; 0: 2.5 × the longest vector of the conventional cell, so that no
  // atom has two of them in its neighbourhood.
  double least_distance = 0.0;
  // Å that defects keep from the surface at least (periodic blocks have none); 0: twice the longest vector.
  double depth = 0.0;
  // Every second defect sits beside the one before it, on the nearest site or void that is free, so that pairs share
  // neighbours; least_distance then holds between pairs.
  bool pairs = false;

  double noise = 0.0;  // rms displacement along each axis (normal), as a share of the nearest-neighbour distance
  std::uint64_t rotation = 0;  // seed of a rotation drawn from all alike; 0: the conventional cell's own orientation
  std::uint64_t seed = 1;      // of sites and noise
};

// The truth's sites are the perfect crystal's, before noise. The unit cell is the conventional one, turned with the
// crystal; one of its lattice points is the origin. Interstitials are the last atoms. Positions in a periodic block lie
// inside the box (to rounding). Throws UsageError for an unknown structure, numbers out of range, or when the crystal
// has no room for the defects asked for.
Sample make_planted_crystal(const PlantedCrystalOptions& options, Progress& progress = no_progress());

// The rotation that `seed` stands for; the identity for 0. All orientations are equally likely (Shoemake 1992).
Mat3 random_rotation(std::uint64_t seed);

}  // namespace atomesh
