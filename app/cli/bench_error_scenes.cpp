// bench error, part scenes.
#include <fmt/format.h>

#include <cmath>

#include "app/cli/bench_error.h"
#include "app/cli/bench_render_tools.h"
#include "core/error.h"

namespace atomesh::cli {

namespace {

constexpr std::size_t sample_atoms = 20000;
constexpr std::size_t quick_sample_atoms = 5000;

class SceneErrors {
 public:
  explicit SceneErrors(RenderBench& bench) : bench_(bench) {}

  void measure(const BenchScene& data) {
    for (const BenchView& view : data.views) {
      for (const Mode mode : {Mode::volume, Mode::volume_surface, Mode::surface, Mode::xray}) {
        Parameters parameters = data.seen(view, mode);
        const Scene scene = make_scene(data.material, parameters, bench_.session.progress());
        const Camera camera = make_camera(parameters, scene.bounds, bench_.width(512), bench_.height(512));
        const std::string label = fmt::format("{}, {}, {}", data.name, view.name, mode_name(mode));
        add(label, data, view, scene, camera, parameters);
        if (has_integrator(mode) && parameters.integrator != Integrator::exact) {
          parameters.integrator = Integrator::exact;
          add(label, data, view, scene, camera, parameters);
        }
      }
    }
  }

  BenchTable take() {
    return {"Errors on all data sets",
            std::move(table_),
            fmt::format("One run each. Samples of about {} atoms. Surface and xray have no integrator: their closed "
                        "form is the only one. Map: {}.",
                        bench_.options.quick ? quick_sample_atoms : sample_atoms, volume_map_caption()),
            {}};
  }

 private:
  void add(const std::string& label, const BenchScene& data, const BenchView& view, const Scene& scene,
           const Camera& camera, const Parameters& parameters) {
    Progress& progress = bench_.session.progress();
    progress.stage(label);
    TimedPicture picture(scene, camera, parameters);
    picture.draw(progress);
    const PictureError error = bench_.judge.error(label, scene, camera, parameters, picture.image(), progress);
    BenchRow row = picture_row(label, "default setting", picture_settings(data, view, parameters, camera), picture);
    row.suite = "error";
    set_error(row, error);
    const bool volume = has_integrator(parameters.mode);
    if (parameters.integrator == Parameters{}.integrator) {
      row.requirements.push_back({"scenes: default setting, largest error", default_limit, false, error.max, ""});
    }
    if (volume && parameters.integrator == Integrator::exact) {
      row.what = "closed form";
      row.requirements.push_back({"scenes: closed form, largest error", closed_form_limit, false, error.max, ""});
    }
    bench_.result.add(std::move(row));
    table_.row({label, parameters.mode == Mode::volume ? data.volume_map : "",
                volume ? integrator_text(parameters) : "", milliseconds(picture.total().median),
                short_number(error.max), short_number(error.rmse),
                std::isfinite(error.psnr) ? fmt::format("{:.1f}", error.psnr) : "-",
                error.max > 0.0 ? fmt::format("{}, {}", error.column, error.row) : ""});
  }

  RenderBench& bench_;
  TextTable table_{{"case", "map", "integrator", "ms", "max error", "RMS", "PSNR, dB", "at pixel"}};
};

std::vector<std::string> all_scenes(bool full) {
  std::vector<std::string> names;
  for (const BenchSceneInfo& info : bench_scene_table()) {
    const bool large = info.name.starts_with("lattice-58") || info.name.starts_with("lattice-100");
    if (full || !large) names.push_back(info.name);
  }
  return names;
}

}  // namespace

void bench_error_scenes(RenderBench& bench) {
  SceneErrors errors(bench);
  for (const std::string& name : bench.cases(all_scenes(bench.options.full))) {
    bench.session.progress().stage(name);
    try {
      errors.measure(make_bench_scene(name, bench.options.data, bench.options.quick ? quick_sample_atoms : sample_atoms,
                                      bench.session.progress()));
    } catch (const UnavailableError& error) {
      bench.session.note(error.what());
    }
  }
  bench.result.tables.push_back(errors.take());
}

}  // namespace atomesh::cli
