#include "app/gui/movie_writer.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <optional>

#include "core/error.h"
#include "core/file_extension.h"

namespace atomesh::gui {

namespace {

namespace fs = std::filesystem;

constexpr std::array ffmpeg_endings{".mp4", ".mov", ".mkv", ".webm", ".avi"};

// The number of "NAME-0123.png" in a series of NAME.png.
std::optional<long> number_of(const std::string& file, const std::string& stem) {
  if (!file.starts_with(stem + "-") || !file.ends_with(".png")) return std::nullopt;
  const std::string digits = file.substr(stem.size() + 1, file.size() - stem.size() - 5);
  if (digits.size() < 4 || digits.size() > 9 ||
      !std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c) != 0; })) {
    return std::nullopt;
  }
  return std::stol(digits);
}

fs::path folder_of(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

// A series must not end in pictures of an older, longer one, and theirs are not ours to remove.
void refuse_older_series(const std::string& path, int frames) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder_of(path), ignored)) {
    const std::string name = entry.path().filename().string();
    const auto number = number_of(name, fs::path(path).stem().string());
    if (number && *number > frames) {
      throw UsageError(
          fmt::format("{}: is left of an older series, which this one of {} pictures would be mixed up "
                      "with; remove it, or choose another name",
                      entry.path().string(), frames));
    }
  }
}

// Numbered PNGs, in a folder of their own until all of them are there.
class PictureSeries : public MovieWriter {
 public:
  PictureSeries(std::string path, const MovieSettings& settings, int frames) : path_(std::move(path)) {
    refuse_older_series(path_, frames);
    static_cast<void>(settings);
    folder_ = folder_of(path_) / fmt::format(".{}-{}.part", fs::path(path_).filename().string(), ::getpid());
    std::error_code error;
    fs::create_directory(folder_, error);
    if (error) throw Error(fmt::format("{}: cannot be written: {}", path_, error.message()));
  }
  ~PictureSeries() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  PictureSeries(const PictureSeries&) = delete;
  PictureSeries& operator=(const PictureSeries&) = delete;

  void write(const Image& frame, const PngText& text, Progress& progress) override {
    ++frames_;
    write_png((folder_ / name(frames_)).string(), frame, text, progress);
  }
  void finish(Progress& progress) override {
    progress.check();
    for (int frame = 1; frame <= frames_; ++frame) {
      std::error_code error;
      fs::rename(folder_ / name(frame), numbered_path(path_, frame), error);
      if (error) throw Error(fmt::format("{}: cannot be written: {}", numbered_path(path_, frame), error.message()));
    }
  }

 private:
  fs::path name(int frame) const { return fs::path(numbered_path(path_, frame)).filename(); }

  std::string path_;
  fs::path folder_;
  int frames_ = 0;
};

}  // namespace

MovieKind movie_kind(const std::string& path) {
  const std::string end = lower_extension(path);
  if (end == ".ogv") return MovieKind::theora;
  if (end == ".png") return MovieKind::pictures;
  if (std::find(ffmpeg_endings.begin(), ffmpeg_endings.end(), end) != ffmpeg_endings.end()) return MovieKind::ffmpeg;
  throw UsageError(
      fmt::format("\"{}\": cannot write this kind of movie; the name must end in .ogv, {}, or .png for "
                  "numbered pictures",
                  path, fmt::join(ffmpeg_endings, ", ")));
}

std::string movie_problem(const std::string& path) {
  if (movie_kind(path) != MovieKind::ffmpeg || !ffmpeg_program().empty()) return "";
  return fmt::format(
      "{} movies are written by the program ffmpeg, which is not installed. Install it (Debian: apt "
      "install ffmpeg), or choose a name that ends in .ogv, or in .png for numbered pictures",
      lower_extension(path));
}

std::unique_ptr<MovieWriter> make_movie_writer(const std::string& path, const MovieSettings& settings, int frames) {
  const MovieKind kind = movie_kind(path);
  if (settings.frames_per_second < 1 || settings.frames_per_second > 120) {
    throw UsageError(fmt::format("{} frames per second: expected 1 to 120", settings.frames_per_second));
  }
  if (!fs::is_directory(folder_of(path))) {
    throw UsageError(
        fmt::format("\"{}\": the folder {} does not exist; make it first", path, folder_of(path).string()));
  }
  if (kind == MovieKind::pictures) return std::make_unique<PictureSeries>(path, settings, frames);
  if (settings.width < 2 || settings.height < 2 || settings.width % 2 != 0 || settings.height % 2 != 0) {
    throw UsageError(fmt::format("a movie of {}x{} pixels: both must be even", settings.width, settings.height));
  }
  const std::string problem = movie_problem(path);
  if (!problem.empty()) throw UnavailableError(problem);
  return kind == MovieKind::theora ? make_theora_writer(path, settings) : make_ffmpeg_writer(path, settings);
}

std::string numbered_path(const std::string& path, int frame) {
  fs::path numbered(path);
  numbered.replace_filename(fmt::format("{}-{:04}.png", numbered.stem().string(), frame));
  return numbered.string();
}

std::vector<unsigned char> rgb_bytes(const Image& frame, bool from_bottom) {
  std::vector<unsigned char> bytes;
  bytes.reserve(3 * frame.pixels.size());
  for (int row = 0; row < frame.height; ++row) {
    for (int column = 0; column < frame.width; ++column) {
      const Vec4f& pixel = frame.at(column, from_bottom ? frame.height - 1 - row : row);
      for (int c = 0; c < 3; ++c) {
        // As a PNG has it; written so that NaN becomes 0.
        const float channel = pixel[c] > 0.0F ? std::min(pixel[c], 1.0F) : 0.0F;
        bytes.push_back(static_cast<unsigned char>(std::lround(channel * 255.0F)));
      }
    }
  }
  return bytes;
}

}  // namespace atomesh::gui
