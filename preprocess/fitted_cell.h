// A unit cell as it is fitted to a sample: where its sites lie in the sample, and which site a place belongs to.
#pragma once

#include <span>
#include <vector>

#include "core/progress.h"
#include "preprocess/local_cluster.h"

namespace atomesh {

struct FittedCell {
  Mat3 vectors{1.0};                   // columns, Å; reduced and right-handed
  Vec3 origin{0.0};                    // Å, in the sample: a lattice point
  std::vector<Vec3> sites;             // Å, from the origin
  std::vector<std::uint16_t> species;  // of each site, index into Atoms::species_table
  double rms = 0.0;        // Å, per axis, of the atoms that were fitted (a robust measure: of the middle half)
  double nearest = 0.0;    // Å, between sites
  std::size_t fitted = 0;  // atoms in the fit
  double volume() const { return std::abs(glm::determinant(vectors)); }
};

// The smallest distance between two sites of the endless crystal.
double nearest_site_distance(const Mat3& vectors, std::span<const Vec3> sites);

struct SiteHit {
  int site = -1;     // -1: none near enough
  Vec3 offset{0.0};  // Å, from the site
};

// Finds the site a place belongs to: the cell is cut into voxels, each naming the sites whose sphere meets it.
class SiteLookup {
 public:
  // `tolerance` Å, at most half the distance between sites.
  SiteLookup(const Mat3& vectors, std::span<const Vec3> sites, double tolerance);
  // The nearest site within the tolerance of `p`, Å from the origin.
  SiteHit find(const Vec3& p) const {
    const Vec3 f = to_fraction_ * p;
    const Vec3 wrapped(f.x - floor_of(f.x), f.y - floor_of(f.y), f.z - floor_of(f.z));
    std::size_t voxel = 0;
    for (int k = 2; k >= 0; --k) {
      const int cell = static_cast<int>(wrapped[k] * voxels_);
      voxel = voxel * count_ + static_cast<std::size_t>(cell < last_ ? cell : last_);
    }
    SiteHit hit;
    double best = tolerance2_;
    for (std::uint32_t n = start_[voxel]; n != start_[voxel + 1]; ++n) {
      Vec3 d = wrapped - fractions_[entry_[n]];
      for (int k = 0; k < 3; ++k) d[k] -= d[k] > 0.5 ? 1.0 : d[k] < -0.5 ? -1.0 : 0.0;
      const Vec3 offset = vectors_ * d;
      const double distance2 = glm::dot(offset, offset);
      if (distance2 <= best) {
        best = distance2;
        hit = {static_cast<int>(entry_[n]), offset};
      }
    }
    return hit;
  }
  // Which cell that is: p = vectors·cell + site + offset.
  Vec3 cell(const Vec3& p, const SiteHit& hit) const {
    const Vec3 f = to_fraction_ * (p - hit.offset) - fractions_[static_cast<std::size_t>(hit.site)];
    return glm::round(f);
  }
  // Of the sites, each in [0, 1).
  const std::vector<Vec3>& fractions() const { return fractions_; }

 private:
  static double floor_of(double x) {
    const auto whole = static_cast<double>(static_cast<std::int64_t>(x));
    return whole > x ? whole - 1.0 : whole;
  }

  Mat3 vectors_, to_fraction_;
  double tolerance2_;
  std::size_t count_;  // voxels along each axis
  int last_;
  double voxels_;
  std::vector<Vec3> fractions_;
  std::vector<std::uint32_t> start_;
  std::vector<std::uint32_t> entry_;
};

// The cell fitted by least squares to the points within `radius` of the cluster's centre: vectors and sites, from the
// start that is given. Atoms far from their site beside the others (defects, another grain) have no say. `kept` is the
// share of the points near a site before. Not changed where too few atoms fit to tell.
struct CellFit {
  FittedCell cell;
  double kept = 0.0;
};
CellFit fit_cell(const LocalCluster& cluster, double radius, const FittedCell& start);

// The same over ever larger clusters about `center` as long as the crystal goes on there as it began: until the sample
// or some ten thousands of atoms are in, or strain or a boundary shows.
FittedCell grow_fit(const Atoms& atoms, const Vec3& center, const LocalScale& scale, const FittedCell& start,
                    Progress& progress);

// Adds translations that map every site on a site of its species (within what the fit's noise explains) to the lattice,
// so that the cell is primitive. Returns whether there were any.
bool make_primitive(FittedCell& cell);

// The rotation of a linear map: the orthogonal factor of its polar decomposition.
Mat3 rotation_of(const Mat3& map);

}  // namespace atomesh
