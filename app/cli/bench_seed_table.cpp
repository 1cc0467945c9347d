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

constexpr std::array<Mode, 5> modes{Mode::volume_surface, Mode::volume, Mode::surface, Mode::xray, Mode::atoms};

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
  std::vector<std::string> headings{"sample", "atoms", "tetrahedra", "preprocessing"};
  if (options.pictures)
    headings.insert(headings.end(), {"volume-surface", "volume", "surface", "xray", "atoms (balls)"});
  TextTable table(headings);
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
        options.repeats, session, name + ": preprocess",
        [&] {
          PipelineReport report;
          material = preprocess(atoms_file, {}, report, session.progress());
          write_material(material_file, material, {}, session.progress());
        },
        options.warm_up);
    const std::size_t atoms = material.atoms.size();
    std::vector<std::string> cells{name, grouped(atoms), grouped(material.mesh.tetrahedra.size()),
                                   cell(preprocessing.median, sample.seed_ms[0])};
    BenchRow preprocessing_row =
        row(sample, atoms, "preprocess", Json::object({{"threads", threads()}}), preprocessing, sample.seed_ms[0]);
    if (options.atoms == 0) {
      preprocessing_row.requirements = {{"pipeline: times faster than the seed's preprocessing, table 5.1", 30.0, true,
                                         sample.seed_ms[0] / preprocessing.median, "×"}};
    }
    result.add(std::move(preprocessing_row));

    for (std::size_t m = 0; options.pictures && m < modes.size(); ++m) {
      Parameters parameters;
      parameters.mode = modes[m];
      const std::string mode(mode_name(modes[m]));
      const Times times = measure(
          options.repeats, session, name + ": " + mode,
          [&] {
            const Scene scene = make_scene(material, parameters, session.progress());
            const Camera camera = make_camera(parameters, scene.bounds, options.width, options.height);
            RenderStats stats;
            render(renderer, scene, camera, parameters, stats, {}, session.progress());
          },
          options.warm_up);
      cells.push_back(cell(times.median, sample.seed_ms[m + 1]));
      result.add(row(sample, atoms, mode,
                     Json::object({{"threads", threads()},
                                   {"renderer", renderer.name()},
                                   {"size", Json::array({options.width, options.height})}}),
                     times, sample.seed_ms[m + 1]));
    }
    table.row(std::move(cells));
  }

  std::string caption = fmt::format(
      "Milliseconds (the seed's on a 3.2 GHz quad-core with a GTX 560; how many times faster). {} "
      "{}. Commit {}. Preprocessing: .dat on disk to .crb on disk.",
      options.repeats > 1 || options.warm_up > 0
          ? fmt::format("Medians of {} runs after {} not counted.", options.repeats, options.warm_up)
          : "One run each.",
      machine_name(), build_commit());
  if (options.pictures) {
    caption += fmt::format(" Pictures: {}x{} with renderer {}, material in memory to pixels.", options.width,
                           options.height, renderer.name());
  }
  if (options.atoms != 0 || options.width != 512 || options.height != 512) {
    caption += " Other sizes than the seed's were asked for: the ratios compare different amounts of work.";
  }
  result.tables.push_back({"The seed's table 5.1", std::move(table), std::move(caption)});
}

}  // namespace atomesh::cli
