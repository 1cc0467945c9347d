#include "preprocess/defect_sites.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "preprocess/compare_features.h"

namespace atomesh {

namespace {

// Votes for one site scatter by the strain over the first shells; sites are 1 apart (all over the nearest distance).
constexpr double vote_spread = 0.35;
constexpr double voting_share = 0.6;
// A void of more sites than this is a cavity of the sample's shape.
constexpr std::size_t largest_void = 64;
constexpr std::size_t piece = 256;

struct Vote {
  Vec3 place;
  std::uint16_t species;
  std::uint16_t kind;
};

struct Candidate {
  VacancySite site;
  std::uint16_t kind = 0;
  std::size_t filled = 0;  // near sites that hold an atom
  bool possible = false;   // the atoms around it agree that their neighbour is missing
  bool foreign = false;    // an atom of another species sits there
  enum class Verdict : std::uint8_t { open, vacancy, outside } verdict = Verdict::open;
};

std::vector<Vote> collect_votes(const SiteSearch& search, Progress& progress) {
  std::vector<Vote> votes;
  const std::size_t species_count = search.sample.atoms.species_table.size();
  std::size_t looked = 0;
  for (const Misfit& m : search.misfits.atoms) {
    if (++looked % 65536 == 0) progress.check();
    if (m.kind == no_kind || !search.reliable(m.slot)) continue;
    const SiteKind& kind = search.sample.features.kinds[m.kind];
    for (const std::uint32_t e : search.misfits.missing_of(m)) {
      const FeatureEntry& entry = kind.entries[e];
      // What the whole sample lacks has no number in its table and cannot be reported as a site.
      if (e >= kind.near || entry.species >= species_count) continue;
      votes.push_back({search.sample.grid.wrap(m.site + entry.offset), entry.species, entry.kind});
    }
  }
  return votes;
}

std::vector<Vec3> places(const std::vector<Vote>& votes) {
  std::vector<Vec3> result;
  result.reserve(votes.size());
  for (const Vote& vote : votes) result.push_back(vote.place);
  return result;
}

// Votes of one species within the spread of the first of them make a candidate at their mean; its kind is the one most
// of them name.
std::vector<Candidate> gather(const SiteSearch& search, const std::vector<Vote>& votes, Progress& progress) {
  std::vector<Candidate> candidates;
  const double spread = vote_spread * search.sample.features.nearest;
  const NeighbourGrid grid(places(votes), search.sample.atoms.box, spread, spread, progress);
  std::vector<std::uint8_t> used(votes.size(), 0);
  std::vector<Index> slots;
  std::vector<std::uint16_t> kinds;
  std::size_t looked = 0;
  for (const Index seed : grid.home_slots()) {
    if (++looked % 1024 == 0) progress.check();
    const Vote& first = votes[grid.point(seed)];
    if (used[grid.point(seed)]) continue;
    grid.find(grid.position(seed), spread, slots);
    Vec3 sum(0.0);
    kinds.clear();
    for (const Index slot : slots) {
      const Vote& vote = votes[grid.point(slot)];
      if (used[grid.point(slot)] || vote.species != first.species) continue;
      used[grid.point(slot)] = 1;
      sum += grid.position(slot) - grid.position(seed);
      kinds.push_back(vote.kind);
    }
    const double count = static_cast<double>(kinds.size());
    Candidate candidate;
    candidate.site = {search.sample.grid.wrap(grid.position(seed) + sum / count), first.species,
                      static_cast<Index>(kinds.size())};
    std::sort(kinds.begin(), kinds.end());
    std::size_t most = 0;
    for (std::size_t n = 0; n < kinds.size();) {
      const auto end = std::upper_bound(kinds.begin(), kinds.end(), kinds[n]);
      const auto same = static_cast<std::size_t>(end - kinds.begin()) - n;
      if (same > most) {
        most = same;
        candidate.kind = kinds[n];
      }
      n += same;
    }
    candidates.push_back(std::move(candidate));
  }
  return candidates;
}

// Looks at the atoms around a candidate.
void inspect(const SiteSearch& search, Candidate& candidate, FeatureComparer& comparer, std::vector<Index>& slots,
             std::vector<Neighbour>& neighbours) {
  const FeatureSet& features = search.sample.features;
  const SiteKind& kind = features.kinds[candidate.kind];
  const double pair2 = features.pair_distance * features.pair_distance;
  search.sample.grid.find(candidate.site.position, features.near_radius + features.tolerance, slots);
  neighbours.clear();
  bool boundary = false;
  for (const Index slot : slots) {
    const std::uint16_t grain = search.standing[search.sample.grid.point(slot)];
    boundary = boundary || (grain != no_grain && grain != kind.grain);
    const Vec3 d = search.sample.grid.position(slot) - candidate.site.position;
    const std::uint16_t species = search.sample.atoms.species[search.sample.grid.point(slot)];
    if (glm::dot(d, d) <= pair2) {
      if (species == candidate.site.species) return;
      candidate.foreign = true;
    }
    neighbours.push_back({d, species});
  }
  const Match& match = comparer.match_kind(candidate.kind, Vec3(0.0), neighbours, true);
  if (search.sample.several_grains() && (boundary || 6 * match.near_stray > kind.near)) return;
  std::size_t asked = 0;
  for (std::size_t e = 0; e < kind.near; ++e) {
    const int n = match.neighbour[e];
    if (n < 0) continue;
    ++candidate.filled;
    const bool right = neighbours[n].species == kind.entries[e].species;
    asked += right && search.reliable(slots[n]) ? 1 : 0;
  }
  candidate.possible = static_cast<double>(candidate.site.votes) >= voting_share * static_cast<double>(asked);
}

// Follows empty sites from neighbour to neighbour (SiteKind::link of either).
class VoidWalk {
 public:
  explicit VoidWalk(const SiteSearch& search) : search_(search) {}

  struct Site {
    Vec3 place;
    std::uint16_t kind;
  };
  // True when the void around the (empty) site ends after at most largest_void sites; visited() are those seen.
  bool closed(const Site& start) {
    visited_.assign(1, start);
    for (std::size_t n = 0; n < visited_.size(); ++n) {
      const SiteKind& kind = search_.sample.features.kinds[visited_[n].kind];
      for (const FeatureEntry& entry : kind.entries) {
        if (entry.length > std::max(kind.link, search_.sample.features.kinds[entry.kind].link)) continue;
        const Site next{visited_[n].place + entry.offset, entry.kind};
        if (known(next) || filled(next)) continue;
        if (visited_.size() == largest_void) return false;
        visited_.push_back(next);
      }
    }
    return true;
  }
  const std::vector<Site>& visited() const { return visited_; }

 private:
  bool known(const Site& site) const {
    const double apart = 0.5 * search_.sample.features.nearest;
    return std::any_of(visited_.begin(), visited_.end(), [&](const Site& other) {
      return glm::length(search_.sample.grid.nearest_image(site.place - other.place)) < apart;
    });
  }
  // Where another grain begins the void ends: its atoms leave sites of this one empty all over it.
  bool filled(const Site& site) {
    const FeatureSet& features = search_.sample.features;
    const bool several = search_.sample.several_grains();
    const Vec3 place = search_.sample.grid.wrap(site.place);
    search_.sample.grid.find(place, several ? features.nearest : features.pair_distance, slots_);
    if (!several) return !slots_.empty();
    const double pair2 = features.pair_distance * features.pair_distance;
    return std::any_of(slots_.begin(), slots_.end(), [&](Index slot) {
      const Vec3 d = search_.sample.grid.position(slot) - place;
      return glm::dot(d, d) <= pair2 ||
             search_.standing[search_.sample.grid.point(slot)] != features.kinds[site.kind].grain;
    });
  }

  const SiteSearch& search_;
  std::vector<Site> visited_;
  std::vector<Index> slots_;
};

// From each enclosed candidate walks its void: where the void is closed its candidates are vacancies, where it is open
// they lie outside the sample.
void judge(const SiteSearch& search, std::vector<Candidate>& candidates, Progress& progress) {
  const double apart = 0.5 * search.sample.features.nearest;
  std::vector<Vec3> positions;
  for (const Candidate& candidate : candidates) positions.push_back(candidate.site.position);
  const NeighbourGrid grid(positions, search.sample.atoms.box, apart, apart);
  VoidWalk walk(search);
  std::vector<Index> slots;
  std::size_t looked = 0;
  for (Candidate& seed : candidates) {
    if (++looked % 64 == 0) progress.check();
    const SiteKind& kind = search.sample.features.kinds[seed.kind];
    if (!seed.possible || seed.verdict != Candidate::Verdict::open) continue;
    if (seed.foreign) {
      // The atom that took the place shows that the place belongs to the sample.
      if (4 * seed.filled >= kind.near) seed.verdict = Candidate::Verdict::vacancy;
      continue;
    }
    if (seed.filled < kind.enclosed) continue;
    const auto verdict =
        walk.closed({seed.site.position, seed.kind}) ? Candidate::Verdict::vacancy : Candidate::Verdict::outside;
    for (const VoidWalk::Site& site : walk.visited()) {
      grid.find(grid.wrap(site.place), apart, slots);
      for (const Index slot : slots) {
        Candidate& candidate = candidates[grid.point(slot)];
        if (candidate.possible && !candidate.foreign) candidate.verdict = verdict;
      }
    }
  }
}

// Two candidates for one place (votes that scatter more than usual) are one site: the one with more votes.
std::vector<VacancySite> distinct(const SiteSearch& search, const std::vector<Candidate>& candidates) {
  std::vector<VacancySite> sites;
  for (const Candidate& candidate : candidates) {
    if (candidate.verdict == Candidate::Verdict::vacancy) sites.push_back(candidate.site);
  }
  std::vector<Vec3> positions;
  for (const VacancySite& site : sites) positions.push_back(site.position);
  const double apart = 0.5 * search.sample.features.nearest;
  const NeighbourGrid grid(positions, search.sample.atoms.box, apart, apart);
  std::vector<Index> slots;
  std::vector<VacancySite> kept;
  for (const Index home : grid.home_slots()) {
    const Index self = grid.point(home);
    grid.find(grid.position(home), apart, slots, home);
    const bool best = std::none_of(slots.begin(), slots.end(), [&](Index slot) {
      const Index other = grid.point(slot);
      return sites[other].species == sites[self].species && other != self &&
             (sites[other].votes > sites[self].votes || (sites[other].votes == sites[self].votes && other < self));
    });
    if (best) kept.push_back(sites[self]);
  }
  return kept;
}

// Whether three quarters of the atoms stand in one grain and none in another.
bool inside_a_grain(const SiteSearch& search, const std::vector<Index>& slots) {
  std::uint16_t grain = no_grain;
  std::size_t standing = 0;
  for (const Index slot : slots) {
    const std::uint16_t other = search.standing[search.sample.grid.point(slot)];
    if (other == no_grain) continue;
    if (grain != no_grain && grain != other) return false;
    grain = other;
    ++standing;
  }
  return 4 * standing >= 3 * slots.size();
}

}  // namespace

std::vector<VacancySite> find_vacancies(const SiteSearch& search, Progress& progress) {
  const std::vector<Vote> votes = collect_votes(search, progress);
  std::vector<Candidate> candidates = gather(search, votes, progress);
  progress.update(0.3);
  // Outside a flat surface a site gathers less than half of its near neighbours' votes; most are left out here.
  std::erase_if(candidates, [&](const Candidate& candidate) {
    return 3 * candidate.site.votes < search.sample.features.kinds[candidate.kind].enclosed;
  });
  parallel_for(candidates.size(), piece, [&](std::size_t begin, std::size_t end) {
    FeatureComparer comparer(search.sample.features);
    std::vector<Index> slots;
    std::vector<Neighbour> neighbours;
    progress.check();
    for (std::size_t n = begin; n < end; ++n) inspect(search, candidates[n], comparer, slots, neighbours);
  });
  judge(search, candidates, progress);
  std::vector<VacancySite> sites = distinct(search, candidates);
  std::sort(sites.begin(), sites.end(), [](const VacancySite& a, const VacancySite& b) {
    const Vec3& p = a.position;
    const Vec3& q = b.position;
    return std::tie(p.z, p.y, p.x, a.species) < std::tie(q.z, q.y, q.x, b.species);
  });
  return sites;
}

std::vector<ExtraAtom> find_extras(const SiteSearch& search, Progress& progress) {
  const FeatureSet& features = search.sample.features;
  const std::size_t count = search.sample.atoms.size();
  std::vector<Index> votes(count, 0);
  for (const Misfit& m : search.misfits.atoms) {
    if (m.kind == no_kind || !search.reliable(m.slot)) continue;
    for (const Index slot : search.misfits.strays_of(m)) {
      if (glm::length(search.sample.grid.position(slot) - m.site) > features.near_radius) continue;
      ++votes[search.sample.grid.point(slot)];
    }
  }
  std::vector<std::uint8_t> extra(count, 0);
  const std::span<const Index> homes = search.sample.grid.home_slots();
  parallel_for(homes.size(), 4096, [&](std::size_t begin, std::size_t end) {
    progress.check();
    std::vector<Index> slots;
    for (std::size_t h = begin; h < end; ++h) {
      const Index atom = search.sample.grid.point(homes[h]);
      if (!features.in_crystal[search.sample.atoms.species[atom]]) {
        extra[atom] = 1;
      } else if (votes[atom] >= 2) {
        search.sample.grid.find(search.sample.grid.position(homes[h]), features.near_radius, slots, homes[h]);
        std::size_t asked = 0;
        for (const Index slot : slots) asked += search.reliable(slot) ? 1 : 0;
        if (search.sample.several_grains() && !inside_a_grain(search, slots)) continue;
        extra[atom] = static_cast<double>(votes[atom]) >= voting_share * static_cast<double>(asked) ? 1 : 0;
      }
    }
  });
  std::vector<ExtraAtom> extras;
  for (std::size_t atom = 0; atom < count; ++atom) {
    if (extra[atom]) extras.push_back({static_cast<Index>(atom), votes[atom]});
  }
  return extras;
}

std::vector<Substitution> find_substitutions(const SiteSearch& search, const std::vector<VacancySite>& vacancies,
                                             const std::vector<ExtraAtom>& extras) {
  if (vacancies.empty() || extras.empty()) return {};
  struct Pair {
    double distance2;
    Index atom;
    Index vacancy;
  };
  std::vector<std::uint8_t> extra(search.sample.atoms.size(), 0);
  for (const ExtraAtom& e : extras) extra[e.atom] = 1;
  std::vector<Pair> pairs;
  std::vector<Index> slots;
  for (Index v = 0; v < vacancies.size(); ++v) {
    search.sample.grid.find(vacancies[v].position, search.sample.features.pair_distance, slots);
    for (const Index slot : slots) {
      const Index atom = search.sample.grid.point(slot);
      if (!extra[atom] || search.sample.atoms.species[atom] == vacancies[v].species) continue;
      const Vec3 d = search.sample.grid.position(slot) - vacancies[v].position;
      pairs.push_back({glm::dot(d, d), atom, v});
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.distance2, a.atom, a.vacancy) < std::tie(b.distance2, b.atom, b.vacancy);
  });
  std::vector<std::uint8_t> filled(vacancies.size(), 0);
  std::vector<Substitution> substitutions;
  for (const Pair& pair : pairs) {
    if (!extra[pair.atom] || filled[pair.vacancy]) continue;
    extra[pair.atom] = 0;
    filled[pair.vacancy] = 1;
    substitutions.push_back({pair.atom, vacancies[pair.vacancy].species, pair.vacancy});
  }
  std::sort(substitutions.begin(), substitutions.end(),
            [](const Substitution& a, const Substitution& b) { return a.atom < b.atom; });
  return substitutions;
}

}  // namespace atomesh
