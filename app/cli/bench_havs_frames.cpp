// bench havs, part frames.
#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

#include "app/cli/bench_havs.h"
#include "app/cli/bench_havs_tools.h"
#include "app/cli/peer_vtk_volume.h"
#include "app/cli/virtual_display.h"

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

// What is drawn; the camera is the view's own.
struct Subject {
  const BenchScene& data;
  const BenchView& view;
  const Parameters& parameters;
  const Scene& scene;
  const Camera& camera;
};

// What a way took.
struct TimedWay : Way {
  using Way::Way;

  std::vector<Run> turning, still;
  std::vector<double> order_ms, repair_ms;
  double table_ms = 0.0;
  gl::VolumeStats last;
  Image image;

  // Of the frame that was drawn last.
  void take_steps() {
    order_ms.push_back(volume.last().order_ms);
    repair_ms.push_back(volume.last().repair.ms);
  }
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() / 2];
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

// Frames of a turning and of a resting view, beside the peers.
class HavsFrames : HavsBench {
 public:
  explicit HavsFrames(RenderBench& bench) : HavsBench(bench) {
    if (bench.options.peers) display_.emplace();
  }

  void measure(const BenchScene& data, const BenchView& view, int width, int height) {
    const Parameters parameters = data.seen(view, Mode::volume);
    const Scene scene = make_scene(data.material, parameters, progress());
    const Camera camera = make_camera(parameters, scene.bounds, width, height);
    const Subject subject{data, view, parameters, scene, camera};
    label_ = fmt::format("{}, {}", data.name, view.name);
    std::deque<TimedWay> ways;
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
    Image of_cpu;
    // Side by side, so that whatever else the machine does hits all of them.
    for_frames(subject, [&](const Camera& turned_camera, const Parameters& turned, bool counted) {
      for (TimedWay& way : ways) run_way(way, turned_camera, counted);
      stage("cpu");
      RenderStats stats;
      const Run ours =
          timed([&] { of_cpu = find_renderer("cpu").draw(scene, turned_camera, turned, stats, {}, progress()); });
      if (counted) cpu.push_back(ours);
      if (!vtk) return;
      stage("VTK projected tetrahedra");
      vtk_thread_.run([&] {
        const Run theirs = timed([&] { vtk->draw(VtkMapper::projected_tetrahedra, turned_camera); });
        if (counted) projected.push_back(theirs);
      });
    });
    // Of a card VolumeStats has the time to ask for a step, unless each is waited for, which makes frames longer.
    if (!driver_.software) {
      for (TimedWay& way : ways) way.volume.set_timed_steps(true);
      for_frames(subject, [&](const Camera& turned_camera, const Parameters&, bool counted) {
        for (TimedWay& way : ways) {
          stage(way.name + ", steps");
          draw(way, turned_camera);
          if (counted) way.take_steps();
        }
      });
    }
    report(subject, ways);
    add_peer(subject, "cpu", "", cpu, of_cpu, "-");
    Image theirs;
    std::string their_driver;
    if (vtk) {
      vtk_thread_.run([&] {
        theirs = vtk->image();
        their_driver = vtk->driver();
        vtk.reset();
      });
      add_peer(subject, "VTK projected tetrahedra", "VTK", projected, theirs, their_driver);
    }
    const bool software = driver_.software && their_driver.find("llvmpipe") != std::string::npos;
    if (software && width == 1024 && height == 1024) {
      rows_.front().requirements.push_back({"havs: times faster than VTK's projected tetrahedra on llvmpipe, 1024x1024",
                                            1.0, true,
                                            times_of(projected).median / times_of(ways.front().turning).median, "×"});
    }
    for (BenchRow& row : rows_) bench_.result.add(std::move(row));
    rows_.clear();
  }

  BenchTable take() {
    return {
        "Volumes on OpenGL",
        std::move(table_),
        fmt::format(
            "Mode volume by the renderer \"havs\", on {} (OpenGL {}){}. ms: a frame with the camera turned since "
            "the last, projected, sorted and drawn, median of the runs; still: drawn again with the same camera, "
            "when nothing is sorted. order, table, repair: of that{}, putting cells in order; making the table, when "
            "it was made; pixels whose order was wrong. wrong: pixels whose order could not be restored. Errors "
            "against the judge, of premultiplied RGB and coverage. Samples of about {} atoms. cover: coverage, the "
            "mean of all pixels. map: {}.",
            driver_.renderer, driver_.version,
            beside_vtk() ? "; VTK's projected tetrahedra on " + display_->name() : std::string(),
            driver_.software ? "" : " (in frames of their own, which wait for each step)",
            bench_.options.quick ? quick_havs_sample_atoms : havs_sample_atoms, volume_map_caption()),
        {}};
  }

 private:
  void stage(const std::string& what) { progress().stage(label_ + ": " + what); }
  bool beside_vtk() const { return display_ && display_->available(); }
  // What the driver takes by itself first.
  std::vector<HavsIntegration> integrations() const {
    if (driver_.software) return {HavsIntegration::automatic, HavsIntegration::exact, HavsIntegration::table};
    return {HavsIntegration::automatic, HavsIntegration::exact};
  }

  // Calls frame(camera, parameters, counted) for cameras that turn and end with the view's own; the first frame warms
  // up and is not counted.
  void for_frames(const Subject& subject, auto&& frame) {
    const int frames = bench_.options.repeats;
    for (int run = -1; run < frames; ++run) {
      Parameters turned = subject.parameters;
      turned.azimuth += turn * (frames - 1 - run);
      frame(make_camera(turned, subject.scene.bounds, subject.camera.width, subject.camera.height), turned, run >= 0);
    }
  }

  void run_way(TimedWay& way, const Camera& camera, bool counted) {
    stage(way.name);
    const Run turning = timed([&] { draw(way, camera); });
    way.last = way.volume.last();
    if (counted && driver_.software) way.take_steps();
    if (!counted) way.table_ms = way.volume.table().build_ms;
    const Run still = timed([&] { draw(way, camera); });
    if (!counted) return;
    way.turning.push_back(turning);
    way.still.push_back(still);
    way.image = way.volume.read();
  }

  PictureError error_of(const Subject& subject, const Image& image) {
    stage("the judge");
    return bench_.judge.error(label_ + size_text(subject.camera), subject.scene, subject.camera, subject.parameters,
                              image, progress());
  }

  void report(const Subject& subject, const std::deque<TimedWay>& ways) {
    const auto& [data, view, parameters, scene, camera] = subject;
    const std::size_t cells = scene.tetrahedra.size();
    for (const TimedWay& way : ways) {
      const Times times = times_of(way.turning);
      const Times still = times_of(way.still);
      const PictureError error = error_of(subject, way.image);
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

  void add_peer(const Subject& subject, const std::string& name, const std::string& peer, const std::vector<Run>& runs,
                const Image& image, const std::string& opengl) {
    const auto& [data, view, parameters, scene, camera] = subject;
    const Times times = times_of(runs);
    const PictureError error = error_of(subject, image);
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

  std::optional<VirtualDisplay> display_;  // none without peers
  OwnThread vtk_thread_;
  std::string label_;
  std::deque<BenchRow> rows_;
  TextTable table_{{"case", "map", "size", "cover", "cells", "what", "ms", "still", "frames/s", "Mcells/s", "order",
                    "table", "repair", "wrong", "max error", "PSNR, dB", "OpenGL"}};
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

struct Size {
  int width, height;
};

}  // namespace

void bench_havs_frames(RenderBench& bench) {
  HavsFrames frames(bench);
  const auto measure = [&](const std::string& name, const std::vector<Size>& sizes) {
    const std::optional<BenchScene> data = havs_bench_scene(bench, name);
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

}  // namespace atomesh::cli
