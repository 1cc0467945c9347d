#include "app/cli/bench_seed_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/cli/machine.h"
#include "core/camera.h"
#include "core/error.h"
#include "core/image.h"
#include "core/material_file.h"
#include "core/parallel.h"
#include "preprocess/pipeline.h"
#include "preprocess/write_atoms.h"
#include "render/renderer.h"
#include "render/scene.h"
#include "samples/samples.h"

namespace atomesh::cli {

namespace {

// A column of the seed's table: SampleInfo::seed_ms holds preprocessing, then these.
struct Column {
  Mode mode;
  const char* heading;
  double required;  // times faster; 0: nothing is
};
constexpr std::array<Column, 5> columns{{{Mode::volume_surface, "volume-surface", 10.0},
                                         {Mode::volume, "volume", 0.0},
                                         {Mode::surface, "surface", 0.0},
                                         {Mode::xray, "xray", 20.0},
                                         {Mode::atoms, "atoms (balls)", 0.0}}};

// "123 (9,254; 75×)": ours, the seed's, and how many times faster.
std::string cell(double ours, double seeds) {
  const double ratio = seeds / ours;
  return fmt::format(
      "{} ({}; {}×)", milliseconds(ours), milliseconds(seeds),
      ratio < 999.5 ? fmt::format("{:.3g}", ratio) : grouped(static_cast<std::uint64_t>(std::lround(ratio))));
}

BenchRow row(const SampleInfo& sample, std::size_t atoms, std::string_view what, Json settings, const Times& times,
             double seed_ms) {
  BenchRow row{"seed-table",
               std::string(sample.name),
               std::string(what),
               std::move(settings),
               "seed 003, table 5.1",
               times,
               {},
               {},
               {}};
  row.more = {{"atoms", atoms}, {"peer_ms", seed_ms}, {"ratio", seed_ms / times.median}};
  return row;
}

}  // namespace

std::vector<SampleInfo> chosen_samples(const std::vector<std::string>& names) {
  if (names.empty()) return sample_table();
  std::vector<std::string> known;
  for (const SampleInfo& sample : sample_table()) known.emplace_back(sample.name);
  std::vector<SampleInfo> chosen;
  for (const std::string& name : names) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      const std::string nearest = nearest_name(name, known);
      throw UsageError("--sample: there is no \"" + name + "\"" +
                       (nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"));
    }
    chosen.push_back(sample_table()[static_cast<std::size_t>(found - known.begin())]);
  }
  return chosen;
}

void bench_seed_table(const SeedTableOptions& options, Session& session, BenchResult& result) {
  const auto wanted = [&](const Column& column) {
    return std::find(options.modes.begin(), options.modes.end(), column.mode) != options.modes.end();
  };
  std::vector<std::string> headings{"sample", "atoms", "tetrahedra"};
  if (options.preprocessing) headings.emplace_back("preprocessing");
  for (const Column& column : columns) {
    if (wanted(column)) headings.emplace_back(column.heading);
  }
  TextTable table(headings);
  const bool seeds_size = options.width == 512 && options.height == 512;
  const Renderer& renderer = find_renderer("auto");
  const TemporaryFolder folder;
  const std::string atoms_file = folder.file("atoms.dat");
  const std::string material_file = folder.file("material.crb");

  for (const SampleInfo& sample : chosen_samples(options.samples)) {
    const std::string name(sample.name);
    session.progress().stage("sample " + name);
    {
      const Sample grown = make_sample(name, {.atoms = options.atoms}, session.progress());
      write_atoms(atoms_file, grown.atoms, grown.unit_cell, session.progress());
    }
    Material material;
    const Times preprocessing = measure(
        options.preprocessing ? options.repeats : 1, session, name + ": preprocess",
        [&] {
          PipelineReport report;
          material = preprocess(atoms_file, {}, report, session.progress());
          if (options.preprocessing) write_material(material_file, material, {}, session.progress());
        },
        options.preprocessing ? options.warm_up : 0);
    const std::size_t atoms = material.atoms.size();
    std::vector<std::string> cells{name, grouped(atoms), grouped(material.mesh.tetrahedra.size())};
    if (options.preprocessing) {
      cells.push_back(cell(preprocessing.median, sample.seed_ms[0]));
      BenchRow preprocessing_row =
          row(sample, atoms, "preprocess", Json::object({{"threads", threads()}}), preprocessing, sample.seed_ms[0]);
      if (options.atoms == 0) {
        preprocessing_row.requirements = {{"pipeline: times faster than the seed's preprocessing, table 5.1", 30.0,
                                           true, sample.seed_ms[0] / preprocessing.median, "×"}};
      }
      result.add(std::move(preprocessing_row));
    }

    for (std::size_t c = 0; c < columns.size(); ++c) {
      const Column& column = columns[c];
      if (!wanted(column)) continue;
      const double seed_ms = sample.seed_ms[c + 1];
      Parameters parameters;
      parameters.mode = column.mode;
      const std::string mode(mode_name(column.mode));
      const Times times = measure(
          options.repeats, session, name + ": " + mode,
          [&] {
            const Scene scene = make_scene(material, parameters, session.progress());
            const Camera camera = make_camera(parameters, scene.bounds, options.width, options.height);
            RenderStats stats;
            render(renderer, scene, camera, parameters, stats, {}, session.progress());
          },
          options.warm_up);
      cells.push_back(cell(times.median, seed_ms));
      BenchRow picture_row = row(sample, atoms, mode,
                                 Json::object({{"threads", threads()},
                                               {"renderer", renderer.name()},
                                               {"size", Json::array({options.width, options.height})}}),
                                 times, seed_ms);
      if (options.atoms == 0 && seeds_size && column.required > 0.0) {
        picture_row.requirements = {{fmt::format("{}: times faster than the seed's, table 5.1", mode), column.required,
                                     true, seed_ms / times.median, "×"}};
      }
      result.add(std::move(picture_row));
    }
    table.row(std::move(cells));
  }

  std::string caption = fmt::format(
      "Milliseconds (the seed's on a 3.2 GHz quad-core with a GTX 560; how many times faster). {} "
      "{}. Commit {}.{}",
      options.repeats > 1 || options.warm_up > 0
          ? fmt::format("Medians of {} runs after {} not counted.", options.repeats, options.warm_up)
          : "One run each.",
      machine_name(), build_commit(), options.preprocessing ? " Preprocessing: .dat on disk to .crb on disk." : "");
  if (!options.modes.empty()) {
    caption += fmt::format(" Pictures: {}x{} with renderer {}, material in memory to pixels.", options.width,
                           options.height, renderer.name());
  }
  if (options.atoms != 0 || !seeds_size) {
    caption += " Other sizes than the seed's were asked for: the ratios compare different amounts of work.";
  }
  result.tables.push_back({"The seed's table 5.1", std::move(table), std::move(caption)});
}

}  // namespace atomesh::cli
