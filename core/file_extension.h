// What kind of file a name says it is.
#pragma once

#include <string>

namespace atomesh {

// The last extension of a path with its dot, ASCII letters in lower case: ".vtu" of "A.b/C.VTU"; "" where it has none.
std::string lower_extension(const std::string& path);

}  // namespace atomesh
