// bench render, parts rates and threads.
#include <fmt/format.h>

#include <algorithm>

#include "app/cli/bench_render.h"
#include "app/cli/bench_render_tools.h"
#include "core/parallel.h"

namespace atomesh::cli {

namespace {

// Million steps a second and core that are required of a mesh of so many cells; 0: nothing.
double required_rate(std::size_t cells) {
  if (cells >= 6'500'000) return 60.0;
  if (cells >= 1'300'000) return 100.0;
  if (cells >= 300'000) return 150.0;
  return 0.0;
}

// So many threads while it lives.
class Threads {
 public:
  explicit Threads(int count) : before_(threads()) { set_threads(count); }
  ~Threads() { set_threads(before_); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

 private:
  int before_;
};

std::size_t differing_pixels(const Image& a, const Image& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) count += a.pixels[i] == b.pixels[i] ? 0 : 1;
  return count;
}

}  // namespace

void bench_render_rates(RenderBench& bench) {
  TextTable table(
      {"case", "tetrahedra", "mode", "ms", "prepare", "draw", "CPU ms", "M steps", "M steps/s/core", "steps a pixel"});
  Progress& progress = bench.session.progress();
  for (const std::string& name : bench.cases({"lattice-36", "lattice-58", "lattice-100"}, {"lattice-36-random"})) {
    const auto data = bench.scene(name);
    if (!data) continue;
    const std::size_t cells = data->material.mesh.tetrahedra.size();
    for (const BenchView& view : bench.views(*data)) {
      for (const Mode mode : {Mode::volume, Mode::volume_surface}) {
        const Parameters parameters = data->seen(view, mode);
        const Scene scene = make_scene(data->material, parameters, progress);
        const Camera camera = make_camera(parameters, scene.bounds, bench.width(1024), bench.height(1024));
        const std::string label = name + ", " + view.name;
        TimedPicture picture(scene, camera, parameters);
        picture.draw(bench.options.repeats, bench.session, label + ": " + std::string(mode_name(mode)));
        BenchRow row = picture_row(label, "rate, " + std::string(mode_name(mode)),
                                   picture_settings(*data, view, parameters, camera), picture);
        row.more.emplace_back("tetrahedra", cells);
        const double required = required_rate(cells);
        if (mode == Mode::volume && required > 0.0 && bench.usual_size() && data->material.mesh.delaunay) {
          row.requirements = {{fmt::format("rates: million steps/s/core at {} M cells", required > 140.0  ? "0.3"
                                                                                        : required > 90.0 ? "1.4"
                                                                                                          : "7"),
                               required, true, picture.rate(), ""}};
        }
        bench.result.add(std::move(row));
        const double pixels = static_cast<double>(camera.width) * camera.height;
        table.row({label, grouped(cells), std::string(mode_name(mode)), milliseconds(picture.total().median),
                   milliseconds(picture.prepare().median), milliseconds(picture.pixels().median),
                   milliseconds(picture.total().cpu),
                   fmt::format("{:.2f}", 1e-6 * static_cast<double>(picture.steps())),
                   fmt::format("{:.1f}", picture.rate()),
                   fmt::format("{:.1f}", static_cast<double>(picture.steps()) / pixels)});
      }
    }
  }
  bench.result.tables.push_back(
      {"Ray–tetrahedron steps", std::move(table),
       fmt::format("{}x{}, all threads, the default integrator. Rates by processor time of the whole picture, prepared "
                   "and drawn; medians of {} runs after one not counted.",
                   bench.width(1024), bench.height(1024), bench.options.repeats)});
}

void bench_render_threads(RenderBench& bench) {
  const int all = threads();
  if (all == 1) {
    bench.result.not_measured("threads: times faster on two threads than on one", "--threads 1");
    return;
  }
  TextTable table({"case", "mode", "1 thread, ms", fmt::format("{} threads, ms", all), "times faster", "CPU, times",
                   "differing pixels"});
  Progress& progress = bench.session.progress();
  for (const std::string& name : bench.cases({"lattice-36", "comb", "nacl-cracked"}, {"lattice-58"})) {
    const auto data = bench.scene(name);
    if (!data) continue;
    const BenchView& view = data->views.front();
    for (const Mode mode : {Mode::volume, Mode::volume_surface}) {
      const Parameters parameters = data->seen(view, mode);
      const Scene scene = make_scene(data->material, parameters, progress);
      const Camera camera = make_camera(parameters, scene.bounds, bench.width(1024), bench.height(1024));
      const std::string label = name + ", " + view.name;
      TimedPicture one(scene, camera, parameters);
      TimedPicture many(scene, camera, parameters);
      // Turn and turn about, so that both see the same machine.
      for (int run = -1; run < std::max(3, bench.options.repeats); ++run) {
        progress.stage(label + ": threads");
        {
          const Threads single(1);
          one.draw(progress, run >= 0);
        }
        many.draw(progress, run >= 0);
      }
      const double speedup = one.total().median / many.total().median;
      const std::size_t differing = differing_pixels(one.image(), many.image());
      BenchRow row = picture_row(label, "threads, " + std::string(mode_name(mode)),
                                 picture_settings(*data, view, parameters, camera), many);
      row.more.insert(row.more.end(), {{"one_thread_ms", one.total().median},
                                       {"speedup", speedup},
                                       {"cpu_ratio", many.total().cpu / one.total().cpu},
                                       {"differing_pixels", differing}});
      row.requirements = {
          {"threads: pixels that differ between one thread and all", 0.0, false, static_cast<double>(differing), ""}};
      if (all == 2 && bench.usual_size() && data->material.mesh.tetrahedra.size() > 100'000) {
        row.requirements.push_back({"threads: times faster on two threads than on one", 1.85, true, speedup, "×"});
      }
      bench.result.add(std::move(row));
      table.row({label, std::string(mode_name(mode)), milliseconds(one.total().median),
                 milliseconds(many.total().median), fmt::format("{:.2f}", speedup),
                 fmt::format("{:.2f}", many.total().cpu / one.total().cpu), grouped(differing)});
    }
  }
  bench.result.tables.push_back(
      {"Threads", std::move(table),
       fmt::format("{}x{}, runs of one thread and of all in turns. CPU: processor time of all threads beside that of "
                   "one; 1 is perfect, whatever else the machine does meanwhile.",
                   bench.width(1024), bench.height(1024))});
}

}  // namespace atomesh::cli
