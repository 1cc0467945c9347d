#include "app/cli/machine.h"

#include <fmt/format.h>

#include <fstream>

#include "build_commit.h"
#include "core/memory.h"
#include "core/parallel.h"

namespace atomesh::cli {

namespace {

// The rest of the first line of `path` that starts with `key`, without the blanks and colon between.
std::string value_of(const char* path, std::string_view key) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(key)) continue;
    const std::size_t value = line.find_first_not_of(": \t", key.size());
    return value == std::string::npos ? "" : line.substr(value);
  }
  return "";
}

}  // namespace

double peak_memory_mb() {
  return static_cast<double>(peak_memory()) * 1e-6;
}

std::string machine_name() {
  const std::string processor = value_of("/proc/cpuinfo", "model name");
  return fmt::format("{}, {} threads", processor.empty() ? "unknown processor" : processor, threads());
}

std::string build_commit() {
  return ATOMESH_BUILD_COMMIT;
}

}  // namespace atomesh::cli
