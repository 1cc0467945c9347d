#include "app/cli/bench_render_tools.h"

#include <fmt/format.h>

#include <optional>

#include "core/parallel.h"

namespace atomesh::cli {

void TimedPicture::draw(Progress& progress, bool counted) {
  const Renderer& renderer = find_renderer("auto");
  std::unique_ptr<Frame> frame;
  stats_ = {};
  image_ = {};
  std::optional<PeakMemory> peak;
  if (!counted) peak.emplace();
  image_ = Image(camera_.width, camera_.height);
  const Run prepare =
      timed([&] { frame = renderer.prepare(scene_, camera_, parameters_, whole_picture(camera_), stats_, progress); });
  const Run pixels = timed([&] { frame->draw({}, image_, stats_, {}, progress); });
  if (peak) memory_ = peak->grown();
  if (!counted) return;
  prepare_.push_back(prepare);
  pixels_.push_back(pixels);
  total_.push_back({prepare.ms + pixels.ms, prepare.cpu_ms + pixels.cpu_ms});
}

void TimedPicture::draw(int repeats, Session& session, const std::string& what) {
  for (int run = -1; run < repeats; ++run) {
    session.progress().stage(what);
    draw(session.progress(), run >= 0);
  }
}

std::string integrator_text(const Parameters& parameters) {
  switch (parameters.integrator) {
    case Integrator::exact:
      return "exact";
    case Integrator::linear:
      return "linear";
    case Integrator::preintegrated:
      return "preintegrated";
    case Integrator::sampled:
      return fmt::format("sampled, {} a cell", parameters.samples_per_cell);
  }
  return "";
}

bool has_integrator(Mode mode) {
  return mode == Mode::volume || mode == Mode::volume_surface;
}

std::vector<Parameters> integrator_settings(const Parameters& parameters) {
  if (!has_integrator(parameters.mode)) return {parameters};
  std::vector<Parameters> all;
  for (const Integrator integrator : {Integrator::exact, Integrator::linear, Integrator::preintegrated}) {
    all.push_back(parameters);
    all.back().integrator = integrator;
  }
  for (const int samples : {1, 4, 16}) {
    all.push_back(parameters);
    all.back().integrator = Integrator::sampled;
    all.back().samples_per_cell = samples;
  }
  return all;
}

Json picture_settings(const BenchScene& data, const BenchView& view, const Parameters& parameters,
                      const Camera& camera) {
  Json settings = Json::object({{"mode", mode_name(parameters.mode)}});
  if (parameters.mode == Mode::volume) settings.set("map", data.volume_map);
  settings.set("view", view.name);
  settings.set("projection", parameters.projection == Projection::parallel ? "parallel" : "perspective");
  if (has_integrator(parameters.mode)) {
    settings.set("integrator", integrator_text(parameters));
  }
  settings.set("size", Json::array({camera.width, camera.height}));
  settings.set("threads", threads());
  settings.set("renderer", find_renderer("auto").name());
  return settings;
}

BenchRow picture_row(const std::string& case_name, std::string what, Json settings, const TimedPicture& picture) {
  BenchRow row{"render", case_name, std::move(what), std::move(settings), "", picture.total(), {}, {}, {}};
  row.more = {{"prepare_ms", picture.prepare().median},
              {"draw_ms", picture.pixels().median},
              {"frame_mb", 1e-6 * picture.memory()}};
  if (picture.steps() > 0) {
    row.more.insert(
        row.more.end(),
        {{"steps", picture.steps()}, {"rate", picture.rate()}, {"rate_unit", "million ray-primitive steps/s/core"}});
  }
  return row;
}

double mean_coverage(const Image& picture) {
  double sum = 0.0;
  for (const Vec4f& pixel : picture.pixels) sum += static_cast<double>(pixel.a);
  return picture.pixels.empty() ? 0.0 : sum / static_cast<double>(picture.pixels.size());
}

void set_error(BenchRow& row, const PictureError& error) {
  row.max_error = error.max;
  row.rmse = error.rmse;
  row.psnr = error.psnr;  // not finite where pictures are equal: null
  row.more.emplace_back("pixels_judged", error.pixels);
}

}  // namespace atomesh::cli
