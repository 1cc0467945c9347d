#include "preprocess/find_unit_cell.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/unit_cell.h"
#include "preprocess/explain_atoms.h"
#include "preprocess/find_grains.h"
#include "preprocess/match_orientation.h"
#include "preprocess/propose_cell.h"
#include "preprocess/typical_cell.h"

namespace atomesh {

namespace {

constexpr std::size_t places_asked = 8;
constexpr std::size_t atoms_of_probe = 1500;
constexpr std::size_t fewest_atoms = 24;
// A cell that repeats less often is the box's, not the crystal's.
constexpr std::size_t fewest_cells = 4;
// A candidate that explains so much, of which so many sites are taken, ends the search if strain does not blur it.
constexpr double plenty = 0.97;
constexpr double full = 0.9;
// One of so much merit is the crystal's, if strained; one of less may be an average over a fault.
constexpr double good = 0.9;
// One that explains so much (a grain of many) is no chance: longer cells are not looked for.
constexpr double some = 0.05;
// Where a translation holds for so many atoms but no cell is found, what is missing is another direction.
constexpr double repeats = 0.9;
// Sites that fewer atoms sit on than this share of the fullest site's are no sites but interstitials'.
constexpr double least_occupied = 0.5;

// How the places are asked, one sweep after the other.
struct Sweep {
  std::size_t reach;   // into translation_reaches
  std::size_t seeds;   // atoms that judge
  std::size_t places;  // where there is no crystal, the far search is the one that takes time
  bool closer;         // after a crystal was found that fits badly: between faults that lie close
};
constexpr std::array<Sweep, 4> sweeps{{{0, 400, places_asked, false},
                                       {0, 120, places_asked, true},
                                       {1, 400, places_asked / 2, false},
                                       {2, 400, places_asked / 4, false}}};

std::string percent(double share) {
  return std::to_string(std::lround(100.0 * share)) + " %";
}

std::string rounded(double value, int digits) {
  std::string text = std::to_string(value);
  return text.substr(0, text.find('.') + 1 + static_cast<std::size_t>(digits));
}

// The n-th of places spread evenly over the unit cube (J. Halton's sequence in bases 2, 3, 5); the seed turns them
// about.
Vec3 spread_place(std::size_t n, std::uint64_t seed) {
  constexpr std::array<std::size_t, 3> bases{2, 3, 5};
  Vec3 place(0.0);
  for (int k = 0; k < 3; ++k) {
    const std::size_t base = bases[static_cast<std::size_t>(k)];
    double scale = 1.0;
    for (std::size_t i = n + 64 * static_cast<std::size_t>(seed % 1024); i > 0; i /= base) {
      scale /= static_cast<double>(base);
      place[k] += scale * static_cast<double>(i % base);
    }
  }
  return place;
}

struct Candidate {
  FittedCell cell;
  LocalScale scale;
  double occupancy = 1.0;
  Claims claims;
};

// What was tried, for the sentence of a refusal.
struct Trials {
  std::size_t places = 0, cells = 0;
  double best_translation = 0.0;
  double reach = 0.0;  // Å
};

bool same_cell(const FittedCell& a, const FittedCell& b) {
  if (a.sites.size() != b.sites.size()) return false;
  double difference = 0.0;
  for (int k = 0; k < 3; ++k) difference = std::max(difference, glm::length(a.vectors[k] - b.vectors[k]));
  return difference < 2e-3 * a.nearest;
}

// How well a candidate describes the sample: atoms near their sites, of the right species, and sites that hold atoms;
// of two that do alike, the smaller cell (strain can make one cell of several look primitive).
double merit(const Candidate& candidate, std::size_t atoms) {
  const Explained& sum = candidate.claims.sum;
  return (sum.closeness - 0.5 * static_cast<double>(sum.foreign)) / static_cast<double>(atoms) -
         0.5 * (1.0 - candidate.occupancy) - 0.004 * static_cast<double>(candidate.cell.sites.size());
}

// Whether other places could hardly tell more: nearly all is explained, and as sharply as around the place asked.
bool settles(const Candidate& candidate, std::size_t atoms) {
  const Explained& sum = candidate.claims.sum;
  const double count = static_cast<double>(sum.atoms);
  const double blur = 0.03 * candidate.cell.nearest;
  return count > plenty * static_cast<double>(atoms) && candidate.occupancy > full &&
         sum.squares / (3.0 * count) < 1.4 * candidate.cell.rms * candidate.cell.rms + blur * blur;
}

// Sites that the sample as a whole does not fill are dropped and the species are the sample's majority. Whether
// anything changed.
bool revise_sites(Candidate& candidate) {
  const auto& at_site = candidate.claims.sum.at_site;
  std::vector<std::size_t> counts(at_site.size(), 0);
  for (std::size_t j = 0; j < at_site.size(); ++j) {
    for (const auto& [species, count] : at_site[j]) counts[j] += count;
  }
  const std::size_t most = *std::max_element(counts.begin(), counts.end());
  if (most == 0) return false;
  FittedCell revised = candidate.cell;
  revised.sites.clear();
  revised.species.clear();
  bool changed = false;
  for (std::size_t j = 0; j < counts.size(); ++j) {
    if (static_cast<double>(counts[j]) < least_occupied * static_cast<double>(most)) {
      changed = true;
      continue;
    }
    const auto common = std::max_element(at_site[j].begin(), at_site[j].end(),
                                         [](const auto& a, const auto& b) { return a.second < b.second; });
    changed = changed || common->first != candidate.cell.species[j];
    revised.sites.push_back(candidate.cell.sites[j]);
    revised.species.push_back(common->first);
  }
  if (!changed) return false;
  revised.nearest = nearest_site_distance(revised.vectors, revised.sites);
  make_primitive(revised);
  candidate.cell = revised;
  return true;
}

// The cell that is typical of the blocks, unless the atoms are clearly farther from its sites.
void take_typical(const Atoms& atoms, const StrainBlocks& blocks, Candidate& candidate, Progress& progress) {
  const auto typical = typical_cell(atoms, blocks, candidate.cell, candidate.claims, progress);
  if (!typical) return;
  Claims claims = explain_atoms(atoms, blocks, *typical, {}, {}, progress);
  if (claims.sum.closeness < candidate.claims.sum.closeness - 0.01 * static_cast<double>(atoms.size())) return;
  candidate.cell = *typical;
  candidate.claims = std::move(claims);
}

// Reduced vectors; the basis starts with an atom of the rarest species at the origin and lists species after species.
UnitCell to_unit_cell(const Atoms& atoms, const FittedCell& cell) {
  UnitCell result;
  const std::array<Vec3, 3> reduced = reduce_lattice({cell.vectors[0], cell.vectors[1], cell.vectors[2]});
  result.primitive = reduced;
  const Mat3 vectors = result.matrix();
  const Mat3 to_fraction = glm::inverse(vectors);
  const auto count_of = [&cell](std::uint16_t species) {
    return std::count(cell.species.begin(), cell.species.end(), species);
  };
  std::size_t first = 0;
  for (std::size_t j = 1; j < cell.sites.size(); ++j) {
    if (count_of(cell.species[j]) < count_of(cell.species[first])) first = j;
  }
  struct Site {
    bool origin;
    std::uint16_t species;
    Vec3 fraction;
  };
  std::vector<Site> sites;
  for (std::size_t j = 0; j < cell.sites.size(); ++j) {
    Vec3 f = to_fraction * (cell.sites[j] - cell.sites[first]);
    // Just below a lattice plane is on it.
    f -= glm::floor(f + 1e-6);
    sites.push_back({j == first, cell.species[j], j == first ? Vec3(0.0) : f});
  }
  const std::uint16_t leading = cell.species[first];
  std::sort(sites.begin(), sites.end(), [leading](const Site& a, const Site& b) {
    if (a.origin != b.origin) return a.origin;
    const bool p = a.species == leading;
    const bool q = b.species == leading;
    if (p != q) return p;
    if (a.species != b.species) return a.species < b.species;
    const Vec3& f = a.fraction;
    const Vec3& g = b.fraction;
    return f.z != g.z ? f.z < g.z : f.y != g.y ? f.y < g.y : f.x < g.x;
  });
  for (const Site& site : sites) {
    result.basis.push_back({atoms.species_table[site.species].name, vectors * site.fraction});
  }
  return result;
}

// Candidates from several places: one may lie in a defect, a void, a strained part. Short translations are looked for
// everywhere before longer ones are anywhere.
std::optional<Candidate> best_candidate(const Atoms& atoms, const FindCellOptions& options,
                                        std::optional<StrainBlocks>& blocks, Trials& trials, Progress& progress) {
  struct Place {
    Vec3 center;
    LocalScale scale;
  };
  const double count = static_cast<double>(atoms.size());
  const Bounds bounds = bounds_of(atoms.positions);
  std::vector<Place> places;
  std::vector<FittedCell> seen;
  std::optional<Candidate> best;
  for (const Sweep& sweep : sweeps) {
    if (sweep.closer && !best) continue;
    const double reach = translation_reaches[sweep.reach];
    for (std::size_t n = 0; n < sweep.places; ++n) {
      progress.update(0.5 * static_cast<double>(n) / places_asked);
      if (n == places.size()) {
        const Vec3 share = n == 0 ? Vec3(0.5) : spread_place(n, options.seed);
        const LocalCluster cluster = probe(atoms, bounds.min + share * bounds.extent(), atoms_of_probe);
        places.push_back({cluster.center, measure_scale(cluster)});
      }
      const auto& [center, scale] = places[n];
      if (!scale.known()) continue;
      trials.places = places.size();
      trials.reach = std::max(trials.reach, reach * scale.spacing);
      std::optional<FittedCell> cell;
      double occupancy = 1.0;
      for (const bool tell_species : {true, false}) {
        if (cell || (!tell_species && atoms.species_table.size() < 2)) break;
        const CellProposal proposal =
            propose_cell(atoms, center, scale, {options.largest_basis, reach, sweep.seeds, tell_species}, progress);
        trials.best_translation = std::max(trials.best_translation, proposal.best_translation);
        cell = proposal.cell;
        occupancy = proposal.occupancy;
      }
      if (!cell || cell->sites.size() * fewest_cells > atoms.size()) continue;
      if (std::any_of(seen.begin(), seen.end(), [&](const FittedCell& other) { return same_cell(other, *cell); })) {
        continue;
      }
      seen.push_back(*cell);
      ++trials.cells;
      if (!blocks) blocks.emplace(atoms, 4.0 * scale.spacing);
      Candidate candidate{*cell, scale, occupancy, {}};
      for (int round = 0; round < 2; ++round) {
        candidate.claims = explain_atoms(atoms, *blocks, candidate.cell, {}, {}, progress);
        if (round > 0 || !revise_sites(candidate)) break;
        candidate.cell = grow_fit(atoms, center, scale, candidate.cell, progress);
      }
      take_typical(atoms, *blocks, candidate, progress);
      if (!best || merit(candidate, atoms.size()) > merit(*best, atoms.size())) best = std::move(candidate);
      if (settles(*best, atoms.size())) return best;
    }
    const bool crystal = best && static_cast<double>(best->claims.sum.atoms) > some * count;
    if (crystal && (sweep.closer || merit(*best, atoms.size()) > good)) return best;
  }
  return best;
}

// What check_unit_cell() says against it: atoms closer together than rounding, say.
std::string objection(const UnitCell& cell) {
  try {
    check_unit_cell(cell);
    return {};
  } catch (const Error& error) {
    return error.what();
  }
}

std::string refusal(const Trials& trials, const Candidate* best, std::size_t atoms, double least) {
  if (best != nullptr) {
    return "no unit cell: the best of " + std::to_string(trials.cells) + " candidates (" +
           std::to_string(best->cell.sites.size()) + " atoms in " + rounded(best->cell.volume(), 1) + " Å³) explains " +
           percent(static_cast<double>(best->claims.sum.atoms) / static_cast<double>(atoms)) +
           " of the atoms, less than the " + percent(least) + " asked for";
  }
  if (trials.places == 0) return "no unit cell: " + std::to_string(atoms) + " atoms, as they lie, are too few to tell";
  if (trials.best_translation > repeats) {
    return "no unit cell: translations map " + percent(trials.best_translation) +
           " of the atoms on each other, but none in three independent directions (as of a chain or a layer), or with "
           "a "
           "cell of too many atoms";
  }
  return "no unit cell: at " + std::to_string(trials.places) + " places no lattice of translations up to " +
         rounded(trials.reach, 1) + " Å maps the atoms on each other; the best translation holds for " +
         percent(trials.best_translation) + " of them";
}

// False where the cell stays as it was fitted.
bool make_symmetric(UnitCell& cell, double nearest, const FindCellReport& report, std::size_t on_site) {
  const double per_site = std::max(static_cast<double>(on_site) / static_cast<double>(cell.basis.size()), 1.0);
  const double standard_error = report.displacement / std::sqrt(per_site);
  const bool exact = report.displacement < 1e-6 * nearest;
  const double tolerance = exact ? 1e-6 * nearest : std::max(8.0 * standard_error, 1e-3 * nearest);
  const std::optional<UnitCell> symmetric = symmetrized(cell, std::min(tolerance, 0.02 * nearest));
  if (symmetric) cell = *symmetric;
  return symmetric.has_value();
}

}  // namespace

Crystal find_unit_cell(const Atoms& atoms, const FindCellOptions& options, FindCellReport& report, Progress& progress) {
  report = FindCellReport{};
  if (atoms.size() < fewest_atoms) {
    report.why = "no unit cell: " + std::to_string(atoms.size()) + " atoms are too few to tell; at least " +
                 std::to_string(fewest_atoms) + " are needed";
    return {};
  }

  std::optional<StrainBlocks> blocks;
  Trials trials;
  std::optional<Candidate> best = best_candidate(atoms, options, blocks, trials, progress);
  const double count = static_cast<double>(atoms.size());
  if (!best) {
    report.why = refusal(trials, nullptr, atoms.size(), options.least_explained);
    return {};
  }

  // Again: the blocks' origins are seen in the better cell now.
  take_typical(atoms, *blocks, *best, progress);

  const std::size_t least_grain = std::max<std::size_t>(40, 2 * best->cell.sites.size());
  GrainSearch grains = find_grains(atoms, *blocks, best->scale, best->cell, best->claims, least_grain, progress);
  report.explained = static_cast<double>(grains.on_site) / count;
  if (grains.on_site > 0) {
    report.foreign = static_cast<double>(grains.foreign) / static_cast<double>(grains.on_site);
    report.displacement = std::sqrt(grains.squares / (3.0 * static_cast<double>(grains.on_site)));
  }
  if (report.explained < options.least_explained) {
    report.why = refusal(trials, &*best, atoms.size(), options.least_explained);
    return {};
  }

  Crystal crystal;
  const FittedCell& reference = grains.cells.front();
  crystal.grains.push_back(to_unit_cell(atoms, reference));
  if (const std::string why = objection(crystal.grains[0]); !why.empty()) {
    report.why = "no unit cell: the best one found is none (" + why + ")";
    return {};
  }
  report.found = true;
  const bool symmetric = make_symmetric(crystal.grains[0], reference.nearest, report, grains.on_site);
  const std::vector<Mat3> symmetries = symmetry_rotations(reference, 0.1 * reference.nearest);
  report.grains.resize(grains.cells.size());
  for (std::size_t g = 0; g < grains.cells.size(); ++g) {
    // The grain's cell is the first one's, turned least: the same fractions. Strained as the grain is, unless that
    // would undo the symmetry.
    const Mat3 map = grains.cells[g].vectors * glm::inverse(reference.vectors);
    const Mat3 rotation = rotation_of(map);
    report.grains[g].rotation = g == 0 ? Mat3(1.0) : smallest_rotation(rotation, symmetries);
    if (g == 0) continue;
    const Mat3 strain = symmetric ? Mat3(1.0) : map * glm::transpose(rotation);
    const Mat3 turn = strain * report.grains[g].rotation;
    UnitCell cell = crystal.grains[0];
    for (Vec3& v : cell.primitive) v = turn * v;
    for (BasisAtom& atom : cell.basis) atom.position = turn * atom.position;
    crystal.grains.push_back(cell);
  }
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    const std::uint16_t g = grains.grain_of.empty() ? std::uint16_t{0} : grains.grain_of[i];
    if (g == no_grain) continue;
    ++report.grains[g].atoms;
    report.grains[g].center += atoms.positions[i];
  }
  for (Grain& grain : report.grains) grain.center /= static_cast<double>(std::max<std::size_t>(grain.atoms, 1));
  if (crystal.grains.size() > 1) crystal.grain_of = std::move(grains.grain_of);
  if (report.foreign > 0.01) {
    report.notes.push_back(percent(report.foreign) +
                           " of the atoms on sites are of another species than most on their site");
  }
  return crystal;
}

}  // namespace atomesh
