// bench render, parts frames and seed.
#include <fmt/format.h>

#include "app/cli/bench_render.h"
#include "app/cli/bench_render_tools.h"
#include "app/cli/bench_seed_table.h"
#include "render/progressive.h"

namespace atomesh::cli {

namespace {

constexpr Mode all_modes[] = {Mode::volume_surface, Mode::volume, Mode::surface, Mode::xray, Mode::atoms};

void first_pictures(RenderBench& bench, const std::string& name, TextTable& table) {
  const auto data = bench.scene(name);
  if (!data) return;
  Progress& progress = bench.session.progress();
  const BenchView& view = data->views.front();
  const Renderer& renderer = find_renderer("auto");
  for (const Mode mode : all_modes) {
    const Parameters parameters = data->seen(view, mode);
    Scene scene;
    const Times making = measure(
        bench.options.repeats, bench.session, name + ": scene",
        [&] { scene = make_scene(data->material, parameters, progress); }, 0);
    const Camera camera = make_camera(parameters, scene.bounds, bench.width(1280), bench.height(720));
    double prepare = 0.0;
    const Times times = measure(bench.options.repeats, bench.session, name + ": first picture", [&] {
      RenderStats stats;
      // A budget that is used up at once: the first picture, and no more.
      render_progressively(renderer, scene, camera, parameters, {.sub_window = 8, .time_budget_ms = 0.0}, stats, {}, {},
                           progress);
      prepare = stats.setup_ms;
    });
    const std::size_t cells = data->material.mesh.tetrahedra.size();
    BenchRow row{"render",
                 name,
                 fmt::format("first picture, {}", mode_name(mode)),
                 picture_settings(*data, view, parameters, camera),
                 "",
                 times,
                 {},
                 {},
                 {}};
    row.more = {{"tetrahedra", cells}, {"prepare_ms", prepare}, {"make_scene_ms", making.median}};
    if (bench.usual_size() && cells >= 1'000'000) {
      row.requirements = {
          {"frames: first picture of a million tetrahedra at 1280x720", 100.0, false, times.median, " ms"}};
    }
    bench.result.add(std::move(row));
    table.row({name, grouped(cells), std::string(mode_name(mode)), milliseconds(making.median), milliseconds(prepare),
               milliseconds(times.median), milliseconds(times.cpu)});
  }
}

void full_frames(RenderBench& bench, const std::string& name, TextTable& table) {
  const auto data = bench.scene(name);
  if (!data) return;
  Progress& progress = bench.session.progress();
  const BenchView& view = data->views.front();
  for (const Mode mode : all_modes) {
    const Parameters parameters = data->seen(view, mode);
    const Scene scene = make_scene(data->material, parameters, progress);
    const Camera camera = make_camera(parameters, scene.bounds, bench.width(1280), bench.height(720));
    TimedPicture picture(scene, camera, parameters);
    picture.draw(std::max(5, bench.options.repeats), bench.session, name + ": " + std::string(mode_name(mode)));
    const double rate = 1e3 / picture.total().median;
    BenchRow row = picture_row(name, fmt::format("frames, {}", mode_name(mode)),
                               picture_settings(*data, view, parameters, camera), picture);
    row.more.insert(row.more.end(), {{"atoms", data->material.atoms.size()}, {"frames_per_second", rate}});
    if (bench.usual_size() && data->material.atoms.size() >= 25'000) {
      row.requirements = {{"frames: a second, of 25,000 atoms at 1280x720", 10.0, true, rate, ""}};
    }
    bench.result.add(std::move(row));
    table.row({name, grouped(data->material.atoms.size()), std::string(mode_name(mode)),
               milliseconds(picture.total().median), milliseconds(picture.total().cpu), fmt::format("{:.1f}", rate)});
  }
}

}  // namespace

void bench_render_frames(RenderBench& bench) {
  TextTable first({"case", "tetrahedra", "mode", "make scene, ms", "prepare, ms", "first picture, ms", "CPU ms"});
  TextTable frames({"case", "atoms", "mode", "ms", "CPU ms", "frames a second"});
  const bool chosen = !bench.options.cases.empty() || bench.options.quick;
  for (const std::string& name : chosen ? bench.cases({}) : std::vector<std::string>{"cu-line-defect"}) {
    first_pictures(bench, name, first);
  }
  for (const std::string& name : chosen ? bench.cases({}) : std::vector<std::string>{"nacl-cracked"}) {
    full_frames(bench, name, frames);
  }
  bench.result.tables.push_back({"First picture", std::move(first),
                                 fmt::format("Progressive drawing at {}x{}: from the scene in memory to a picture of "
                                             "every eighth pixel of every eighth row; prepare: of the last run.",
                                             bench.width(1280), bench.height(720))});
  bench.result.tables.push_back(
      {"Frames", std::move(frames),
       fmt::format(
           "Whole pictures of {}x{} from the scene in memory, prepared anew each time as for a camera that moves.",
           bench.width(1280), bench.height(720))});
}

void bench_render_seed(RenderBench& bench) {
  SeedTableOptions options;
  options.modes = {Mode::volume_surface, Mode::xray};
  options.preprocessing = false;
  options.repeats = bench.options.repeats;
  options.width = bench.options.width > 0 ? bench.options.width : bench.options.quick ? 64 : 512;
  options.height = bench.options.height > 0 ? bench.options.height : bench.options.quick ? 64 : 512;
  if (bench.options.quick) {
    options.atoms = 2000;
    options.samples = {"nacl-cracked"};
  }
  bench_seed_table(options, bench.session, bench.result);
}

}  // namespace atomesh::cli
