// bench preprocess, part find_unit_cell.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/cli/bench_preprocess.h"
#include "core/parallel.h"
#include "preprocess/find_unit_cell.h"
#include "samples/crystal.h"
#include "samples/planted_crystal.h"
#include "samples/structure_types.h"

namespace atomesh::cli {

namespace {

constexpr double parameter_limit = 0.1;  // %, of a lattice parameter
constexpr double silicon_edge = 5.431;   // Å; the sponge is cut from it and its file has no cell

// What the crystal is known to be.
struct Known {
  std::string name;
  Atoms atoms;
  std::optional<UnitCell> cell;
  int space_group = 0;  // 0: not known beforehand
  std::size_t primitive_atoms = 0;
};

// The largest relative error of a, b, c (%) and of an angle (as if it were one of length), both cells standardised; the
// volumes' where spglib standardises one of them alone.
double worst_parameter_error(const UnitCell& found, const UnitCell& true_cell, double tolerance) {
  const auto a = find_space_group(found, tolerance);
  const auto b = find_space_group(true_cell, tolerance);
  if (!a || !b || a->number != b->number) {
    const double atoms = static_cast<double>(true_cell.basis.size()) / static_cast<double>(found.basis.size());
    return 100.0 * std::abs(std::cbrt(found.volume() * atoms / true_cell.volume()) - 1.0);
  }
  double worst = 0.0;
  const auto compare = [&](double x, double y) { worst = std::max(worst, 100.0 * std::abs(x / y - 1.0)); };
  compare(a->a, b->a);
  compare(a->b, b->b);
  compare(a->c, b->c);
  compare(a->alpha, b->alpha);
  compare(a->beta, b->beta);
  compare(a->gamma, b->gamma);
  return worst;
}

// How one search went, as a table says it.
struct Outcome {
  bool right = false;
  std::string error;  // "0.0012 %", of the worst lattice parameter; "NOT FOUND", "WRONG"
  std::string group;  // "225 Fm-3m"
  std::string explained;
  double ms = 0.0;
};

class CellSearch {
 public:
  explicit CellSearch(const PreprocessBench& bench) : bench_(bench) {}

  Outcome measure_crystal(const Known& known) {
    Outcome outcome;
    FindCellReport report;
    Crystal crystal;
    const Times times = measure(
        1, bench_.session, known.name,
        [&] { crystal = find_unit_cell(known.atoms, {}, report, bench_.session.progress()); }, 0);
    BenchRow row{"preprocess", known.name, "find_unit_cell", Json::object({{"threads", threads()}}), "", times, {},
                 {},           {}};
    row.more = {{"atoms", known.atoms.size()},
                {"rate", times.per_core(static_cast<double>(known.atoms.size()))},
                {"rate_unit", "atoms/s/core"},
                {"found", crystal.known()},
                {"explained", report.explained}};
    ++asked_;
    std::string verdict;
    if (crystal.known()) {
      const UnitCell& cell = crystal.grains.front();
      const double tolerance = 0.03 * nearest_neighbour_distance(cell);  // above what thermal noise leaves in a mean
      const auto space_group = find_space_group(cell, tolerance);
      outcome.group = space_group ? fmt::format("{} {}", space_group->number, space_group->symbol) : "none";
      row.more.emplace_back("space_group", space_group ? space_group->number : 0);
      if (known.cell) {
        const double worst = worst_parameter_error(cell, *known.cell, tolerance);
        row.max_error = 0.01 * worst;
        worst_ = std::max(worst_, worst);
        outcome.error = fmt::format("{:.4f} %", worst);
        if (worst > parameter_limit) verdict += "lattice parameters; ";
      }
      if (known.primitive_atoms > 0 && known.primitive_atoms != cell.basis.size()) {
        verdict += fmt::format("{} atoms in the cell, not {}; ", cell.basis.size(), known.primitive_atoms);
      }
      if (known.space_group > 0 && (!space_group || space_group->number != known.space_group)) {
        verdict += fmt::format("group {} was expected; ", known.space_group);
      }
      outcome.right = verdict.empty();
      row.more.emplace_back("basis", cell.basis.size());
      if (!outcome.right) outcome.error = "WRONG";
    } else {
      verdict = report.why;
      outcome.error = "NOT FOUND";
    }
    row.more.emplace_back("right", outcome.right);
    bench_.result.add(std::move(row));
    right_ += outcome.right ? 1 : 0;
    if (!outcome.right) remarks_ += fmt::format(" {}: {}.", known.name, verdict);
    outcome.explained = fmt::format("{:.2f} %", 100.0 * report.explained);
    outcome.ms = times.median;
    return outcome;
  }

  // The requirements, and the table that the outcomes were put into.
  void finish(const std::string& title, TextTable table, const std::string& caption) {
    BenchRow row{"preprocess", title, "find_unit_cell", Json::object(), "", {}, {}, {}, {}};
    row.requirements = {{"find_unit_cell: cell and space group right, of " + title, static_cast<double>(asked_), true,
                         static_cast<double>(right_), ""},
                        {"find_unit_cell: worst lattice parameter", parameter_limit, false, worst_, " %"}};
    bench_.result.add(std::move(row));
    bench_.result.tables.push_back({"Unit cells: " + title, std::move(table),
                                    fmt::format("{} {} of {} found with the right cell (lattice parameters to {} %).{}",
                                                caption, right_, asked_, parameter_limit, remarks_)});
  }

 private:
  const PreprocessBench& bench_;
  std::size_t asked_ = 0;
  std::size_t right_ = 0;
  double worst_ = 0.0;   // %, of the lattice parameters found
  std::string remarks_;  // on those that are not right
};

Known planted(const PreprocessBench& bench, const StructureType& type, double noise, double vacancies, bool rotated) {
  PlantedCrystalOptions options;
  options.structure = std::string(type.name);
  options.atoms = bench.atoms(20000);
  options.vacancies = static_cast<std::size_t>(vacancies * static_cast<double>(options.atoms));
  options.least_distance = 0.9 * type.nearest_neighbour;  // anywhere, next to each other too
  options.depth = 0.1;
  options.noise = noise;
  options.rotation = rotated ? 17 : 0;
  const Sample sample = make_planted_crystal(options, bench.session.progress());
  const std::string name = fmt::format("{} {}, {:g} % noise, {:g} % vacancies{}", type.name, type.material,
                                       100.0 * noise, 100.0 * vacancies, rotated ? ", rotated" : "");
  return {name, sample.atoms, sample.unit_cell, type.space_group, type.primitive_atoms};
}

}  // namespace

void bench_find_unit_cell(const PreprocessBench& bench) {
  struct Condition {
    const char* heading;
    double noise, vacancies;
    bool rotated;
  };
  std::vector<Condition> conditions{{"perfect", 0.0, 0.0, false},
                                    {"turned, 1 % noise, 1 % vacancies", 0.01, 0.01, true},
                                    {"turned, 3 % noise, 2 % vacancies", 0.03, 0.02, true}};
  if (bench.options.full) conditions.push_back({"turned, 5 % noise", 0.05, 0.0, true});
  std::vector<std::string> headings{"structure", "space group"};
  for (const Condition& condition : conditions) headings.emplace_back(condition.heading);
  headings.emplace_back("ms, the slowest");
  TextTable table(headings);
  CellSearch common(bench);
  for (const StructureType& type : structure_types()) {
    std::vector<std::string> cells{fmt::format("{} ({})", type.name, type.material),
                                   fmt::format("{} {}", type.space_group, type.symbol)};
    double slowest = 0.0;
    for (const auto& [heading, noise, vacancies, rotated] : conditions) {
      const Outcome outcome = common.measure_crystal(planted(bench, type, noise, vacancies, rotated));
      cells.push_back(outcome.error);
      slowest = std::max(slowest, outcome.ms);
    }
    cells.push_back(milliseconds(slowest));
    table.row(std::move(cells));
  }
  common.finish(
      "common structures", std::move(table),
      fmt::format("From {} atoms alone: the error of the worst lattice parameter.", grouped(bench.atoms(20000))));

  if (bench.atoms(20000) < 10000) return;  // the samples need more to show what they are
  CellSearch samples(bench);
  TextTable ten({"sample", "atoms", "space group found", "worst parameter", "atoms on its sites", "ms"});
  for (const SampleInfo& info : sample_table()) {
    const std::size_t atoms =
        bench.options.atoms == 0 ? info.seed_atoms : std::max<std::size_t>(bench.options.atoms, 20000);
    Sample sample = make_sample(info.name, {.atoms = atoms}, bench.session.progress());
    if (!sample.unit_cell) sample.unit_cell = zinc_blende_cell("Si", "Si", silicon_edge);
    const std::size_t count = sample.atoms.size();
    const Outcome outcome =
        samples.measure_crystal({std::string(info.name), std::move(sample.atoms), sample.unit_cell, 0, 0});
    ten.row({std::string(info.name), grouped(count), outcome.group, outcome.error, outcome.explained,
             milliseconds(outcome.ms)});
  }
  samples.finish("the ten samples", std::move(ten), "From the atoms alone.");
}

}  // namespace atomesh::cli
