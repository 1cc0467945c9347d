#include "app/cli/write_npy.h"

#include <fmt/format.h>

#include <bit>

#include "core/text_file.h"

namespace atomesh::cli {

namespace {

static_assert(std::endian::native == std::endian::little, "write_npy writes the bytes as they lie in memory");

// NumPy format 1.0: magic, version, header length, a Python dict padded with blanks to a multiple of 64 bytes.
template <class T>
void write(const std::string& path, std::span<const T> values, const char* type, int width, int height) {
  std::string header =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}, {}), }}", type, height, width);
  constexpr std::size_t preamble = 10;
  header.append(63 - (preamble + header.size()) % 64, ' ');
  header += '\n';
  AtomicFile file(path);
  file.write(std::string_view("\x93NUMPY\x01\x00", 8));
  const auto length = static_cast<std::uint16_t>(header.size());
  file.write(&length, sizeof length);
  file.write(header);
  file.write(values.data(), values.size_bytes());
  file.commit();
}

}  // namespace

void write_npy(const std::string& path, std::span<const float> values, int width, int height) {
  write(path, values, "<f4", width, height);
}

void write_npy(const std::string& path, std::span<const std::uint32_t> values, int width, int height) {
  write(path, values, "<u4", width, height);
}

}  // namespace atomesh::cli
