#include "app/cli/write_npy.h"

#include <fmt/format.h>

#include <bit>

namespace atomesh::cli {

static_assert(std::endian::native == std::endian::little, "NpyWriter writes the bytes as they lie in memory");

// NumPy format 1.0: magic, version, header length, a Python dict padded with blanks to a multiple of 64 bytes.
NpyWriter::NpyWriter(const std::string& path, Type type, int width, int height) : file_(path) {
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}, {}), }}",
                                   type == Type::float32 ? "<f4" : "<u4", height, width);
  constexpr std::size_t preamble = 10;
  header.append(63 - (preamble + header.size()) % 64, ' ');
  header += '\n';
  file_.write(std::string_view("\x93NUMPY\x01\x00", 8));
  const auto length = static_cast<std::uint16_t>(header.size());
  file_.write(&length, sizeof length);
  file_.write(header);
}

}  // namespace atomesh::cli
