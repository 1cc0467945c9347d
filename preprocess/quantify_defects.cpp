#include "preprocess/quantify_defects.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/error.h"
#include "core/parallel.h"
#include "preprocess/compare_features.h"
#include "preprocess/defect_sites.h"
#include "preprocess/feature_vectors.h"
#include "preprocess/neighbour_grid.h"

namespace atomesh {

namespace {

constexpr std::size_t grain = 1024;
// Below this share of matched neighbours the cell is not the sample's.
constexpr double fitting_share = 0.5;
// A neighbourhood this many times as crowded as the crystal's is not compared.
constexpr std::size_t crowd = 40;

// What one range of atoms found, put together in order afterwards.
struct RangeResult {
  Misfits misfits;
  std::size_t matched = 0;
  std::size_t absent = 0;  // missing inside the sample
  std::size_t strays = 0;  // of species that the cell has
};

// Compares atoms with the perfect crystal, one after the other. One per thread.
class Examiner {
 public:
  Examiner(const Atoms& atoms, const FeatureSet& features, const NeighbourGrid& grid, bool search_shifts)
      : atoms_(atoms), features_(features), grid_(grid), search_shifts_(search_shifts), comparer_(features) {}

  // Fills the atom's values with what is certain from its own neighbourhood; the rest goes to the misfits.
  void examine(Index slot, Defects& defects, std::vector<std::uint8_t>& reliable, RangeResult& result);
  bool fits(Index slot);

 private:
  struct Pair {
    double distance2;
    std::uint32_t entry;
    Index neighbour;
  };
  void find_neighbours(Index slot, double radius);
  bool crowded(Index slot) const;
  void pair_displaced(const Match& match);

  const Atoms& atoms_;
  const FeatureSet& features_;
  const NeighbourGrid& grid_;
  bool search_shifts_;
  FeatureComparer comparer_;
  std::vector<Index> slots_;
  std::vector<Neighbour> neighbours_;
  std::vector<Pair> pairs_;
  std::vector<int> occupant_;  // of each entry: its displaced occupant
  std::vector<int> home_;      // of each neighbour: the entry it was displaced from
};

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

void Examiner::examine(Index slot, Defects& defects, std::vector<std::uint8_t>& reliable, RangeResult& result) {
  const Index atom = grid_.point(slot);
  const std::uint16_t species = atoms_.species[atom];
  if (features_.kinds_of[species].empty() || crowded(slot)) {
    defects.extra[atom] = 1.0F;
    return;
  }
  find_neighbours(slot, features_.search_radius);
  const Match* match = &comparer_.match(species, neighbours_);
  if (search_shifts_ && match->near_stray > 0) {
    // Perhaps the others are in place and the centre is not.
    find_neighbours(slot, features_.search_radius + features_.pair_distance);
    match = &comparer_.match_shifted(species, neighbours_);
  }
  if (match->kind == no_kind || match->near_matched * 3 < match->near_stray * 2) {
    defects.extra[atom] = 1.0F;
    result.strays += match->kind == no_kind ? features_.kinds[features_.kinds_of[species][0]].near : match->near_stray;
    return;
  }
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
  result.matched += matched;

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
    const bool counted = home_[n] >= 0 ? home_[n] < static_cast<int>(kind.counted) : distance2 <= radius2;
    if (counted) {
      ++strays;
      result.strays += features_.kinds_of[neighbours_[n].species].empty() ? 0 : 1;
    }
    if (home_[n] < 0 && distance2 <= std::max(radius2, near2)) result.misfits.strays.push_back(slots_[n]);
  }
  defects.vacancy[atom] = static_cast<float>(absent);
  defects.extra[atom] = static_cast<float>(strays);
  result.absent += absent;
  misfit.missing = result.misfits.missing.size() - misfit.first_missing;
  misfit.strays = result.misfits.strays.size() - misfit.first_stray;
  if (misfit.missing + misfit.strays > 0) result.misfits.atoms.push_back(misfit);
}

// Whether the crystal is recognised around at least a fifth of some thousand atoms spread evenly. Where it is not,
// looking for displaced atoms one by one would be long and in vain.
bool recognised(const Atoms& atoms, const FeatureSet& features, const NeighbourGrid& grid) {
  const std::span<const Index> homes = grid.home_slots();
  const std::size_t stride = std::max<std::size_t>(homes.size() / 2000, 1);
  Examiner examiner(atoms, features, grid, false);
  std::size_t asked = 0;
  std::size_t fitting = 0;
  for (std::size_t n = 0; n < homes.size(); n += stride) {
    if (features.kinds_of[atoms.species[grid.point(homes[n])]].empty()) continue;
    ++asked;
    fitting += examiner.fits(homes[n]) ? 1 : 0;
  }
  return homes.size() < 200 || 5 * fitting >= asked;
}

// Puts the ranges' misfits one after the other.
Misfits concatenate(std::vector<RangeResult>& ranges) {
  Misfits all;
  for (RangeResult& range : ranges) {
    for (Misfit misfit : range.misfits.atoms) {
      misfit.first_missing += all.missing.size();
      misfit.first_stray += all.strays.size();
      all.atoms.push_back(misfit);
    }
    all.missing.insert(all.missing.end(), range.misfits.missing.begin(), range.misfits.missing.end());
    all.strays.insert(all.strays.end(), range.misfits.strays.begin(), range.misfits.strays.end());
    range.misfits = {};
  }
  return all;
}

// Adds to each atom's vacancy value the missing entries that lead to a vacancy, and to each vacancy the votes. Returns
// the number of entries that do; what leads elsewhere the sample's surface cuts off.
std::size_t count_vacancies(const SiteSearch& search, Defects& defects, DefectReport& report) {
  std::vector<Vec3> positions;
  for (VacancySite& site : defects.vacancies) {
    positions.push_back(site.position);
    site.votes = 0;
  }
  const double spread = search.features.tolerance;
  const NeighbourGrid grid(positions, search.atoms.box, spread, spread);
  std::vector<Index> slots;
  std::size_t leading = 0;
  for (const Misfit& m : search.misfits.atoms) {
    if (m.kind == no_kind) continue;
    const SiteKind& kind = search.features.kinds[m.kind];
    const Index atom = search.grid.point(m.slot);
    bool cut = false;
    for (const std::uint32_t e : search.misfits.missing_of(m)) {
      bool found = false;
      if (!positions.empty()) {
        grid.find(grid.wrap(m.site + kind.entries[e].offset), spread, slots);
        for (const Index slot : slots) {
          VacancySite& site = defects.vacancies[grid.point(slot)];
          if (found || site.species != kind.entries[e].species) continue;
          found = true;
          ++site.votes;
        }
      }
      if (e >= kind.counted) continue;
      if (found) {
        defects.vacancy[atom] += 1.0F;
        ++leading;
      } else {
        cut = true;
      }
    }
    report.surface_atoms += cut ? 1 : 0;
  }
  return leading;
}

void note_species(const Atoms& atoms, const FeatureSet& features, DefectReport& report) {
  std::vector<std::size_t> count(atoms.species_table.size(), 0);
  for (const std::uint16_t species : atoms.species) ++count[species];
  for (std::size_t s = 0; s < count.size(); ++s) {
    if (count[s] == 0 || !features.kinds_of[s].empty()) continue;
    report.notes.push_back("the unit cell has no " + atoms.species_table[s].name + ": its " + std::to_string(count[s]) +
                           " atoms count as extra");
  }
  for (const std::string& name : features.absent_species) {
    report.notes.push_back("the sample has no " + name + ", which the unit cell has: vacancies of it are not listed");
  }
}

}  // namespace

Defects quantify_defects(const Atoms& atoms, const UnitCell& cell, const DefectOptions& options, DefectReport& report,
                         Progress& progress) {
  report = {};
  const FeatureSet features =
      build_feature_vectors(cell, atoms.species_table, options.neighbourhood, options.tolerance);
  report.radius = features.radius;
  report.tolerance = features.tolerance;
  if (features.tolerance_limited) {
    report.notes.push_back("the tolerance was limited to " + std::to_string(features.tolerance) +
                           " Å: beyond it an atom could match two sites");
  }
  const NeighbourGrid grid(atoms.positions, atoms.box, features.search_radius + features.pair_distance,
                           features.search_radius);
  Defects defects;
  defects.positional.assign(atoms.size(), 0.0F);
  defects.vacancy.assign(atoms.size(), 0.0F);
  defects.extra.assign(atoms.size(), 0.0F);
  std::vector<std::uint8_t> reliable(atoms.size(), 0);
  const std::span<const Index> homes = grid.home_slots();
  const bool search_shifts = recognised(atoms, features, grid);
  progress.update(0.1);

  std::vector<RangeResult> ranges((homes.size() + grain - 1) / grain);
  parallel_for(homes.size(), grain, [&](std::size_t begin, std::size_t end) {
    progress.check();
    Examiner examiner(atoms, features, grid, search_shifts);
    for (std::size_t h = begin; h < end; ++h) examiner.examine(homes[h], defects, reliable, ranges[begin / grain]);
  });
  std::size_t matched = 0;
  std::size_t absent = 0;
  std::size_t strays = 0;
  for (const RangeResult& range : ranges) {
    matched += range.matched;
    absent += range.absent;
    strays += range.strays;
  }
  const Misfits misfits = concatenate(ranges);
  progress.update(0.6);

  const SiteSearch search{atoms, features, grid, reliable, misfits};
  const auto share = [&] {
    const std::size_t other = std::max(absent, strays);
    return matched + other > 0 ? static_cast<double>(matched) / static_cast<double>(matched + other) : 0.0;
  };
  const bool known = std::any_of(atoms.species.begin(), atoms.species.end(),
                                 [&](std::uint16_t s) { return !features.kinds_of[s].empty(); });
  note_species(atoms, features, report);
  if (known && (search_shifts && (matched + absent + strays == 0 || share() >= fitting_share))) {
    defects.vacancies = find_vacancies(search, progress);
    progress.update(0.8);
    defects.extras = find_extras(search, progress);
  } else {
    report.notes.push_back(
        "the unit cell does not fit the sample: hardly any atom has the neighbours it asks for, so no vacancies and "
        "extra atoms are listed; check its vectors, orientation and species");
  }
  absent += count_vacancies(search, defects, report);
  report.matched_fraction = share();
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    report.positional_atoms += defects.positional[i] > 0.0F ? 1 : 0;
    report.vacancy_atoms += defects.vacancy[i] > 0.0F ? 1 : 0;
    report.extra_atoms += defects.extra[i] > 0.0F ? 1 : 0;
  }
  progress.update(1.0);
  return defects;
}

}  // namespace atomesh
