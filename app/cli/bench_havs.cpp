#include "app/cli/bench_havs.h"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "app/cli/bench_render_tools.h"
#include "app/cli/machine.h"
#include "app/cli/peer_vtk_volume.h"
#include "app/cli/virtual_display.h"
#include "core/error.h"
#include "render/gl/context.h"
#include "render/gl/volume.h"

namespace atomesh::cli {

namespace {

// What is required of every picture beside the judge's.
constexpr double least_psnr = 45.0;  // dB
constexpr double largest_error = 4.0 / 255.0;
// Of a card in a data centre, with a million cells at 1024x1024.
constexpr double frames_of_a_card = 30.0;
constexpr std::size_t million = 1'000'000;

// The camera turns by so much from frame to frame, so that each is projected and sorted anew.
constexpr double turn = 0.7;  // degrees

constexpr std::size_t sample_atoms = 20000;
constexpr std::size_t quick_sample_atoms = 2000;

// One way of "havs" to draw the volume, and what it took.
struct Way {
  std::string name;
  Parameters parameters;
  gl::Volume volume;
  std::vector<Run> turning, still;
  std::vector<double> order_ms, repair_ms;
  double table_ms = 0.0;
  gl::VolumeStats last;
  Image image;

  Way(std::string n, const Parameters& p) : name(std::move(n)), parameters(p) {}
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() / 2];
}

std::string percent(double share) {
  return fmt::format("{:.1f} %", 100.0 * share);
}

std::string size_text(const Camera& camera) {
  return fmt::format("{}x{}", camera.width, camera.height);
}

// Runs one piece of work after the other on a thread of its own: a thread has one current context, and VTK's stays
// current where it is used.
class OwnThread {
 public:
  ~OwnThread() { run(nullptr); }
  // Waits for it. Exceptions come out.
  void run(std::function<void()> work) {
    std::unique_lock lock(mutex_);
    if (!thread_.joinable()) {
      if (work == nullptr) return;
      thread_ = std::thread([this] { serve(); });
    }
    const bool last = work == nullptr;
    work_ = std::move(work);
    waiting_ = true;
    change_.notify_all();
    change_.wait(lock, [this] { return !waiting_; });
    if (last) {
      lock.unlock();
      thread_.join();
    } else if (error_ != nullptr) {
      std::rethrow_exception(std::exchange(error_, nullptr));
    }
  }

 private:
  void serve() {
    std::unique_lock lock(mutex_);
    for (bool more = true; more;) {
      change_.wait(lock, [this] { return waiting_; });
      more = work_ != nullptr;
      try {
        if (more) work_();
      } catch (...) {
        error_ = std::current_exception();
      }
      waiting_ = false;
      change_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable change_;
  std::function<void()> work_;
  std::exception_ptr error_;
  bool waiting_ = false;
  std::thread thread_;
};

// A context of our own, and a display for the peer.
class HavsBench {
 public:
  HavsBench(RenderBench& bench, bool peers) : bench_(bench), current_(context_), driver_(gl::current_driver()) {
    if (peers && bench.options.peers) display_.emplace();
  }
  HavsBench(const HavsBench&) = delete;
  HavsBench& operator=(const HavsBench&) = delete;

 protected:
  Session& session() { return bench_.session; }
  Progress& progress() { return bench_.session.progress(); }
  bool beside_vtk() const { return display_ && display_->available(); }

  void draw(Way& way, const Camera& camera) {
    RenderStats stats;
    way.volume.draw(camera, way.parameters, whole_picture(camera), {}, stats, progress());
  }
  Json settings(const Way& way, const BenchScene& data, const BenchView& view, const Camera& camera) const {
    return Json::object({{"mode", "volume"},
                         {"map", data.volume_map},
                         {"view", view.name},
                         {"projection", camera.projection == Projection::parallel ? "parallel" : "perspective"},
                         {"size", Json::array({camera.width, camera.height})},
                         {"renderer", "havs"},
                         {"integration", integration_name(way.parameters.havs.integration)},
                         {"opengl", driver_.renderer}});
  }
  // What the driver takes by itself first.
  std::vector<HavsIntegration> integrations() const {
    if (driver_.software) return {HavsIntegration::automatic, HavsIntegration::exact, HavsIntegration::table};
    return {HavsIntegration::automatic, HavsIntegration::exact};
  }
  std::string_view integration_name(HavsIntegration integration) const {
    if (integration == HavsIntegration::automatic) return driver_.software ? "ramps" : "table";
    return integration == HavsIntegration::exact ? "exact" : "table";
  }

  RenderBench& bench_;
  gl::HeadlessContext context_;
  gl::HeadlessContext::Current current_;
  gl::Driver driver_;
  std::optional<VirtualDisplay> display_;  // none without peers
};

// Frames of a turning and of a resting view, beside the peers.
class HavsFrames : HavsBench {
 public:
  explicit HavsFrames(RenderBench& bench) : HavsBench(bench, true) {}

  void measure(const BenchScene& data, const BenchView& view, int width, int height) {
    const Parameters parameters = data.seen(view, Mode::volume);
    const Scene scene = make_scene(data.material, parameters, progress());
    label_ = fmt::format("{}, {}", data.name, view.name);
    std::deque<Way> ways;
    // The default first.
    for (const HavsIntegration integration : integrations()) {
      Way& way = ways.emplace_back(fmt::format("havs, {}", integration_name(integration)), parameters);
      way.parameters.havs.integration = integration;
      way.volume.set_scene(scene);
    }
    std::vector<Run> cpu;
    std::vector<Run> projected;
    std::optional<VtkVolumeScene> vtk;
    if (beside_vtk()) vtk_thread_.run([&] { vtk.emplace(scene, parameters); });
    // Side by side, so that whatever else the machine does hits all of them. The first warms up; the last is judged.
    Parameters turned = parameters;
    Camera camera;
    Image of_cpu;
    for (int run = -1; run < bench_.options.repeats; ++run) {
      turned.azimuth = parameters.azimuth + turn * (bench_.options.repeats - 1 - run);
      camera = make_camera(turned, scene.bounds, width, height);
      for (Way& way : ways) run_way(way, camera, run >= 0);
      stage("cpu");
      RenderStats stats;
      const Run ours = timed([&] { of_cpu = find_renderer("cpu").draw(scene, camera, turned, stats, {}, progress()); });
      if (run >= 0) cpu.push_back(ours);
      if (!vtk) continue;
      stage("VTK projected tetrahedra");
      vtk_thread_.run([&] {
        const Run theirs = timed([&] { vtk->draw(VtkMapper::projected_tetrahedra, camera); });
        if (run >= 0) projected.push_back(theirs);
      });
    }
    report(data, view, scene, camera, turned, ways);
    add_peer(data, scene, camera, view, turned, "cpu", "", cpu, of_cpu, "-");
    Image theirs;
    std::string their_driver;
    if (vtk) {
      vtk_thread_.run([&] {
        theirs = vtk->image();
        their_driver = vtk->driver();
        vtk.reset();
      });
      add_peer(data, scene, camera, view, turned, "VTK projected tetrahedra", "VTK", projected, theirs, their_driver);
    }
    const bool software = driver_.software && their_driver.find("llvmpipe") != std::string::npos;
    if (software && bench_.usual_size() && width == 1024 && height == 1024) {
      rows_.front().requirements.push_back({"havs: times faster than VTK's projected tetrahedra on llvmpipe, 1024x1024",
                                            1.0, true,
                                            times_of(projected).median / times_of(ways.front().turning).median, "×"});
    }
    for (BenchRow& row : rows_) bench_.result.add(std::move(row));
    rows_.clear();
  }

  BenchTable take() {
    return {"Volumes on OpenGL",
            std::move(table_),
            fmt::format(
                "Mode volume by the renderer \"havs\", on {} (OpenGL {}){}. ms: a frame with the camera turned since "
                "the last, projected, sorted and drawn, median of the runs; still: drawn again with the same camera, "
                "when nothing is sorted. order, table, repair: of that, putting cells in order; making the table, when "
                "it was made; pixels whose order was wrong. wrong: pixels whose order could not be restored. Errors "
                "against the judge, of premultiplied RGB and coverage. Samples of about {} atoms. cover: coverage, the "
                "mean of all pixels. map: the color map, with peaks over the scalar; where that leaves less than "
                "{:.0f} % of "
                "a square picture covered, scalars it does not show are given a little opacity (in haze), and a "
                "scalar that is the same everywhere is replaced by waves.",
                driver_.renderer, driver_.version,
                beside_vtk() ? "; VTK's projected tetrahedra on " + display_->name() : std::string(),
                bench_.options.quick ? quick_sample_atoms : sample_atoms, 100.0 * nearly_empty),
            {}};
  }

 private:
  void stage(const std::string& what) { progress().stage(label_ + ": " + what); }

  void run_way(Way& way, const Camera& camera, bool counted) {
    stage(way.name);
    const Run turning = timed([&] { draw(way, camera); });
    way.last = way.volume.last();
    if (!counted) way.table_ms = way.volume.table().build_ms;
    const Run still = timed([&] { draw(way, camera); });
    if (!counted) return;
    way.turning.push_back(turning);
    way.still.push_back(still);
    way.order_ms.push_back(way.last.order_ms);
    way.repair_ms.push_back(way.last.repair.ms);
    way.image = way.volume.read();
  }

  PictureError error_of(const Scene& scene, const Camera& camera, const Parameters& turned, const Image& image) {
    stage("the judge");
    return bench_.judge.error(label_ + size_text(camera), scene, camera, turned, image, progress());
  }

  void report(const BenchScene& data, const BenchView& view, const Scene& scene, const Camera& camera,
              const Parameters& turned, const std::deque<Way>& ways) {
    const std::size_t cells = scene.tetrahedra.size();
    for (const Way& way : ways) {
      const Times times = times_of(way.turning);
      const Times still = times_of(way.still);
      const PictureError error = error_of(scene, camera, turned, way.image);
      BenchRow& row = rows_.emplace_back(
          BenchRow{"havs", label_, way.name, settings(way, data, view, camera), "", times, {}, {}, {}});
      const double frames = 1e3 / times.median;
      const double rate = 1e-6 * static_cast<double>(cells) * frames;
      row.more = {{"still_ms", still.median},
                  {"frames_per_second", frames},
                  {"tetrahedra", cells},
                  {"tetrahedra_drawn", way.last.cells},
                  {"triangles", way.last.triangles},
                  {"ramp_triangles", way.last.ramp_triangles},
                  {"rate", rate},
                  {"rate_unit", "million tetrahedra/s"},
                  {"order_ms", median(way.order_ms)},
                  {"table_ms", way.table_ms},
                  {"repair_ms", median(way.repair_ms)},
                  {"repaired_pixels", way.last.repair.pixels},
                  {"wrong_pixels", way.last.repair.wrong_pixels},
                  {"coverage", mean_coverage(way.image)}};
      set_error(row, error);
      row.requirements = {
          {"havs: PSNR against the judge, every data set", least_psnr, true, std::min(error.psnr, 999.0), " dB"},
          {"havs: largest error, every data set", largest_error, false, error.max, ""},
          {"havs: pixels whose order could not be restored", 0.0, false,
           static_cast<double>(way.last.repair.wrong_pixels), ""}};
      if (!driver_.software && camera.width == 1024 && camera.height == 1024 && cells >= million) {
        row.requirements.push_back(
            {"havs: frames a second of a million cells at 1024x1024 on a card", frames_of_a_card, true, frames, ""});
      }
      table_.row({data.name, data.volume_map, size_text(camera), percent(mean_coverage(way.image)), grouped(cells),
                  way.name, milliseconds(times.median), milliseconds(still.median), fmt::format("{:.1f}", frames),
                  fmt::format("{:.2f}", rate), milliseconds(median(way.order_ms)), milliseconds(way.table_ms),
                  milliseconds(median(way.repair_ms)), grouped(way.last.repair.wrong_pixels), short_number(error.max),
                  fmt::format("{:.1f}", error.psnr), driver_.renderer});
    }
  }

  void add_peer(const BenchScene& data, const Scene& scene, const Camera& camera, const BenchView& view,
                const Parameters& turned, const std::string& name, const std::string& peer,
                const std::vector<Run>& runs, const Image& image, const std::string& opengl) {
    const Times times = times_of(runs);
    const PictureError error = error_of(scene, camera, turned, image);
    const double frames = 1e3 / times.median;
    const double rate = 1e-6 * static_cast<double>(scene.tetrahedra.size()) * frames;
    BenchRow& row = rows_.emplace_back(BenchRow{"havs",
                                                label_,
                                                name,
                                                Json::object({{"mode", "volume"},
                                                              {"map", data.volume_map},
                                                              {"view", view.name},
                                                              {"size", Json::array({camera.width, camera.height})},
                                                              {"opengl", opengl}}),
                                                peer,
                                                times,
                                                {},
                                                {},
                                                {}});
    row.more = {{"frames_per_second", frames},
                {"rate", rate},
                {"rate_unit", "million tetrahedra/s"},
                {"coverage", mean_coverage(image)}};
    set_error(row, error);
    table_.row({data.name, data.volume_map, size_text(camera), percent(mean_coverage(image)),
                grouped(scene.tetrahedra.size()), name, milliseconds(times.median), "", fmt::format("{:.1f}", frames),
                fmt::format("{:.2f}", rate), "", "", "", "", short_number(error.max), fmt::format("{:.1f}", error.psnr),
                opengl});
  }

  OwnThread vtk_thread_;
  std::string label_;
  std::deque<BenchRow> rows_;
  TextTable table_{{"case", "map", "size", "cover", "cells", "what", "ms", "still", "frames/s", "Mcells/s", "order",
                    "table", "repair", "wrong", "max error", "PSNR, dB", "OpenGL"}};
};

// Pixels that come out wrong, by what is done about their order.
class WrongPixels : HavsBench {
 public:
  explicit WrongPixels(RenderBench& bench) : HavsBench(bench, false) {}

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
      progress().stage(label + ": " + way.name);
      way.volume.set_scene(scene);
      std::vector<Run> runs;
      for (int run = -1; run < bench_.options.repeats; ++run) {
        const Run one = timed([&] { draw(way, camera); });
        if (run >= 0) runs.push_back(one);
      }
      const gl::VolumeStats& last = way.volume.last();
      const Times times = times_of(runs);
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

// Samples small enough for the judge, and the public data sets.
std::vector<std::string> usual_scenes(bool full) {
  std::vector<std::string> names;
  for (const BenchSceneInfo& info : bench_scene_table()) {
    const bool lattice = info.name.starts_with("lattice");
    const bool small = info.name == "comb" || info.name == "blunt-fin";
    if ((full && info.name != "lattice-100" && info.name != "lattice-100-random") || (!lattice && info.file.empty()) ||
        small) {
      names.push_back(info.name);
    }
  }
  return names;
}

std::optional<BenchScene> scene_of(RenderBench& bench, const std::string& name) {
  bench.session.progress().stage(name);
  try {
    BenchScene scene = make_bench_scene(
        name, bench.options.data, bench.options.quick ? quick_sample_atoms : sample_atoms, bench.session.progress());
    show_in_volume(scene, bench.session.progress());
    return scene;
  } catch (const UnavailableError& error) {
    bench.session.note(error.what());
    return std::nullopt;
  }
}

struct Size {
  int width, height;
};

void bench_frames(RenderBench& bench) {
  HavsFrames frames(bench);
  const auto measure = [&](const std::string& name, const std::vector<Size>& sizes) {
    const std::optional<BenchScene> data = scene_of(bench, name);
    if (!data) return;
    for (const Size& size : sizes) {
      frames.measure(*data, data->views.front(), bench.width(size.width), bench.height(size.height));
    }
  };
  const std::vector<Size> all{{512, 512}, {1024, 1024}, {1920, 1080}};
  const bool one_size = !bench.usual_size();
  for (const std::string& name : bench.cases(usual_scenes(bench.options.full))) {
    measure(name, one_size || !bench.options.full ? std::vector<Size>{{512, 512}} : all);
  }
  if (bench.options.cases.empty() && !bench.options.full && bench.usual_size()) {
    for (const char* name : {"comb", "lattice-36"}) measure(name, {{1024, 1024}, {1920, 1080}});
  }
  bench.result.tables.push_back(frames.take());
}

void bench_order(RenderBench& bench) {
  WrongPixels wrong(bench);
  for (const std::string& name : bench.cases({"comb", "lattice-36", "quantum-dot"}, {"blunt-fin", "nacl-cracked"})) {
    const std::optional<BenchScene> data = scene_of(bench, name);
    if (data) wrong.measure(*data, data->views.front(), bench.width(512), bench.height(512));
  }
  bench.result.tables.push_back(wrong.take());
}

struct Part {
  const char* name;
  void (*run)(RenderBench&);
};
constexpr Part parts[] = {{"frames", bench_frames}, {"order", bench_order}};

}  // namespace

std::vector<std::string> havs_bench_parts() {
  std::vector<std::string> names;
  for (const Part& part : parts) names.emplace_back(part.name);
  return names;
}

void bench_havs(const RenderBenchOptions& options, Session& session, BenchResult& result) {
  check_parts(options.parts, havs_bench_parts());
  RenderBench bench(options, session, result);
  const auto wanted = [&](const std::string& part) {
    return options.parts.empty() || std::find(options.parts.begin(), options.parts.end(), part) != options.parts.end();
  };
  for (const Part& part : parts) {
    if (!wanted(part.name)) continue;
    const std::size_t first = result.tables.size();
    part.run(bench);
    session.print_text(result.text(first));
  }
  BenchTable requirements = result.requirements();
  requirements.caption += fmt::format(" {}. Commit {}. Made by `atomesh bench havs{}`.", machine_name(), build_commit(),
                                      options.full ? " --full" : "");
  result.tables.push_back(std::move(requirements));
  session.print_text(result.text(result.tables.size() - 1));
  std::rotate(result.tables.begin(), result.tables.end() - 1, result.tables.end());
}

}  // namespace atomesh::cli
