#include "render/gl/state_guard.h"

namespace atomesh::gl {

namespace {

GLint integer(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

GLint integer_at(GLenum name, GLuint place) {
  GLint value = 0;
  glGetIntegeri_v(name, place, &value);
  return value;
}

// For names of objects and of constants.
GLuint unsigned_of(GLint value) {
  return static_cast<GLuint>(value);
}

// What was bound may be gone: deleted by a context that shares its objects, or only kept by being bound.
template <class Is>
GLuint living(GLint value, Is&& is) {
  return value != 0 && is(unsigned_of(value)) == GL_TRUE ? unsigned_of(value) : 0;
}
GLuint living_buffer(GLint value) {
  return living(value, [](GLuint n) { return glIsBuffer(n); });
}
GLuint living_texture(GLint value) {
  return living(value, [](GLuint n) { return glIsTexture(n); });
}

struct PlaceNames {
  GLenum target, buffer, start, size;
};
constexpr PlaceNames storage_names{GL_SHADER_STORAGE_BUFFER, GL_SHADER_STORAGE_BUFFER_BINDING,
                                   GL_SHADER_STORAGE_BUFFER_START, GL_SHADER_STORAGE_BUFFER_SIZE};
constexpr PlaceNames uniform_names{GL_UNIFORM_BUFFER, GL_UNIFORM_BUFFER_BINDING, GL_UNIFORM_BUFFER_START,
                                   GL_UNIFORM_BUFFER_SIZE};

BufferPlace buffer_at(const PlaceNames& names, GLuint place) {
  BufferPlace found;
  found.buffer = integer_at(names.buffer, place);
  glGetInteger64i_v(names.start, place, &found.start);
  glGetInteger64i_v(names.size, place, &found.size);
  return found;
}

void bind_at(const PlaceNames& names, GLuint place, const BufferPlace& was) {
  const GLuint buffer = living_buffer(was.buffer);
  if (buffer != 0 && was.size != 0) {
    glBindBufferRange(names.target, place, buffer, static_cast<GLintptr>(was.start), static_cast<GLsizeiptr>(was.size));
  } else {
    glBindBufferBase(names.target, place, buffer);
  }
}

void turn(GLenum what, bool on) {
  (on ? glEnable : glDisable)(what);
}

}  // namespace

StorageGuard::StorageGuard() : buffer_(integer(GL_SHADER_STORAGE_BUFFER_BINDING)) {
  for (std::size_t i = 0; i < places_.size(); ++i) places_[i] = buffer_at(storage_names, static_cast<GLuint>(i));
}

StorageGuard::~StorageGuard() {
  for (std::size_t i = 0; i < places_.size(); ++i) bind_at(storage_names, static_cast<GLuint>(i), places_[i]);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, living_buffer(buffer_));
}

void StateGuard::save_fragment_tests() {
  for (std::size_t i = 0; i < switches_.size(); ++i) enabled_[i] = glIsEnabled(switches_[i]) == GL_TRUE;
  for (std::size_t i = 0; i < viewports_.size(); ++i) {
    const auto n = static_cast<GLuint>(i);
    Viewport& viewport = viewports_[i];
    glGetFloati_v(GL_VIEWPORT, n, viewport.rectangle.data());
    glGetIntegeri_v(GL_SCISSOR_BOX, n, viewport.scissor.data());
    glGetDoublei_v(GL_DEPTH_RANGE, n, viewport.depths.data());
    viewport.scissored = glIsEnabledi(GL_SCISSOR_TEST, n);
  }
  for (std::size_t i = 0; i < draw_buffers_.size(); ++i) {
    const auto n = static_cast<GLuint>(i);
    DrawBuffer& buffer = draw_buffers_[i];
    buffer.functions = {integer_at(GL_BLEND_SRC_RGB, n), integer_at(GL_BLEND_DST_RGB, n),
                        integer_at(GL_BLEND_SRC_ALPHA, n), integer_at(GL_BLEND_DST_ALPHA, n)};
    buffer.equations = {integer_at(GL_BLEND_EQUATION_RGB, n), integer_at(GL_BLEND_EQUATION_ALPHA, n)};
    glGetBooleani_v(GL_COLOR_WRITEMASK, n, buffer.mask.data());
    buffer.blended = glIsEnabledi(GL_BLEND, n);
  }
  stencil_[0] = {integer(GL_STENCIL_FUNC),           integer(GL_STENCIL_REF),  integer(GL_STENCIL_VALUE_MASK),
                 integer(GL_STENCIL_WRITEMASK),      integer(GL_STENCIL_FAIL), integer(GL_STENCIL_PASS_DEPTH_FAIL),
                 integer(GL_STENCIL_PASS_DEPTH_PASS)};
  stencil_[1] = {integer(GL_STENCIL_BACK_FUNC),           integer(GL_STENCIL_BACK_REF),
                 integer(GL_STENCIL_BACK_VALUE_MASK),     integer(GL_STENCIL_BACK_WRITEMASK),
                 integer(GL_STENCIL_BACK_FAIL),           integer(GL_STENCIL_BACK_PASS_DEPTH_FAIL),
                 integer(GL_STENCIL_BACK_PASS_DEPTH_PASS)};
  depth_function_ = integer(GL_DEPTH_FUNC);
  glGetBooleanv(GL_DEPTH_WRITEMASK, &depth_mask_);
}

void StateGuard::restore_fragment_tests() const {
  for (std::size_t i = 0; i < switches_.size(); ++i) turn(switches_[i], enabled_[i]);
  for (std::size_t i = 0; i < viewports_.size(); ++i) {
    const auto n = static_cast<GLuint>(i);
    const Viewport& viewport = viewports_[i];
    glViewportIndexedfv(n, viewport.rectangle.data());
    glScissorIndexedv(n, viewport.scissor.data());
    glDepthRangeIndexed(n, viewport.depths[0], viewport.depths[1]);
    (viewport.scissored == GL_TRUE ? glEnablei : glDisablei)(GL_SCISSOR_TEST, n);
  }
  for (std::size_t i = 0; i < draw_buffers_.size(); ++i) {
    const auto n = static_cast<GLuint>(i);
    const DrawBuffer& buffer = draw_buffers_[i];
    glBlendFuncSeparatei(n, unsigned_of(buffer.functions[0]), unsigned_of(buffer.functions[1]),
                         unsigned_of(buffer.functions[2]), unsigned_of(buffer.functions[3]));
    glBlendEquationSeparatei(n, unsigned_of(buffer.equations[0]), unsigned_of(buffer.equations[1]));
    glColorMaski(n, buffer.mask[0], buffer.mask[1], buffer.mask[2], buffer.mask[3]);
    (buffer.blended == GL_TRUE ? glEnablei : glDisablei)(GL_BLEND, n);
  }
  for (std::size_t i = 0; i < stencil_.size(); ++i) {
    const StencilSide& side = stencil_[i];
    const GLenum face = i == 0 ? GL_FRONT : GL_BACK;
    glStencilFuncSeparate(face, unsigned_of(side.function), side.reference, unsigned_of(side.compare_mask));
    glStencilMaskSeparate(face, unsigned_of(side.write_mask));
    glStencilOpSeparate(face, unsigned_of(side.fail), unsigned_of(side.depth_fail), unsigned_of(side.pass));
  }
  glDepthFunc(unsigned_of(depth_function_));
  glDepthMask(depth_mask_);
}

StateGuard::StateGuard() {
  save_fragment_tests();
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    in_the_way_[i] = glIsEnabled(obstacles[i]) == GL_TRUE;
    if (in_the_way_[i]) glDisable(obstacles[i]);
  }
  glGetIntegerv(GL_POLYGON_MODE, polygon_mode_.data());
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  active_texture_ = integer(GL_ACTIVE_TEXTURE);
  for (std::size_t i = 0; i < units_.size(); ++i) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
    units_[i] = {integer(GL_TEXTURE_BINDING_2D), integer(GL_TEXTURE_BINDING_3D), integer(GL_TEXTURE_BINDING_BUFFER),
                 integer(GL_SAMPLER_BINDING)};
    glBindSampler(static_cast<GLuint>(i), 0);
  }
  // Textures are made at the unit that is active: it has to be one of these.
  glActiveTexture(GL_TEXTURE0);
  image_ = {integer_at(GL_IMAGE_BINDING_NAME, 0),    integer_at(GL_IMAGE_BINDING_LEVEL, 0),
            integer_at(GL_IMAGE_BINDING_LAYERED, 0), integer_at(GL_IMAGE_BINDING_LAYER, 0),
            integer_at(GL_IMAGE_BINDING_ACCESS, 0),  integer_at(GL_IMAGE_BINDING_FORMAT, 0)};
  draw_framebuffer_ = integer(GL_DRAW_FRAMEBUFFER_BINDING);
  read_framebuffer_ = integer(GL_READ_FRAMEBUFFER_BINDING);
  program_ = integer(GL_CURRENT_PROGRAM);
  vertex_array_ = integer(GL_VERTEX_ARRAY_BINDING);
  block_ = buffer_at(uniform_names, uniform_block);
  for (std::size_t i = 0; i < buffers_.size(); ++i) buffers_[i] = integer(buffer_targets[i][1]);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  for (std::size_t i = 0; i < pixel_stores.size(); ++i) {
    pixel_stores_[i] = integer(pixel_stores[i].name);
    glPixelStorei(pixel_stores[i].name, pixel_stores[i].usual);
  }
}

StateGuard::~StateGuard() {
  restore_fragment_tests();
  for (std::size_t i = 0; i < obstacles.size(); ++i) turn(obstacles[i], in_the_way_[i]);
  const auto [front, back] = polygon_mode_;
  // Only compatibility profiles know two, or have both asked for by one name.
  glPolygonMode(back == 0 || back == front ? GL_FRONT_AND_BACK : GL_FRONT, unsigned_of(front));
  if (back != 0 && back != front) glPolygonMode(GL_BACK, unsigned_of(back));
  for (std::size_t i = 0; i < units_.size(); ++i) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
    glBindTexture(GL_TEXTURE_2D, living_texture(units_[i].texture_2d));
    glBindTexture(GL_TEXTURE_3D, living_texture(units_[i].texture_3d));
    glBindTexture(GL_TEXTURE_BUFFER, living_texture(units_[i].texture_buffer));
    glBindSampler(static_cast<GLuint>(i), living(units_[i].sampler, [](GLuint n) { return glIsSampler(n); }));
  }
  glActiveTexture(unsigned_of(active_texture_));
  glBindImageTexture(0, living_texture(image_.texture), image_.level, image_.layered != 0 ? GL_TRUE : GL_FALSE,
                     image_.layer, unsigned_of(image_.access), unsigned_of(image_.format));
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, unsigned_of(draw_framebuffer_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, unsigned_of(read_framebuffer_));
  glUseProgram(living(program_, [](GLuint n) { return glIsProgram(n); }));
  glBindVertexArray(unsigned_of(vertex_array_));
  bind_at(uniform_names, uniform_block, block_);
  for (std::size_t i = 0; i < buffers_.size(); ++i) glBindBuffer(buffer_targets[i][0], living_buffer(buffers_[i]));
  for (std::size_t i = 0; i < pixel_stores.size(); ++i) glPixelStorei(pixel_stores[i].name, pixel_stores_[i]);
}

}  // namespace atomesh::gl
