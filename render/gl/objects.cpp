#include "render/gl/objects.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "render/gl/shader_files.h"

namespace atomesh::gl {

namespace {

// 4.3 is what render/gl asks for everywhere else; the interlock's extension is written against 4.5.
constexpr std::string_view version_line = "#version 430 core\n";
constexpr std::string_view interlock_lines =
    "#version 450 core\n#extension GL_ARB_fragment_shader_interlock : require\n";

std::string log_of(GLuint object, decltype(glGetShaderiv) ask, decltype(glGetShaderInfoLog) get) {
  GLint length = 0;
  ask(object, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 0)), '\0');
  if (length > 0) get(object, length, nullptr, log.data());
  while (!log.empty() && (log.back() == '\0' || log.back() == '\n')) log.pop_back();
  return log;
}

std::string with_defines(std::string_view file, std::span<const std::string> defines) {
  // Extensions have to stand before anything else, so that a file asks for them by a define.
  const bool interlock = std::ranges::find(defines, "INTERLOCK") != defines.end();
  std::string source(interlock ? interlock_lines : version_line);
  for (const std::string& define : defines) source += "#define " + define + "\n";
  return source + shader_source(file);
}

}  // namespace

Framebuffer make_framebuffer() {
  GLuint name = 0;
  glGenFramebuffers(1, &name);
  return Framebuffer(name);
}

VertexArray make_vertex_array() {
  GLuint name = 0;
  glGenVertexArrays(1, &name);
  return VertexArray(name);
}

Query make_query() {
  GLuint name = 0;
  glGenQueries(1, &name);
  return Query(name);
}

void Buffer::reserve(std::size_t bytes, GLenum usage) {
  if (handle_ && bytes <= bytes_) return;
  if (!handle_) {
    GLuint name = 0;
    glGenBuffers(1, &name);
    handle_ = Handle<detail::destroy_buffer>(name);
  }
  // GL_COPY_WRITE_BUFFER: no other binding is disturbed.
  glBindBuffer(GL_COPY_WRITE_BUFFER, handle_.name());
  glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(std::max<std::size_t>(bytes, 16)), nullptr, usage);
  glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
  bytes_ = bytes;
}

void Buffer::write_bytes(const void* data, std::size_t bytes, GLenum usage) {
  reserve(bytes, usage);
  if (bytes == 0) return;
  glBindBuffer(GL_COPY_WRITE_BUFFER, handle_.name());
  glBufferSubData(GL_COPY_WRITE_BUFFER, 0, static_cast<GLsizeiptr>(bytes), data);
  glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
}

void Buffer::read_bytes(void* data, std::size_t bytes, std::size_t offset) const {
  if (bytes == 0) return;
  glBindBuffer(GL_COPY_READ_BUFFER, handle_.name());
  glGetBufferSubData(GL_COPY_READ_BUFFER, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
  glBindBuffer(GL_COPY_READ_BUFFER, 0);
}

void Buffer::bind_storage(GLuint place) const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, place, handle_.name());
}

void Buffer::bind_uniform(GLuint place) const {
  glBindBufferBase(GL_UNIFORM_BUFFER, place, handle_.name());
}

Texture Texture::make_2d(GLenum internal_format, int width, int height) {
  Texture texture;
  GLuint name = 0;
  glGenTextures(1, &name);
  texture.handle_ = Handle<detail::destroy_texture>(name);
  texture.width_ = width;
  texture.height_ = height;
  texture.depth_ = 1;
  glBindTexture(GL_TEXTURE_2D, name);
  glTexStorage2D(GL_TEXTURE_2D, 1, internal_format, width, height);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glBindTexture(GL_TEXTURE_2D, 0);
  return texture;
}

Texture Texture::make_3d(GLenum internal_format, int width, int height, int depth) {
  Texture texture;
  GLuint name = 0;
  glGenTextures(1, &name);
  texture.handle_ = Handle<detail::destroy_texture>(name);
  texture.target_ = GL_TEXTURE_3D;
  texture.width_ = width;
  texture.height_ = height;
  texture.depth_ = depth;
  glBindTexture(GL_TEXTURE_3D, name);
  glTexStorage3D(GL_TEXTURE_3D, 1, internal_format, width, height, depth);
  glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
  glBindTexture(GL_TEXTURE_3D, 0);
  return texture;
}

void Texture::bind(GLuint unit) const {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(target_, handle_.name());
}

void BufferTexture::attach() {
  if (!handle_) {
    GLuint name = 0;
    glGenTextures(1, &name);
    handle_ = Handle<detail::destroy_texture>(name);
  }
  glBindTexture(GL_TEXTURE_BUFFER, handle_.name());
  glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, buffer_.name());
  glBindTexture(GL_TEXTURE_BUFFER, 0);
}

void BufferTexture::bind(GLuint unit) const {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_BUFFER, handle_.name());
}

std::string shader_source(std::string_view file) {
  const auto found = std::find_if(shader_files.begin(), shader_files.end(),
                                  [file](const ShaderFile& shader) { return shader.name == file; });
  if (found == shader_files.end()) throw Error("there is no shader " + std::string(file));
  constexpr std::string_view include = "#include \"";
  std::string source;
  std::string_view rest = found->text;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    if (line.substr(0, include.size()) == include) {
      const std::string_view name = line.substr(include.size());
      source += shader_source(name.substr(0, name.find('"')));
    } else {
      source += line;
      source += '\n';
    }
    rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
  }
  return source;
}

Program::Program(std::span<const std::pair<GLenum, std::string>> stages) : handle_(glCreateProgram()) {
  std::vector<GLuint> shaders;
  std::string failed;
  for (const auto& [stage, source] : stages) {
    const GLuint shader = glCreateShader(stage);
    shaders.push_back(shader);
    const char* text = source.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (compiled == GL_FALSE) failed += log_of(shader, glGetShaderiv, glGetShaderInfoLog) + "\n";
    glAttachShader(handle_.name(), shader);
  }
  if (failed.empty()) {
    glLinkProgram(handle_.name());
    GLint linked = GL_FALSE;
    glGetProgramiv(handle_.name(), GL_LINK_STATUS, &linked);
    if (linked == GL_FALSE) failed = log_of(handle_.name(), glGetProgramiv, glGetProgramInfoLog) + "\n";
  }
  for (const GLuint shader : shaders) glDeleteShader(shader);
  if (!failed.empty()) {
    const GLubyte* renderer = glGetString(GL_RENDERER);
    throw UnavailableError("OpenGL: the driver \"" +
                           std::string(renderer != nullptr ? reinterpret_cast<const char*>(renderer) : "") +
                           "\" does not take a shader:\n" + failed);
  }
}

Program Program::draw(std::string_view vertex_file, std::string_view fragment_file,
                      std::span<const std::string> defines) {
  const std::array<std::pair<GLenum, std::string>, 2> stages{
      {{GL_VERTEX_SHADER, with_defines(vertex_file, defines)},
       {GL_FRAGMENT_SHADER, with_defines(fragment_file, defines)}}};
  return Program(stages);
}

Program Program::compute(std::string_view file, std::span<const std::string> defines) {
  const std::array<std::pair<GLenum, std::string>, 1> stages{{{GL_COMPUTE_SHADER, with_defines(file, defines)}}};
  return Program(stages);
}

void Program::use() const {
  glUseProgram(handle_.name());
}

void dispatch(std::size_t groups) {
  constexpr std::size_t most_groups = 65535;  // along a dimension, what every driver has
  const std::size_t rows = std::max<std::size_t>((groups + most_groups - 1) / most_groups, 1);
  glDispatchCompute(static_cast<GLuint>((groups + rows - 1) / rows), static_cast<GLuint>(rows), 1);
}

}  // namespace atomesh::gl
