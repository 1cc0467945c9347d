// bench render, part modes.
#include <fmt/format.h>

#include "app/cli/bench_render.h"
#include "app/cli/bench_render_tools.h"

namespace atomesh::cli {

void bench_render_modes(RenderBench& bench) {
  TextTable table({"case", "mode", "integrator", "ms", "prepare", "draw", "M steps", "M steps/s/core", "MB",
                   "max error", "RMS", "PSNR, dB"});
  Progress& progress = bench.session.progress();
  for (const std::string& name :
       bench.cases({"comb", "lattice-36", "nacl-cracked"}, {"blunt-fin", "post", "quake", "lattice-36-random"})) {
    const auto data = bench.scene(name);
    if (!data) continue;
    for (const BenchView& view : bench.views(*data)) {
      const std::string label = name + ", " + view.name;
      for (const Mode mode : {Mode::volume_surface, Mode::volume, Mode::surface, Mode::xray, Mode::atoms}) {
        if (mode == Mode::atoms && data->material.atoms.size() == 0) continue;
        const Parameters seen = data->seen(view, mode);
        const Scene scene = make_scene(data->material, seen, progress);
        const Camera camera = make_camera(seen, scene.bounds, bench.width(512), bench.height(512));
        for (const Parameters& parameters : integrator_settings(seen)) {
          const bool cells = has_integrator(mode);
          const std::string integrator = cells ? integrator_text(parameters) : "";
          const std::string what = std::string(mode_name(mode)) + (integrator.empty() ? "" : ": " + integrator);
          TimedPicture picture(scene, camera, parameters);
          picture.draw(bench.options.repeats, bench.session, label + ": " + what);
          progress.stage(label + ": the judge");
          const PictureError error = bench.judge.error(label, scene, camera, parameters, picture.image(), progress);
          BenchRow row = picture_row(label, what, picture_settings(*data, view, parameters, camera), picture);
          set_error(row, error);
          bench.result.add(std::move(row));
          table.row({label, std::string(mode_name(mode)), integrator, milliseconds(picture.total().median),
                     milliseconds(picture.prepare().median), milliseconds(picture.pixels().median),
                     cells ? fmt::format("{:.2f}", 1e-6 * static_cast<double>(picture.steps())) : "",
                     cells ? fmt::format("{:.1f}", picture.rate()) : "", fmt::format("{:.1f}", 1e-6 * picture.memory()),
                     short_number(error.max), short_number(error.rmse), fmt::format("{:.1f}", error.psnr)});
        }
      }
    }
  }
  bench.result.tables.push_back(
      {"Modes and integrators", std::move(table),
       fmt::format(
           "{}x{}. ms: a picture from the scene in memory, median of {} runs after one not counted. Steps: "
           "ray–tetrahedron intersections that contributed; a second of one core, by processor time of the whole "
           "picture. MB: beyond the scene, the picture included. Errors against the judge.",
           bench.width(512), bench.height(512), bench.options.repeats)});
}

}  // namespace atomesh::cli
