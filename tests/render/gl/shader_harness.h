// What tests of shaders share: a function of GLSL evaluated for many inputs, and segments of rays and colour maps to
// put through it.
#pragma once

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <array>
#include <span>
#include <string>
#include <vector>

#include "core/color_map.h"
#include "render/gl/objects.h"

namespace atomesh::gl {

// A compute shader that puts every input, four floats, through a function. Of one context, which is current whenever
// anything of it is called, the destructor included. Storage buffers from place 2 on are the caller's.
class ShaderFunction {
 public:
  // GLSL behind #version, which has `vec4 result_of(vec4 given)`. A driver that does not take it, or has something to
  // say about it, fails the test.
  explicit ShaderFunction(const std::string& source) {
    const std::string whole = "#version 430 core\n" + source + R"glsl(
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Inputs { vec4 inputs[]; };
layout(std430, binding = 1) writeonly buffer Results { vec4 results[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < inputs.length()) results[i] = result_of(inputs[i]);
})glsl";
    const char* text = whole.c_str();
    program_ = glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &text);
    std::array<char, 4096> log{};
    glGetProgramInfoLog(program_, static_cast<GLsizei>(log.size()), nullptr, log.data());
    EXPECT_STREQ(log.data(), "");
  }
  ~ShaderFunction() { glDeleteProgram(program_); }
  ShaderFunction(const ShaderFunction&) = delete;
  ShaderFunction& operator=(const ShaderFunction&) = delete;

  template <class Input>
  std::vector<Vec4f> operator()(const std::vector<Input>& inputs) const {
    static_assert(sizeof(Input) == sizeof(Vec4f));
    Buffer in;
    Buffer out;
    in.write(std::span<const Input>(inputs));
    out.reserve(inputs.size() * sizeof(Vec4f));
    in.bind_storage(0);
    out.bind_storage(1);
    glUseProgram(program_);
    glDispatchCompute(static_cast<GLuint>((inputs.size() + 63) / 64), 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    return out.read<Vec4f>(inputs.size());
  }

 private:
  GLuint program_ = 0;
};

// Of a ray in a cell, as shaders are given it.
struct Segment {
  float near = 0.0F;  // scalar
  float far = 0.0F;
  float length = 0.0F;  // Å
  float row = 0.0F;     // of MapRamps::rows(), for who reads them
};

struct NamedMap {
  std::string name;
  ColorMap map;
};

// Smooth and sharp ones, and `more`. Knots are floats, so that the judge has them where shaders have them.
inline std::vector<NamedMap> segment_maps(const NamedMap& more) {
  const Vec4f red(1, 0, 0, 1);
  const Vec4f green(0, 1, 0, 0.5);
  const Vec4f blue(0, 0, 1, 0);
  std::vector<NamedMap> all{
      {"gray", preset_color_map("gray")},
      {"viridis", preset_color_map("viridis")},
      {"figure 5.8", preset_color_map("seed-figure-5.8")},
      {"jumps", {{{0.25, blue}, {0.25, red}, {0.5, red}, {0.5, green}, {0.75, green}, {0.75, blue}}}},
      {"windows", {{{0.0, blue}, {0.3, blue}, {0.4, red}, {0.5, blue}, {0.8, blue}, {1.0, green}}}},
      more};
  for (NamedMap& map : all) {
    for (ColorMapEntry& entry : map.map.entries) entry.scalar = static_cast<double>(static_cast<float>(entry.scalar));
  }
  return all;
}

}  // namespace atomesh::gl
