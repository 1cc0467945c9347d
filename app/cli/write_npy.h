// Per-pixel numbers as .npy, which numpy, Julia and others read directly.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace atomesh::cli {

// `values` row-major, height × width; little-endian float32 or uint32. Written beside and renamed.
void write_npy(const std::string& path, std::span<const float> values, int width, int height);
void write_npy(const std::string& path, std::span<const std::uint32_t> values, int width, int height);

}  // namespace atomesh::cli
