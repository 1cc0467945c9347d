#include "app/gui/gpu_buffers.h"

#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkShaderProgram.h>
#include <vtk_glew.h>

#include <array>
#include <string>

#include "core/error.h"

namespace atomesh::gui {

namespace {

[[noreturn]] void no_room(std::size_t bytes) {
  throw UnavailableError("the graphics card has no room for " + std::to_string(bytes / 1000000 + 1) +
                         " MB more; the CPU can draw it (view options, drawing)");
}

// Whatever went wrong before is not ours.
void forget_errors() {
  for (int i = 0; i < 100 && glGetError() != GL_NO_ERROR; ++i) {
  }
}

unsigned make_texture(GLenum inner, GLenum outer, GLenum type, int width, int height) {
  unsigned texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(inner), width, height, 0, outer, type, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glBindTexture(GL_TEXTURE_2D, 0);
  return texture;
}

}  // namespace

unsigned make_buffer(const void* bytes, std::size_t size) {
  forget_errors();
  unsigned buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(size), bytes, GL_STATIC_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
  if (glGetError() != GL_NO_ERROR) {
    glDeleteBuffers(1, &buffer);
    no_room(size);
  }
  return buffer;
}

void delete_buffer(unsigned& buffer) {
  if (buffer != 0) glDeleteBuffers(1, &buffer);
  buffer = 0;
}

void set_attribute(vtkShaderProgram& program, const char* name, unsigned buffer) {
  const GLint location = glGetAttribLocation(static_cast<GLuint>(program.GetHandle()), name);
  if (location < 0) return;
  const auto at = static_cast<GLuint>(location);
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glEnableVertexAttribArray(at);
  glVertexAttribPointer(at, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void delete_vertex_array(unsigned& array) {
  if (array != 0) glDeleteVertexArrays(1, &array);
  array = 0;
}

unsigned make_buffer_texture(unsigned buffer) {
  unsigned texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_BUFFER, texture);
  glTexBuffer(GL_TEXTURE_BUFFER, GL_R32F, buffer);
  glBindTexture(GL_TEXTURE_BUFFER, 0);
  return texture;
}

std::size_t largest_buffer_texture() {
  GLint most = 65536;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  return static_cast<std::size_t>(most);
}

void delete_texture(unsigned& texture) {
  if (texture != 0) glDeleteTextures(1, &texture);
  texture = 0;
}

void bind_texture(vtkOpenGLRenderWindow& window, unsigned unit, unsigned texture) {
  window.GetState()->vtkglActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_2D, texture);
}

void bind_buffer_texture(vtkOpenGLRenderWindow& window, unsigned unit, unsigned texture) {
  window.GetState()->vtkglActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_BUFFER, texture);
}

void GpuTarget::resize(vtkOpenGLRenderWindow& window, int width, int height) {
  if (framebuffer_ != 0 && width == width_ && height == height_) return;
  release();
  width_ = width;
  height_ = height;
  forget_errors();
  vtkOpenGLState& state = *window.GetState();
  state.vtkglActiveTexture(GL_TEXTURE0);
  if (kind_ == Kind::balls) {
    texture_ = make_texture(GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, width, height);
    depths_ = make_texture(GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, width, height);
  } else {
    texture_ = make_texture(GL_RGBA32F, GL_RGBA, GL_FLOAT, width, height);
  }
  glGenFramebuffers(1, &framebuffer_);
  state.PushFramebufferBindings();
  state.vtkglBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
  if (depths_ != 0) glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depths_, 0);
  const bool complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  state.PopFramebufferBindings();
  if (complete && glGetError() == GL_NO_ERROR) return;
  release();
  no_room(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * (kind_ == Kind::balls ? 8 : 16));
}

void GpuTarget::bind(vtkOpenGLRenderWindow& window) const {
  vtkOpenGLState& state = *window.GetState();
  state.vtkglBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  state.vtkglViewport(0, 0, width_, height_);
  state.vtkglDisable(GL_SCISSOR_TEST);
}

void GpuTarget::clear(vtkOpenGLRenderWindow& window) const {
  if (kind_ == Kind::balls) {
    const std::array<GLuint, 4> none{0xFFFFFFFFU, 0, 0, 0};
    const GLfloat farthest = 1.0F;
    window.GetState()->vtkglDepthMask(GL_TRUE);
    glClearBufferuiv(GL_COLOR, 0, none.data());
    glClearBufferfv(GL_DEPTH, 0, &farthest);
  } else {
    const std::array<GLfloat, 4> none{};
    glClearBufferfv(GL_COLOR, 0, none.data());
  }
}

void GpuTarget::release() {
  if (framebuffer_ != 0) glDeleteFramebuffers(1, &framebuffer_);
  framebuffer_ = 0;
  delete_texture(texture_);
  delete_texture(depths_);
  width_ = height_ = 0;
}

}  // namespace atomesh::gui
