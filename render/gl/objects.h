// OpenGL's objects as values that give back what they hold. All of it, destructors included, with the context current
// that made them.
#pragma once

#include <epoxy/gl.h>

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace atomesh::gl {

// The name of an object, 0 for none.
template <void (*destroy)(GLuint)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(GLuint name) : name_(name) {}
  Handle(Handle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~Handle() {
    if (name_ != 0) destroy(name_);
  }
  GLuint name() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  GLuint name_ = 0;
};

namespace detail {
inline void destroy_buffer(GLuint name) {
  glDeleteBuffers(1, &name);
}
inline void destroy_texture(GLuint name) {
  glDeleteTextures(1, &name);
}
inline void destroy_framebuffer(GLuint name) {
  glDeleteFramebuffers(1, &name);
}
inline void destroy_vertex_array(GLuint name) {
  glDeleteVertexArrays(1, &name);
}
inline void destroy_query(GLuint name) {
  glDeleteQueries(1, &name);
}
inline void destroy_program(GLuint name) {
  glDeleteProgram(name);
}
}  // namespace detail

using Framebuffer = Handle<detail::destroy_framebuffer>;
using VertexArray = Handle<detail::destroy_vertex_array>;
using Query = Handle<detail::destroy_query>;

Framebuffer make_framebuffer();
VertexArray make_vertex_array();
Query make_query();

// Bytes on the card.
class Buffer {
 public:
  Buffer() = default;
  GLuint name() const { return handle_.name(); }
  std::size_t bytes() const { return bytes_; }

  // At least so many bytes; what was in it is lost where it has to grow. `usage` as glBufferData's.
  void reserve(std::size_t bytes, GLenum usage = GL_DYNAMIC_DRAW);
  // Exactly these bytes from the start; grows where needed.
  template <class T>
  void write(std::span<const T> values, GLenum usage = GL_DYNAMIC_DRAW) {
    write_bytes(values.data(), values.size_bytes(), usage);
  }
  // `count` values from the byte `offset`; waits for the card.
  template <class T>
  std::vector<T> read(std::size_t count, std::size_t offset = 0) const {
    std::vector<T> values(count);
    read_bytes(values.data(), values.size() * sizeof(T), offset);
    return values;
  }
  void bind_storage(GLuint place) const;  // all of it, as the shader storage buffer of that binding
  void bind_uniform(GLuint place) const;

 private:
  void write_bytes(const void* data, std::size_t bytes, GLenum usage);
  void read_bytes(void* data, std::size_t bytes, std::size_t offset) const;

  Handle<detail::destroy_buffer> handle_;
  std::size_t bytes_ = 0;
};

// A texture of one level with storage that does not change.
class Texture {
 public:
  Texture() = default;
  // Nearest, clamped to its edges.
  static Texture make_2d(GLenum internal_format, int width, int height);
  // Linear, clamped to its edges.
  static Texture make_3d(GLenum internal_format, int width, int height, int depth);

  GLuint name() const { return handle_.name(); }
  GLenum target() const { return target_; }
  int width() const { return width_; }
  int height() const { return height_; }
  int depth() const { return depth_; }
  void bind(GLuint unit) const;  // as the texture of that unit

 private:
  Handle<detail::destroy_texture> handle_;
  GLenum target_ = GL_TEXTURE_2D;
  int width_ = 0;
  int height_ = 0;
  int depth_ = 0;
};

// A buffer whose texels, of four floats each, shaders fetch by their number (samplerBuffer).
class BufferTexture {
 public:
  BufferTexture() = default;
  // Exactly these values from the first texel on; grows where needed. A value is one texel or several.
  template <class T>
  void write(std::span<const T> values, GLenum usage = GL_DYNAMIC_DRAW) {
    static_assert(sizeof(T) % (4 * sizeof(float)) == 0);
    buffer_.write(values, usage);
    attach();
  }
  explicit operator bool() const { return static_cast<bool>(handle_); }  // whether anything was written
  void bind(GLuint unit) const;                                          // as the texture of that unit

 private:
  void attach();

  Buffer buffer_;
  Handle<detail::destroy_texture> handle_;
};

// A source of render/gl/shaders/, by its file's name, with the others it includes (#include "name") in place. Error for
// a name there is not.
std::string shader_source(std::string_view file);

// A linked program. Stages are files of render/gl/shaders/; each begins without #version: that line, then one
// "#define NAME VALUE" for each of `defines` ("NAME" or "NAME VALUE"), then the source.
class Program {
 public:
  Program() = default;
  static Program draw(std::string_view vertex_file, std::string_view fragment_file,
                      std::span<const std::string> defines = {});
  static Program compute(std::string_view file, std::span<const std::string> defines = {});

  GLuint name() const { return handle_.name(); }
  explicit operator bool() const { return static_cast<bool>(handle_); }
  void use() const;
  // -1 where the program has no such uniform (the compiler leaves out what nothing reads), which setting ignores.
  GLint uniform(const char* name) const { return glGetUniformLocation(handle_.name(), name); }

 private:
  explicit Program(std::span<const std::pair<GLenum, std::string>> stages);

  Handle<detail::destroy_program> handle_;
};

// Runs the compute shader in use in at least so many work groups, in rows: group n is the one with n =
// gl_WorkGroupID.y · gl_NumWorkGroups.x + gl_WorkGroupID.x, and those beyond have nothing to do.
void dispatch(std::size_t groups);

}  // namespace atomesh::gl
