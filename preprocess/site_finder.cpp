#include "preprocess/site_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace atomesh {

namespace {

constexpr int most_bins = 64;  // along one vector

}  // namespace

SiteFinder::SiteFinder(const UnitCell& cell, double reach) {
  const Mat3 matrix = cell.matrix();
  const Mat3 to_fraction = glm::inverse(matrix);
  for (const BasisAtom& atom : cell.basis) fractional_.push_back(to_fraction * atom.position);

  // Bins about as wide as the reach hold one or two candidates each.
  Vec3 half(0.0);
  for (int k = 0; k < 3; ++k) {
    bins_[k] = std::clamp(static_cast<int>(std::ceil(glm::length(cell.primitive[k]) / reach)), 1, most_bins);
    half += glm::abs(cell.primitive[k]) / (2.0 * bins_[k]);
  }
  // A site in reach of any place of a bin is this near its middle; the margin is for strain.
  const double limit = 1.1 * reach + glm::length(half);
  // Sites that near may lie this many cells away: rows of the inverse are one over the distance of the planes.
  std::array<int, 3> cells{};
  for (int k = 0; k < 3; ++k) {
    cells[k] = static_cast<int>(
        std::ceil(limit * glm::length(Vec3(to_fraction[0][k], to_fraction[1][k], to_fraction[2][k])) + 1.0));
  }
  std::vector<Candidate> around;
  for (int i = -cells[0]; i <= cells[0]; ++i) {
    for (int j = -cells[1]; j <= cells[1]; ++j) {
      for (int k = -cells[2]; k <= cells[2]; ++k) {
        for (std::size_t b = 0; b < fractional_.size(); ++b) {
          around.push_back({fractional_[b] + Vec3(i, j, k),
                            {static_cast<std::int8_t>(i), static_cast<std::int8_t>(j), static_cast<std::int8_t>(k)},
                            static_cast<std::uint16_t>(b)});
        }
      }
    }
  }
  for (int i = 0; i < bins_[0]; ++i) {
    for (int j = 0; j < bins_[1]; ++j) {
      for (int k = 0; k < bins_[2]; ++k) {
        first_.push_back(static_cast<std::uint32_t>(candidates_.size()));
        const Vec3 middle((i + 0.5) / bins_[0], (j + 0.5) / bins_[1], (k + 0.5) / bins_[2]);
        for (const Candidate& site : around) {
          const Vec3 d = matrix * (site.fraction - middle);
          if (glm::dot(d, d) <= limit * limit) candidates_.push_back(site);
        }
      }
    }
  }
  first_.push_back(static_cast<std::uint32_t>(candidates_.size()));
}

SiteFinder::Found SiteFinder::find(const LatticeFrame& frame, const Mat3& to_fraction, const Vec3& place) const {
  const Vec3 fraction = to_fraction * (place - frame.origin);
  const Vec3 base(std::floor(fraction.x), std::floor(fraction.y), std::floor(fraction.z));
  const Vec3 inside = fraction - base;
  std::size_t bin = 0;
  for (int k = 0; k < 3; ++k) {
    const int index = std::min(static_cast<int>(inside[k] * bins_[k]), bins_[k] - 1);
    bin = bin * static_cast<std::size_t>(bins_[k]) + static_cast<std::size_t>(index);
  }
  Found found;
  found.squared = std::numeric_limits<double>::infinity();
  const Candidate* best = nullptr;
  for (std::uint32_t n = first_[bin]; n < first_[bin + 1]; ++n) {
    const Vec3 offset = frame.matrix * (inside - candidates_[n].fraction);
    const double squared = glm::dot(offset, offset);
    if (squared < found.squared) {
      found.squared = squared;
      found.offset = offset;
      best = &candidates_[n];
    }
  }
  if (best == nullptr) return found;
  found.basis = best->basis;
  for (int k = 0; k < 3; ++k) found.cell[k] = static_cast<std::int32_t>(base[k]) + best->shift[k];
  return found;
}

double shortest_distance(const UnitCell& cell) {
  double shortest = cell.longest_primitive();
  // With reduced vectors the nearest image is among the 27; any others only add candidates.
  const std::array<Vec3, 3> v = reduce_lattice(cell.primitive);
  const Mat3 matrix(v[0], v[1], v[2]);
  const Mat3 to_fraction = glm::inverse(matrix);
  for (std::size_t a = 0; a < cell.basis.size(); ++a) {
    for (std::size_t b = a; b < cell.basis.size(); ++b) {
      Vec3 fraction = to_fraction * (cell.basis[b].position - cell.basis[a].position);
      fraction -= glm::round(fraction);
      for (int n = 0; n < 27; ++n) {
        const Vec3 d = matrix * (fraction + Vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
        if (a == b && n == 13) continue;
        shortest = std::min(shortest, glm::length(d));
      }
    }
  }
  return shortest;
}

}  // namespace atomesh
