// Per-pixel numbers as .npy, which numpy, Julia and others read directly.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/text_file.h"

namespace atomesh::cli {

// Values row-major, height × width, in portions from the top; little-endian float32 or uint32. Written beside and
// renamed by finish(); without it, nothing is left. Throws Error when it cannot be written.
class NpyWriter {
 public:
  enum class Type { float32, uint32 };
  NpyWriter(const std::string& path, Type type, int width, int height);

  // All values of a file are of the type it was made for.
  void write(std::span<const float> values) { file_.write(values.data(), values.size_bytes()); }
  void write(std::span<const std::uint32_t> values) { file_.write(values.data(), values.size_bytes()); }
  void finish() { file_.commit(); }

 private:
  AtomicFile file_;
};

}  // namespace atomesh::cli
