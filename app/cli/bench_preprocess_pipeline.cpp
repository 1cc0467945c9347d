// bench preprocess, part pipeline.
#include <fmt/format.h>

#include <algorithm>

#include "app/cli/bench_preprocess.h"
#include "app/cli/bench_seed_table.h"
#include "core/error.h"
#include "core/material_file.h"
#include "core/parallel.h"
#include "preprocess/pipeline.h"
#include "preprocess/write_atoms.h"
#include "samples/planted_crystal.h"

namespace atomesh::cli {

namespace {

constexpr double million_seconds = 20.0;  // what a million atoms may take
constexpr double million_megabytes = 4000.0;

// A line for each stage that took a hundredth of the time or more, and one for all.
void add_stages(TextTable& table, const std::string& name, const Material& material, const PipelineReport& report,
                double write_ms, const Times& times, double bytes) {
  const auto megabytes = [](double b) { return grouped(static_cast<std::uint64_t>(1e-6 * b)); };
  const auto line = [&](const std::string& stage, double ms, const std::string& peak) {
    const double share = 100.0 * ms / times.median;
    if (share >= 1.0) table.row({name, stage, milliseconds(ms), "", fmt::format("{:.0f} %", share), peak});
  };
  for (std::size_t i = 0; i < material.provenance.stages.size(); ++i) {
    const StageTime& stage = material.provenance.stages[i];
    line(stage.name, stage.ms, megabytes(static_cast<double>(report.stage_memory[i])));
  }
  line("write_crb", write_ms, "");
  table.row({name,
             fmt::format("all: {} tetrahedra by {}, unit cell: {}", grouped(material.mesh.tetrahedra.size()),
                         report.tetrahedralize.mesher, report.unit_cell_source),
             milliseconds(times.median), milliseconds(times.cpu), "100 %", megabytes(bytes)});
}

struct FileCase {
  std::string structure = "fcc";
  std::size_t atoms = 1000000;
  bool vacancies_only = false;  // else each kind of defect
  bool with_cell = true;        // the file names its unit cell
  bool simplify = false;

  bool required() const { return atoms == 1000000 && !simplify; }
  bool large() const { return atoms > 1000000; }
};

Requirement without_failing(double failed) {
  return {"pipeline: files of a million atoms and more that failed", 0.0, false, failed, ""};
}

// A crystal with defects, .dat on disk to .crb on disk, in this process.
void bench_file(const PreprocessBench& bench, TextTable& table, const FileCase& file) {
  const TemporaryFolder folder;
  const std::string input = folder.file("atoms.dat");
  std::string name;
  {
    PlantedCrystalOptions options;
    options.structure = file.structure;
    options.atoms = file.atoms;
    const std::size_t each = file.atoms < 50000 ? 1 : 20;
    options.vacancies = each;
    if (!file.vacancies_only) options.interstitials = options.substitutions = each;
    bench.session.progress().stage("grow " + file.structure);
    const Sample sample = make_planted_crystal(options, bench.session.progress());
    name = fmt::format("{}, {} {}{}{}, {} atoms", file.structure, each,
                       file.vacancies_only ? "vacancies" : "of each defect",
                       file.with_cell ? "" : ", no unit cell in the file", file.simplify ? ", --simplify" : "",
                       grouped(sample.atoms.size()));
    write_atoms(input, sample.atoms, file.with_cell ? sample.unit_cell : std::nullopt, bench.session.progress());
  }
  PipelineOptions options;
  options.simplify = file.simplify;
  Material material;
  PipelineReport report;
  double write_ms = 0.0;
  double bytes = 0.0;
  Times times;
  try {
    const PeakMemory memory;
    times = measure(
        bench.options.repeats, bench.session, name,
        [&] {
          material = {};
          material = preprocess(input, options, report, bench.session.progress());
          write_ms =
              measure(
                  1, bench.session, "write_crb",
                  [&] { write_material(folder.file("material.crb"), material, {}, bench.session.progress()); }, 0)
                  .median;
        },
        0);
    // Each stage starts its own high-water mark.
    bytes = memory.held();
    for (const std::uint64_t stage : report.stage_memory) bytes = std::max(bytes, static_cast<double>(stage));
  } catch (const CancelledError&) {
    throw;
  } catch (const Error& error) {
    BenchRow row{"preprocess", name, "pipeline: .dat to .crb", Json::object(), "", {}, {}, {}, {}};
    row.more = {{"error", error.what()}};
    if (file.required() || file.large()) row.requirements = {without_failing(1.0)};
    bench.result.add(std::move(row));
    table.row({name, std::string("FAILED: ") + error.what(), "", "", "", ""});
    return;
  }

  BenchRow row{"preprocess", name, "pipeline: .dat to .crb", Json::object({{"threads", threads()}}), "", times, {},
               {},           {}};
  Json stages = Json::array();
  for (std::size_t i = 0; i < material.provenance.stages.size(); ++i) {
    const StageTime& stage = material.provenance.stages[i];
    stages.push(Json::object({{"name", stage.name},
                              {"ms", stage.ms},
                              {"peak_memory_mb", 1e-6 * static_cast<double>(report.stage_memory[i])}}));
  }
  stages.push(Json::object({{"name", "write_crb"}, {"ms", write_ms}}));
  row.more = {{"atoms", material.atoms.size()},
              {"tetrahedra", material.mesh.tetrahedra.size()},
              {"mesher", report.tetrahedralize.mesher},
              {"unit_cell", report.unit_cell_source},
              {"rate", times.per_core(static_cast<double>(material.atoms.size()))},
              {"rate_unit", "atoms/s/core"},
              {"memory_mb", 1e-6 * bytes},
              {"stages", stages}};
  if (file.required()) {
    row.requirements = {{"pipeline: .dat to .crb, a million atoms", million_seconds, false, 1e-3 * times.median, " s"},
                        {"pipeline: peak memory, a million atoms", million_megabytes, false, 1e-6 * bytes, " MB"}};
  }
  if (file.required() || file.large()) {
    row.requirements.push_back(without_failing(0.0));
  }
  bench.result.add(std::move(row));
  add_stages(table, name, material, report, write_ms, times, bytes);
}

}  // namespace

void bench_pipeline(const PreprocessBench& bench) {
  TextTable table({"crystal", "stage", "ms", "CPU ms", "share", "peak, MB"});
  const std::size_t atoms = bench.atoms(1000000);
  std::vector<FileCase> files{{.atoms = atoms},
                              {.structure = "rock-salt", .atoms = atoms, .vacancies_only = true, .with_cell = false},
                              {.atoms = atoms, .simplify = true}};
  if (bench.options.atoms == 0) {
    if (bench.options.full) {
      files.push_back({.atoms = 10000000});
    } else {
      bench.result.not_measured("pipeline: ten million atoms without failing", "--full");
    }
  }
  for (const FileCase& file : files) bench_file(bench, table, file);
  bench.result.tables.push_back(
      {"A file of atoms to a .crb", std::move(table),
       fmt::format("`atomesh preprocess` with its default options and those named: .dat on disk to .crb on disk, wall "
                   "clock, {} threads. Stages of less than 1 % are left out. Peak: all the memory of the process.",
                   threads())});
  SeedTableOptions seed;
  seed.atoms = bench.options.atoms == 0 ? 0 : std::max<std::size_t>(bench.options.atoms, 20000);
  seed.repeats = bench.options.repeats;
  seed.warm_up = 0;
  seed.modes.clear();
  if (bench.options.atoms > 0 && bench.options.atoms < 20000) seed.samples = {"nacl-cracked"};
  bench_seed_table(seed, bench.session, bench.result);
}

}  // namespace atomesh::cli
