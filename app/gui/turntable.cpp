#include "app/gui/turntable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/gui/navigation.h"
#include "core/error.h"

namespace atomesh::gui {

namespace {

constexpr int most_frames = 10000;

void check(const TurntableSettings& settings) {
  if (settings.frames < 2 || settings.frames > most_frames) {
    throw UsageError(fmt::format("a movie of {} frames: expected 2 to {}", settings.frames, most_frames));
  }
  if (!(std::abs(settings.degrees) <= 36000.0) || settings.degrees == 0.0) {
    throw UsageError(fmt::format("a turn by {} degrees: expected -36000 to 36000, and not 0", settings.degrees));
  }
}

}  // namespace

Parameters turntable_view(const Parameters& start, const Bounds& bounds, const Vec3& pivot, TurntableAxis axis,
                          double degrees) {
  Parameters view = start;
  if (degrees == 0.0) return view;
  if (axis == TurntableAxis::picture) {
    rotate_view(view, bounds, pivot, degrees / 180.0, 0.0, false);
    return view;
  }
  // The viewer goes about z the other way, and with him the point he looks at.
  view.azimuth = std::remainder(start.azimuth - degrees, 360.0);
  const double angle = -degrees * std::numbers::pi / 180.0;
  const Vec3 from_pivot = bounds.center() + start.pan - pivot;
  const Vec3 turned(std::cos(angle) * from_pivot.x - std::sin(angle) * from_pivot.y,
                    std::sin(angle) * from_pivot.x + std::cos(angle) * from_pivot.y, from_pivot.z);
  view.pan = pivot + turned - bounds.center();
  return view;
}

PictureSettings frame_settings(const std::string& path, const PictureSettings& picture) {
  PictureSettings frame = picture;
  if (movie_kind(path) == MovieKind::pictures) return frame;
  frame.width += frame.width % 2;
  frame.height += frame.height % 2;
  frame.transparent = false;
  return frame;
}

void save_turntable(const std::string& path, const Document& document, const Parameters& parameters, const Vec3& pivot,
                    const TurntableSettings& settings, Progress& progress) {
  check(settings);
  const PictureSettings frame = frame_settings(path, settings.picture);
  // Before anything is drawn: it says what is wrong with the name.
  const auto writer = make_movie_writer(path, {frame.width, frame.height, settings.frames_per_second, settings.quality},
                                        settings.frames);
  Parameters start = parameters;
  if (movie_kind(path) != MovieKind::pictures) start.background.a = 1.0F;
  const PictureStudio studio(document, start, frame, progress);
  const auto view = [&](int i) {
    return turntable_view(studio.parameters(), studio.scene().bounds, pivot, settings.axis,
                          settings.degrees * i / settings.frames);
  };

  progress.stage("turntable");
  const int rounds = studio.goes_by_thickness() ? 2 : 1;
  const double all = static_cast<double>(rounds) * settings.frames;
  std::optional<double> thickest;
  for (int i = 0; i < settings.frames && studio.goes_by_thickness(); ++i) {
    Progress part(progress, i / all, (i + 1) / all);
    thickest = std::max(thickest.value_or(0.0), studio.largest_thickness(view(i), part));
  }
  for (int i = 0; i < settings.frames; ++i) {
    const int done = (rounds - 1) * settings.frames + i;
    Progress part(progress, done / all, (done + 1) / all);
    const Parameters from = view(i);
    const Image image = studio.draw(from, thickest, part);
    writer->write(image, studio.text(numbered_path(path, i + 1), from), progress);
  }
  writer->finish(progress);
}

}  // namespace atomesh::gui
