#include "preprocess/examine_atoms.h"

#include <algorithm>
#include <tuple>

namespace atomesh {

namespace {

// A neighbourhood this many times as crowded as the crystal's is not compared.
constexpr std::size_t crowd = 40;

}  // namespace

void Examiner::find_neighbours(Index slot, double radius) {
  const Vec3 centre = sample_.grid.position(slot);
  sample_.grid.find(centre, radius, slots_, slot);
  neighbours_.resize(slots_.size());
  for (std::size_t n = 0; n < slots_.size(); ++n) {
    neighbours_[n] = {sample_.grid.position(slots_[n]) - centre, sample_.species(slots_[n])};
  }
}

// What the atom may be: of its own grain's kinds, or of those of the grains around it.
std::span<const std::uint16_t> Examiner::kinds_for(Index slot) {
  const std::uint16_t grain = sample_.grain(slot);
  const std::uint16_t species = sample_.species(slot);
  if (grain != no_grain) return sample_.features.kinds_in(grain, species);
  sample_.grid.find(sample_.grid.position(slot), sample_.features.near_radius, slots_, slot);
  grains_.clear();
  for (const Index near : slots_) {
    if (sample_.grain(near) != no_grain) grains_.push_back(sample_.grain(near));
  }
  std::sort(grains_.begin(), grains_.end());
  grains_.erase(std::unique(grains_.begin(), grains_.end()), grains_.end());
  kinds_.clear();
  for (const std::uint16_t near : grains_) {
    const auto kinds = sample_.features.kinds_in(near, species);
    kinds_.insert(kinds_.end(), kinds.begin(), kinds.end());
  }
  return kinds_;
}

bool Examiner::crowded(Index slot, std::span<const std::uint16_t> kinds) const {
  std::size_t most = 0;
  for (const std::uint16_t kind : kinds) most = std::max(most, sample_.features.kinds[kind].entries.size());
  return sample_.grid.count_candidates(sample_.grid.position(slot), sample_.features.search_radius) >
         crowd * (most + 10);
}

const Match* Examiner::match(Index slot) {
  const std::span<const std::uint16_t> kinds = kinds_for(slot);
  if (kinds.empty() || crowded(slot, kinds)) return nullptr;
  find_neighbours(slot, sample_.features.search_radius);
  return &comparer_.match(kinds, neighbours_);
}

// A neighbour too far from every entry to match, but within the pair distance of an empty one of its species, was
// displaced from it: nearest first, each once.
void Examiner::pair_displaced(const Match& match) {
  const FeatureSet& features = sample_.features;
  const SiteKind& kind = features.kinds[match.kind];
  const double limit = features.pair_distance * features.pair_distance;
  pairs_.clear();
  for (std::size_t n = 0; n < neighbours_.size(); ++n) {
    if (match.entry[n] >= 0) continue;
    const Vec3 place = neighbours_[n].d + match.shift;
    const double length = glm::length(place);
    for (std::size_t e = 0; e < kind.entries.size(); ++e) {
      const FeatureEntry& entry = kind.entries[e];
      if (entry.length < length - features.pair_distance) continue;
      if (entry.length > length + features.pair_distance) break;
      if (match.neighbour[e] >= 0 || entry.species != neighbours_[n].species) continue;
      const Vec3 d = place - entry.offset;
      const double distance2 = glm::dot(d, d);
      if (distance2 <= limit) pairs_.push_back({distance2, static_cast<std::uint32_t>(e), static_cast<Index>(n)});
    }
  }
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.distance2, a.entry, a.neighbour) < std::tie(b.distance2, b.entry, b.neighbour);
  });
  occupant_.assign(kind.entries.size(), -1);
  home_.assign(neighbours_.size(), -1);
  for (const Pair& pair : pairs_) {
    if (occupant_[pair.entry] >= 0 || home_[pair.neighbour] >= 0) continue;
    occupant_[pair.entry] = static_cast<int>(pair.neighbour);
    home_[pair.neighbour] = static_cast<int>(pair.entry);
  }
}

void Examiner::examine(Index slot, Defects& defects, std::uint16_t& standing, RangeResult& result) {
  const FeatureSet& features = sample_.features;
  const Index atom = sample_.grid.point(slot);
  standing = no_grain;
  const std::span<const std::uint16_t> kinds = kinds_for(slot);
  const auto lose = [&] {
    defects.extra[atom] = 1.0F;
    if (!kinds.empty()) result.census.strays += features.kinds[kinds.front()].near;
  };
  if (kinds.empty()) return lose();
  const double nearest2 = features.nearest * features.nearest;
  if (GlanceResult glance; glance_.settled(slot, kinds, glance)) {
    const SiteKind& kind = features.kinds[glance.kind];
    defects.positional[atom] = static_cast<float>(glance.squares / nearest2);
    result.census.matched += kind.counted;
    if (kind.near >= 2) standing = kind.grain;
    return;
  }
  if (crowded(slot, kinds)) return lose();
  find_neighbours(slot, features.search_radius);
  const Match* match = &comparer_.match(kinds, neighbours_);
  if (search_shifts_ && match->near_stray > 0) {
    // Perhaps the others are in place and the centre is not.
    find_neighbours(slot, features.search_radius + features.pair_distance);
    match = &comparer_.match_shifted(kinds, neighbours_);
  }
  if (match->lost()) return lose();
  const SiteKind& kind = features.kinds[match->kind];
  if (match->reliable()) standing = kind.grain;

  // Displacements count as the atom itself sees them, without the shift that helped to recognise its neighbours.
  double squares = 0.0;
  std::size_t matched = 0;
  const double noise2 = features.noise * features.noise;
  for (std::size_t e = 0; e < kind.counted; ++e) {
    if (match->neighbour[e] < 0) continue;
    ++matched;
    const Vec3 d = neighbours_[match->neighbour[e]].d - kind.entries[e].offset;
    const double square = glm::dot(d, d);
    if (square > noise2) squares += square;
  }
  defects.positional[atom] = static_cast<float>(squares / nearest2);
  result.census.matched += matched;
  if (match->matched == neighbours_.size() && matched == kind.counted && match->near_matched == kind.near) return;
  pair_displaced(*match);
  keep_misfit(slot, *match, defects, result);
}

void Examiner::keep_misfit(Index slot, const Match& match, Defects& defects, RangeResult& result) {
  const FeatureSet& features = sample_.features;
  const SiteKind& kind = features.kinds[match.kind];
  const Index atom = sample_.grid.point(slot);
  Misfit misfit{slot,
                match.kind,
                sample_.grid.position(slot) - match.shift,
                result.misfits.missing.size(),
                0,
                result.misfits.strays.size(),
                0};
  std::size_t absent = 0;
  for (std::size_t e = 0; e < std::max(kind.near, kind.counted); ++e) {
    if (match.neighbour[e] >= 0) continue;
    if (occupant_[e] < 0) {
      if (search_shifts_) result.misfits.missing.push_back(static_cast<std::uint32_t>(e));
    } else if (e < kind.counted) {
      ++absent;
    }
  }
  std::size_t strays = 0;
  const double radius2 = features.radius * features.radius;
  const double near2 = features.near_radius * features.near_radius;
  for (std::size_t n = 0; n < neighbours_.size(); ++n) {
    if (match.entry[n] >= 0) continue;
    const Vec3 place = neighbours_[n].d + match.shift;
    const double distance2 = glm::dot(place, place);
    // A displaced or foreign atom counts when the place it should or does take counts.
    const int e = home_[n] >= 0 ? home_[n] : kind.lookup.find(kind.entries, place);
    const bool counted = e >= 0 ? e < static_cast<int>(kind.counted) : distance2 <= radius2;
    if (counted) {
      ++strays;
      result.census.strays += features.in_crystal[neighbours_[n].species];
    }
    if (search_shifts_ && home_[n] < 0 && distance2 <= std::max(radius2, near2)) {
      result.misfits.strays.push_back(slots_[n]);
    }
  }
  defects.vacancy[atom] = static_cast<float>(absent);
  defects.extra[atom] = static_cast<float>(strays);
  result.census.absent += absent;
  misfit.missing = result.misfits.missing.size() - misfit.first_missing;
  misfit.strays = result.misfits.strays.size() - misfit.first_stray;
  if (misfit.missing + misfit.strays > 0) result.misfits.atoms.push_back(misfit);
}

}  // namespace atomesh
