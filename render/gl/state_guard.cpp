#include "render/gl/state_guard.h"

namespace atomesh::gl {

namespace {

GLint integer(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

// A buffer that was bound may be gone: deleted by a context that shares its objects, or only kept by being bound.
GLuint living_buffer(GLint value) {
  return value != 0 && glIsBuffer(static_cast<GLuint>(value)) == GL_TRUE ? static_cast<GLuint>(value) : 0;
}

}  // namespace

StorageGuard::StorageGuard() : buffer_(integer(GL_SHADER_STORAGE_BUFFER_BINDING)) {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const auto n = static_cast<GLuint>(i);
    glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, n, &places_[i].buffer);
    glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_START, n, &places_[i].start);
    glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_SIZE, n, &places_[i].size);
  }
}

StorageGuard::~StorageGuard() {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Place& place = places_[i];
    const auto n = static_cast<GLuint>(i);
    const GLuint buffer = living_buffer(place.buffer);
    if (buffer != 0 && place.size != 0) {
      glBindBufferRange(GL_SHADER_STORAGE_BUFFER, n, buffer, static_cast<GLintptr>(place.start),
                        static_cast<GLsizeiptr>(place.size));
    } else {
      glBindBufferBase(GL_SHADER_STORAGE_BUFFER, n, buffer);
    }
  }
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, living_buffer(buffer_));
}

StateGuard::StateGuard() {
  for (std::size_t i = 0; i < switches_.size(); ++i) enabled_[i] = glIsEnabled(switches_[i]) == GL_TRUE;
  active_texture_ = integer(GL_ACTIVE_TEXTURE);
  for (std::size_t i = 0; i < units_.size(); ++i) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
    units_[i] = {integer(GL_TEXTURE_BINDING_2D), integer(GL_TEXTURE_BINDING_3D), integer(GL_TEXTURE_BINDING_BUFFER)};
  }
  stencil_[0] = {integer(GL_STENCIL_FUNC),           integer(GL_STENCIL_REF),  integer(GL_STENCIL_VALUE_MASK),
                 integer(GL_STENCIL_WRITEMASK),      integer(GL_STENCIL_FAIL), integer(GL_STENCIL_PASS_DEPTH_FAIL),
                 integer(GL_STENCIL_PASS_DEPTH_PASS)};
  stencil_[1] = {integer(GL_STENCIL_BACK_FUNC),           integer(GL_STENCIL_BACK_REF),
                 integer(GL_STENCIL_BACK_VALUE_MASK),     integer(GL_STENCIL_BACK_WRITEMASK),
                 integer(GL_STENCIL_BACK_FAIL),           integer(GL_STENCIL_BACK_PASS_DEPTH_FAIL),
                 integer(GL_STENCIL_BACK_PASS_DEPTH_PASS)};
  glGetIntegerv(GL_VIEWPORT, viewport_.data());
  glGetIntegerv(GL_SCISSOR_BOX, scissor_.data());
  blend_functions_ = {integer(GL_BLEND_SRC_RGB), integer(GL_BLEND_DST_RGB), integer(GL_BLEND_SRC_ALPHA),
                      integer(GL_BLEND_DST_ALPHA)};
  blend_equations_ = {integer(GL_BLEND_EQUATION_RGB), integer(GL_BLEND_EQUATION_ALPHA)};
  glGetBooleanv(GL_COLOR_WRITEMASK, color_mask_.data());
  glGetFloatv(GL_COLOR_CLEAR_VALUE, clear_color_.data());
  glGetFloatv(GL_DEPTH_CLEAR_VALUE, &clear_depth_);
  clear_stencil_ = integer(GL_STENCIL_CLEAR_VALUE);
  depth_function_ = integer(GL_DEPTH_FUNC);
  glGetFloatv(GL_DEPTH_RANGE, depth_range_.data());
  glGetBooleanv(GL_DEPTH_WRITEMASK, &depth_mask_);
  draw_framebuffer_ = integer(GL_DRAW_FRAMEBUFFER_BINDING);
  read_framebuffer_ = integer(GL_READ_FRAMEBUFFER_BINDING);
  program_ = integer(GL_CURRENT_PROGRAM);
  vertex_array_ = integer(GL_VERTEX_ARRAY_BINDING);
  array_buffer_ = integer(GL_ARRAY_BUFFER_BINDING);
  indirect_buffer_ = integer(GL_DRAW_INDIRECT_BUFFER_BINDING);
  pack_buffer_ = integer(GL_PIXEL_PACK_BUFFER_BINDING);
  pack_alignment_ = integer(GL_PACK_ALIGNMENT);
  unpack_buffer_ = integer(GL_PIXEL_UNPACK_BUFFER_BINDING);
  unpack_alignment_ = integer(GL_UNPACK_ALIGNMENT);
  unpack_row_length_ = integer(GL_UNPACK_ROW_LENGTH);
}

StateGuard::~StateGuard() {
  const auto name = [](GLint value) { return static_cast<GLuint>(value); };
  // What was bound may be gone: deleted by a context that shares its objects, or only kept by being bound.
  const auto living = [&](GLint value, auto&& is) {
    return value != 0 && is(name(value)) == GL_TRUE ? name(value) : GLuint{0};
  };
  const auto texture = [&](GLint value) { return living(value, [](GLuint n) { return glIsTexture(n); }); };
  for (std::size_t i = 0; i < switches_.size(); ++i) (enabled_[i] ? glEnable : glDisable)(switches_[i]);
  for (std::size_t i = 0; i < units_.size(); ++i) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
    glBindTexture(GL_TEXTURE_2D, texture(units_[i].texture_2d));
    glBindTexture(GL_TEXTURE_3D, texture(units_[i].texture_3d));
    glBindTexture(GL_TEXTURE_BUFFER, texture(units_[i].texture_buffer));
  }
  glActiveTexture(name(active_texture_));
  for (std::size_t i = 0; i < stencil_.size(); ++i) {
    const StencilSide& side = stencil_[i];
    const GLenum face = i == 0 ? GL_FRONT : GL_BACK;
    glStencilFuncSeparate(face, name(side.function), side.reference, name(side.compare_mask));
    glStencilMaskSeparate(face, name(side.write_mask));
    glStencilOpSeparate(face, name(side.fail), name(side.depth_fail), name(side.pass));
  }
  glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
  glScissor(scissor_[0], scissor_[1], scissor_[2], scissor_[3]);
  glBlendFuncSeparate(name(blend_functions_[0]), name(blend_functions_[1]), name(blend_functions_[2]),
                      name(blend_functions_[3]));
  glBlendEquationSeparate(name(blend_equations_[0]), name(blend_equations_[1]));
  glColorMask(color_mask_[0], color_mask_[1], color_mask_[2], color_mask_[3]);
  glClearColor(clear_color_[0], clear_color_[1], clear_color_[2], clear_color_[3]);
  glClearDepth(static_cast<GLdouble>(clear_depth_));
  glClearStencil(clear_stencil_);
  glDepthFunc(name(depth_function_));
  glDepthRangef(depth_range_[0], depth_range_[1]);
  glDepthMask(depth_mask_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name(draw_framebuffer_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, name(read_framebuffer_));
  glUseProgram(living(program_, [](GLuint n) { return glIsProgram(n); }));
  glBindVertexArray(name(vertex_array_));
  glBindBuffer(GL_ARRAY_BUFFER, living_buffer(array_buffer_));
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, living_buffer(indirect_buffer_));
  glBindBuffer(GL_PIXEL_PACK_BUFFER, living_buffer(pack_buffer_));
  glPixelStorei(GL_PACK_ALIGNMENT, pack_alignment_);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, name(unpack_buffer_));
  glPixelStorei(GL_UNPACK_ALIGNMENT, unpack_alignment_);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, unpack_row_length_);
}

}  // namespace atomesh::gl
