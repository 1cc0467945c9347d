// Pictures one after the other into a movie, or into numbered PNGs.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/progress.h"

namespace atomesh::gui {

// By the name's end:
//   .ogv                      Ogg Theora, through VTK: always there
//   .mp4 .mov .mkv .webm .avi through the program ffmpeg, where it is installed
//   .png                      NAME-0001.png, NAME-0002.png, …
enum class MovieKind { theora, ffmpeg, pictures };
// Throws UsageError naming the endings for another.
MovieKind movie_kind(const std::string& path);

// The ffmpeg that PATH finds; "" when there is none.
std::string ffmpeg_program();
// Why this file cannot be written here, and what can be done; "" when it can.
std::string movie_problem(const std::string& path);

struct MovieSettings {
  int width = 0;  // pixels; movies (not numbered pictures) need even ones
  int height = 0;
  int frames_per_second = 25;  // 1 to 120
  int quality = 2;             // 0 small, 1, 2 good
};

// Nothing has the movie's name before finish(), and nothing is left without it.
class MovieWriter {
 public:
  virtual ~MovieWriter() = default;
  // The next frame, of the movie's size. `text` goes into numbered PNGs only. Opacities are kept by these only. Throws
  // Error when it cannot be written, CancelledError.
  virtual void write(const Image& frame, const PngText& text, Progress& progress) = 0;
  virtual void finish(Progress& progress) = 0;
};

// Throws UsageError for the path's ending, odd sides, a rate out of range and numbered pictures beyond those that will
// be written (`frames`) of an older series; UnavailableError with movie_problem(); Error when it cannot be written.
std::unique_ptr<MovieWriter> make_movie_writer(const std::string& path, const MovieSettings& settings, int frames);

// "turn-0001.png" of "turn.png"; frames count from 1.
std::string numbered_path(const std::string& path, int frame);

// Their own files: one for each library.
std::unique_ptr<MovieWriter> make_theora_writer(const std::string& path, const MovieSettings& settings);
std::unique_ptr<MovieWriter> make_ffmpeg_writer(const std::string& path, const MovieSettings& settings);

// 8-bit RGB, rows from the top (or from the bottom), three bytes a pixel.
std::vector<unsigned char> rgb_bytes(const Image& frame, bool from_bottom);

}  // namespace atomesh::gui
