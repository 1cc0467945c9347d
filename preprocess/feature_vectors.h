// What the perfect crystal has around each of its sites (the feature vectors of the seed's appendix A.3), and the
// comparison of a real neighbourhood with them.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "core/atoms.h"
#include "core/unit_cell.h"

namespace atomesh {

struct FeatureEntry {
  Vec3 offset;            // Å, from the site
  double length;          // |offset|
  std::uint16_t species;  // as FeatureSet::kinds_of
  std::uint16_t kind;     // of the site it leads to, into FeatureSet::kinds
};

// Finds the entry at a place. The space around a site is cut into voxels, each naming the entries whose sphere of
// tolerance meets it: seldom more than one.
class EntryLookup {
 public:
  EntryLookup() = default;
  EntryLookup(const std::vector<FeatureEntry>& entries, double tolerance, double voxel);
  // Index of the entry within the tolerance of q (the spheres do not overlap), or -1.
  int find(const std::vector<FeatureEntry>& entries, const Vec3& q) const;

 private:
  double tolerance2_ = 0.0;
  double half_ = 0.0;  // Å, the table covers [-half_, half_)³
  double per_voxel_ = 1.0;
  int size_ = 0;
  std::vector<std::uint32_t> start_;
  std::vector<std::uint32_t> entry_;
};

// One kind of site of one grain: basis atoms of one species with the same surroundings share it (the four of a cubic
// fcc cell do).
struct SiteKind {
  std::uint16_t species;
  std::uint16_t grain;
  std::vector<FeatureEntry> entries;  // ascending length, the site itself left out
  std::size_t near = 0;               // the first `near` entries lie within FeatureSet::near_radius
  std::size_t counted = 0;            // the first `counted` entries lie within FeatureSet::radius
  // A place of this kind with at least so many of its near entries occupied lies inside the sample. It is more than
  // any half-space holds, so no site outside a convex sample reaches it, whatever the crystal and the cut.
  std::size_t enclosed = 0;
  // Å: the first whole shell by which there is a neighbour in every direction. An empty place within it of another
  // belongs to the same void.
  double link = 0.0;
  EntryLookup lookup;
};

struct FeatureSet {
  std::vector<SiteKind> kinds;
  // Kinds of each species, grain after grain; species beyond the atoms' table are those of the cells that the sample
  // lacks.
  std::vector<std::vector<std::uint16_t>> kinds_of;
  std::vector<std::uint8_t> in_crystal;     // of each species: some grain has it
  std::vector<std::string> absent_species;  // of the cells, in the order of the numbers after the table's
  double nearest = 0.0;                     // Å between nearest neighbours in the perfect crystal
  double radius = 0.0;                      // Å, of the seed's local neighbourhood: defects within it count
  double near_radius = 0.0;                 // Å, of the first shells, by which sites and atoms are judged
  double tolerance = 0.0;                   // Å
  double pair_distance = 0.0;  // Å: an atom that far from an empty place of its species is its occupant, displaced
  double noise = 0.0;          // Å: displacements up to it are the rounding of a file, or thermal, and count as zero
  double rounding = 0.0;       // Å: displacements up to it are the rounding of a file
  double margin = 0.0;         // Å: where nobody is displaced by more a glance is enough
  double search_radius = 0.0;  // Å: neighbours needed for a comparison
  double glance_radius = 0.0;  // Å: neighbours needed where everybody is nearly in place
  bool tolerance_limited = false;  // the tolerance asked for reached half-way to the next site

  double farthest_counted() const { return std::max(radius, near_radius); }
  std::span<const std::uint16_t> kinds_in(std::uint16_t grain, std::uint16_t species) const {
    return kinds_of[grain * in_crystal.size() + species];
  }
};

// Thermal noise as the comparison takes it into account.
struct NoiseLevel {
  double amplitude = 0.0;  // Å, rms of an atom's displacement along each axis
  double factor = 0.0;     // displacements between neighbours up to so many amplitudes count as zero
};

// `table` names the species of the atoms, `cells` are the grains' own. Lengths that differ from grain to grain (several
// phases) are the largest, `nearest` the smallest. A tolerance of 0 is 0.3 × the nearest-neighbour distance, more where
// the noise asks for it. Throws what check_unit_cell throws, UsageError for a neighbourhood or tolerance that is not
// sensible or that holds more than 20,000 neighbours.
FeatureSet build_feature_vectors(std::span<const UnitCell> cells, const std::vector<Species>& table,
                                 double neighbourhood, double tolerance, const NoiseLevel& noise = {});
FeatureSet build_feature_vectors(const UnitCell& cell, const std::vector<Species>& table, double neighbourhood,
                                 double tolerance);

}  // namespace atomesh
