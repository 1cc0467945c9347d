#include "app/cli/output_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/error.h"

namespace atomesh::cli {

void check_output(const std::string& path, const std::vector<std::string_view>& extensions) {
  const std::filesystem::path file(path);
  if (std::find(extensions.begin(), extensions.end(), file.extension().string()) == extensions.end()) {
    throw UsageError(fmt::format("\"{}\": cannot write this kind of file; the name must end in {}", path,
                                 fmt::join(extensions, ", ")));
  }
  check_output_folder(path);
}

void check_output_folder(const std::string& path) {
  const std::filesystem::path file(path);
  if (file.has_parent_path() && !std::filesystem::is_directory(file.parent_path())) {
    throw UsageError(
        fmt::format("\"{}\": the folder {} does not exist; make it first", path, file.parent_path().string()));
  }
}

}  // namespace atomesh::cli
