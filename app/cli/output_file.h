// The file a subcommand is to write.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace atomesh::cli {

// Before any work: throws UsageError when `path` does not end in one of `extensions` (".crb") and when its folder does
// not exist.
void check_output(const std::string& path, const std::vector<std::string_view>& extensions);

// Only the folder: for a file that may be called anything.
void check_output_folder(const std::string& path);

}  // namespace atomesh::cli
