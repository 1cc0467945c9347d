// Words of the command line → which files a batch reads and what it writes.
#pragma once

#include <string>
#include <vector>

#include "app/cli/preprocess_file.h"

namespace atomesh::cli {

// Several inputs, a pattern, a folder, or an output that is a folder or a template make a batch; one plain file with
// one plain output does not.
bool is_batch(const std::vector<std::string>& inputs, const std::string& output);

// The files in the order of the words, those of a pattern or folder by name, each once, with what they are to become.
// A word that names a file is that file even if it looks like a pattern. An output that names a folder (it exists, or
// ends in "/") stands for FOLDER/{name}.crb. Nothing is read or written. Throws UsageError for an output that is
// neither folder nor template, a placeholder there is not, an ending that is not written, and two inputs that would
// become the same file; InputError for a pattern or folder without atoms files.
std::vector<PreprocessJob> plan_batch(const std::vector<std::string>& inputs, const std::string& output);

}  // namespace atomesh::cli
