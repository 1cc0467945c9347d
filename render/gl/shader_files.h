// The texts of render/gl/shaders/, inside the program: nothing is looked for where it runs.
#pragma once

#include <span>
#include <string_view>

namespace atomesh::gl {

struct ShaderFile {
  std::string_view name;  // "blend.frag"
  std::string_view text;
};

// Made by CMake from the files (render/gl/CMakeLists.txt).
extern const std::span<const ShaderFile> shader_files;

}  // namespace atomesh::gl
