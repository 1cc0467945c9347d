#include "preprocess/match_orientation.h"

#include <algorithm>
#include <cmath>

namespace atomesh {

namespace {

// Shells go on until so many atoms are in: the first alone cannot tell a twin from its parent.
constexpr std::size_t enough_neighbours = 26;
constexpr double least_share = 0.75;

// The rotation that turns the frame of (a, b) into that of (p, q): TRIAD, H. Black 1964.
Mat3 frame_rotation(const Vec3& a, const Vec3& b, const Vec3& p, const Vec3& q) {
  const auto frame = [](const Vec3& x, const Vec3& y) {
    const Vec3 first = glm::normalize(x);
    const Vec3 third = glm::normalize(glm::cross(x, y));
    return Mat3(first, glm::cross(third, first), third);
  };
  return frame(p, q) * glm::transpose(frame(a, b));
}

double sine_between(const Vec3& a, const Vec3& b) {
  return glm::length(glm::cross(a, b)) / (glm::length(a) * glm::length(b));
}

}  // namespace

std::vector<Mat3> symmetry_rotations(const FittedCell& cell, double tolerance) {
  std::vector<Mat3> rotations{Mat3(1.0)};
  const Mat3 to_fraction = glm::inverse(cell.vectors);
  const SiteLookup lookup(cell.vectors, cell.sites, std::min(tolerance, 0.25 * cell.nearest));
  const auto maps_sites = [&](const Mat3& r) {
    // The first site goes to some site of its species; the rest must follow.
    for (std::size_t to = 0; to < cell.sites.size(); ++to) {
      if (cell.species[to] != cell.species[0]) continue;
      const Vec3 shift = cell.sites[to] - r * cell.sites[0];
      bool all = true;
      for (std::size_t j = 0; all && j < cell.sites.size(); ++j) {
        const SiteHit hit = lookup.find(r * cell.sites[j] + shift);
        all = hit.site >= 0 && cell.species[static_cast<std::size_t>(hit.site)] == cell.species[j];
      }
      if (all) return true;
    }
    return false;
  };
  // In a reduced basis the matrices of the lattice's symmetries have entries -1, 0, 1.
  std::array<std::vector<Vec3>, 3> images;
  for (int k = 0; k < 3; ++k) {
    for (int n = 0; n < 27; ++n) {
      const Vec3 v = cell.vectors * Vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
      if (std::abs(glm::length(v) - glm::length(cell.vectors[k])) < tolerance) {
        images[static_cast<std::size_t>(k)].push_back(v);
      }
    }
  }
  for (const Vec3& a : images[0]) {
    for (const Vec3& b : images[1]) {
      for (const Vec3& c : images[2]) {
        const Mat3 map = Mat3(a, b, c) * to_fraction;
        if (!(glm::determinant(map) > 0.5)) continue;
        const Mat3 r = rotation_of(map);
        if (angle_of(r) < 1e-3) continue;
        bool rigid = true;
        for (int k = 0; k < 3; ++k) rigid = rigid && glm::length((map - r) * cell.vectors[k]) < tolerance;
        if (rigid && maps_sites(r)) rotations.push_back(r);
      }
    }
  }
  return rotations;
}

Mat3 smallest_rotation(const Mat3& rotation, const std::vector<Mat3>& symmetries) {
  Mat3 best = rotation;
  for (const Mat3& s : symmetries) {
    const Mat3 r = rotation * s;
    if (angle_of(r) < angle_of(best) - 1e-9) best = r;
  }
  return best;
}

double angle_of(const Mat3& rotation) {
  const double cosine = 0.5 * (rotation[0][0] + rotation[1][1] + rotation[2][2] - 1.0);
  const Vec3 axis(rotation[1][2] - rotation[2][1], rotation[2][0] - rotation[0][2], rotation[0][1] - rotation[1][0]);
  return std::atan2(0.5 * glm::length(axis), cosine);
}

NeighbourShells::NeighbourShells(const FittedCell& cell) : tolerance_(0.25 * cell.nearest) {
  const Mat3 to_fraction = glm::inverse(cell.vectors);
  const Mat3 rows = glm::transpose(to_fraction);
  const double atom_volume = cell.volume() / static_cast<double>(cell.sites.size());
  // A radius with enough neighbours for every site, cut between shells.
  radius_ = std::cbrt(1.2 * static_cast<double>(enough_neighbours) * atom_volume * 0.2387);
  for (;; radius_ *= 1.1) {
    sites_.clear();
    std::size_t fewest = enough_neighbours;
    std::array<int, 3> reach;
    for (int k = 0; k < 3; ++k) {
      reach[static_cast<std::size_t>(k)] = static_cast<int>(std::ceil(radius_ * glm::length(rows[k]))) + 1;
    }
    for (std::size_t j = 0; j < cell.sites.size(); ++j) {
      Shells shells{cell.species[j], {}, 0};
      for (std::size_t i = 0; i < cell.sites.size(); ++i) {
        Vec3 f = to_fraction * (cell.sites[i] - cell.sites[j]);
        f -= glm::round(f);
        for (int a = -reach[0]; a <= reach[0]; ++a) {
          for (int b = -reach[1]; b <= reach[1]; ++b) {
            for (int c = -reach[2]; c <= reach[2]; ++c) {
              const Vec3 d = cell.vectors * (f + Vec3(a, b, c));
              const double length = glm::length(d);
              if (length < radius_ && length > 0.5 * cell.nearest) shells.entries.push_back({d, cell.species[i]});
            }
          }
        }
      }
      std::stable_sort(shells.entries.begin(), shells.entries.end(), [](const Entry& a, const Entry& b) {
        return glm::dot(a.offset, a.offset) < glm::dot(b.offset, b.offset);
      });
      fewest = std::min(fewest, shells.entries.size());
      sites_.push_back(std::move(shells));
    }
    if (fewest >= enough_neighbours) break;
  }
  for (Shells& shells : sites_) {
    for (std::size_t n = 1; n < shells.entries.size() && shells.second == 0; ++n) {
      if (sine_between(shells.entries[0].offset, shells.entries[n].offset) > 0.6) shells.second = n;
    }
  }
}

std::optional<NeighbourShells::Match> NeighbourShells::match(const LocalCluster& cluster, const NeighbourGrid& grid,
                                                             Index atom) const {
  std::vector<Index> slots;
  const Vec3 center = cluster.points[atom];
  grid.find(center, radius_ + tolerance_, slots);
  std::vector<Entry> around;
  for (const Index s : slots) {
    const Index i = grid.point(s);
    if (i != atom) around.push_back({cluster.points[i] - center, cluster.species[i]});
  }
  Match best;
  double best_score = 0.0;
  for (std::size_t j = 0; j < sites_.size(); ++j) {
    const Shells& shells = sites_[j];
    if (shells.species != cluster.species[atom] || shells.second == 0) continue;
    const Vec3& a = shells.entries[0].offset;
    const Vec3& b = shells.entries[shells.second].offset;
    for (const Entry& p : around) {
      if (std::abs(glm::length(p.offset) - glm::length(a)) > tolerance_) continue;
      for (const Entry& q : around) {
        if (std::abs(glm::length(q.offset) - glm::length(b)) > tolerance_) continue;
        if (std::abs(glm::length(q.offset - p.offset) - glm::length(b - a)) > 1.4 * tolerance_) continue;
        if (sine_between(p.offset, q.offset) < 0.3) continue;
        Mat3 rotation = frame_rotation(a, b, p.offset, q.offset);
        // Two atoms shake; all that were met give the rotation better.
        for (int round = 0; round < 2; ++round) {
          Mat3 cross(0.0);
          Mat3 spread(0.0);
          std::size_t met = 0;
          std::size_t kin = 0;
          double squares = 0.0;
          for (const Entry& e : shells.entries) {
            const Vec3 place = rotation * e.offset;
            const Entry* nearest = nullptr;
            double limit = tolerance_ * tolerance_;
            for (const Entry& n : around) {
              const double d = glm::dot(n.offset - place, n.offset - place);
              if (d > limit) continue;
              limit = d;
              nearest = &n;
            }
            if (nearest == nullptr) continue;
            ++met;
            kin += nearest->species == e.species ? 1 : 0;
            squares += limit;
            cross += glm::outerProduct(nearest->offset, e.offset);
            spread += glm::outerProduct(e.offset, e.offset);
          }
          const double share = static_cast<double>(met) / static_cast<double>(shells.entries.size());
          if (share < 0.5) break;
          if (round == 0) {
            const Mat3 map = cross * glm::inverse(spread);
            if (glm::determinant(map) > 0.3) rotation = rotation_of(map);
            continue;
          }
          const double fit = 1.0 - squares / (static_cast<double>(met) * tolerance_ * tolerance_);
          const double score =
              share + 0.5 * static_cast<double>(kin) / static_cast<double>(shells.entries.size()) + 0.25 * fit;
          if (score <= best_score) continue;
          best_score = score;
          best = {rotation, j, share};
        }
      }
    }
  }
  if (best.share < least_share) return std::nullopt;
  return best;
}

}  // namespace atomesh
