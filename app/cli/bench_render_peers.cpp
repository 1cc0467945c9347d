// bench render, part peers.
#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <optional>

#include "app/cli/bench_render.h"
#include "app/cli/bench_render_tools.h"
#include "app/cli/peer_vtk_volume.h"
#include "app/cli/virtual_display.h"
#include "core/parallel.h"

namespace atomesh::cli {

namespace {

// Of processor time: a peer that takes longer is measured once after its first run, and one that is slower still, in
// it.
constexpr double slow_ms = 4000.0;
constexpr double very_slow_ms = 20000.0;
constexpr std::size_t many_cells = 300'000;

struct Peer {
  VtkMapper mapper;
  Run first;  // builds what VTK keeps for the later runs
  std::vector<Run> runs;
  Image image;
};

struct Ours {
  Parameters parameters;
  std::optional<TimedPicture> picture;
};

class PeerTable {
 public:
  explicit PeerTable(RenderBench& bench) : bench_(bench) {
    if (bench.options.peers) display_.emplace();
  }

  void measure(const BenchScene& data, const BenchView& view) {
    const Parameters parameters = data.seen(view, Mode::volume);
    Progress& progress = bench_.session.progress();
    const Scene scene = make_scene(data.material, parameters, progress);
    const Camera camera = make_camera(parameters, scene.bounds, bench_.width(1024), bench_.height(1024));
    view_ = &view;
    data_ = &data;
    label_ = data.name + ", " + view.name;

    std::deque<Ours> ours;
    for (const Parameters& setting : integrator_settings(parameters)) {
      Ours& one = ours.emplace_back(Ours{setting, std::nullopt});
      one.picture.emplace(scene, camera, one.parameters);
      progress.stage(label_ + ": " + integrator_text(one.parameters));
      one.picture->draw(progress, false);
    }
    std::deque<Peer> peers;
    std::optional<VtkVolumeScene> vtk;
    if (display_ && display_->available()) {
      vtk.emplace(scene, parameters);
      first_runs(*vtk, camera, peers);
    }
    // Side by side, so that whatever else the machine does hits all of them.
    for (int run = 0; run < bench_.options.repeats; ++run) {
      for (Ours& one : ours) {
        progress.stage(label_ + ": " + integrator_text(one.parameters));
        one.picture->draw(progress);
      }
      for (Peer& peer : peers) {
        if (run > 0 && peer.first.cpu_ms > slow_ms) continue;
        if (peer.first.cpu_ms > very_slow_ms && !bench_.options.full) continue;
        progress.stage(label_ + ": " + std::string(vtk_mapper_name(peer.mapper)));
        peer.runs.push_back(timed([&] { vtk->draw(peer.mapper, camera); }));
      }
    }
    if (vtk) driver_ = vtk->driver();
    progress.stage(label_ + ": the judge");
    report(scene, camera, ours, peers);
    if (!vtk) report_missing();
  }

  BenchTable take() {
    std::string caption =
        "Mode volume. ms: a picture from the scene in memory, prepared and drawn, median of the runs; times: how many "
        "times longer than atomesh's default takes. Errors against the judge, of premultiplied RGB and coverage. VTK: "
        "one ray a pixel through our pixel centres, its own structures kept from a run before (\"first\"), unit "
        "distance 1 / alpha_length; ray cast's channels are cut off to 8 bits and its rays end at opacity 0.99; Z "
        "sweep moves vertices to whole pixels; projected tetrahedra colour vertices in 8 bits, order cells by their "
        "centres and hand over 8 bits.";
    if (!driver_.empty())
      caption += fmt::format(" OpenGL, which projected tetrahedra run on: {}, {}.", driver_, display_->name());
    return {"VTK's volume mappers", std::move(table_), std::move(caption), std::move(plots_)};
  }

 private:
  void first_runs(VtkVolumeScene& vtk, const Camera& camera, std::deque<Peer>& peers) {
    for (const VtkMapper mapper : vtk_mappers) {
      if (mapper == VtkMapper::z_sweep && !bench_.options.z_sweep) continue;
      bench_.session.progress().stage(label_ + ": " + std::string(vtk_mapper_name(mapper)));
      Peer& peer = peers.emplace_back(Peer{mapper, {}, {}, {}});
      peer.first = timed([&] { vtk.draw(mapper, camera); });
      peer.image = vtk.image();
    }
  }

  void report(const Scene& scene, const Camera& camera, const std::deque<Ours>& ours, std::deque<Peer>& peers) {
    const auto error_of = [&](const Image& image, const Parameters& parameters) {
      return bench_.judge.error(label_, scene, camera, parameters, image, bench_.session.progress());
    };
    const auto is_default = [](const Ours& one) { return one.parameters.integrator == Parameters{}.integrator; };
    const Ours& standard = *std::find_if(ours.begin(), ours.end(), is_default);
    const double standard_ms = standard.picture->total().median;
    Plot plot = empty_plot();
    std::deque<BenchRow> rows;
    std::size_t standard_row = 0;
    PictureError standard_error;
    for (const Ours& one : ours) {
      const PictureError error = error_of(one.picture->image(), one.parameters);
      if (&one == &standard) {
        standard_row = rows.size();
        standard_error = error;
      }
      const std::string name = "atomesh, " + integrator_text(one.parameters);
      const bool sampled = one.parameters.integrator == Integrator::sampled;
      plot.series[sampled ? 1 : 0].points.push_back(
          {one.picture->total().median, error.max,
           sampled ? std::to_string(one.parameters.samples_per_cell) : integrator_text(one.parameters)});
      BenchRow& row = rows.emplace_back(picture_row(
          label_, "volume: " + name, picture_settings(*data_, *view_, one.parameters, camera), *one.picture));
      set_error(row, error);
      const Times times = one.picture->total();
      table_.row({label_, name, milliseconds(times.median),
                  fmt::format("{}…{}", milliseconds(times.min), milliseconds(times.max)), milliseconds(times.cpu), "",
                  &one == &standard ? "" : fmt::format("{:.2f}", times.median / standard_ms), short_number(error.max),
                  short_number(error.rmse), fmt::format("{:.1f}", error.psnr)});
    }
    double ray_cast_ms = std::numeric_limits<double>::infinity();
    double ray_cast_error = std::numeric_limits<double>::infinity();
    double projected_ms = 0.0;
    for (Peer& peer : peers) {
      if (peer.runs.empty()) peer.runs.push_back(peer.first);
      const Times times = times_of(peer.runs);
      const PictureError error = error_of(peer.image, standard.parameters);
      if (peer.mapper == VtkMapper::ray_cast || peer.mapper == VtkMapper::ray_cast_linear) {
        ray_cast_ms = std::min(ray_cast_ms, times.median);
        ray_cast_error = std::min(ray_cast_error, error.max);
      }
      if (peer.mapper == VtkMapper::projected_tetrahedra) projected_ms = times.median;
      const std::string name(vtk_mapper_name(peer.mapper));
      plot.series.push_back({name, {{times.median, error.max}}, false});
      BenchRow& row = rows.emplace_back(
          BenchRow{"render", label_, "volume: " + name, peer_settings(camera, peer), "VTK", times, {}, {}, {}});
      row.more = {{"first_ms", peer.first.ms}, {"runs", peer.runs.size()}, {"times_ours", times.median / standard_ms}};
      set_error(row, error);
      table_.row({label_, name, milliseconds(times.median),
                  fmt::format("{}…{}", milliseconds(times.min), milliseconds(times.max)), milliseconds(times.cpu),
                  milliseconds(peer.first.ms), fmt::format("{:.2f}", times.median / standard_ms),
                  short_number(error.max), short_number(error.rmse), fmt::format("{:.1f}", error.psnr)});
    }
    if (!peers.empty() && bench_.usual_size()) {
      require(rows[standard_row], ray_cast_ms / standard_ms, standard_error.max / ray_cast_error,
              projected_ms / standard_ms);
    }
    for (BenchRow& row : rows) bench_.result.add(std::move(row));
    plots_.push_back(std::move(plot));
  }

  Plot empty_plot() const {
    std::string name = "volume-mappers-" + data_->name + "-" + view_->name;
    Plot plot{std::move(name),
              "Error over time: " + label_,
              {"time of a picture, ms", AxisScale::logarithmic},
              {"largest error of a channel", AxisScale::logarithmic},
              {}};
    plot.series = {{"atomesh, closed forms", {}, false}, {"atomesh, samples a cell", {}}};
    plot.guides = {{true, 1.0 / 512.0, "half a step of 8 bits"}};
    return plot;
  }

  // The faster of the two ray casts, and the smaller of their errors.
  void require(BenchRow& row, double ray_casts, double error_share, double projected) const {
    if (data_->name == "comb") {
      row.requirements = {{"peers: Comb, times faster than VTK's ray cast", 8.0, true, ray_casts, "×"},
                          {"peers: Comb, maximum error in parts of VTK's ray cast's", 1.0, false, error_share, ""}};
    } else if (data_->material.mesh.delaunay && data_->material.mesh.tetrahedra.size() >= many_cells) {
      row.requirements = {
          {"peers: Delaunay mesh of 300,000 cells, times faster than VTK's ray cast", 20.0, true, ray_casts, "×"}};
      if (driver_.find("llvmpipe") != std::string::npos) {
        row.requirements.push_back(
            {"peers: Delaunay mesh of 300,000 cells, times faster than VTK's projected tetrahedra on llvmpipe", 5.0,
             true, projected, "×"});
      }
    }
  }

  Json peer_settings(const Camera& camera, const Peer& peer) const {
    Json settings =
        Json::object({{"mode", "volume"},
                      {"view", view_->name},
                      {"projection", camera.projection == Projection::parallel ? "parallel" : "perspective"},
                      {"size", Json::array({camera.width, camera.height})}});
    if (peer.mapper == VtkMapper::projected_tetrahedra) {
      settings.set("opengl", driver_);
    } else {
      settings.set("image_sample_distance", 1);
      settings.set("threads", peer.mapper == VtkMapper::z_sweep ? 1 : threads());
      settings.set("ray_integrator", peer.mapper == VtkMapper::ray_cast ? "vtkUnstructuredGridPreIntegration"
                                                                        : "vtkUnstructuredGridLinearRayIntegrator");
    }
    return settings;
  }

  void report_missing() {
    const std::string why = "not run: " + (display_ ? display_->why_not() : std::string("--no-peers"));
    for (const VtkMapper mapper : vtk_mappers) {
      const std::string name(vtk_mapper_name(mapper));
      BenchRow row{"render", label_, "volume: " + name, Json::object(), "VTK", std::nullopt, {}, {}, {}};
      row.more = {{"not_run", why}};
      bench_.result.add(std::move(row));
      table_.row({label_, name, why, "", "", "", "", "", "", ""});
    }
    bench_.result.not_measured("peers: times faster than VTK's mappers", why);
  }

  RenderBench& bench_;
  std::optional<VirtualDisplay> display_;  // none with --no-peers
  const BenchScene* data_ = nullptr;
  const BenchView* view_ = nullptr;
  std::string label_;
  std::string driver_;
  std::vector<Plot> plots_;
  TextTable table_{{"case", "what", "ms", "range", "CPU ms", "first, ms", "times", "max error", "RMS", "PSNR, dB"}};
};

}  // namespace

void bench_render_peers(RenderBench& bench) {
  PeerTable table(bench);
  for (const std::string& name : bench.cases({"comb", "lattice-36"}, {"blunt-fin", "post", "lattice-58"})) {
    const auto data = bench.scene(name);
    if (!data) continue;
    for (const BenchView& view : bench.views(*data)) table.measure(*data, view);
  }
  bench.result.tables.push_back(table.take());
}

}  // namespace atomesh::cli
