// A short name for the content of a file: equal for equal bytes, whatever the file is called and when it was written.
#pragma once

#include <string>
#include <string_view>

#include "core/progress.h"

namespace atomesh {

// "xxh3-128:" and 32 hexadecimal digits. Tells files apart that differ by accident or by work done on them, not files
// made on purpose to have the same hash.
std::string content_hash(std::string_view bytes, Progress& progress = no_progress());

// The same of a file. Throws InputError when it cannot be read.
std::string content_hash_of_file(const std::string& path, Progress& progress = no_progress());

}  // namespace atomesh
