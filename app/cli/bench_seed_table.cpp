#include "app/cli/bench_seed_table.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>

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

struct Times {
  double median = 0.0;
  double min = 0.0;
  double max = 0.0;
};

// One run that is not counted (caches, first touch of memory), then `repeats` that are.
Times measure(int repeats, Session& session, const std::string& what, auto&& work) {
  std::vector<double> ms;
  for (int run = -1; run < repeats; ++run) {
    session.progress().stage(what);
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
    if (run >= 0) ms.push_back(elapsed.count());
  }
  std::sort(ms.begin(), ms.end());
  const std::size_t n = ms.size();
  return {n % 2 == 1 ? ms[n / 2] : 0.5 * (ms[n / 2 - 1] + ms[n / 2]), ms.front(), ms.back()};
}

// Removed with everything in it, whatever happens.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_(std::filesystem::temp_directory_path() / ("atomesh-bench-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string file(const char* name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

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

// "123 (9,254; 75×)": ours, the seed's, and how many times faster.
std::string cell(double ours, double seeds) {
  const double ratio = seeds / ours;
  return fmt::format(
      "{} ({}; {}×)", milliseconds(ours), milliseconds(seeds),
      ratio < 999.5 ? fmt::format("{:.3g}", ratio) : grouped(static_cast<std::uint64_t>(std::lround(ratio))));
}

Json row_json(const SampleInfo& sample, std::size_t atoms, std::string_view what, Json settings, const Times& times,
              double seed_ms) {
  return Json::object({{"suite", "seed-table"},
                       {"case", sample.name},
                       {"what", what},
                       {"settings", std::move(settings)},
                       {"atoms", atoms},
                       {"peer", "seed 003, table 5.1"},
                       {"ms_median", times.median},
                       {"ms_min", times.min},
                       {"ms_max", times.max},
                       {"peer_ms", seed_ms},
                       {"ratio", seed_ms / times.median},
                       {"max_error", nullptr},
                       {"rmse", nullptr},
                       {"psnr", nullptr}});
}

}  // namespace

BenchResult bench_seed_table(const SeedTableOptions& options, Session& session) {
  BenchResult result{TextTable({"sample", "atoms", "tetrahedra", "preprocessing", "volume-surface", "volume", "surface",
                                "xray", "atoms (balls)"}),
                     "", Json::object()};
  Json rows = Json::array();
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
    const Times preprocessing = measure(options.repeats, session, name + ": preprocess", [&] {
      PipelineReport report;
      material = preprocess(atoms_file, {}, report, session.progress());
      write_material(material_file, material, {}, session.progress());
    });
    const std::size_t atoms = material.atoms.size();
    std::vector<std::string> cells{name, grouped(atoms), grouped(material.mesh.tetrahedra.size()),
                                   cell(preprocessing.median, sample.seed_ms[0])};
    rows.push(row_json(sample, atoms, "preprocess", Json::object({{"threads", threads()}}), preprocessing,
                       sample.seed_ms[0]));

    for (std::size_t m = 0; m < modes.size(); ++m) {
      Parameters parameters;
      parameters.mode = modes[m];
      const std::string mode(mode_name(modes[m]));
      const Times times = measure(options.repeats, session, name + ": " + mode, [&] {
        const Scene scene = make_scene(material, parameters, session.progress());
        const Camera camera = make_camera(parameters, scene.bounds, options.width, options.height);
        RenderStats stats;
        render(renderer, scene, camera, parameters, stats, {}, session.progress());
      });
      cells.push_back(cell(times.median, sample.seed_ms[m + 1]));
      rows.push(row_json(sample, atoms, mode,
                         Json::object({{"threads", threads()},
                                       {"renderer", renderer.name()},
                                       {"size", Json::array({options.width, options.height})}}),
                         times, sample.seed_ms[m + 1]));
    }
    result.table.row(std::move(cells));
  }

  result.caption = fmt::format(
      "Milliseconds (the seed's on a 3.2 GHz quad-core with a GTX 560; how many times faster). Medians of {} runs "
      "after "
      "a warm-up, pictures {}x{} with renderer {}. {}. Commit {}. Preprocessing: .dat on disk to .crb on disk. "
      "Pictures: "
      "material in memory to pixels. Made by `atomesh bench seed-table`.",
      options.repeats, options.width, options.height, renderer.name(), machine_name(), build_commit());
  if (options.atoms != 0 || options.width != 512 || options.height != 512) {
    result.caption += " Other sizes than the seed's were asked for: the ratios compare different amounts of work.";
  }
  result.json = Json::object({{"machine", machine_name()}, {"commit", build_commit()}, {"rows", rows}});
  return result;
}

}  // namespace atomesh::cli
