// Pictures: float channels, PNG files, and the comparison of two.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/geometry.h"
#include "core/progress.h"

namespace atomesh {

// Row-major from the top left. Colours are not premultiplied, in [0,1], display-referred (no gamma is applied
// anywhere).
struct Image {
  int width = 0;
  int height = 0;
  std::vector<Vec4f> pixels;

  Image() = default;
  Image(int w, int h) : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  Vec4f& at(int column, int row) {
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
  }
  const Vec4f& at(int column, int row) const {
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
  }
};

// Keys and texts that a PNG carries as iTXt chunks (the parameters that made the picture), UTF-8.
using PngText = std::vector<std::pair<std::string, std::string>>;

// A PNG of 8-bit RGB (`opaque`) or RGBA written row by row, from the top, so that pictures larger than memory can be
// written; channels are rounded to the nearest of 256. Written beside and renamed by finish(); without it, nothing is
// left. Everything throws Error when it cannot be done.
class PngWriter {
 public:
  // Each side 1 to 65535 pixels, keys of 1 to 79 characters, no NUL in keys and texts.
  PngWriter(const std::string& path, int width, int height, bool opaque, const PngText& text = {});
  ~PngWriter();
  PngWriter(PngWriter&&) noexcept;

  // The next rows, whole. Throws CancelledError, after which the writer can only be thrown away.
  void write_rows(std::span<const Vec4f> pixels, const Progress& progress = no_progress());
  // After all rows.
  void finish();

 private:
  class File;
  std::unique_ptr<File> file_;
};

// A whole picture: RGB, or RGBA where a pixel is not opaque.
void write_png(const std::string& path, const Image& image, const PngText& text = {},
               Progress& progress = no_progress());
// Any PNG of 8 or 16 bits, gray, palette or colour. Throws InputError for anything else, truncated or damaged files.
Image read_png(const std::string& path);
// The same from bytes in memory; `name` stands for the file in messages.
Image parse_png(std::string_view bytes, const std::string& name);
// By its first bytes. Throws InputError when the file cannot be read.
bool is_png_file(const std::string& path);
// The texts of a PNG, in file order. The pixels are passed over: it takes no time and memory for them, whatever the
// size of the picture, and does not notice when they are damaged. Throws InputError for anything that is no PNG,
// truncated, or damaged in its texts.
PngText read_png_text(const std::string& path);

struct ImageDifference {
  double max = 0.0;             // largest absolute channel difference, channels in [0,1]
  double rmse = 0.0;            // over all pixels and the channels RGBA
  double psnr = 0.0;            // dB, -20 log10(rmse); infinity when equal
  std::size_t pixels_over = 0;  // pixels with a channel difference above the tolerance
};

// Throws Error naming both sizes when they differ.
ImageDifference compare_images(const Image& a, const Image& b, double tolerance = 0.0);
// |a-b| amplified by `gain`, opaque, black where equal.
Image difference_picture(const Image& a, const Image& b, double gain = 8.0);

}  // namespace atomesh
