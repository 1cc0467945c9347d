#include "preprocess/quantify_defects.h"

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"
#include "preprocess/defect_sites.h"
#include "preprocess/examine_atoms.h"
#include "preprocess/feature_vectors.h"
#include "preprocess/neighbour_grid.h"

namespace atomesh {

namespace {

constexpr std::size_t grain = 1024;
// Below this share of matched neighbours the cell is not the sample's.
constexpr double fitting_share = 0.5;
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
  Census census;
  for (const RangeResult& range : ranges) census.add(range.census);
  const Misfits misfits = concatenate(ranges);
  progress.update(0.6);

  note_species(atoms, features, report);
  // One atom alone says nothing about the cell.
  const auto fits = [&] { return atoms.size() < 2 || (search_shifts && census.matched_share() >= fitting_share); };
  if (fits()) {
    const SiteSearch search{atoms, features, grid, reliable, misfits};
    const std::vector<float> certain = defects.vacancy;
    defects.vacancies = find_vacancies(search, progress);
    progress.update(0.8);
    census.absent += count_vacancies(search, defects, report);
    if (fits()) {
      defects.extras = find_extras(search, progress);
      defects.substitutions = find_substitutions(search, defects.vacancies, defects.extras);
    } else {
      defects.vacancies.clear();
      defects.vacancy = certain;
    }
  }
  if (!fits()) {
    report.notes.push_back(
        "the unit cell does not fit the sample: too few atoms have the neighbours it asks for, so no vacancies and "
        "extra atoms are listed; check its vectors, orientation and species");
  }
  report.matched_fraction = census.matched_share();
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    report.positional_atoms += defects.positional[i] > 0.0F ? 1 : 0;
    report.vacancy_atoms += defects.vacancy[i] > 0.0F ? 1 : 0;
    report.extra_atoms += defects.extra[i] > 0.0F ? 1 : 0;
  }
  progress.update(1.0);
  return defects;
}

}  // namespace atomesh
