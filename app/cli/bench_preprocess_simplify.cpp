// bench preprocess, part simplify.
#include <fmt/format.h>

#include <algorithm>

#include "app/cli/bench_preprocess.h"
#include "app/cli/peer_vtk_decimation.h"
#include "core/camera.h"
#include "core/image.h"
#include "core/parallel.h"
#include "preprocess/carve.h"
#include "preprocess/quantify_defects.h"
#include "preprocess/simplify.h"
#include "preprocess/tetrahedralize.h"
#include "render/renderer.h"
#include "render/scene.h"
#include "samples/planted_crystal.h"

namespace atomesh::cli {

namespace {

constexpr int picture_size = 256;  // pixels

// The volume from three sides, and how long a picture takes on the average.
struct Pictures {
  std::vector<Image> images;
  double ms = 0.0;
};

Pictures draw(const Material& material, Session& session) {
  Pictures pictures;
  const Renderer& renderer = find_renderer("auto");
  for (const char* view : {"front", "iso", "25,-40"}) {
    session.progress().stage("pictures");
    Parameters parameters;
    parameters.mode = Mode::volume;
    set_view(parameters, view);
    const Scene scene = make_scene(material, parameters, session.progress());
    const Camera camera = make_camera(parameters, scene.bounds, picture_size, picture_size);
    RenderStats stats;
    pictures.images.push_back(render(renderer, scene, camera, parameters, stats, {}, session.progress()));
    pictures.ms += (stats.setup_ms + stats.render_ms) / 3.0;
  }
  return pictures;
}

ImageDifference worst_difference(const Pictures& a, const Pictures& b) {
  ImageDifference worst = compare_images(a.images[0], b.images[0]);
  for (std::size_t i = 1; i < a.images.size(); ++i) {
    const ImageDifference difference = compare_images(a.images[i], b.images[i]);
    if (difference.rmse > worst.rmse || difference.max > worst.max) worst = difference;
  }
  return worst;
}

class SimplifyTable {
 public:
  SimplifyTable(const PreprocessBench& bench, const std::string& structure, bool turned) : bench_(bench) {
    PlantedCrystalOptions options;
    options.structure = structure;
    options.rotation = turned ? 1 : 0;
    options.atoms = bench.atoms(200000);
    const bool small = options.atoms < 50000;
    options.vacancies = small ? 1 : 7;
    options.interstitials = small ? 1 : 7;
    options.substitutions = small ? 1 : 6;
    Progress& progress = bench.session.progress();
    const Sample sample = make_planted_crystal(options, progress);
    material_.atoms = sample.atoms;
    Crystal crystal;
    crystal.grains = {*sample.unit_cell};
    TetrahedralizeReport tetrahedralized;
    CarveReport carved;
    DefectReport quantified;
    progress.stage("tetrahedralize");
    material_.mesh =
        carve(tetrahedralize(sample.atoms, crystal, 0.0, {}, tetrahedralized, progress), {}, carved, progress);
    material_.surface = extract_surface(material_.mesh);
    material_.defects = quantify_defects(sample.atoms, crystal, {}, quantified, progress);
    name_ =
        fmt::format("{}{}, {} defects, {} atoms", structure, turned ? " turned" : "",
                    options.vacancies + options.interstitials + options.substitutions, grouped(sample.atoms.size()));
    full_ = draw(material_, bench.session);
    table_.row({name_, "the full mesh", "", "", "", "", "", "", "", milliseconds(full_.ms), ""});
  }

  void measure_ours(const std::string& strategy) {
    Material simplified;
    SimplifyReport report;
    // Each run needs a mesh to work on; copying it is not timed.
    std::vector<Run> runs;
    for (int run = 0; run < bench_.options.repeats; ++run) {
      simplified = material_;
      const Times once = measure(
          1, bench_.session, name_ + ": " + strategy,
          [&] {
            simplify(simplified.mesh, simplified.surface, simplified.atoms, simplified.defects, {.strategy = strategy},
                     report, bench_.session.progress());
          },
          0);
      runs.push_back({once.median, once.cpu});
    }
    add_ours(times_of(runs), report, simplified);
  }

  // `reduction` is the share of tetrahedra that VTK is to remove.
  void measure_vtk(double reduction) {
    std::vector<float> scalars;
    for (const Index atom : material_.mesh.vertex_atom) {
      scalars.push_back(atom == no_index ? 0.0F : material_.defects.positional[atom]);
    }
    bench_.session.progress().stage(name_ + ": VTK");
    const VtkDecimation vtk = decimate_with_vtk(material_.mesh, scalars, reduction);
    const double removed = static_cast<double>(vtk.tetrahedra_before) - static_cast<double>(vtk.tetrahedra_after);
    const double rate = removed / (1e-3 * vtk.cpu_ms);
    BenchRow row{"preprocess",
                 name_,
                 "simplify: vtkUnstructuredGridQuadricDecimation",
                 Json::object({{"threads", 1}, {"lossy", true}}),
                 "VTK",
                 Times{vtk.ms, vtk.ms, vtk.ms, vtk.cpu_ms},
                 {},
                 {},
                 {}};
    row.more = {{"tetrahedra_before", vtk.tetrahedra_before},
                {"tetrahedra_after", vtk.tetrahedra_after},
                {"rate", rate},
                {"rate_unit", "tetrahedra removed/s/core"},
                {"volume_change", vtk.volume_change},
                {"inverted", vtk.inverted}};
    bench_.result.add(std::move(row));
    table_.row({name_, "VTK quadric decimation (lossy)", milliseconds(vtk.ms), milliseconds(vtk.cpu_ms),
                grouped(vtk.tetrahedra_before), grouped(vtk.tetrahedra_after), fmt::format("{:.3f}", 1e-6 * rate), "",
                fmt::format("volume {:.1e}, {} inverted", vtk.volume_change, grouped(vtk.inverted)), "", ""});
  }

  double removed_share() const { return removed_share_; }
  TextTable take() { return std::move(table_); }

 private:
  void add_ours(const Times& times, const SimplifyReport& report, const Material& simplified) {
    const double removed = static_cast<double>(report.tetrahedra_before - report.tetrahedra_after);
    const double allowed = static_cast<double>(report.tetrahedra_before - report.least_tetrahedra);
    const double share = allowed > 0.0 ? 100.0 * removed / allowed : 100.0;
    const double rate = times.per_core(removed);
    removed_share_ = std::max(removed_share_, removed / static_cast<double>(report.tetrahedra_before));
    const bool lossless = report.volume_change < 1e-12 && report.surface_identical &&
                          report.defect_tetrahedra_identical && report.scalar_error == 0.0;
    BenchRow row{"preprocess",
                 name_,
                 "simplify: " + report.strategy,
                 Json::object({{"threads", threads()}, {"strategy", report.strategy}}),
                 "",
                 times,
                 {},
                 {},
                 {}};
    row.more = {{"tetrahedra_before", report.tetrahedra_before},
                {"tetrahedra_after", report.tetrahedra_after},
                {"least_tetrahedra", report.least_tetrahedra},
                {"free_vertices", report.free_vertices},
                {"removed_vertices", report.removed_vertices},
                {"share_of_bound", share},
                {"rate", rate},
                {"rate_unit", "tetrahedra removed/s/core"},
                {"volume_change", report.volume_change},
                {"surface_identical", report.surface_identical},
                {"scalar_error", report.scalar_error},
                {"lossless", lossless}};
    std::string certificate =
        lossless ? "lossless"
                 : fmt::format("volume {:.1e}, scalars {:.1e}{}", report.volume_change, report.scalar_error,
                               report.surface_identical ? "" : ", SURFACE CHANGED");
    const bool valid = validate(simplified.mesh, 1).empty();
    certificate += valid ? "" : ", NOT VALID";
    const Pictures pictures = draw(simplified, bench_.session);
    const ImageDifference worst = worst_difference(full_, pictures);
    row.max_error = worst.max;
    row.rmse = worst.rmse;
    row.psnr = worst.psnr;
    row.more.insert(row.more.end(),
                    {{"valid", valid}, {"picture_ms", pictures.ms}, {"picture_ms_full_mesh", full_.ms}});
    if (bench_.atoms(200000) > 190000) {
      row.requirements.push_back({fmt::format("simplify: {}: million tetrahedra removed/s/core", report.strategy), 0.3,
                                  true, 1e-6 * rate, ""});
      row.requirements.push_back(
          {fmt::format("simplify: {}: share of the bound", report.strategy), 95.0, true, share, " %"});
    }
    bench_.result.add(std::move(row));
    table_.row({name_, report.strategy, milliseconds(times.median), milliseconds(times.cpu),
                grouped(report.tetrahedra_before), grouped(report.tetrahedra_after), fmt::format("{:.3f}", 1e-6 * rate),
                fmt::format("{:.2f} %", share), certificate, milliseconds(pictures.ms), short_number(worst.max)});
  }

  const PreprocessBench& bench_;
  Material material_;
  std::string name_;
  Pictures full_;
  double removed_share_ = 0.0;
  TextTable table_{{"crystal", "what", "ms", "CPU ms", "tetrahedra", "left", "M removed/s/core", "of the bound",
                    "certificate", "picture, ms", "picture error"}};
};

}  // namespace

void bench_simplify(const PreprocessBench& bench) {
  struct Block {
    const char* structure;
    bool turned;
  };
  std::vector<Block> blocks{{"fcc", false}};
  if (bench.options.full) {
    blocks.insert(blocks.end(), {{"rock-salt", false}, {"rock-salt", true}, {"diamond", false}});
  }
  for (const auto& [structure, turned] : blocks) {
    SimplifyTable table(bench, structure, turned);
    for (const std::string& strategy : simplify_strategies()) table.measure_ours(strategy);
    table.measure_vtk(table.removed_share());
    bench.result.tables.push_back(
        {fmt::format("Simplification: {}{}", structure, turned ? " turned" : ""), table.take(),
         fmt::format(
             "Bound: the fewest tetrahedra of any mesh with the same surface and the same tetrahedra at defects. "
             "Rates by processor time. "
             "Pictures: mode volume, {0}x{0}, mean of three views; error: largest channel difference from the "
             "full mesh. VTK was asked to remove as large a share; it moves the surface and the values.",
             picture_size)});
  }
}

}  // namespace atomesh::cli
