#include "preprocess/examine_atoms.h"

#include <algorithm>
#include <tuple>

namespace atomesh {

namespace {

// A neighbourhood this many times as crowded as the crystal's is not compared.
constexpr std::size_t crowd = 40;

}  // namespace

void Examiner::find_neighbours(Index slot, double radius) {
  const Vec3 centre = grid_.position(slot);
  grid_.find(centre, radius, slots_, slot);
  neighbours_.resize(slots_.size());
  for (std::size_t n = 0; n < slots_.size(); ++n) {
    neighbours_[n] = {grid_.position(slots_[n]) - centre, atoms_.species[grid_.point(slots_[n])]};
  }
}

bool Examiner::crowded(Index slot) const {
  std::size_t most = 0;
  for (const std::uint16_t kind : features_.kinds_of[atoms_.species[grid_.point(slot)]]) {
    most = std::max(most, features_.kinds[kind].entries.size());
  }
  return grid_.count_candidates(grid_.position(slot), features_.search_radius) > crowd * (most + 10);
}

bool Examiner::fits(Index slot) {
  if (crowded(slot)) return false;
  find_neighbours(slot, features_.search_radius);
  return comparer_.match(atoms_.species[grid_.point(slot)], neighbours_).reliable();
}

// A neighbour too far from every entry to match, but within the pair distance of an empty one of its species, was
// displaced from it: nearest first, each once.
void Examiner::pair_displaced(const Match& match) {
  const SiteKind& kind = features_.kinds[match.kind];
  const double limit = features_.pair_distance * features_.pair_distance;
  pairs_.clear();
  for (std::size_t n = 0; n < neighbours_.size(); ++n) {
    if (match.entry[n] >= 0) continue;
    const Vec3 place = neighbours_[n].d + match.shift;
    const double length = glm::length(place);
    for (std::size_t e = 0; e < kind.entries.size(); ++e) {
      const FeatureEntry& entry = kind.entries[e];
      if (entry.length < length - features_.pair_distance) continue;
      if (entry.length > length + features_.pair_distance) break;
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

// Most atoms are in place and so is everybody around them; a look hardly beyond what counts tells. Nobody further away
// can hold an entry better: no displacement exceeds what the glance reaches further.
bool Examiner::settled(const Match& match) const {
  const double margin = features_.glance_radius - features_.farthest_counted();
  if (match.matched != neighbours_.size() || match.squares > margin * margin) return false;
  const SiteKind& kind = features_.kinds[match.kind];
  const auto end = match.neighbour.begin() + static_cast<std::ptrdiff_t>(std::max(kind.near, kind.counted));
  return std::find(match.neighbour.begin(), end, -1) == end;
}

void Examiner::examine(Index slot, Defects& defects, std::vector<std::uint8_t>& reliable, RangeResult& result) {
  const Index atom = grid_.point(slot);
  const std::uint16_t species = atoms_.species[atom];
  const auto lose = [&] {
    defects.extra[atom] = 1.0F;
    if (features_.kinds_of[species].empty()) return;
    result.census.strays += features_.kinds[features_.kinds_of[species][0]].near;
  };
  if (features_.kinds_of[species].empty() || crowded(slot)) return lose();
  find_neighbours(slot, features_.glance_radius);
  const Match* match = &comparer_.match(species, neighbours_);
  if (!settled(*match)) {
    find_neighbours(slot, features_.search_radius);
    match = &comparer_.match(species, neighbours_);
    if (search_shifts_ && match->near_stray > 0) {
      // Perhaps the others are in place and the centre is not.
      find_neighbours(slot, features_.search_radius + features_.pair_distance);
      match = &comparer_.match_shifted(species, neighbours_);
    }
  }
  if (match->lost()) return lose();
  const SiteKind& kind = features_.kinds[match->kind];
  reliable[atom] = match->reliable() ? 1 : 0;

  // Displacements count as the atom itself sees them, without the shift that helped to recognise its neighbours.
  double squares = 0.0;
  std::size_t matched = 0;
  const double noise2 = features_.noise * features_.noise;
  for (std::size_t e = 0; e < kind.counted; ++e) {
    if (match->neighbour[e] < 0) continue;
    ++matched;
    const Vec3 d = neighbours_[match->neighbour[e]].d - kind.entries[e].offset;
    const double square = glm::dot(d, d);
    if (square > noise2) squares += square;
  }
  defects.positional[atom] = static_cast<float>(squares / (features_.nearest * features_.nearest));
  result.census.matched += matched;

  const std::size_t farthest = std::max(kind.near, kind.counted);
  if (match->matched == neighbours_.size() && matched == kind.counted && match->near_matched == kind.near) return;
  pair_displaced(*match);
  Misfit misfit{slot,
                match->kind,
                grid_.position(slot) - match->shift,
                result.misfits.missing.size(),
                0,
                result.misfits.strays.size(),
                0};
  std::size_t absent = 0;
  for (std::size_t e = 0; e < farthest; ++e) {
    if (match->neighbour[e] >= 0) continue;
    if (occupant_[e] < 0) {
      result.misfits.missing.push_back(static_cast<std::uint32_t>(e));
    } else if (e < kind.counted) {
      ++absent;
    }
  }
  std::size_t strays = 0;
  const double radius2 = features_.radius * features_.radius;
  const double near2 = features_.near_radius * features_.near_radius;
  for (std::size_t n = 0; n < neighbours_.size(); ++n) {
    if (match->entry[n] >= 0) continue;
    const Vec3 place = neighbours_[n].d + match->shift;
    const double distance2 = glm::dot(place, place);
    // A displaced or foreign atom counts when the place it should or does take counts.
    const int e = home_[n] >= 0 ? home_[n] : kind.lookup.find(kind.entries, place);
    const bool counted = e >= 0 ? e < static_cast<int>(kind.counted) : distance2 <= radius2;
    if (counted) {
      ++strays;
      result.census.strays += features_.kinds_of[neighbours_[n].species].empty() ? 0 : 1;
    }
    if (home_[n] < 0 && distance2 <= std::max(radius2, near2)) result.misfits.strays.push_back(slots_[n]);
  }
  defects.vacancy[atom] = static_cast<float>(absent);
  defects.extra[atom] = static_cast<float>(strays);
  result.census.absent += absent;
  misfit.missing = result.misfits.missing.size() - misfit.first_missing;
  misfit.strays = result.misfits.strays.size() - misfit.first_stray;
  if (misfit.missing + misfit.strays > 0) result.misfits.atoms.push_back(misfit);
}

}  // namespace atomesh
