// bench render, part memory.
#include <fmt/format.h>

#include <array>

#include "app/cli/bench_render.h"
#include "app/cli/bench_render_tools.h"
#include "core/memory.h"

namespace atomesh::cli {

namespace {

constexpr double bytes_a_tetrahedron = 24.0;
constexpr double bytes_a_pixel = 64.0;

struct Held {
  double scene = 0.0;  // bytes beyond the material
  double frame = 0.0;  // beyond the scene, the picture included
  double all = 0.0;    // beyond the material
};

Held picture_memory(const Material& material, const Parameters& parameters, int width, int height, Progress& progress) {
  Held held;
  const PeakMemory all;
  const auto before = static_cast<double>(current_memory());
  const Scene scene = make_scene(material, parameters, progress);
  held.scene = std::max(0.0, static_cast<double>(current_memory()) - before);
  const double beside_scene = all.grown();  // what making it took at most
  const PeakMemory drawing;
  {
    const Camera camera = make_camera(parameters, scene.bounds, width, height);
    RenderStats stats;
    find_renderer("auto").draw(scene, camera, parameters, stats, {}, progress);
  }
  held.frame = drawing.grown();
  held.all = std::max(beside_scene, held.scene + held.frame);
  return held;
}

}  // namespace

void bench_render_memory(RenderBench& bench) {
  TextTable table({"case", "mode", "size", "tetrahedra", "scene, MB", "frame, MB", "in all, MB", "allowed, MB",
                   "frame: bytes a tetrahedron", "frame: bytes a pixel"});
  Progress& progress = bench.session.progress();
  for (const std::string& name : bench.cases({"comb", "lattice-36", "lattice-58"}, {"lattice-100"})) {
    const auto data = bench.scene(name);
    if (!data) continue;
    const BenchView& view = data->views.front();
    const auto cells = static_cast<double>(data->material.mesh.tetrahedra.size());
    for (const Mode mode : {Mode::volume, Mode::volume_surface}) {
      const Parameters parameters = data->seen(view, mode);
      // A small picture shows what a tetrahedron takes, a large one what a pixel takes.
      const std::array<int, 2> scale{1, 4};
      std::array<Held, 2> held;
      for (std::size_t s = 0; s < scale.size(); ++s) {
        const int width = bench.width(1024) * scale[s];
        const int height = bench.height(1024) * scale[s];
        const double pixels = static_cast<double>(width) * height;
        progress.stage(name + ": memory");
        held[s] = picture_memory(data->material, parameters, width, height, progress);
        const double allowed = bytes_a_tetrahedron * cells + bytes_a_pixel * pixels;
        const double a_tetrahedron = (held[s].frame - 16.0 * pixels) / cells;
        const double a_pixel = held[s].frame / pixels;
        const std::string size = fmt::format("{}x{}", width, height);
        BenchRow row{"render",
                     name,
                     fmt::format("memory, {}", mode_name(mode)),
                     Json::object({{"mode", mode_name(mode)}, {"size", Json::array({width, height})}}),
                     "",
                     std::nullopt,
                     {},
                     {},
                     {}};
        row.more = {{"tetrahedra", cells},
                    {"scene_mb", 1e-6 * held[s].scene},
                    {"frame_mb", 1e-6 * held[s].frame},
                    {"memory_mb", 1e-6 * held[s].all},
                    {"allowed_mb", 1e-6 * allowed},
                    {"frame_bytes_per_tetrahedron", a_tetrahedron},
                    {"frame_bytes_per_pixel", a_pixel}};
        if (bench.usual_size() && cells > 100'000) {
          row.requirements = {{"memory: beyond the material, in parts of 24 bytes a tetrahedron and 64 bytes a pixel",
                               1.0, false, held[s].all / allowed, ""},
                              {"memory: beyond the scene, in parts of 24 bytes a tetrahedron and 64 bytes a pixel", 1.0,
                               false, held[s].frame / allowed, ""}};
        }
        bench.result.add(std::move(row));
        table.row({name, std::string(mode_name(mode)), size, grouped(static_cast<std::uint64_t>(cells)),
                   fmt::format("{:.1f}", 1e-6 * held[s].scene), fmt::format("{:.1f}", 1e-6 * held[s].frame),
                   fmt::format("{:.1f}", 1e-6 * held[s].all), fmt::format("{:.1f}", 1e-6 * allowed),
                   fmt::format("{:.1f}", a_tetrahedron), fmt::format("{:.1f}", a_pixel)});
      }
    }
  }
  bench.result.tables.push_back(
      {"Memory of a picture", std::move(table),
       "Scene: what make_scene() adds to the material in memory. Frame: the most that preparing and drawing add to "
       "that, the picture (16 bytes a pixel) included; bytes a tetrahedron are without it, bytes a pixel with "
       "everything."});
}

}  // namespace atomesh::cli
