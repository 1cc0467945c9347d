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

void add_stages(TextTable& table, const std::string& name, const Material& material, const PipelineReport& report,
                double write_ms, const Times& times, double bytes, const std::string& required) {
  for (const StageTime& stage : material.provenance.stages) {
    table.row({name, stage.name, milliseconds(stage.ms), "", fmt::format("{:.0f} %", 100.0 * stage.ms / times.median),
               "", ""});
  }
  table.row({name, "write_crb", milliseconds(write_ms), "", fmt::format("{:.0f} %", 100.0 * write_ms / times.median),
             "", ""});
  table.row(
      {name,
       fmt::format("all: {} tetrahedra by {}", grouped(material.mesh.tetrahedra.size()), report.tetrahedralize.mesher),
       milliseconds(times.median), milliseconds(times.cpu), "100 %", grouped(static_cast<std::uint64_t>(1e-6 * bytes)),
       required});
}

// A crystal with defects, .dat on disk to .crb on disk, in this process.
void bench_file(const PreprocessBench& bench, TextTable& table, std::size_t atoms) {
  const TemporaryFolder folder;
  const std::string input = folder.file("atoms.dat");
  std::string name;
  {
    PlantedCrystalOptions options;
    options.atoms = atoms;
    const std::size_t each = atoms < 50000 ? 1 : 20;
    options.vacancies = options.interstitials = options.substitutions = each;
    const Sample sample = make_planted_crystal(options, bench.session.progress());
    name = fmt::format("fcc, {} of each defect, {} atoms", each, grouped(sample.atoms.size()));
    write_atoms(input, sample.atoms, sample.unit_cell, bench.session.progress());
  }
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
          material = preprocess(input, {}, report, bench.session.progress());
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
    table.row({name, std::string("failed: ") + error.what(), "-", "-", "-", "-", "required: without failing MISSED"});
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
  const double million_atoms = 1e-6 * static_cast<double>(material.atoms.size());
  row.more = {{"atoms", material.atoms.size()},
              {"tetrahedra", material.mesh.tetrahedra.size()},
              {"mesher", report.tetrahedralize.mesher},
              {"rate", times.per_core(1e6 * million_atoms)},
              {"rate_unit", "atoms/s/core"},
              {"memory_mb", 1e-6 * bytes},
              {"stages", stages}};
  std::string required;
  if (million_atoms > 0.9 && million_atoms < 1.1) {
    row.requirements = {{"pipeline: .dat to .crb, a million atoms", million_seconds, false, 1e-3 * times.median, " s"},
                        {"pipeline: peak memory, a million atoms", million_megabytes, false, 1e-6 * bytes, " MB"}};
    required = row.requirements[0].text() + "; " + row.requirements[1].text();
  } else if (million_atoms > 9.0) {
    required = "required without failing: done";
  }
  bench.result.add(std::move(row));
  add_stages(table, name, material, report, write_ms, times, bytes, required);
}

}  // namespace

void bench_pipeline(const PreprocessBench& bench) {
  TextTable table({"crystal", "stage", "ms", "CPU ms", "share", "peak MB", "required"});
  bench_file(bench, table, bench.atoms(1000000));
  if (bench.options.full && bench.options.atoms == 0) bench_file(bench, table, 10000000);
  bench.result.tables.push_back({"A file of atoms to a .crb", std::move(table),
                                 fmt::format("{} threads. Peak: all the memory of the process.", threads())});
  SeedTableOptions seed;
  seed.atoms = bench.options.atoms == 0 ? 0 : std::max<std::size_t>(bench.options.atoms, 20000);
  seed.repeats = bench.options.repeats;
  seed.warm_up = 0;
  seed.pictures = false;
  if (bench.options.atoms > 0 && bench.options.atoms < 20000) seed.samples = {"nacl-cracked"};
  bench_seed_table(seed, bench.session, bench.result);
}

}  // namespace atomesh::cli
