// OpenGL's buffers, textures and targets as GpuScene uses them. 0 is none; deleting none is nothing. All calls with the
// context current and VTK's function pointers loaded.
#pragma once

#include <cstddef>

class vtkOpenGLRenderWindow;
class vtkShaderProgram;

namespace atomesh::gui {

// Throws UnavailableError when the card has no room.
unsigned make_buffer(const void* bytes, std::size_t size);
void delete_buffer(unsigned& buffer);
// Of the vertex array that is bound: three floats of the buffer for each vertex. What the program does not use is left
// out.
void set_attribute(vtkShaderProgram& program, const char* name, unsigned buffer);
void delete_vertex_array(unsigned& array);

// The floats of a buffer for texelFetch().
unsigned make_buffer_texture(unsigned buffer);
std::size_t largest_buffer_texture();  // floats
void delete_texture(unsigned& texture);
// Textures of the shaders' samplers, which are told the unit's number.
void bind_texture(vtkOpenGLRenderWindow& window, unsigned unit, unsigned texture);
void bind_buffer_texture(vtkOpenGLRenderWindow& window, unsigned unit, unsigned texture);

// A texture to draw into: balls and their depths (GL_R32UI, GL_DEPTH_COMPONENT32F), or light (GL_RGBA32F).
class GpuTarget {
 public:
  enum class Kind { balls, light };
  explicit GpuTarget(Kind kind) : kind_(kind) {}
  // Of this size, made anew where it is not. Throws UnavailableError when the card has no room.
  void resize(vtkOpenGLRenderWindow& window, int width, int height);
  // To be drawn into from now on, whole.
  void bind(vtkOpenGLRenderWindow& window) const;
  // To no ball, farthest, or no light. It is bound.
  void clear(vtkOpenGLRenderWindow& window) const;
  unsigned texture() const { return texture_; }
  unsigned depths() const { return depths_; }
  void release();

 private:
  Kind kind_;
  int width_ = 0;
  int height_ = 0;
  unsigned framebuffer_ = 0;
  unsigned texture_ = 0;
  unsigned depths_ = 0;
};

}  // namespace atomesh::gui
