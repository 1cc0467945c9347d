// Questions the sample tests ask about atoms.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_map>
#include <vector>

#include "samples/samples.h"

namespace atomesh::test {

// Atoms by cells of a cubic grid, for questions about what is near a point.
class NearGrid {
 public:
  NearGrid(const std::vector<Vec3>& points, double cell) : points_(points), cell_(cell) {
    for (std::size_t i = 0; i < points.size(); ++i) cells_[key(points[i], 0, 0, 0)].push_back(static_cast<Index>(i));
  }
  // Calls visit(index, distance) for every point within one cell edge of p.
  template <class Visit>
  void near(const Vec3& p, Visit&& visit) const {
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          const auto found = cells_.find(key(p, x, y, z));
          if (found == cells_.end()) continue;
          for (const Index i : found->second) {
            const double d = glm::distance(p, points_[i]);
            if (d <= cell_) visit(i, d);
          }
        }
      }
    }
  }

 private:
  std::uint64_t key(const Vec3& p, int x, int y, int z) const {
    const auto c = [this](double v, int shift) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(v / cell_)) + shift + (1 << 20)) &
             0x1fffff;
    };
    return c(p.x, x) | c(p.y, y) << 21 | c(p.z, z) << 42;
  }
  const std::vector<Vec3>& points_;
  double cell_;
  std::unordered_map<std::uint64_t, std::vector<Index>> cells_;
};

// The smallest distance between two atoms, or `limit` when none are nearer.
inline double smallest_distance(const Atoms& atoms, double limit) {
  const NearGrid grid(atoms.positions, limit);
  double smallest = limit;
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    grid.near(atoms.positions[i], [&](Index j, double d) {
      if (j != i) smallest = std::min(smallest, d);
    });
  }
  return smallest;
}

// Distance from p to the nearest site of the crystal that starts at the origin, and the species of that site.
struct NearestSite {
  double distance;
  std::string species;
};
inline NearestSite nearest_site(const UnitCell& cell, const Vec3& p) {
  const Mat3 inverse = glm::inverse(cell.matrix());
  NearestSite best{1e300, ""};
  for (const BasisAtom& site : cell.basis) {
    const Vec3 base = glm::round(inverse * (p - site.position));
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        for (int k = -1; k <= 1; ++k) {
          const double d = glm::distance(p, site.position + cell.matrix() * (base + Vec3(i, j, k)));
          if (d < best.distance) best = {d, site.species};
        }
      }
    }
  }
  return best;
}

// FNV-1a over species and the bits of every position.
inline std::uint64_t fingerprint(const Atoms& atoms) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  const auto add = [&hash](const void* data, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i) {
      hash = (hash ^ static_cast<const unsigned char*>(data)[i]) * 0x100000001b3ULL;
    }
  };
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    const Vec3& p = atoms.positions[i];
    add(&p, sizeof p);
    add(atoms.species_name(i).data(), atoms.species_name(i).size());
  }
  return hash;
}

}  // namespace atomesh::test
