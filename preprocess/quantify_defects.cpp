#include "preprocess/quantify_defects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/parallel.h"
#include "preprocess/defect_sites.h"
#include "preprocess/examine_atoms.h"
#include "preprocess/feature_vectors.h"
#include "preprocess/neighbour_grid.h"
#include "preprocess/smooth_positional.h"
#include "preprocess/survey_sample.h"

namespace atomesh {

namespace {

constexpr std::size_t piece = 1024;
// Below this share of matched neighbours the cell is not the sample's.
constexpr double fitting_share = 0.5;
constexpr int most_smoothing = 10;

// Puts the ranges' misfits one after the other.
Misfits concatenate(std::vector<RangeResult>& ranges) {
  Misfits all;
  std::size_t atoms = 0, missing = 0, strays = 0;
  for (const RangeResult& range : ranges) {
    atoms += range.misfits.atoms.size();
    missing += range.misfits.missing.size();
    strays += range.misfits.strays.size();
  }
  all.atoms.reserve(atoms);
  all.missing.reserve(missing);
  all.strays.reserve(strays);
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
std::size_t count_vacancies(const SiteSearch& search, Defects& defects, DefectReport& report, Progress& progress) {
  std::vector<Vec3> positions;
  for (VacancySite& site : defects.vacancies) {
    positions.push_back(site.position);
    site.votes = 0;
  }
  const double spread = search.sample.features.tolerance;
  const NeighbourGrid grid(positions, search.sample.atoms.box, spread, spread);
  std::vector<Index> slots;
  std::size_t leading = 0;
  std::size_t looked = 0;
  for (const Misfit& m : search.misfits.atoms) {
    if (++looked % 4096 == 0) progress.check();
    if (m.kind == no_kind) continue;
    const SiteKind& kind = search.sample.features.kinds[m.kind];
    const Index atom = search.sample.grid.point(m.slot);
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
    if (count[s] == 0 || features.in_crystal[s]) continue;
    report.notes.push_back("the unit cell has no " + atoms.species_table[s].name + ": its " + std::to_string(count[s]) +
                           " atoms count as extra");
  }
  for (const std::string& name : features.absent_species) {
    report.notes.push_back("the sample has no " + name + ", which the unit cell has: vacancies of it are not listed");
  }
}

// The cells as they fit the sample, and what a person should know of it.
std::vector<UnitCell> fit_cells(const std::vector<UnitCell>& cells, const Survey& survey, DefectReport& report) {
  std::vector<UnitCell> fitted = cells;
  std::size_t changed = 0;
  double stretch = 0.0;
  double angle = 0.0;
  for (std::size_t g = 0; g < cells.size(); ++g) {
    const Mat3& frame = survey.frame[g];
    if (frame == Mat3(1.0)) continue;
    ++changed;
    for (Vec3& v : fitted[g].primitive) v = frame * v;
    for (BasisAtom& atom : fitted[g].basis) atom.position = frame * atom.position;
    const double linear = std::cbrt(glm::determinant(frame)) - 1.0;
    if (std::abs(linear) > std::abs(stretch)) stretch = linear;
    const Vec3 axial(frame[1][2] - frame[2][1], frame[2][0] - frame[0][2], frame[0][1] - frame[1][0]);
    angle = std::max(angle, 0.5 * glm::length(axial) * 180.0 / std::numbers::pi);
  }
  if (changed == 0) return fitted;
  report.notes.push_back(fmt::format(
      "the unit cell was fitted to the sample{}, where its edges are {:+.3f} % longer and turned by {:.3f}°",
      cells.size() > 1 ? fmt::format(" in {} of {} grains", changed, cells.size()) : "", 100.0 * stretch, angle));
  return fitted;
}

void check(const Atoms& atoms, const Crystal& crystal, const DefectOptions& options) {
  if (!crystal.known()) throw UsageError("quantify_defects: no crystal is known");
  if (!crystal.grain_of.empty() && crystal.grain_of.size() != atoms.size()) {
    throw Error("crystal: grain numbers of " + std::to_string(crystal.grain_of.size()) + " atoms for " +
                std::to_string(atoms.size()));
  }
  for (const std::uint16_t grain : crystal.grain_of) {
    if (grain != no_grain && grain >= crystal.grains.size()) {
      throw Error("crystal: an atom is of grain " + std::to_string(grain) + ", but there are " +
                  std::to_string(crystal.grains.size()));
    }
  }
  const auto not_negative = [](const char* name, double value) {
    if (!(value >= 0.0) || !std::isfinite(value)) {
      throw UsageError(std::string(name) + ": expected a finite number of 0 or more, got " + std::to_string(value));
    }
  };
  not_negative("noise", options.noise.value_or(0.0));
  not_negative("noise factor", options.noise_factor);
  if (options.smoothing < 0 || options.smoothing > most_smoothing) {
    throw UsageError("smoothing: expected 0 to " + std::to_string(most_smoothing) + " rounds, got " +
                     std::to_string(options.smoothing));
  }
}

void count_atoms(const Defects& defects, DefectReport& report) {
  for (std::size_t i = 0; i < defects.positional.size(); ++i) {
    report.positional_atoms += defects.positional[i] > 0.0F ? 1 : 0;
    report.vacancy_atoms += defects.vacancy[i] > 0.0F ? 1 : 0;
    report.extra_atoms += defects.extra[i] > 0.0F ? 1 : 0;
  }
}

}  // namespace

Defects quantify_defects(const Atoms& atoms, const Crystal& crystal, const DefectOptions& options, DefectReport& report,
                         Progress& progress) {
  report = {};
  check(atoms, crystal, options);
  const auto vectors = [&](const std::vector<UnitCell>& cells, double amplitude) {
    return build_feature_vectors(cells, atoms.species_table, options.neighbourhood, options.tolerance,
                                 {amplitude, options.noise_factor});
  };
  // One grain that holds all atoms is no grain among others.
  const std::span<const std::uint16_t> grain_of = crystal.grain_of;
  FeatureSet features = vectors(crystal.grains, options.noise.value_or(0.0));
  // Room for what the survey may ask for: a cell larger by some percent, a larger tolerance.
  const double reach = 1.06 * features.farthest_counted() + 1.06 * features.nearest + features.pair_distance;
  std::optional<NeighbourGrid> grid;
  grid.emplace(atoms.positions, atoms.box, reach, features.glance_radius, progress);
  progress.update(0.08);
  const Survey survey = survey_sample({atoms, features, *grid, grain_of}, crystal.grains.size(), options.noise,
                                      options.noise_factor, progress);
  const bool fitted =
      std::any_of(survey.frame.begin(), survey.frame.end(), [](const Mat3& f) { return f != Mat3(1.0); });
  if (fitted || survey.amplitude != options.noise.value_or(0.0)) {
    features = vectors(fit_cells(crystal.grains, survey, report), survey.amplitude);
  }
  if (features.glance_radius > 1.02 * grid->cell_edge()) {
    grid.reset();
    grid.emplace(atoms.positions, atoms.box, reach, features.glance_radius, progress);
  }
  report.radius = features.radius;
  report.tolerance = features.tolerance;
  report.noise = survey.amplitude;
  report.noise_limit = features.noise;
  if (features.tolerance_limited) {
    report.notes.push_back("the tolerance was limited to " + std::to_string(features.tolerance) +
                           " Å: beyond it an atom could match two sites");
  }
  progress.update(0.15);

  const SampleView sample{atoms, features, *grid, grain_of};
  Defects defects;
  defects.positional.assign(atoms.size(), 0.0F);
  defects.vacancy.assign(atoms.size(), 0.0F);
  defects.extra.assign(atoms.size(), 0.0F);
  std::vector<std::uint16_t> standing(atoms.size(), no_grain);
  const std::span<const Index> homes = grid->home_slots();
  std::vector<RangeResult> ranges((homes.size() + piece - 1) / piece);
  const GlanceTables tables(features);
  parallel_for(homes.size(), piece, [&](std::size_t begin, std::size_t end) {
    progress.check();
    Examiner examiner(sample, tables, survey.recognised);
    for (std::size_t h = begin; h < end; ++h) {
      examiner.examine(homes[h], defects, standing[grid->point(homes[h])], ranges[begin / piece]);
    }
  });
  Census census;
  for (const RangeResult& range : ranges) census.add(range.census);
  const Misfits misfits = concatenate(ranges);
  progress.update(0.6);
  if (options.smoothing > 0 && survey.amplitude > 0.0) {
    smooth_positional(sample, options.smoothing, {survey.amplitude, options.noise_factor}, standing, defects, progress);
    progress.update(0.7);
  }

  note_species(atoms, features, report);
  // One atom alone says nothing about the cell.
  const auto fits = [&] { return atoms.size() < 2 || (survey.recognised && census.matched_share() >= fitting_share); };
  if (fits()) {
    const SiteSearch search{sample, standing, misfits};
    const std::vector<float> certain = defects.vacancy;
    defects.vacancies = find_vacancies(search, progress);
    progress.update(0.8);
    census.absent += count_vacancies(search, defects, report, progress);
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
  count_atoms(defects, report);
  progress.update(1.0);
  return defects;
}

Defects quantify_defects(const Atoms& atoms, const UnitCell& cell, const DefectOptions& options, DefectReport& report,
                         Progress& progress) {
  return quantify_defects(atoms, Crystal{{cell}, {}}, options, report, progress);
}

}  // namespace atomesh
