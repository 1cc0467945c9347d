#include "app/cli/render_picture.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <optional>

#include "app/cli/text_values.h"
#include "core/memory.h"
#include "render/passes.h"
#include "render/progressive.h"
#include "render/sub_resolution.h"

namespace atomesh::cli {

namespace {

std::string level_path(const std::string& output, int level) {
  std::filesystem::path path(output);
  path.replace_filename(fmt::format("{}-{}.png", path.stem().string(), level));
  return path.string();
}

std::uint64_t pass_bytes(const Picture& picture, const Channels& channels, int rows) {
  return pass_bytes_per_row(picture.camera, picture.parameters, channels) * static_cast<std::uint64_t>(rows);
}

// `thickest`: where the channels do not hold the whole picture.
void lay_out(PictureLegend& legend, const Picture& picture, std::optional<double> thickest, Session& session) {
  legend.lay_out(picture.scene, picture.material, picture.parameters, picture.camera, thickest, session);
}

PictureReport draw_at_once(const Picture& picture, ChannelFiles& channel_files, PictureLegend& legend,
                           Session& session) {
  PictureReport report;
  Image image = render(picture.renderer, picture.scene, picture.camera, picture.parameters, report.stats,
                       legend.channels(channel_files.channels()), session.progress());
  lay_out(legend, picture, std::nullopt, session);
  legend.draw(image);
  session.progress().stage("write_picture");
  channel_files.begin(image.width, image.height);
  channel_files.write_rows();
  write_png(picture.output, image, picture.text, session.progress());
  channel_files.finish();
  return report;
}

PictureReport draw_in_passes(const Picture& picture, int rows, ChannelFiles& channel_files, PictureLegend& legend,
                             Session& session) {
  require_memory(fmt::format("a pass of {} rows at {}x{} pixels", rows, picture.camera.width, picture.camera.height),
                 pass_bytes(picture, legend.channels(channel_files.channels()), rows),
                 "fewer rows at a time (--pass-rows), or a smaller --size");
  PictureReport report;
  std::optional<double> thickest;
  if (legend.goes_by_thickness()) {
    thickest = largest_thickness(picture.renderer, picture.scene, picture.camera, picture.parameters, rows,
                                 session.progress());
  }
  lay_out(legend, picture, thickest, session);
  const auto [width, height] = std::pair(picture.camera.width, picture.camera.height);
  PngWriter png(picture.output, width, height, picture.parameters.background.a == 1.0F, picture.text);
  channel_files.begin(width, height);
  render_in_passes(
      picture.renderer, picture.scene, picture.camera, picture.parameters, rows, report.stats, channel_files.channels(),
      [&](Image& band, int first_row) {
        legend.draw(band, first_row);
        png.write_rows(band.pixels, session.progress());
        channel_files.write_rows();
      },
      session.progress());
  png.finish();
  channel_files.finish();
  const int count = (height + rows - 1) / rows;
  report.summary = fmt::format(", in {} passes of {} rows", count, rows);
  report.passes = Json::object({{"count", count}, {"rows", rows}});
  return report;
}

PictureReport draw_progressively(const Picture& picture, const PictureOptions& options, ChannelFiles& channel_files,
                                 PictureLegend& legend, Session& session) {
  // A finished picture stands beside the rays.
  require_memory(fmt::format("--progressive at {}x{} pixels", picture.camera.width, picture.camera.height),
                 2 * pass_bytes(picture, legend.channels(channel_files.channels()), picture.camera.height),
                 "draw it without --progressive, which is done in passes where it must, or at a smaller --size");
  PictureReport report;
  Json levels = Json::array();
  std::vector<PngWriter> kept;  // named as they should be only once all is done
  const bool opaque = picture.parameters.background.a == 1.0F;
  const auto keep = [&](const ProgressivePicture& level) {
    Json json =
        Json::object({{"rows", level.resolution.rows}, {"columns", level.resolution.columns}, {"ms", level.ms}});
    if (options.keep_levels) {
      const std::string path = level_path(picture.output, level.level);
      kept.emplace_back(path, level.image.width, level.image.height, opaque, picture.text);
      kept.back().write_rows(level.image.pixels, session.progress());
      json.set("file", path);
    }
    levels.push(json);
  };
  ProgressivePicture best = render_progressively(picture.renderer, picture.scene, picture.camera, picture.parameters,
                                                 {options.progressive, options.time_budget_ms}, report.stats,
                                                 legend.channels(channel_files.channels()), keep, session.progress());
  lay_out(legend, picture, std::nullopt, session);
  legend.draw(best.image);
  session.progress().stage("write_picture");
  channel_files.begin(best.image.width, best.image.height);
  channel_files.write_rows();
  write_png(picture.output, best.image, picture.text, session.progress());
  channel_files.finish();
  for (PngWriter& level : kept) level.finish();
  const SubResolution& reached = best.resolution;
  report.summary = best.complete()
                       ? fmt::format(", in {} sub-resolutions", best.levels)
                       : fmt::format(", sub-resolution {}x{} of {}x{} ({:.3g} % of the pixels)", reached.rows,
                                     reached.columns, reached.sub_window, reached.sub_window, 100.0 * best.fraction);
  report.progressive = Json::object({{"sub_window", options.progressive},
                                     {"complete", best.complete()},
                                     {"fraction", best.fraction},
                                     {"levels", levels}});
  return report;
}

}  // namespace

void add_picture_options(CLI::App& app, PictureOptions& options) {
  CLI::Option* progressive =
      app.add_option(
             "--progressive", options.progressive,
             "Draw coarse to fine, in sub-windows of 4x4 or 8x8 pixels: the first picture has one pixel of each")
          ->type_name("4|8")
          ->check(CLI::IsMember({4, 8}));
  app.add_option_function<std::string>(
         "--time-budget",
         [&options](const std::string& text) { options.time_budget_ms = parse_milliseconds("--time-budget", text); },
         "With --progressive: draw for this long, then keep the finest picture that is complete; the first always is. "
         "Loading and writing do not count")
      ->type_name("MS")
      ->needs(progressive);
  app.add_flag("--keep-levels", options.keep_levels,
               "With --progressive: also write the picture of every sub-resolution, without a legend, as IMG-1.png, "
               "IMG-2.png …")
      ->needs(progressive);
  app.add_option("--pass-rows", options.pass_rows,
                 "Draw and write the picture this many rows at a time [all of them, where they take no more than a "
                 "quarter of the free memory and 1 GB; else as many as do]. Never changes the picture")
      ->type_name("N")
      ->check(CLI::Range(1, 32768))
      ->excludes(progressive);
}

bool writes_level(const std::string& path, const std::string& output, const PictureOptions& options) {
  std::error_code ignored;
  for (int level = 1;
       options.keep_levels && level <= static_cast<int>(sub_resolution_steps(options.progressive).size()); ++level) {
    if (std::filesystem::weakly_canonical(level_path(output, level), ignored) ==
        std::filesystem::weakly_canonical(path, ignored)) {
      return true;
    }
  }
  return false;
}

PictureReport draw_picture(const Picture& picture, const PictureOptions& options, ChannelFiles& channel_files,
                           PictureLegend& legend, Session& session) {
  if (options.progressive > 0) return draw_progressively(picture, options, channel_files, legend, session);
  const Channels channels = legend.channels(channel_files.channels());
  int rows = options.pass_rows;
  if (rows == 0) {
    rows = rows_within(default_pass_bytes(), picture.camera, picture.parameters, channels);
    if (rows < picture.camera.height) {
      session.note(fmt::format("drawn {} rows at a time: the whole picture would take {}", rows,
                               memory_text(pass_bytes(picture, channels, picture.camera.height))));
    }
  }
  return rows < picture.camera.height ? draw_in_passes(picture, rows, channel_files, legend, session)
                                      : draw_at_once(picture, channel_files, legend, session);
}

}  // namespace atomesh::cli
