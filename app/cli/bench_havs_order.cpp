// bench havs, part order.
#include <fmt/format.h>

#include "app/cli/bench_havs.h"
#include "app/cli/bench_havs_tools.h"

namespace atomesh::cli {

namespace {

// Pixels that come out wrong, by what is done about their order.
class WrongPixels : HavsBench {
 public:
  explicit WrongPixels(RenderBench& bench) : HavsBench(bench) {}

  void measure(const BenchScene& data, const BenchView& view, int width, int height) {
    const Parameters parameters = data.seen(view, Mode::volume);
    const Scene scene = make_scene(data.material, parameters, progress());
    const Camera camera = make_camera(parameters, scene.bounds, width, height);
    const std::string label = fmt::format("{}, {}", data.name, view.name);
    for (const int k : {0, 2, 4, 8, 16, 32, 64}) {
      Way way(k == 0 ? "lists" : fmt::format("k = {}", k), parameters);
      way.parameters.havs.order = k == 0 ? HavsOrder::lists : HavsOrder::k_buffer;
      if (k > 0) way.parameters.havs.k = k;
      way.volume.set_order_by_faces(false);
      way.volume.set_scene(scene);
      const Times times =
          cli::measure(bench_.options.repeats, bench_.session, label + ": " + way.name, [&] { draw(way, camera); });
      const gl::VolumeStats& last = way.volume.last();
      const Image image = way.volume.read();
      const PictureError error = bench_.judge.error(label, scene, camera, parameters, image, progress());
      BenchRow row{"havs", label, "order: " + way.name, settings(way, data, view, camera), "", times, {}, {}, {}};
      row.more = {{"k", k},
                  {"repaired_pixels", last.repair.pixels},
                  {"wrong_pixels", last.repair.wrong_pixels},
                  {"repair_ms", last.repair.ms},
                  {"coverage", mean_coverage(image)}};
      set_error(row, error);
      bench_.result.add(std::move(row));
      table_.row({data.name, size_text(camera), percent(mean_coverage(image)), grouped(scene.tetrahedra.size()),
                  scene.delaunay ? "yes" : "no", way.name, grouped(last.repair.pixels),
                  grouped(last.repair.wrong_pixels), milliseconds(last.repair.ms), milliseconds(times.median),
                  short_number(error.max), fmt::format("{:.1f}", error.psnr), driver_.renderer});
    }
  }

  BenchTable take() {
    return {
        "Wrong-order pixels against k",
        std::move(table_),
        "Pixels whose cells came in a wrong order and were composed again, and those whose order could not be "
        "restored: by k-buffers that keep k of a pixel's cells, and by lists that keep all. Here cells are ordered by "
        "their keys alone (circumspheres in a Delaunay mesh, else centroids), not by the faces they share, which "
        "leaves hardly a pixel to repair. ms: a picture of a resting view.",
        {}};
  }

 private:
  TextTable table_{{"case", "size", "cover", "cells", "Delaunay", "order", "repaired", "wrong", "repair, ms", "ms",
                    "max error", "PSNR, dB", "OpenGL"}};
};

}  // namespace

void bench_havs_order(RenderBench& bench) {
  WrongPixels wrong(bench);
  for (const std::string& name : bench.cases({"comb", "lattice-36", "quantum-dot"}, {"blunt-fin", "nacl-cracked"})) {
    const std::optional<BenchScene> data = havs_bench_scene(bench, name);
    if (data) wrong.measure(*data, data->views.front(), bench.width(512), bench.height(512));
  }
  bench.result.tables.push_back(wrong.take());
}

}  // namespace atomesh::cli
