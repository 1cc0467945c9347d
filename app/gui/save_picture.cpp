#include "app/gui/save_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "app/gui/overlay.h"
#include "core/error.h"
#include "core/memory.h"
#include "render/passes.h"

namespace atomesh::gui {

namespace {

// Where pictures without a size come from: a field of the dialog, a script.
void check_size(const PictureSettings& settings) {
  const auto fits = [](int side) { return side >= 1 && side <= largest_picture_side; };
  if (fits(settings.width) && fits(settings.height)) return;
  throw UsageError(fmt::format("a picture of {}x{} pixels: each side must be 1 to {}", settings.width, settings.height,
                               largest_picture_side));
}

Document with_what_is_drawn(const Document& document, const Parameters& parameters, Progress& progress) {
  progress.stage("prepare");
  return with_parts(document, parts_needed(parameters), progress);
}

Camera size_only(const PictureSettings& settings) {
  Camera camera;
  camera.width = settings.width;
  camera.height = settings.height;
  return camera;
}

// What lies over the sample.
OverlayParts overlay_of(const PictureStudio& studio, const Camera& camera, double thickest) {
  const PictureSettings& settings = studio.settings();
  const Material& material = *studio.document().material;
  ViewOptions options;
  options.legend = settings.parts.legend;
  options.scale_bar = settings.parts.scale_bar;
  options.tripod = settings.parts.tripod;
  OverlayParts parts =
      overlay_parts(options, studio.scene(), material, studio.parameters(), camera, thickest, settings.marks);
  add_picks(parts, settings.picks, material, studio.parameters());
  return parts;
}

double largest(const std::vector<float>& values) {
  return values.empty() ? 0.0 : static_cast<double>(*std::max_element(values.begin(), values.end()));
}

std::uint64_t pass_bytes(const Camera& camera, const Parameters& parameters, const Channels& channels, int rows) {
  return pass_bytes_per_row(camera, parameters, channels) * static_cast<std::uint64_t>(rows);
}

}  // namespace

Parameters picture_parameters(const Parameters& parameters, const PictureSettings& settings) {
  Parameters drawn = parameters;
  if (settings.transparent) drawn.background.a = 0.0F;
  if (settings.supersampling > 0) drawn.supersampling = settings.supersampling;
  check_parameters(drawn);
  return drawn;
}

// A cancel is heeded between passes, and their finishing takes its time.
constexpr std::uint64_t prompt_pass_bytes = 128'000'000;

PicturePlan plan_picture(const Parameters& parameters, const PictureSettings& settings) {
  check_size(settings);
  const Parameters drawn = picture_parameters(parameters, settings);
  const Camera camera = size_only(settings);
  std::vector<float> thickness;
  Channels channels;
  if (settings.parts.legend && drawn.mode == Mode::xray) channels.thickness = &thickness;
  PicturePlan plan;
  plan.rows = rows_within(std::min(default_pass_bytes(), prompt_pass_bytes), camera, drawn, channels);
  plan.passes = (camera.height + plan.rows - 1) / plan.rows;
  plan.bytes = pass_bytes(camera, drawn, channels, plan.rows);
  return plan;
}

PictureStudio::PictureStudio(const Document& document, const Parameters& parameters, const PictureSettings& settings,
                             Progress& progress)
    : document_(with_what_is_drawn(document, parameters, progress)),
      parameters_(picture_parameters(parameters, settings)),
      settings_(settings),
      renderer_(find_renderer(settings.renderer)) {
  check_size(settings);
  scene_ = make_scene(*document_.material, parameters_, progress);
  data_hash_ = cli::hash_of_data(document_.path, progress);
}

Camera PictureStudio::camera(const Parameters& view) const {
  return make_camera(view, scene_.bounds, settings_.width, settings_.height);
}

bool PictureStudio::goes_by_thickness() const {
  return settings_.parts.legend && parameters_.mode == Mode::xray;
}

double PictureStudio::largest_thickness(const Parameters& view, Progress& progress) const {
  return atomesh::largest_thickness(renderer_, scene_, camera(view), view, plan_picture(view, settings_).rows,
                                    progress);
}

Image PictureStudio::draw(const Parameters& view, std::optional<double> thickest, Progress& progress) const {
  const Camera from = camera(view);
  std::vector<float> thickness;
  Channels channels;
  if (goes_by_thickness() && !thickest) channels.thickness = &thickness;
  require_memory(fmt::format("a picture of {}x{} pixels", from.width, from.height),
                 pass_bytes(from, view, channels, from.height), "take a smaller size, or save the picture to a file");
  RenderStats stats;
  Image image = render(renderer_, scene_, from, view, stats, channels, progress);
  draw_overlay(image, 0, from, *document_.material, view.background,
               overlay_of(*this, from, thickest.value_or(largest(thickness))));
  return image;
}

PicturePlan PictureStudio::save(const std::string& png, const Parameters& view, std::optional<double> thickest,
                                Progress& progress) const {
  const Camera from = camera(view);
  const PicturePlan plan = plan_picture(view, settings_);
  require_memory(fmt::format("a pass of {} rows at {}x{} pixels", plan.rows, from.width, from.height), plan.bytes,
                 "take a smaller size or less supersampling");
  std::vector<float> thickness;
  Channels channels;
  if (goes_by_thickness() && !thickest) {
    if (plan.passes == 1) {
      channels.thickness = &thickness;
    } else {
      progress.stage("measure");
      thickest = largest_thickness(view, progress);
    }
  }
  std::optional<OverlayParts> overlay;
  PngWriter writer(png, from.width, from.height, view.background.a == 1.0F, text(png, view));
  RenderStats stats;
  const BandSink write = [&](Image& band, int first_row) {
    if (!overlay) overlay = overlay_of(*this, from, thickest.value_or(largest(thickness)));
    draw_overlay(band, first_row, from, *document_.material, view.background, *overlay);
    writer.write_rows(band.pixels, progress);
  };
  render_in_passes(renderer_, scene_, from, view, plan.rows, stats, channels, write, progress);
  writer.finish();
  return plan;
}

PngText PictureStudio::text(const std::string& png, const Parameters& view) const {
  return cli::picture_text(png, document_.path, data_hash_, *document_.material, view, renderer_.name(),
                           settings_.parts);
}

PicturePlan save_picture(const std::string& png, const Document& document, const Parameters& parameters,
                         const PictureSettings& settings, Progress& progress) {
  const PictureStudio studio(document, parameters, settings, progress);
  return studio.save(png, studio.parameters(), std::nullopt, progress);
}

}  // namespace atomesh::gui
