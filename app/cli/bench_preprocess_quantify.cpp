// bench preprocess, part quantify_defects.
#include <fmt/format.h>

#include "app/cli/bench_lammps.h"
#include "app/cli/bench_preprocess.h"
#include "core/parallel.h"
#include "preprocess/quantify_defects.h"
#include "samples/planted_crystal.h"
#include "samples/structure_types.h"

namespace atomesh::cli {

namespace {

struct Crystal26 {
  const char* structure;
  double neighbourhood;  // × the conventional cell's edge
  int neighbours;        // that many atoms lie within it
  double cna_cutoff;     // × the edge, as LAMMPS's manual gives it
  int cna;               // neighbours within it
  int centro;            // neighbours of centro/atom
};

constexpr Crystal26 crystals[] = {
    {"fcc", 1.0, 18, 0.8536, 12, 12},
    {"bcc", 1.4143, 26, 1.207, 14, 8},
};

class QuantifyTable {
 public:
  explicit QuantifyTable(const PreprocessBench& bench) : bench_(bench), lammps_(find_lammps()) {}

  void measure_crystal(const Crystal26& crystal, double noise) {
    PlantedCrystalOptions planted;
    planted.structure = crystal.structure;
    planted.atoms = bench_.atoms(256000);
    planted.shape = PlantedShape::periodic_block;
    planted.noise = noise;
    const Sample sample = make_planted_crystal(planted, bench_.session.progress());
    name_ = fmt::format("{}, {:g} % noise, {} atoms", crystal.structure, 100.0 * noise, grouped(sample.atoms.size()));
    atoms_ = sample.atoms.size();

    DefectOptions options;
    options.neighbourhood = crystal.neighbourhood;
    const int all = threads();
    for (const int cores : {1, all}) {
      set_threads(cores);
      std::size_t positional = 0;
      const PeakMemory memory;
      const Times times = measure(bench_.options.repeats, bench_.session, name_ + ": quantify_defects", [&] {
        DefectReport report;
        quantify_defects(sample.atoms, *sample.unit_cell, options, report, bench_.session.progress());
        positional = report.positional_atoms;
      });
      add_ours(crystal, times, cores, memory.grown(), positional);
      if (all == 1) break;
    }
    set_threads(all);
    add_lammps(crystal, sample);
  }

  TextTable take() { return std::move(table_); }
  bool has_lammps() const { return !lammps_.empty(); }

 private:
  void add_ours(const Crystal26& crystal, const Times& times, int cores, double bytes, std::size_t positional) {
    const double rate = times.per_core(static_cast<double>(atoms_));
    BenchRow row{"preprocess",
                 name_,
                 "quantify_defects",
                 Json::object({{"threads", cores}, {"neighbours", crystal.neighbours}}),
                 "",
                 times,
                 {},
                 {},
                 {}};
    row.more = {{"atoms", atoms_},
                {"rate", rate},
                {"rate_unit", "atoms/s/core"},
                {"memory_mb", 1e-6 * bytes},
                {"positional_atoms", positional}};
    if (crystal.neighbours == 26 && atoms_ > 100000) {  // below that, setting up counts
      row.requirements.push_back({"quantify_defects: million atoms/s/core, 26 neighbours", 1.0, true, 1e-6 * rate, ""});
    }
    bench_.result.add(std::move(row));
    add_line("ours: neighbours found, values, sites", crystal.neighbours, cores, times, rate);
  }

  void add_lammps(const Crystal26& crystal, const Sample& sample) {
    if (lammps_.empty()) return;
    const double edge = glm::length(sample.unit_cell->primitive[0]);
    std::string why;
    bench_.session.progress().stage(name_ + ": LAMMPS");
    const auto times = time_lammps(lammps_, sample.atoms, crystal.cna_cutoff * edge, crystal.centro,
                                   std::max(3, bench_.options.repeats), bench_.session, why);
    if (!times) {
      table_.row({name_, "LAMMPS: " + why, "", "", "", "", ""});
      return;
    }
    const struct {
      const char* what;
      int neighbours;
      const Times& times;
    } lines[] = {{"LAMMPS cna/atom alone: its neighbour list given", crystal.cna, times->cna},
                 {"LAMMPS cna/atom with its neighbour list built", crystal.cna, times->cna_with_lists},
                 {"LAMMPS centro/atom alone: its neighbour list given", crystal.centro, times->centro},
                 {"LAMMPS centro/atom with its neighbour list built", crystal.centro, times->centro_with_lists}};
    for (const auto& [what, neighbours, one] : lines) {
      const double rate = one.per_core(static_cast<double>(atoms_));
      BenchRow row{"preprocess", name_, what, Json::object({{"threads", 1}}), "LAMMPS", one, {}, {}, {}};
      row.more = {{"atoms", atoms_}, {"rate", rate}, {"rate_unit", "atoms/s/core"}};
      bench_.result.add(std::move(row));
      add_line(what, neighbours, 1, one, rate);
    }
  }

  void add_line(const std::string& what, int neighbours, int cores, const Times& times, double rate) {
    table_.row({name_, what, std::to_string(neighbours), std::to_string(cores), milliseconds(times.median),
                milliseconds(times.cpu), fmt::format("{:.2f}", 1e-6 * rate)});
  }

  const PreprocessBench& bench_;
  std::string lammps_;
  std::string name_;
  std::size_t atoms_ = 0;
  TextTable table_{{"crystal", "what", "neighbours", "cores", "ms", "CPU ms", "M atoms/s/core"}};
};

}  // namespace

void bench_quantify_defects(const PreprocessBench& bench) {
  QuantifyTable table(bench);
  for (const Crystal26& crystal : crystals) {
    for (const double noise : {0.0, 0.01}) table.measure_crystal(crystal, noise);
  }
  std::string caption =
      "Periodic blocks, the unit cell given. Ours: from bare positions to the values of every atom, vacancy sites and "
      "extra atoms, the search for neighbours included. Rates by processor time. ";
  caption += table.has_lammps()
                 ? "LAMMPS: one process, one thread. The rows with its list built are what a new snapshot costs and "
                   "the ones to compare; those alone leave out the search for neighbours, most of the work on a "
                   "perfect crystal."
                 : "LAMMPS: not installed (no lmp in PATH).";
  bench.result.tables.push_back({"Defect quantification", table.take(), std::move(caption)});
}

}  // namespace atomesh::cli
