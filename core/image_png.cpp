#include <png.h>

#include <array>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "core/image.h"
#include "core/text_file.h"

// libpng reports errors by longjmp, which must not cross a C++ object with a destructor. Every function that calls it
// therefore holds only plain data and references: what owns memory (PngReader, PngWriter, the vectors) lives in the
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

// Reads a whole picture as 16-bit RGBA, big-endian; throws InputError.
std::vector<png_byte> read_all(PngReader& reader, std::string_view bytes, const std::string& path, int& width,
                               int& height) {
  if (bytes.size() < 8 || png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, 8) != 0) {
    throw InputError(path, 0, "not a PNG file");
  }
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

struct PngWriter {
  Complaint complaint;
  png_structp png = nullptr;
  png_infop info = nullptr;

  PngWriter() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &complaint, keep_message, ignore_warning);
    if (png != nullptr) info = png_create_info_struct(png);
    if (info == nullptr) {
      png_destroy_write_struct(&png, nullptr);
      throw UnavailableError("libpng could not be started (out of memory)");
    }
  }
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
};

bool write_all(PngWriter& writer, std::FILE* stream, int width, int height, int color_type, png_textp text,
               int text_count, png_bytepp rows, Progress& progress) {
  if (setjmp(png_jmpbuf(writer.png)) != 0) return false;
  png_init_io(writer.png, stream);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
               color_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (text_count > 0) png_set_text(writer.png, writer.info, text, text_count);
  png_write_info(writer.png, writer.info);
  for (int y = 0; y < height; ++y) {
    progress.check();  // throws from here, where no frame of libpng is on the stack
    png_write_row(writer.png, rows[y]);
  }
  png_write_end(writer.png, writer.info);
  return true;
}

png_byte to_byte(float channel) {
  // Written so that NaN becomes 0.
  return channel > 0.0F ? static_cast<png_byte>(std::lround(std::min(channel, 1.0F) * 255.0F)) : png_byte{0};
}

}  // namespace

void write_png(const std::string& path, const Image& image,
               const std::vector<std::pair<std::string, std::string>>& text, Progress& progress) {
  if (image.width < 1 || image.height < 1 || image.width > largest_side || image.height > largest_side) {
    throw Error(path + ": a picture of " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                " pixels cannot be written as PNG (each side 1 to 65535)");
  }
  for (const auto& [key, value] : text) {
    if (key.empty() || key.size() > 79 || key.find('\0') != std::string::npos ||
        value.find('\0') != std::string::npos) {
      throw Error(path + ": \"" + key + "\" cannot be a PNG text key (1 to 79 characters, no NUL in it or its text)");
    }
  }
  std::vector<png_byte> data(image.pixels.size() * 4);
  bool opaque = true;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    if (i % 65536 == 0) progress.check();
    for (int c = 0; c < 4; ++c) data[4 * i + static_cast<std::size_t>(c)] = to_byte(image.pixels[i][c]);
    opaque = opaque && data[4 * i + 3] == 255;
  }
  std::size_t channels = 4;
  if (opaque) {
    channels = 3;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) std::memmove(&data[3 * i], &data[4 * i], 3);
  }
  std::vector<png_bytep> rows(static_cast<std::size_t>(image.height));
  for (std::size_t y = 0; y < rows.size(); ++y) {
    rows[y] = data.data() + y * static_cast<std::size_t>(image.width) * channels;
  }
  std::vector<png_text> chunks(text.size());
  std::vector<std::pair<std::string, std::string>> owned = text;  // libpng asks for pointers to non-const
  char no_language[] = "";
  for (std::size_t i = 0; i < owned.size(); ++i) {
    chunks[i] = png_text{};
    chunks[i].compression = PNG_ITXT_COMPRESSION_NONE;  // iTXt: UTF-8
    chunks[i].key = owned[i].first.data();
    chunks[i].text = owned[i].second.data();
    chunks[i].itxt_length = owned[i].second.size();
    chunks[i].lang = no_language;
    chunks[i].lang_key = no_language;
  }
  AtomicFile file(path);
  PngWriter writer;
  if (!write_all(writer, file.stream(), image.width, image.height, opaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGBA,
                 chunks.data(), static_cast<int>(chunks.size()), rows.data(), progress)) {
    throw Error(path + ": the PNG cannot be written: " + writer.complaint.text);
  }
  file.commit();
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

std::vector<std::pair<std::string, std::string>> read_png_text(const std::string& path) {
  const MappedFile file(path);
  PngReader reader;
  int width = 0;
  int height = 0;
  read_all(reader, file.bytes(), path, width, height);
  png_textp chunks = nullptr;
  int count = 0;
  png_get_text(reader.png, reader.info, &chunks, &count);
  std::vector<std::pair<std::string, std::string>> text;
  for (int i = 0; i < count; ++i) {
    const png_text& chunk = chunks[i];
    const std::size_t length = chunk.compression >= PNG_ITXT_COMPRESSION_NONE ? chunk.itxt_length : chunk.text_length;
    text.emplace_back(chunk.key, std::string(chunk.text, length));
  }
  return text;
}

}  // namespace atomesh
