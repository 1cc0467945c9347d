// bench error, part curves.
#include <fmt/format.h>

#include <cmath>
#include <deque>
#include <optional>

#include "app/cli/bench_error.h"
#include "app/cli/bench_render_tools.h"
#include "app/cli/peer_vtk_volume.h"
#include "app/cli/virtual_display.h"

namespace atomesh::cli {

namespace {

constexpr double slow_ms = 2500.0;  // a peer that takes longer is measured once after its first run

struct Ours {
  Parameters parameters;
  std::optional<TimedPicture> picture;
};

struct Peer {
  VtkMapper mapper;
  Run first;
  std::vector<Run> runs;
  Image image;
};

std::vector<Parameters> settings_of(const Parameters& parameters) {
  std::vector<Parameters> all;
  for (const Integrator integrator : {Integrator::exact, Integrator::linear, Integrator::preintegrated}) {
    all.push_back(parameters);
    all.back().integrator = integrator;
  }
  for (const int samples : {1, 2, 4, 8, 16}) {
    all.push_back(parameters);
    all.back().integrator = Integrator::sampled;
    all.back().samples_per_cell = samples;
  }
  return all;
}

class Curves {
 public:
  explicit Curves(RenderBench& bench) : bench_(bench) {
    if (bench.options.peers) display_.emplace();
  }

  void measure(const BenchScene& data, const BenchView& view, Mode mode) {
    const Parameters parameters = data.seen(view, mode);
    Progress& progress = bench_.session.progress();
    const Scene scene = make_scene(data.material, parameters, progress);
    const Camera camera = make_camera(parameters, scene.bounds, bench_.width(1024), bench_.height(1024));
    label_ = fmt::format("{}, {}, {}", data.name, view.name, mode_name(mode));
    std::deque<Ours> ours;
    for (const Parameters& setting : settings_of(parameters)) {
      Ours& one = ours.emplace_back(Ours{setting, std::nullopt});
      one.picture.emplace(scene, camera, one.parameters);
      stage(integrator_text(setting));
      one.picture->draw(progress, false);
    }
    std::deque<Peer> peers;
    std::optional<VtkVolumeScene> vtk;
    if (mode == Mode::volume && display_ && display_->available()) {
      vtk.emplace(scene, parameters);
      for (const VtkMapper mapper : vtk_mappers) {
        if (mapper == VtkMapper::z_sweep && !bench_.options.full) continue;
        stage(vtk_mapper_name(mapper));
        Peer& peer = peers.emplace_back(Peer{mapper, {}, {}, {}});
        peer.first = timed([&] { vtk->draw(mapper, camera); });
        peer.image = vtk->image();
      }
    }
    // Side by side, so that whatever else the machine does hits all of them.
    for (int run = 0; run < bench_.options.repeats; ++run) {
      for (Ours& one : ours) {
        stage(integrator_text(one.parameters));
        one.picture->draw(progress);
      }
      for (Peer& peer : peers) {
        if (run > 0 && peer.first.ms > slow_ms) continue;
        stage(vtk_mapper_name(peer.mapper));
        peer.runs.push_back(timed([&] { vtk->draw(peer.mapper, camera); }));
      }
    }
    if (vtk) driver_ = vtk->driver();
    stage("the judge");
    report(data, view, mode, scene, camera, ours, peers);
  }

  void take() {
    std::string caption =
        "ms: a picture from the scene in memory, prepared and drawn, median of the runs; M steps/s/core: million "
        "ray–tetrahedron steps a second of one core, by processor time. VTK: one ray a pixel through our pixel "
        "centres, its structures built before; bench render says more of it.";
    if (display_ && !display_->available()) caption += " VTK's mappers were not run: " + display_->why_not() + ".";
    if (!driver_.empty()) caption += fmt::format(" Projected tetrahedra ran on {}, {}.", driver_, display_->name());
    bench_.result.tables.push_back({"Speed against error", std::move(table_), std::move(caption), std::move(plots_)});
    bench_.result.tables.push_back(
        {"Convergence of the sampled integrator",
         std::move(orders_),
         "p of error ≈ c / samples^p, fitted to 1, 2, 4, 8 and 16 samples a cell (errors below 2e-6, which are "
         "rounding, left out). Midpoint samples of a smooth integrand are of order 2.",
         {}});
  }

 private:
  void stage(std::string_view what) { bench_.session.progress().stage(label_ + ": " + std::string(what)); }

  void report(const BenchScene& data, const BenchView& view, Mode mode, const Scene& scene, const Camera& camera,
              const std::deque<Ours>& ours, std::deque<Peer>& peers) {
    const bool first_plot = data.name == "comb" && mode == Mode::volume && view.name == data.views.front().name;
    Plot plot{first_plot ? "speed-against-error"
                         : fmt::format("speed-against-error-{}-{}-{}", data.name, view.name, mode_name(mode)),
              fmt::format("Speed against error: {}, {}×{}", label_, camera.width, camera.height),
              {"time of a picture, ms", AxisScale::logarithmic},
              {"largest error of a channel", AxisScale::logarithmic},
              {}};
    plot.series = {{"atomesh, by samples a cell", {}}};
    plot.guides = {{true, default_limit, "half a step of 8 bits"}};
    std::vector<std::pair<int, double>> max_errors;
    std::vector<std::pair<int, double>> rms_errors;
    for (const Ours& one : ours) {
      const Parameters& p = one.parameters;
      const PictureError error =
          bench_.judge.error(label_, scene, camera, p, one.picture->image(), bench_.session.progress());
      const Times times = one.picture->total();
      const std::string name = "atomesh, " + integrator_text(p);
      if (p.integrator == Integrator::sampled) {
        plot.series[0].points.push_back({times.median, error.max, std::to_string(p.samples_per_cell)});
        max_errors.emplace_back(p.samples_per_cell, error.max);
        rms_errors.emplace_back(p.samples_per_cell, error.rmse);
      } else {
        plot.series.push_back({name, {{times.median, error.max}}, false});
      }
      BenchRow row = picture_row(label_, name, picture_settings(data, view, p, camera), *one.picture);
      row.suite = "error";
      set_error(row, error);
      if (p.integrator == Integrator::exact) {
        row.requirements.push_back({"curves: closed form, largest error", closed_form_limit, false, error.max, ""});
      }
      if (p.integrator == Parameters{}.integrator) {
        row.requirements.push_back({"curves: default setting, largest error", default_limit, false, error.max, ""});
      }
      bench_.result.add(std::move(row));
      add_line(name, times, fmt::format("{:.0f}", one.picture->rate()), error);
    }
    for (Peer& peer : peers) {
      if (peer.runs.empty()) peer.runs.push_back(peer.first);
      const Times times = times_of(peer.runs);
      const PictureError error =
          bench_.judge.error(label_, scene, camera, ours.front().parameters, peer.image, bench_.session.progress());
      const std::string name(vtk_mapper_name(peer.mapper));
      plot.series.push_back({name, {{times.median, error.max}}, false});
      BenchRow row{"error", label_, name, Json::object(), "VTK", times, {}, {}, {}};
      row.settings.set("mode", mode_name(mode));
      row.settings.set("view", view.name);
      row.settings.set("size", Json::array({camera.width, camera.height}));
      if (peer.mapper == VtkMapper::projected_tetrahedra) row.settings.set("opengl", driver_);
      set_error(row, error);
      bench_.result.add(std::move(row));
      add_line(name, times, "", error);
    }
    constexpr double rounding = 2e-6;
    const double order = convergence_order(max_errors, rounding);
    const double rms_order = convergence_order(rms_errors, 0.1 * rounding);
    orders_.row({label_, fmt::format("{:.2f}", order), fmt::format("{:.2f}", rms_order)});
    BenchRow row{"error", label_, "convergence order of the sampled integrator", Json::object(), "", std::nullopt, {},
                 {},      {}};
    row.more = {{"order", order}, {"order_rmse", rms_order}};
    bench_.result.add(std::move(row));
    plots_.push_back(std::move(plot));
  }

  void add_line(const std::string& name, const Times& times, const std::string& rate, const PictureError& error) {
    table_.row({label_, name, milliseconds(times.median),
                fmt::format("{}…{}", milliseconds(times.min), milliseconds(times.max)), rate, short_number(error.max),
                short_number(error.rmse), std::isfinite(error.psnr) ? fmt::format("{:.1f}", error.psnr) : "-"});
  }

  RenderBench& bench_;
  std::optional<VirtualDisplay> display_;  // none with --no-peers
  std::string label_;
  std::string driver_;
  std::vector<Plot> plots_;
  TextTable table_{{"case", "what", "ms", "range", "M steps/s/core", "max error", "RMS", "PSNR, dB"}};
  TextTable orders_{{"case", "order, max error", "order, RMS"}};
};

}  // namespace

void bench_error_curves(RenderBench& bench) {
  Curves curves(bench);
  for (const std::string& name : bench.cases({"comb", "lattice-36"}, {"blunt-fin", "post", "lattice-36-random"})) {
    const auto data = bench.scene(name);
    if (!data) continue;
    for (const BenchView& view : bench.views(*data)) {
      for (const Mode mode : {Mode::volume, Mode::volume_surface}) curves.measure(*data, view, mode);
    }
  }
  curves.take();
}

}  // namespace atomesh::cli
