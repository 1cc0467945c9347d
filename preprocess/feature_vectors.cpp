#include "preprocess/feature_vectors.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace atomesh {

namespace {

// Default tolerance over the nearest-neighbour distance. Atoms closer than half of it to each of two sites could be
// either's; thermal vibration at the melting point is about 0.1 of it (Lindemann); zinc-blende's second species and
// the octahedral hole of fcc are 1.0 and 0.71 away from every site of the first. 0.3 keeps clear of all three.
constexpr double default_tolerance = 0.3;
constexpr double largest_tolerance = 0.45;
constexpr double pair_fraction = 0.6;
// Files are written with three decimals or more: two rounded positions and a rounded cell differ by at most 0.004 Å.
constexpr double rounding = 0.005;  // Å
constexpr double noise_fraction = 0.002;
constexpr double same_shell = 0.05;  // of the nearest distance
// Neighbours shake against each other with √2 amplitudes; hardly any pair of an atom's is 4.5 times that apart.
constexpr double glance_amplitudes = 6.4;
constexpr double enclosed_share = 0.65;
constexpr std::size_t most_entries = 20000;

struct CellSites {
  const UnitCell& cell;
  std::vector<Vec3> position;  // wrapped into the cell
  std::vector<std::uint16_t> species;
  std::array<double, 3> planes_per_length;  // 1 / distance of the lattice planes, per axis
};

CellSites cell_sites(const UnitCell& cell, const std::vector<Species>& table, FeatureSet& set) {
  if (cell.basis.size() > 65534) throw Error("unit cell: more than 65,534 basis atoms");
  CellSites sites{cell, {}, {}, {}};
  const Mat3 to_fraction = glm::inverse(cell.matrix());
  for (int k = 0; k < 3; ++k) {
    sites.planes_per_length[k] = glm::length(Vec3(to_fraction[0][k], to_fraction[1][k], to_fraction[2][k]));
  }
  for (const BasisAtom& atom : cell.basis) {
    const Vec3 fraction = to_fraction * atom.position;
    sites.position.push_back(atom.position - cell.matrix() * glm::floor(fraction));
    std::size_t number = 0;
    while (number < table.size() && table[number].name != atom.species) ++number;
    if (number == table.size()) {
      const auto known = std::find(set.absent_species.begin(), set.absent_species.end(), atom.species);
      number += static_cast<std::size_t>(known - set.absent_species.begin());
      if (known == set.absent_species.end()) set.absent_species.push_back(atom.species);
    }
    sites.species.push_back(static_cast<std::uint16_t>(number));
  }
  return sites;
}

// Everything within `radius` of basis atom i, ascending; `kind` of an entry is here the basis atom it leads to.
std::vector<FeatureEntry> surroundings(const CellSites& sites, std::size_t i, double radius) {
  std::vector<FeatureEntry> entries;
  std::array<int, 3> range;
  double cells = 1.0;
  for (int k = 0; k < 3; ++k) {
    const double n = std::ceil(radius * sites.planes_per_length[k]) + 1.0;
    cells *= 2.0 * n + 1.0;
    range[k] = static_cast<int>(std::min(n, 1e6));
  }
  const double expected = static_cast<double>(sites.position.size()) * 4.19 * radius * radius * radius /
                          std::max(sites.cell.volume(), 1e-300);
  if (expected > static_cast<double>(most_entries) || cells > 1e8) {
    throw UsageError("neighbourhood: a radius of " + std::to_string(radius) + " Å holds more than " +
                     std::to_string(most_entries) + " neighbours of this unit cell; choose a smaller factor");
  }
  for (int a = -range[0]; a <= range[0]; ++a) {
    for (int b = -range[1]; b <= range[1]; ++b) {
      for (int c = -range[2]; c <= range[2]; ++c) {
        const Vec3 shift = sites.cell.matrix() * Vec3(a, b, c);
        for (std::size_t j = 0; j < sites.position.size(); ++j) {
          if (a == 0 && b == 0 && c == 0 && i == j) continue;
          const Vec3 offset = sites.position[j] + shift - sites.position[i];
          const double length = glm::length(offset);
          if (length <= radius) {
            entries.push_back({offset, length, sites.species[j], static_cast<std::uint16_t>(j)});
          }
        }
      }
    }
  }
  std::stable_sort(entries.begin(), entries.end(), [](const auto& p, const auto& q) { return p.length < q.length; });
  return entries;
}

// The radius of the first shells: whole shells, at least 14 neighbours, or 12 that reach well beyond the first shell
// (the layers of graphite). 0 when `entries` ends before.
double first_shells(const std::vector<FeatureEntry>& entries, double radius, double nearest) {
  const double gap = same_shell * nearest;
  for (std::size_t n = 0; n < entries.size(); ++n) {
    const double next = n + 1 < entries.size() ? entries[n + 1].length : radius;
    const std::size_t count = n + 1;
    if (next - entries[n].length < gap) continue;
    if (count >= 14 || (count >= 12 && entries[n].length > 1.4 * entries[0].length)) return entries[n].length;
  }
  return 0.0;
}

// True when every entry of `a` shorter than `end` has its like in `b`.
bool contained(const std::vector<FeatureEntry>& a, const std::vector<FeatureEntry>& b, double end, double tolerance) {
  for (const FeatureEntry& entry : a) {
    if (entry.length > end) break;
    bool found = false;
    auto other = std::lower_bound(b.begin(), b.end(), entry.length - tolerance,
                                  [](const FeatureEntry& e, double length) { return e.length < length; });
    for (; !found && other != b.end() && other->length <= entry.length + tolerance; ++other) {
      found = other->species == entry.species && glm::length(other->offset - entry.offset) <= tolerance;
    }
    if (!found) return false;
  }
  return true;
}

// Both vectors end at `radius`; a shell that lies just there may be in one and not in the other by rounding.
bool same_surroundings(const std::vector<FeatureEntry>& a, const std::vector<FeatureEntry>& b, double radius,
                       double tolerance) {
  const double end = radius - 2.0 * tolerance;
  return contained(a, b, end, tolerance) && contained(b, a, end, tolerance);
}

// Directions spread evenly on the sphere (Fibonacci lattice).
std::vector<Vec3> even_directions() {
  constexpr int count = 4000;
  std::vector<Vec3> directions;
  for (int n = 0; n < count; ++n) {
    const double z = 1.0 - (2.0 * n + 1.0) / count;
    const double r = std::sqrt(1.0 - z * z);
    const double angle = n * std::numbers::pi * (3.0 - std::sqrt(5.0));
    directions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  return directions;
}

// The most near entries that lie strictly on one side of a plane through the site.
std::size_t half_space_count(const SiteKind& kind, const std::vector<Vec3>& directions) {
  std::size_t most = 0;
  for (const Vec3& direction : directions) {
    std::size_t count = 0;
    for (std::size_t e = 0; e < kind.near; ++e) count += glm::dot(kind.entries[e].offset, direction) > 0.0 ? 1 : 0;
    most = std::max(most, count);
  }
  return most;
}

// The length by which some entry lies within about 78° of every direction (a bond of diamond does within 71°); that of
// the last near entry where none ever does, as in a single layer.
double link_length(const SiteKind& kind, const std::vector<Vec3>& directions) {
  double link = 0.0;
  for (const Vec3& direction : directions) {
    const auto towards = std::find_if(kind.entries.begin(), kind.entries.end(), [&](const FeatureEntry& entry) {
      return glm::dot(entry.offset, direction) >= 0.2 * entry.length;
    });
    if (towards == kind.entries.end()) return kind.near > 0 ? kind.entries[kind.near - 1].length : 0.0;
    link = std::max(link, towards->length);
  }
  return link;
}

}  // namespace

EntryLookup::EntryLookup(const std::vector<FeatureEntry>& entries, double tolerance, double voxel)
    : tolerance2_(tolerance * tolerance) {
  if (entries.empty()) return;
  half_ = entries.back().length + tolerance;
  size_ = std::clamp(static_cast<int>(std::ceil(2.0 * half_ / voxel)), 1, 128);
  per_voxel_ = size_ / (2.0 * half_);
  const double edge = 1.0 / per_voxel_;
  // Twice over the entries: how many each voxel names, then the names.
  const auto for_voxels = [&](auto&& body) {
    for (std::size_t e = 0; e < entries.size(); ++e) {
      std::array<int, 3> low, high;
      for (int k = 0; k < 3; ++k) {
        low[k] = std::max(0, static_cast<int>((entries[e].offset[k] - tolerance + half_) * per_voxel_));
        high[k] = std::min(size_ - 1, static_cast<int>((entries[e].offset[k] + tolerance + half_) * per_voxel_));
      }
      for (int z = low[2]; z <= high[2]; ++z) {
        for (int y = low[1]; y <= high[1]; ++y) {
          for (int x = low[0]; x <= high[0]; ++x) {
            const Vec3 corner = Vec3(x, y, z) * edge - Vec3(half_);
            const Vec3 outside = entries[e].offset - glm::clamp(entries[e].offset, corner, corner + Vec3(edge));
            if (glm::length(outside) <= tolerance * (1.0 + 1e-9)) {
              body((static_cast<std::size_t>(z) * size_ + y) * size_ + x, static_cast<std::uint32_t>(e));
            }
          }
        }
      }
    }
  };
  start_.assign(static_cast<std::size_t>(size_) * size_ * size_ + 1, 0);
  for_voxels([&](std::size_t voxel_index, std::uint32_t) { ++start_[voxel_index + 1]; });
  for (std::size_t v = 1; v < start_.size(); ++v) start_[v] += start_[v - 1];
  entry_.resize(start_.back());
  std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
  for_voxels([&](std::size_t voxel_index, std::uint32_t e) { entry_[next[voxel_index]++] = e; });
}

int EntryLookup::find(const std::vector<FeatureEntry>& entries, const Vec3& q) const {
  const Vec3 scaled = (q + Vec3(half_)) * per_voxel_;
  const double end = size_;
  if (!(scaled.x >= 0.0 && scaled.y >= 0.0 && scaled.z >= 0.0 && scaled.x < end && scaled.y < end && scaled.z < end)) {
    return -1;
  }
  const std::size_t voxel = (static_cast<std::size_t>(scaled.z) * size_ + static_cast<std::size_t>(scaled.y)) * size_ +
                            static_cast<std::size_t>(scaled.x);
  for (std::uint32_t n = start_[voxel]; n < start_[voxel + 1]; ++n) {
    const Vec3 d = q - entries[entry_[n]].offset;
    if (glm::dot(d, d) <= tolerance2_) return static_cast<int>(entry_[n]);
  }
  return -1;
}

namespace {

// Nearest-neighbour distance of the crystal.
double nearest_distance(const CellSites& sites) {
  const auto shortest = reduce_lattice(sites.cell.primitive);
  double nearest = std::min({glm::length(shortest[0]), glm::length(shortest[1]), glm::length(shortest[2])});
  const std::size_t basis = sites.position.size();
  for (std::size_t i = 0; i < basis && basis > 1; ++i) {
    // Seen from each basis atom, somebody is within the distance found so far or it stands.
    const auto near = surroundings(sites, i, nearest);
    if (!near.empty()) nearest = std::min(nearest, near.front().length);
  }
  return nearest;
}

// Radius of the first shells around the basis atom that needs most.
double near_shells(const CellSites& sites, double nearest) {
  double near_radius = 0.0;
  for (std::size_t i = 0; i < sites.position.size(); ++i) {
    double shells = 0.0;
    double radius = 2.0 * nearest;
    for (; shells == 0.0 && radius < 5.0 * nearest; radius *= 1.2) {
      shells = first_shells(surroundings(sites, i, radius), radius, nearest);
    }
    near_radius = std::max(near_radius, shells > 0.0 ? shells : radius);
  }
  return near_radius;
}

// Adds the kinds of one grain, their entries reaching to `end`.
void add_kinds(const CellSites& sites, std::uint16_t grain, double end, FeatureSet& set) {
  const std::size_t first = set.kinds.size();
  std::vector<std::uint16_t> kind_of_basis;
  for (std::size_t i = 0; i < sites.position.size(); ++i) {
    SiteKind kind{sites.species[i], grain, surroundings(sites, i, end), 0, 0, 0, 0.0, {}};
    const auto same = [&](const SiteKind& known) {
      return known.species == kind.species && same_surroundings(known.entries, kind.entries, end, 2.0 * set.noise);
    };
    const auto found = std::find_if(set.kinds.begin() + static_cast<std::ptrdiff_t>(first), set.kinds.end(), same);
    kind_of_basis.push_back(static_cast<std::uint16_t>(found - set.kinds.begin()));
    if (found == set.kinds.end()) set.kinds.push_back(std::move(kind));
    if (set.kinds.size() > 65534) throw Error("unit cell: more than 65,534 kinds of sites");
  }
  const std::vector<Vec3> directions = even_directions();
  for (std::size_t k = first; k < set.kinds.size(); ++k) {
    SiteKind& kind = set.kinds[k];
    for (FeatureEntry& entry : kind.entries) {
      entry.kind = kind_of_basis[entry.kind];
      kind.near += entry.length <= set.near_radius ? 1 : 0;
      kind.counted += entry.length <= set.radius ? 1 : 0;
    }
    kind.enclosed = std::max(static_cast<std::size_t>(std::ceil(enclosed_share * static_cast<double>(kind.near))),
                             half_space_count(kind, directions) + 1);
    kind.link = link_length(kind, directions) + 0.5 * same_shell * set.nearest;
    kind.lookup = EntryLookup(kind.entries, set.tolerance, 0.2 * set.nearest);
    set.kinds_of[grain * set.in_crystal.size() + kind.species].push_back(static_cast<std::uint16_t>(k));
    set.in_crystal[kind.species] = 1;
  }
}

}  // namespace

FeatureSet build_feature_vectors(std::span<const UnitCell> cells, const std::vector<Species>& table,
                                 double neighbourhood, double tolerance, const NoiseLevel& noise) {
  if (!(neighbourhood > 0.0) || !std::isfinite(neighbourhood)) {
    throw UsageError("neighbourhood: expected a factor above 0, got " + std::to_string(neighbourhood));
  }
  if (!(tolerance >= 0.0) || !std::isfinite(tolerance)) {
    throw UsageError("tolerance: expected a length in Å, 0 for automatic, got " + std::to_string(tolerance));
  }
  FeatureSet set;
  std::vector<CellSites> grains;
  for (const UnitCell& cell : cells) {
    check_unit_cell(cell);
    grains.push_back(cell_sites(cell, table, set));
    const double nearest = nearest_distance(grains.back());
    set.nearest = grains.size() == 1 ? nearest : std::min(set.nearest, nearest);
    // Of the reduced vectors: a skew description of a crystal is the same crystal.
    const UnitCell reduced{reduce_lattice(cell.primitive), {}};
    set.radius = std::max(set.radius, neighbourhood * reduced.longest_primitive());
  }
  const double floor = std::max(noise_fraction * set.nearest, std::min(rounding, 0.02 * set.nearest));
  set.noise = set.rounding = floor;
  set.tolerance = tolerance;
  if (tolerance == 0.0) {
    set.tolerance =
        std::clamp(noise.factor * noise.amplitude, default_tolerance * set.nearest, largest_tolerance * set.nearest);
  } else if (tolerance > largest_tolerance * set.nearest) {
    set.tolerance = largest_tolerance * set.nearest;
    set.tolerance_limited = true;
  }
  set.pair_distance = pair_fraction * set.nearest;

  const double slack = 0.5 * same_shell * set.nearest;
  for (const CellSites& sites : grains) {
    set.near_radius = std::max(set.near_radius, near_shells(sites, set.nearest) + slack);
  }
  // Shells exactly at the radius belong to it whatever the rounding.
  set.radius += slack;
  const double farthest = set.farthest_counted();
  set.search_radius = farthest + set.tolerance;
  set.margin = std::min(std::max(slack, glance_amplitudes * noise.amplitude), set.tolerance);
  set.glance_radius = farthest + set.margin;

  const std::size_t species = table.size() + set.absent_species.size();
  set.in_crystal.assign(species, 0);
  set.kinds_of.resize(species * grains.size());
  // Vectors reach further than what counts, so that nothing near their ends is missing or extra by accident: an atom
  // that strayed out of the neighbourhood or into it still finds its entry.
  for (std::size_t g = 0; g < grains.size(); ++g) {
    add_kinds(grains[g], static_cast<std::uint16_t>(g), farthest + set.pair_distance, set);
  }
  set.noise = std::max(floor, noise.factor * noise.amplitude);
  return set;
}

FeatureSet build_feature_vectors(const UnitCell& cell, const std::vector<Species>& table, double neighbourhood,
                                 double tolerance) {
  return build_feature_vectors(std::span(&cell, 1), table, neighbourhood, tolerance);
}

}  // namespace atomesh
