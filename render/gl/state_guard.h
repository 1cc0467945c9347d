// OpenGL's state as whoever owns the context left it.
#pragma once

#include <epoxy/gl.h>

#include <array>

namespace atomesh::gl {

// Restores on destruction the storage buffers that render/gl binds, places 0 to 7.
class StorageGuard {
 public:
  StorageGuard();
  ~StorageGuard();
  StorageGuard(const StorageGuard&) = delete;
  StorageGuard& operator=(const StorageGuard&) = delete;

 private:
  struct Place {
    GLint buffer = 0;
    GLint64 start = 0;
    GLint64 size = 0;  // 0: all of it
  };
  std::array<Place, 8> places_{};
  GLint buffer_ = 0;  // of no place
};

// Restores on destruction what drawing a volume changes: framebuffer, viewport, scissor, program, vertex array,
// blending, depth and stencil test, masks, clear values, buffers (storage too) and the textures of units 0 to
// texture_units - 1.
class StateGuard {
 public:
  StateGuard();
  ~StateGuard();
  StateGuard(const StateGuard&) = delete;
  StateGuard& operator=(const StateGuard&) = delete;

 private:
  static constexpr int texture_units = 10;
  static constexpr std::array<GLenum, 8> switches_{GL_BLEND,     GL_DEPTH_TEST,  GL_STENCIL_TEST, GL_SCISSOR_TEST,
                                                   GL_CULL_FACE, GL_DEPTH_CLAMP, GL_DITHER,       GL_MULTISAMPLE};
  std::array<bool, switches_.size()> enabled_{};
  struct Unit {
    GLint texture_2d = 0;
    GLint texture_3d = 0;
    GLint texture_buffer = 0;
  };
  std::array<Unit, texture_units> units_{};
  struct StencilSide {
    GLint function = 0, reference = 0, compare_mask = 0, write_mask = 0, fail = 0, depth_fail = 0, pass = 0;
  };
  std::array<StencilSide, 2> stencil_{};  // front, back
  std::array<GLint, 4> viewport_{};
  std::array<GLint, 4> scissor_{};
  std::array<GLint, 4> blend_functions_{};  // RGB source and destination, alpha source and destination
  std::array<GLint, 2> blend_equations_{};
  std::array<GLboolean, 4> color_mask_{};
  std::array<GLfloat, 4> clear_color_{};
  GLfloat clear_depth_ = 1.0F;
  GLint clear_stencil_ = 0;
  GLint depth_function_ = 0;
  std::array<GLfloat, 2> depth_range_{};
  GLboolean depth_mask_ = GL_TRUE;
  GLint draw_framebuffer_ = 0;
  GLint read_framebuffer_ = 0;
  GLint program_ = 0;
  GLint vertex_array_ = 0;
  GLint array_buffer_ = 0;
  GLint indirect_buffer_ = 0;
  StorageGuard storage_;
  GLint pack_buffer_ = 0;
  GLint pack_alignment_ = 4;
  GLint unpack_buffer_ = 0;
  GLint unpack_alignment_ = 4;
  GLint unpack_row_length_ = 0;
  GLint active_texture_ = 0;
};

}  // namespace atomesh::gl
