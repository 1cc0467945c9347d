// What the perfect crystal has around each of its sites (the feature vectors of the seed's appendix A.3), and the
// comparison of a real neighbourhood with them.
#pragma once

#include <algorithm>
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

// One kind of site: basis atoms of one species with the same surroundings share it (the four of a cubic fcc cell do).
struct SiteKind {
  std::uint16_t species;
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
  // Kinds of each species; species beyond the atoms' table are those of the cell that the sample lacks.
  std::vector<std::vector<std::uint16_t>> kinds_of;
  std::vector<std::string> absent_species;  // of the cell, in the order of the numbers after the table's
  double nearest = 0.0;                     // Å between nearest neighbours in the perfect crystal
  double radius = 0.0;                      // Å, of the seed's local neighbourhood: defects within it count
  double near_radius = 0.0;                 // Å, of the first shells, by which sites and atoms are judged
  double tolerance = 0.0;                   // Å
  double pair_distance = 0.0;      // Å: an atom that far from an empty place of its species is its occupant, displaced
  double noise = 0.0;              // Å: displacements up to it are the rounding of a file
  double search_radius = 0.0;      // Å: neighbours needed for a comparison
  double glance_radius = 0.0;      // Å: neighbours needed where everybody is nearly in place
  bool tolerance_limited = false;  // the tolerance asked for reached half-way to the next site

  double farthest_counted() const { return std::max(radius, near_radius); }
};

// `table` names the species of the atoms. Throws what check_unit_cell throws, UsageError for a neighbourhood or
// tolerance that is not sensible or that holds more than 20,000 neighbours.
FeatureSet build_feature_vectors(const UnitCell& cell, const std::vector<Species>& table, double neighbourhood,
                                 double tolerance);

}  // namespace atomesh
