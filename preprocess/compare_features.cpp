#include "preprocess/compare_features.h"

#include <algorithm>

namespace atomesh {

namespace {

double square(const Vec3& v) {
  return glm::dot(v, v);
}

bool better(const Match& a, const Match& b) {
  if (b.kind == no_kind) return true;
  if (a.near_matched != b.near_matched) return a.near_matched > b.near_matched;
  if (a.matched != b.matched) return a.matched > b.matched;
  return a.squares < b.squares;
}

}  // namespace

void FeatureComparer::fill(Match& match, std::uint16_t kind_number, const Vec3& shift,
                           const std::vector<Neighbour>& neighbours, bool any_species) const {
  const SiteKind& kind = features_.kinds[kind_number];
  match.kind = kind_number;
  match.shift = shift;
  match.entry.assign(neighbours.size(), -1);
  match.neighbour.assign(kind.entries.size(), -1);
  match.near_matched = match.near_stray = match.matched = 0;
  match.squares = 0.0;
  const auto distance2 = [&](int n, int e) { return square(neighbours[n].d + shift - kind.entries[e].offset); };
  for (std::size_t n = 0; n < neighbours.size(); ++n) {
    const int e = kind.lookup.find(kind.entries, neighbours[n].d + shift);
    if (e < 0 || !(any_species || kind.entries[e].species == neighbours[n].species)) continue;
    const int holder = match.neighbour[e];
    const int self = static_cast<int>(n);
    if (holder >= 0) {
      // Two atoms at one site: the nearer holds it, whatever order they come in.
      const double mine = distance2(self, e);
      const double theirs = distance2(holder, e);
      if (mine > theirs || (mine == theirs && holder < self)) continue;
      match.entry[holder] = -1;
    }
    match.neighbour[e] = self;
    match.entry[n] = e;
  }
  const double near2 = features_.near_radius * features_.near_radius;
  const int near = static_cast<int>(kind.near);
  for (std::size_t n = 0; n < neighbours.size(); ++n) {
    const int e = match.entry[n];
    if (e >= 0) {
      ++match.matched;
      match.near_matched += e < near ? 1 : 0;
      match.squares += distance2(static_cast<int>(n), e);
    } else if (features_.in_crystal[neighbours[n].species] && square(neighbours[n].d + shift) <= near2) {
      ++match.near_stray;
    }
  }
}

const Match& FeatureComparer::match_kind(std::uint16_t kind, const Vec3& shift,
                                         const std::vector<Neighbour>& neighbours, bool any_species) {
  fill(best_, kind, shift, neighbours, any_species);
  return best_;
}

// The kinds, those first whose near entries most neighbours are at: at most that many can match.
void FeatureComparer::rank(std::span<const std::uint16_t> kinds, const std::vector<Neighbour>& neighbours) {
  ranked_.clear();
  // Trying one or two outright costs less than ranking them.
  const bool few = kinds.size() <= 2;
  for (const std::uint16_t number : kinds) ranked_.push_back({few ? neighbours.size() : 0, number});
  if (few) return;
  const double reach = features_.near_radius + features_.tolerance;
  for (const Neighbour& n : neighbours) {
    if (square(n.d) > reach * reach) continue;
    for (Ranked& ranked : ranked_) {
      const SiteKind& kind = features_.kinds[ranked.kind];
      const int e = kind.lookup.find(kind.entries, n.d);
      if (e >= 0 && e < static_cast<int>(kind.near) && kind.entries[e].species == n.species) ++ranked.most;
    }
  }
  std::stable_sort(ranked_.begin(), ranked_.end(), [](const Ranked& a, const Ranked& b) { return a.most > b.most; });
}

const Match& FeatureComparer::match(std::span<const std::uint16_t> kinds, const std::vector<Neighbour>& neighbours) {
  best_.kind = no_kind;
  rank(kinds, neighbours);
  for (const Ranked& ranked : ranked_) {
    if (best_.kind != no_kind && ranked.most < best_.near_matched) break;
    Match& target = best_.kind == no_kind ? best_ : trial_;
    fill(target, ranked.kind, Vec3(0.0), neighbours, false);
    if (&target == &trial_ && better(trial_, best_)) std::swap(best_, trial_);
    if (best_.matched == neighbours.size() && best_.squares <= features_.rounding * features_.rounding) break;
  }
  return best_;
}

// Moves the shift to what the matched near neighbours say, twice: the second time with those the first one gained.
void FeatureComparer::refine(const std::vector<Neighbour>& neighbours) {
  for (int round = 0; round < 2; ++round) {
    const SiteKind& kind = features_.kinds[best_.kind];
    Vec3 sum(0.0);
    for (std::size_t e = 0; e < kind.near; ++e) {
      if (best_.neighbour[e] >= 0) sum += kind.entries[e].offset - neighbours[best_.neighbour[e]].d;
    }
    if (best_.near_matched == 0) return;
    fill(trial_, best_.kind, sum / static_cast<double>(best_.near_matched), neighbours, false);
    if (!better(trial_, best_)) return;
    std::swap(best_, trial_);
  }
}

bool FeatureComparer::site_taken(std::uint16_t species, const Vec3& shift,
                                 const std::vector<Neighbour>& neighbours) const {
  const double mine = square(shift);
  for (const Neighbour& n : neighbours) {
    if (n.species == species && square(n.d + shift) < std::min(mine, features_.tolerance * features_.tolerance))
      return true;
  }
  return false;
}

const Match& FeatureComparer::match_shifted(std::span<const std::uint16_t> kinds,
                                            const std::vector<Neighbour>& neighbours) {
  best_.kind = no_kind;
  if (kinds.empty()) return best_;
  const std::uint16_t species = features_.kinds[kinds.front()].species;
  for (const std::uint16_t kind : kinds) {
    fill(trial_, kind, Vec3(0.0), neighbours, false);
    if (better(trial_, best_)) std::swap(best_, trial_);
  }
  if (best_.kind == no_kind) return best_;
  refine(neighbours);
  if (best_.lost()) {
    // Every neighbour taken for every entry of the first shell proposes a shift.
    const double far2 = features_.pair_distance * features_.pair_distance;
    for (const std::uint16_t number : kinds) {
      const SiteKind& kind = features_.kinds[number];
      if (kind.entries.empty()) continue;
      const double shell = 1.1 * kind.entries.front().length;
      const double reach = shell + features_.pair_distance;
      for (const Neighbour& n : neighbours) {
        if (square(n.d) > reach * reach) continue;
        for (std::size_t e = 0; e < kind.near && kind.entries[e].length <= shell; ++e) {
          const Vec3 shift = kind.entries[e].offset - n.d;
          if (kind.entries[e].species != n.species || square(shift) > far2 || site_taken(species, shift, neighbours)) {
            continue;
          }
          fill(trial_, number, shift, neighbours, false);
          if (better(trial_, best_)) std::swap(best_, trial_);
        }
      }
    }
    refine(neighbours);
  }
  if (best_.lost()) best_.kind = no_kind;
  return best_;
}

}  // namespace atomesh
