// bench preprocess, part truth.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "app/cli/bench_preprocess.h"
#include "core/parallel.h"
#include "preprocess/quantify_defects.h"
#include "samples/planted_crystal.h"
#include "samples/structure_types.h"

namespace atomesh::cli {

namespace {

// Of one kind of defect.
struct Score {
  std::size_t planted = 0, found = 0;   // of the planted, found
  std::size_t reported = 0, right = 0;  // of the reported, planted

  double recall() const {
    return planted == 0 ? 100.0 : 100.0 * static_cast<double>(right) / static_cast<double>(planted);
  }
  double precision() const {
    return reported == 0 ? 100.0 : 100.0 * static_cast<double>(right) / static_cast<double>(reported);
  }
  Score& operator+=(const Score& other) {
    planted += other.planted;
    reported += other.reported;
    right += other.right;
    return *this;
  }
  std::string text() const { return fmt::format("{} / {}", short_percent(recall()), short_percent(precision())); }
  Json json() const { return Json::object({{"planted", planted}, {"reported", reported}, {"right", right}}); }
  // 100 only when it is.
  static std::string short_percent(double percent) {
    return percent == 100.0 ? "100" : fmt::format("{:.2f}", std::min(percent, 99.99));
  }
};

struct Scores {
  Score vacancy, interstitial, substitution;
  std::size_t false_sites() const {
    const auto wrong = [](const Score& score) { return score.reported - score.right; };
    return wrong(vacancy) + wrong(interstitial) + wrong(substitution);
  }
  Scores& operator+=(const Scores& other) {
    vacancy += other.vacancy;
    interstitial += other.interstitial;
    substitution += other.substitution;
    return *this;
  }
  Score all() const {
    Score sum = vacancy;
    sum += interstitial;
    sum += substitution;
    return sum;
  }
};

// A foreign atom on a site is one missing and one extra at one place: reported together they are the substitution and
// neither counts as a vacancy or an interstitial; reported apart they are mistaken for those.
Scores judge(const Sample& sample, const Defects& defects, double nearest_neighbour) {
  const SampleTruth& truth = sample.truth;
  Scores scores;
  std::set<Index> substituted_sites;
  for (const auto& substitution : truth.substitutions) substituted_sites.insert(substitution.site);
  const auto is_at = [&](const VacancySite& vacancy, const SampleTruth::Site& site) {
    return glm::distance(site.position, vacancy.position) < 0.35 * nearest_neighbour &&
           sample.atoms.species_table[vacancy.species].name == site.species;
  };

  std::set<Index> foreign;
  std::set<Index> vacancies_of_foreign;
  scores.substitution.planted = truth.substitutions.size();
  scores.substitution.reported = defects.substitutions.size();
  for (const Substitution& reported : defects.substitutions) {
    foreign.insert(reported.atom);
    vacancies_of_foreign.insert(reported.vacancy);
    const auto planted = std::find_if(truth.substitutions.begin(), truth.substitutions.end(),
                                      [&](const auto& substitution) { return substitution.atom == reported.atom; });
    const bool right = planted != truth.substitutions.end() &&
                       is_at(defects.vacancies[reported.vacancy], truth.vacancies[planted->site]);
    scores.substitution.right += right ? 1 : 0;
  }

  std::set<Index> found_sites;
  scores.vacancy.planted = truth.vacancies.size() - substituted_sites.size();
  for (std::size_t v = 0; v < defects.vacancies.size(); ++v) {
    if (vacancies_of_foreign.contains(static_cast<Index>(v))) continue;
    ++scores.vacancy.reported;
    for (Index i = 0; i < truth.vacancies.size(); ++i) {
      if (substituted_sites.contains(i) || found_sites.contains(i)) continue;
      if (!is_at(defects.vacancies[v], truth.vacancies[i])) continue;
      found_sites.insert(i);
      break;
    }
  }
  scores.vacancy.right = found_sites.size();

  std::set<Index> interstitials(truth.extras.begin(), truth.extras.end());
  for (const auto& substitution : truth.substitutions) interstitials.erase(substitution.atom);
  scores.interstitial.planted = interstitials.size();
  for (const ExtraAtom& extra : defects.extras) {
    if (foreign.contains(extra.atom)) continue;
    ++scores.interstitial.reported;
    scores.interstitial.right += interstitials.contains(extra.atom) ? 1 : 0;
  }
  return scores;
}

struct Level {
  double noise = 0.0;
  Scores scores;
  double worst_false = 0.0;  // false sites in 100,000 atoms, of the worst crystal
};

// Adds its row and to the level's sums; returns the scores of this crystal.
Scores bench_crystal(const PreprocessBench& bench, Level& level, const std::string& structure, bool rotated) {
  const StructureType& type = find_structure_type(structure);
  PlantedCrystalOptions options;
  options.structure = structure;
  options.atoms = bench.atoms(100000);
  options.vacancies = options.interstitials = options.substitutions = std::max<std::size_t>(1, options.atoms / 3333);
  // Near enough for many, far enough that every neighbourhood holds one defect and lies inside.
  double longest = 0.0;
  for (const Vec3& v : type.cell.primitive) longest = std::max(longest, glm::length(v));
  options.least_distance = 2.05 * longest;
  options.depth = 1.25 * longest;
  options.noise = level.noise;
  options.rotation = rotated ? 11 : 0;
  options.seed = 5;
  const Sample sample = make_planted_crystal(options, bench.session.progress());
  const std::string name = fmt::format("{}, {:g} % noise, {}, {} atoms", structure, 100.0 * level.noise,
                                       rotated ? "rotated" : "as it stands", grouped(sample.atoms.size()));
  Defects defects;
  DefectReport report;
  const Times times = measure(
      1, bench.session, name,
      [&] { defects = quantify_defects(sample.atoms, *sample.unit_cell, {}, report, bench.session.progress()); }, 0);
  const Scores scores = judge(sample, defects, type.nearest_neighbour);
  const double false_sites = 1e5 * static_cast<double>(scores.false_sites()) / static_cast<double>(sample.atoms.size());
  level.scores += scores;
  level.worst_false = std::max(level.worst_false, false_sites);

  BenchRow row{"preprocess", name, "truth", Json::object({{"threads", threads()}}), "", times, {}, {}, {}};
  row.more = {{"atoms", sample.atoms.size()},
              {"vacancies", scores.vacancy.json()},
              {"interstitials", scores.interstitial.json()},
              {"substitutions", scores.substitution.json()},
              {"false_per_100k", false_sites},
              {"positional_atoms", report.positional_atoms}};
  bench.result.add(std::move(row));
  return scores;
}

}  // namespace

void bench_truth(const PreprocessBench& bench) {
  const bool small = bench.atoms(100000) < 50000;
  std::vector<double> noises{0.0, 0.01};
  if (!small) noises.insert(noises.end(), {0.02, 0.03});
  std::vector<Level> levels;
  std::vector<std::string> headings{"crystal", "planted"};
  for (const double noise : noises) {
    levels.push_back({noise, {}, 0.0});
    headings.push_back(fmt::format("{:g} % noise", 100.0 * noise));
  }
  TextTable table(headings);
  for (const char* structure : {"fcc", "bcc", "diamond", "rock-salt", "graphite"}) {
    for (const bool rotated : {false, true}) {
      std::vector<std::string> cells{fmt::format("{}{}", structure, rotated ? " turned" : ""), ""};
      for (Level& level : levels) {
        const Score all = bench_crystal(bench, level, structure, rotated).all();
        cells[1] = grouped(all.planted);
        cells.push_back(all.text());
      }
      table.row(std::move(cells));
    }
  }
  // The sums, and what is required of them.
  std::vector<std::vector<std::string>> sums{
      {"all vacancies"}, {"all interstitials"}, {"all substitutions"}, {"false sites in 100,000 atoms, worst crystal"}};
  for (const Level& level : levels) {
    const Score* kinds[] = {&level.scores.vacancy, &level.scores.interstitial, &level.scores.substitution};
    for (std::size_t k = 0; k < 3; ++k) {
      if (sums[k].size() == 1) sums[k].push_back(grouped(kinds[k]->planted));
      sums[k].push_back(kinds[k]->text());
    }
    if (sums[3].size() == 1) sums[3].emplace_back();
    sums[3].push_back(short_number(level.worst_false));

    const Score all = level.scores.all();
    const bool exact = level.noise < 0.015;
    const double target = exact ? 100.0 : 99.0;
    const std::string at = exact ? "at 0 and 1 % noise" : "at 2 and 3 % noise";
    BenchRow row{"preprocess",
                 fmt::format("all crystals, {:g} % noise", 100.0 * level.noise),
                 "truth",
                 Json::object(),
                 "",
                 {},
                 {},
                 {},
                 {}};
    row.more = {{"planted", all.planted}, {"recall", all.recall()}, {"precision", all.precision()}};
    row.requirements = {{"truth: recall " + at, target, true, all.recall(), " %"},
                        {"truth: precision " + at, target, true, all.precision(), " %"},
                        {"truth: false sites in 100,000 atoms", 1.0, false, level.worst_false, ""}};
    bench.result.add(std::move(row));
  }
  for (std::vector<std::string>& line : sums) table.row(std::move(line));
  bench.result.tables.push_back(
      {"Truth: planted defects", std::move(table),
       fmt::format("Recall / precision in % over vacancies, interstitials and substitutions together, then by kind. "
                   "Crystals of {} atoms, the unit cell given. Noise: normal, rms along each axis, of the "
                   "nearest-neighbour distance. A vacancy is found when it is reported within 0.35 nearest-neighbour "
                   "distances of its site, of the right species.",
                   grouped(bench.atoms(100000)))});
}

}  // namespace atomesh::cli
