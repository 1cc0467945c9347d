#include "core/file_extension.h"

#include <algorithm>
#include <filesystem>

namespace atomesh {

std::string lower_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  // Of ASCII alone, whatever the locale.
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

}  // namespace atomesh
