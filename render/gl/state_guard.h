// OpenGL's state as whoever owns the context left it.
#pragma once

#include <epoxy/gl.h>

#include <array>

namespace atomesh::gl {

// A buffer at a numbered place of shader storage or of uniform blocks.
struct BufferPlace {
  GLint buffer = 0;
  GLint64 start = 0;
  GLint64 size = 0;  // 0: all of it
};

// Restores on destruction the storage buffers that render/gl binds, places 0 to 7.
class StorageGuard {
 public:
  StorageGuard();
  ~StorageGuard();
  StorageGuard(const StorageGuard&) = delete;
  StorageGuard& operator=(const StorageGuard&) = delete;

 private:
  std::array<BufferPlace, 8> places_{};
  GLint buffer_ = 0;  // of no place
};

// Restores on destruction what drawing a volume changes: framebuffer, viewports, scissors, program, vertex array,
// blending, depth and stencil test, masks, buffers (storage and uniform block 8 too), image unit 0, and the textures
// and samplers of units 0 to texture_units - 1.
//
// What the owner may have left, nothing in render/gl sets and would spoil what it draws is out of the way until then:
// pixels are packed and unpacked as OpenGL does by itself, from and to memory; there are no samplers, and nothing of
// `obstacles` is on; polygons are filled.
class StateGuard {
 public:
  StateGuard();
  ~StateGuard();
  StateGuard(const StateGuard&) = delete;
  StateGuard& operator=(const StateGuard&) = delete;

 private:
  static constexpr std::size_t texture_units = 10;
  static constexpr std::size_t viewports = 16;    // as many as every driver has
  static constexpr std::size_t draw_buffers = 8;  // alike
  static constexpr GLuint uniform_block = 8;
  static constexpr std::array<GLenum, 4> switches_{GL_DEPTH_TEST, GL_STENCIL_TEST, GL_CULL_FACE, GL_DEPTH_CLAMP};
  static constexpr std::array<GLenum, 15> obstacles{
      GL_RASTERIZER_DISCARD, GL_POLYGON_OFFSET_FILL, GL_COLOR_LOGIC_OP, GL_SAMPLE_ALPHA_TO_COVERAGE,
      GL_SAMPLE_COVERAGE,    GL_SAMPLE_ALPHA_TO_ONE, GL_SAMPLE_MASK,    GL_CLIP_DISTANCE0,
      GL_CLIP_DISTANCE1,     GL_CLIP_DISTANCE2,      GL_CLIP_DISTANCE3, GL_CLIP_DISTANCE4,
      GL_CLIP_DISTANCE5,     GL_CLIP_DISTANCE6,      GL_CLIP_DISTANCE7};
  // Targets of glBindBuffer() but for storage, and what says which buffer they have.
  static constexpr std::array<std::array<GLenum, 2>, 7> buffer_targets{
      {{GL_ARRAY_BUFFER, GL_ARRAY_BUFFER_BINDING},
       {GL_COPY_READ_BUFFER, GL_COPY_READ_BUFFER_BINDING},
       {GL_COPY_WRITE_BUFFER, GL_COPY_WRITE_BUFFER_BINDING},
       {GL_DRAW_INDIRECT_BUFFER, GL_DRAW_INDIRECT_BUFFER_BINDING},
       {GL_PIXEL_PACK_BUFFER, GL_PIXEL_PACK_BUFFER_BINDING},
       {GL_PIXEL_UNPACK_BUFFER, GL_PIXEL_UNPACK_BUFFER_BINDING},
       {GL_UNIFORM_BUFFER, GL_UNIFORM_BUFFER_BINDING}}};
  // What glPixelStorei() sets, and what it is by itself.
  struct PixelStore {
    GLenum name;
    GLint usual;
  };
  static constexpr std::array<PixelStore, 16> pixel_stores{{{GL_PACK_SWAP_BYTES, 0},
                                                            {GL_PACK_LSB_FIRST, 0},
                                                            {GL_PACK_ROW_LENGTH, 0},
                                                            {GL_PACK_IMAGE_HEIGHT, 0},
                                                            {GL_PACK_SKIP_ROWS, 0},
                                                            {GL_PACK_SKIP_PIXELS, 0},
                                                            {GL_PACK_SKIP_IMAGES, 0},
                                                            {GL_PACK_ALIGNMENT, 4},
                                                            {GL_UNPACK_SWAP_BYTES, 0},
                                                            {GL_UNPACK_LSB_FIRST, 0},
                                                            {GL_UNPACK_ROW_LENGTH, 0},
                                                            {GL_UNPACK_IMAGE_HEIGHT, 0},
                                                            {GL_UNPACK_SKIP_ROWS, 0},
                                                            {GL_UNPACK_SKIP_PIXELS, 0},
                                                            {GL_UNPACK_SKIP_IMAGES, 0},
                                                            {GL_UNPACK_ALIGNMENT, 4}}};
  struct Unit {
    GLint texture_2d = 0;
    GLint texture_3d = 0;
    GLint texture_buffer = 0;
    GLint sampler = 0;
  };
  struct Image {
    GLint texture = 0, level = 0, layered = 0, layer = 0, access = 0, format = 0;
  };
  // What sets one for all sets each.
  struct Viewport {
    std::array<GLfloat, 4> rectangle{};
    std::array<GLint, 4> scissor{};
    std::array<GLdouble, 2> depths{};
    GLboolean scissored = GL_FALSE;
  };
  struct DrawBuffer {
    std::array<GLint, 4> functions{};  // RGB source and destination, alpha source and destination
    std::array<GLint, 2> equations{};  // RGB, alpha
    std::array<GLboolean, 4> mask{};
    GLboolean blended = GL_FALSE;
  };
  struct StencilSide {
    GLint function = 0, reference = 0, compare_mask = 0, write_mask = 0, fail = 0, depth_fail = 0, pass = 0;
  };
  void save_fragment_tests();
  void restore_fragment_tests() const;

  std::array<bool, switches_.size()> enabled_{};
  std::array<bool, obstacles.size()> in_the_way_{};
  std::array<GLint, 2> polygon_mode_{};  // front, back
  std::array<Unit, texture_units> units_{};
  GLint active_texture_ = 0;
  Image image_;  // unit 0
  std::array<Viewport, viewports> viewports_{};
  std::array<DrawBuffer, draw_buffers> draw_buffers_{};
  std::array<StencilSide, 2> stencil_{};  // front, back
  GLint depth_function_ = 0;
  GLboolean depth_mask_ = GL_TRUE;
  GLint draw_framebuffer_ = 0;
  GLint read_framebuffer_ = 0;
  GLint program_ = 0;
  GLint vertex_array_ = 0;
  StorageGuard storage_;
  BufferPlace block_;
  std::array<GLint, buffer_targets.size()> buffers_{};
  std::array<GLint, pixel_stores.size()> pixel_stores_{};
};

}  // namespace atomesh::gl
