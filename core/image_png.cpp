#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "core/image.h"
#include "core/text_file.h"

// libpng reports errors by longjmp, which must not cross a C++ object with a destructor. Every function that calls it
// therefore holds only plain data and references: what owns memory (PngReader, PngStream, the vectors) lives in the
// caller's frame, outside the setjmp.

namespace atomesh {

namespace {

constexpr int largest_side = 65535;
constexpr std::size_t largest_pixels = std::size_t{1} << 28;  // 4 GiB as floats

struct Complaint {
  char text[128] = "damaged";
};

void keep_message(png_structp png, png_const_charp message) {
  auto* complaint = static_cast<Complaint*>(png_get_error_ptr(png));
  std::strncpy(complaint->text, message, sizeof(complaint->text) - 1);
  complaint->text[sizeof(complaint->text) - 1] = '\0';
  png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

// ---- reading

struct Source {
  const char* data;
  std::size_t left;
};

void read_bytes(png_structp png, png_bytep to, png_size_t count) {
  auto* source = static_cast<Source*>(png_get_io_ptr(png));
  if (count > source->left) png_error(png, "the file ends too early");
  std::memcpy(to, source->data, count);
  source->data += count;
  source->left -= count;
}

struct PngReader {
  Complaint complaint;
  png_structp png = nullptr;
  png_infop info = nullptr;

  PngReader() {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &complaint, keep_message, ignore_warning);
    if (png != nullptr) info = png_create_info_struct(png);
    if (info == nullptr) {
      png_destroy_read_struct(&png, nullptr, nullptr);
      throw UnavailableError("libpng could not be started (out of memory)");
    }
  }
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
};

// Header, and the transformations that make every kind of PNG 16-bit RGBA. False after an error.
bool read_header(PngReader& reader, Source& source, png_uint_32& width, png_uint_32& height) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_set_read_fn(reader.png, &source, read_bytes);
  png_set_user_limits(reader.png, largest_side, largest_side);
  png_set_chunk_malloc_max(reader.png, 16U << 20U);
  png_read_info(reader.png, reader.info);
  width = png_get_image_width(reader.png, reader.info);
  height = png_get_image_height(reader.png, reader.info);
  png_set_expand_16(reader.png);  // palettes, tRNS and low depths too
  png_set_gray_to_rgb(reader.png);
  png_set_add_alpha(reader.png, 0xFFFF, PNG_FILLER_AFTER);
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  return true;
}

bool read_pixels(PngReader& reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_read_image(reader.png, rows);
  png_read_end(reader.png, reader.info);
  return true;
}

bool is_png(std::string_view bytes) {
  return bytes.size() >= 8 && png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, 8) == 0;
}

// The same PNG up to the head of its first pixels, its texts moved there and other chunks left out: what libpng reads
// texts from without unpacking the picture. Throws InputError when the file is no PNG or ends within a chunk.
std::string texts_of(std::string_view bytes, const std::string& path) {
  if (!is_png(bytes)) throw InputError(path, 0, "not a PNG file");
  std::string head(bytes.substr(0, 8));
  std::string_view first_pixels;
  std::string_view type;
  for (std::size_t at = 8; type != "IEND";) {
    if (bytes.size() - at < 12) throw InputError(path, 0, "the PNG cannot be read: the file ends too early");
    const std::size_t length = png_get_uint_32(reinterpret_cast<png_const_bytep>(bytes.data() + at));
    if (length > bytes.size() - at - 12) {
      throw InputError(path, 0, "the PNG cannot be read: the file ends too early");
    }
    const std::string_view chunk = bytes.substr(at, length + 12);
    type = chunk.substr(4, 4);
    if (type == "IDAT" && first_pixels.empty()) first_pixels = chunk.substr(0, 8);
    if (type == "IHDR" || type == "PLTE" || type == "tEXt" || type == "zTXt" || type == "iTXt") head += chunk;
    at += chunk.size();
  }
  return head.append(first_pixels);
}

// Reads a whole picture as 16-bit RGBA, big-endian; throws InputError.
std::vector<png_byte> read_all(PngReader& reader, std::string_view bytes, const std::string& path, int& width,
                               int& height) {
  if (!is_png(bytes)) throw InputError(path, 0, "not a PNG file");
  Source source{bytes.data(), bytes.size()};
  png_uint_32 columns = 0;
  png_uint_32 lines = 0;
  if (!read_header(reader, source, columns, lines)) {
    throw InputError(path, 0, "the PNG cannot be read: " + std::string(reader.complaint.text));
  }
  const std::size_t row_bytes = std::size_t{8} * columns;
  if (std::size_t{columns} * lines > largest_pixels) {
    throw InputError(path, 0, "the PNG is larger than the 268 million pixels this program reads");
  }
  // Deflate packs at most 1032 to 1: a header that promises more than the file can hold is damaged, and must not make
  // us allocate for it.
  if (std::size_t{lines} * ((std::size_t{columns} + 7) / 8) > 1032 * bytes.size()) {
    throw InputError(path, 0, "the PNG cannot be read: the file is too short for its size in pixels");
  }
  if (png_get_rowbytes(reader.png, reader.info) != row_bytes) {
    throw InputError(path, 0, "the PNG cannot be read: unexpected pixel format");
  }
  std::vector<png_byte> data(row_bytes * lines);
  std::vector<png_bytep> rows(lines);
  for (std::size_t y = 0; y < lines; ++y) rows[y] = data.data() + y * row_bytes;
  if (!read_pixels(reader, rows.data())) {
    throw InputError(path, 0, "the PNG cannot be read: " + std::string(reader.complaint.text));
  }
  width = static_cast<int>(columns);
  height = static_cast<int>(lines);
  return data;
}

// ---- writing

struct PngStream {
  Complaint complaint;
  png_structp png = nullptr;
  png_infop info = nullptr;

  PngStream() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &complaint, keep_message, ignore_warning);
    if (png != nullptr) info = png_create_info_struct(png);
    if (info == nullptr) {
      png_destroy_write_struct(&png, nullptr);
      throw UnavailableError("libpng could not be started (out of memory)");
    }
  }
  ~PngStream() { png_destroy_write_struct(&png, &info); }
  PngStream(const PngStream&) = delete;
  PngStream& operator=(const PngStream&) = delete;
};

// Each of these: false after an error.
bool write_header(PngStream& to, std::FILE* file, int width, int height, bool opaque, png_textp text, int text_count) {
  if (setjmp(png_jmpbuf(to.png)) != 0) return false;
  png_init_io(to.png, file);
  png_set_IHDR(to.png, to.info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
               opaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  if (text_count > 0) png_set_text(to.png, to.info, text, text_count);
  png_write_info(to.png, to.info);
  return true;
}

bool write_row(PngStream& to, png_const_bytep row) {
  if (setjmp(png_jmpbuf(to.png)) != 0) return false;
  png_write_row(to.png, row);
  return true;
}

bool write_end(PngStream& to) {
  if (setjmp(png_jmpbuf(to.png)) != 0) return false;
  png_write_end(to.png, to.info);
  return true;
}

png_byte to_byte(float channel) {
  // Written so that NaN becomes 0.
  return channel > 0.0F ? static_cast<png_byte>(std::lround(std::min(channel, 1.0F) * 255.0F)) : png_byte{0};
}

void check_size(const std::string& path, int width, int height) {
  if (width >= 1 && height >= 1 && width <= largest_side && height <= largest_side) return;
  throw Error(path + ": a picture of " + std::to_string(width) + "x" + std::to_string(height) +
              " pixels cannot be written as PNG (each side 1 to 65535)");
}

void check_text(const std::string& path, const PngText& text) {
  for (const auto& [key, value] : text) {
    if (key.empty() || key.size() > 79 || key.find('\0') != std::string::npos ||
        value.find('\0') != std::string::npos) {
      throw Error(path + ": \"" + key + "\" cannot be a PNG text key (1 to 79 characters, no NUL in it or its text)");
    }
  }
}

}  // namespace

class PngWriter::File {
 public:
  // libpng asks for texts it might change.
  File(const std::string& path, int width, int height, bool opaque, PngText text)
      : path_(path), channels_(opaque ? 3 : 4), width_(width), rows_left_(height), file_(path) {
    std::vector<png_text> chunks(text.size());
    char no_language[] = "";
    for (std::size_t i = 0; i < text.size(); ++i) {
      chunks[i] = png_text{};
      chunks[i].compression = PNG_ITXT_COMPRESSION_NONE;  // iTXt: UTF-8
      chunks[i].key = text[i].first.data();
      chunks[i].text = text[i].second.data();
      chunks[i].itxt_length = text[i].second.size();
      chunks[i].lang = no_language;
      chunks[i].lang_key = no_language;
    }
    check(write_header(stream_, file_.stream(), width, height, opaque, chunks.data(), static_cast<int>(chunks.size())));
  }

  void write_rows(std::span<const Vec4f> pixels, const Progress& progress) {
    const auto width = static_cast<std::size_t>(width_);
    const std::size_t rows = pixels.size() / width;
    if (rows * width != pixels.size() || rows > static_cast<std::size_t>(rows_left_)) {
      throw Error(path_ + ": " + std::to_string(pixels.size()) +
                  " pixels are no whole rows of the picture, or too many");
    }
    bytes_.resize(width * channels_);
    for (std::size_t row = 0; row < rows; ++row) {
      progress.check();  // throws from here, where no frame of libpng is on the stack
      png_byte* byte = bytes_.data();
      for (const Vec4f& pixel : pixels.subspan(row * width, width)) {
        for (std::size_t c = 0; c < channels_; ++c) *byte++ = to_byte(pixel[static_cast<int>(c)]);
      }
      check(write_row(stream_, bytes_.data()));
    }
    rows_left_ -= static_cast<int>(rows);
  }

  void finish() {
    if (rows_left_ != 0) throw Error(path_ + ": " + std::to_string(rows_left_) + " rows of the picture are missing");
    check(write_end(stream_));
    file_.commit();
  }

 private:
  void check(bool done) const {
    if (!done) throw Error(path_ + ": the PNG cannot be written: " + stream_.complaint.text);
  }

  std::string path_;
  std::size_t channels_;
  int width_;
  int rows_left_;
  AtomicFile file_;
  PngStream stream_;
  std::vector<png_byte> bytes_;  // of one row
};

PngWriter::PngWriter(const std::string& path, int width, int height, bool opaque, const PngText& text) {
  check_size(path, width, height);
  check_text(path, text);
  file_ = std::make_unique<File>(path, width, height, opaque, text);
}

PngWriter::~PngWriter() = default;
PngWriter::PngWriter(PngWriter&&) noexcept = default;

void PngWriter::write_rows(std::span<const Vec4f> pixels, const Progress& progress) {
  file_->write_rows(pixels, progress);
}

void PngWriter::finish() {
  file_->finish();
}

void write_png(const std::string& path, const Image& image, const PngText& text, Progress& progress) {
  check_size(path, image.width, image.height);
  const bool opaque =
      std::all_of(image.pixels.begin(), image.pixels.end(), [](const Vec4f& pixel) { return to_byte(pixel.a) == 255; });
  PngWriter writer(path, image.width, image.height, opaque, text);
  writer.write_rows(image.pixels, progress);
  writer.finish();
}

bool is_png_file(const std::string& path) {
  return is_png(MappedFile(path).bytes());
}

Image read_png(const std::string& path) {
  const MappedFile file(path);
  return parse_png(file.bytes(), path);
}

Image parse_png(std::string_view bytes, const std::string& name) {
  PngReader reader;
  int width = 0;
  int height = 0;
  const std::vector<png_byte> data = read_all(reader, bytes, name, width, height);
  Image image(width, height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      const unsigned value = static_cast<unsigned>(data[8 * i + 2 * c]) << 8U | data[8 * i + 2 * c + 1];
      image.pixels[i][static_cast<int>(c)] = static_cast<float>(value) / 65535.0F;
    }
  }
  return image;
}

PngText read_png_text(const std::string& path) {
  const MappedFile file(path);
  const std::string head = texts_of(file.bytes(), path);
  PngReader reader;
  Source source{head.data(), head.size()};
  png_uint_32 width = 0;
  png_uint_32 height = 0;
  if (!read_header(reader, source, width, height)) {
    throw InputError(path, 0, "the PNG cannot be read: " + std::string(reader.complaint.text));
  }
  png_textp chunks = nullptr;
  int count = 0;
  png_get_text(reader.png, reader.info, &chunks, &count);
  PngText text;
  for (int i = 0; i < count; ++i) {
    const png_text& chunk = chunks[i];
    const std::size_t length = chunk.compression >= PNG_ITXT_COMPRESSION_NONE ? chunk.itxt_length : chunk.text_length;
    text.emplace_back(chunk.key, std::string(chunk.text, length));
  }
  return text;
}

}  // namespace atomesh
