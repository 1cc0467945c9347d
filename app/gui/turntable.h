// A movie of the sample turning once around, drawn by the CPU renderers.
#pragma once

#include "app/gui/movie_writer.h"
#include "app/gui/save_picture.h"

namespace atomesh::gui {

// What it turns about: the sample's z, or the vertical line of the picture.
enum class TurntableAxis { z, picture };

struct TurntableSettings {
  TurntableAxis axis = TurntableAxis::z;
  double degrees = 360.0;  // in all; what is in front goes to the right, with a negative angle to the left
  int frames = 120;        // 2 to 10000; the first is the view as it is, and after the last it would come again
  int frames_per_second = 25;
  int quality = 2;  // MovieSettings::quality
  PictureSettings picture;
};

// The view after turning by so many degrees about `pivot` (Å), which stays where it is in the picture.
Parameters turntable_view(const Parameters& start, const Bounds& bounds, const Vec3& pivot, TurntableAxis axis,
                          double degrees);

// The size of the frames: a movie's sides are even, an odd one is drawn one pixel larger; a transparent background is
// kept by numbered pictures only.
PictureSettings frame_settings(const std::string& path, const PictureSettings& picture);

// Draws and writes all frames; stage "turntable". A legend in mode xray has one scale, for the thickest of all frames.
// Nothing is left of a movie that is cancelled or fails. Throws what PictureStudio and make_movie_writer() throw, and
// UsageError for a number of frames or an angle out of range.
void save_turntable(const std::string& path, const Document& document, const Parameters& parameters, const Vec3& pivot,
                    const TurntableSettings& settings, Progress& progress);

}  // namespace atomesh::gui
