// The words of the .dat grammar that no species can have as its name. Shared by its reader and its writer.
#pragma once

#include <string_view>

namespace atomesh {

inline bool is_dat_word(std::string_view name) {
  return name == "primitive" || name == "basis" || name == "radius" || name == "box" || name == "origin";
}

}  // namespace atomesh
