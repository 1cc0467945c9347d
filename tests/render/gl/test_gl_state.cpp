// OpenGL's state, odd wherever it can be: drawing a volume leaves all of it as it was, and draws the same in it.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "render/gl/context.h"
#include "render/gl/objects.h"
#include "render/gl/volume.h"
#include "render/gl/volume_picture.h"
#include "tests/render/fixtures.h"

namespace atomesh {
namespace {

using gl::VolumePicture;
using test::Subject;

struct Named {
  const char* name;
  GLenum value;
};
#define NAMED(value) \
  Named {            \
#value, value    \
  }

constexpr std::array switches{NAMED(GL_DEPTH_TEST),
                              NAMED(GL_STENCIL_TEST),
                              NAMED(GL_CULL_FACE),
                              NAMED(GL_DEPTH_CLAMP),
                              NAMED(GL_DITHER),
                              NAMED(GL_MULTISAMPLE),
                              NAMED(GL_RASTERIZER_DISCARD),
                              NAMED(GL_POLYGON_OFFSET_FILL),
                              NAMED(GL_POLYGON_OFFSET_LINE),
                              NAMED(GL_COLOR_LOGIC_OP),
                              NAMED(GL_SAMPLE_ALPHA_TO_COVERAGE),
                              NAMED(GL_SAMPLE_ALPHA_TO_ONE),
                              NAMED(GL_SAMPLE_COVERAGE),
                              NAMED(GL_SAMPLE_MASK),
                              NAMED(GL_PRIMITIVE_RESTART),
                              NAMED(GL_PROGRAM_POINT_SIZE),
                              NAMED(GL_LINE_SMOOTH),
                              NAMED(GL_TEXTURE_CUBE_MAP_SEAMLESS),
                              NAMED(GL_FRAMEBUFFER_SRGB),
                              NAMED(GL_CLIP_DISTANCE0),
                              NAMED(GL_CLIP_DISTANCE1),
                              NAMED(GL_CLIP_DISTANCE7)};

constexpr std::array buffers{
    NAMED(GL_ARRAY_BUFFER),      NAMED(GL_ATOMIC_COUNTER_BUFFER),     NAMED(GL_COPY_READ_BUFFER),
    NAMED(GL_COPY_WRITE_BUFFER), NAMED(GL_DISPATCH_INDIRECT_BUFFER),  NAMED(GL_DRAW_INDIRECT_BUFFER),
    NAMED(GL_PIXEL_PACK_BUFFER), NAMED(GL_PIXEL_UNPACK_BUFFER),       NAMED(GL_SHADER_STORAGE_BUFFER),
    NAMED(GL_TEXTURE_BUFFER),    NAMED(GL_TRANSFORM_FEEDBACK_BUFFER), NAMED(GL_UNIFORM_BUFFER)};
constexpr std::array buffer_bindings{NAMED(GL_ARRAY_BUFFER_BINDING),
                                     NAMED(GL_ATOMIC_COUNTER_BUFFER_BINDING),
                                     NAMED(GL_COPY_READ_BUFFER_BINDING),
                                     NAMED(GL_COPY_WRITE_BUFFER_BINDING),
                                     NAMED(GL_DISPATCH_INDIRECT_BUFFER_BINDING),
                                     NAMED(GL_DRAW_INDIRECT_BUFFER_BINDING),
                                     NAMED(GL_PIXEL_PACK_BUFFER_BINDING),
                                     NAMED(GL_PIXEL_UNPACK_BUFFER_BINDING),
                                     NAMED(GL_SHADER_STORAGE_BUFFER_BINDING),
                                     NAMED(GL_TEXTURE_BUFFER_BINDING),
                                     NAMED(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING),
                                     NAMED(GL_UNIFORM_BUFFER_BINDING)};
static_assert(buffers.size() == buffer_bindings.size());

struct PlaceNames {
  const char* name;
  GLenum target, most, buffer, start, size;
};
constexpr std::array places{
    PlaceNames{"uniform block", GL_UNIFORM_BUFFER, GL_MAX_UNIFORM_BUFFER_BINDINGS, GL_UNIFORM_BUFFER_BINDING,
               GL_UNIFORM_BUFFER_START, GL_UNIFORM_BUFFER_SIZE},
    PlaceNames{"storage", GL_SHADER_STORAGE_BUFFER, GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS,
               GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START, GL_SHADER_STORAGE_BUFFER_SIZE},
    PlaceNames{"atomic counter", GL_ATOMIC_COUNTER_BUFFER, GL_MAX_ATOMIC_COUNTER_BUFFER_BINDINGS,
               GL_ATOMIC_COUNTER_BUFFER_BINDING, GL_ATOMIC_COUNTER_BUFFER_START, GL_ATOMIC_COUNTER_BUFFER_SIZE}};

constexpr std::array pixel_stores{
    NAMED(GL_PACK_SWAP_BYTES),   NAMED(GL_PACK_LSB_FIRST),     NAMED(GL_PACK_ROW_LENGTH),
    NAMED(GL_PACK_IMAGE_HEIGHT), NAMED(GL_PACK_SKIP_ROWS),     NAMED(GL_PACK_SKIP_PIXELS),
    NAMED(GL_PACK_SKIP_IMAGES),  NAMED(GL_PACK_ALIGNMENT),     NAMED(GL_UNPACK_SWAP_BYTES),
    NAMED(GL_UNPACK_LSB_FIRST),  NAMED(GL_UNPACK_ROW_LENGTH),  NAMED(GL_UNPACK_IMAGE_HEIGHT),
    NAMED(GL_UNPACK_SKIP_ROWS),  NAMED(GL_UNPACK_SKIP_PIXELS), NAMED(GL_UNPACK_SKIP_IMAGES),
    NAMED(GL_UNPACK_ALIGNMENT)};

struct TextureNames {
  const char* name;
  GLenum target, binding;
};
constexpr std::array textures{TextureNames{"1D", GL_TEXTURE_1D, GL_TEXTURE_BINDING_1D},
                              TextureNames{"2D", GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D},
                              TextureNames{"3D", GL_TEXTURE_3D, GL_TEXTURE_BINDING_3D},
                              TextureNames{"cube", GL_TEXTURE_CUBE_MAP, GL_TEXTURE_BINDING_CUBE_MAP},
                              TextureNames{"array", GL_TEXTURE_2D_ARRAY, GL_TEXTURE_BINDING_2D_ARRAY},
                              TextureNames{"rectangle", GL_TEXTURE_RECTANGLE, GL_TEXTURE_BINDING_RECTANGLE},
                              TextureNames{"buffer", GL_TEXTURE_BUFFER, GL_TEXTURE_BINDING_BUFFER},
                              TextureNames{"samples", GL_TEXTURE_2D_MULTISAMPLE, GL_TEXTURE_BINDING_2D_MULTISAMPLE}};

constexpr std::array numbers{NAMED(GL_ACTIVE_TEXTURE),
                             NAMED(GL_BLEND_COLOR),
                             NAMED(GL_CLIP_ORIGIN),
                             NAMED(GL_COLOR_CLEAR_VALUE),
                             NAMED(GL_CULL_FACE_MODE),
                             NAMED(GL_CURRENT_PROGRAM),
                             NAMED(GL_DEPTH_CLEAR_VALUE),
                             NAMED(GL_DEPTH_FUNC),
                             NAMED(GL_DEPTH_WRITEMASK),
                             NAMED(GL_DRAW_BUFFER0),
                             NAMED(GL_DRAW_FRAMEBUFFER_BINDING),
                             NAMED(GL_FRONT_FACE),
                             NAMED(GL_LINE_WIDTH),
                             NAMED(GL_LOGIC_OP_MODE),
                             NAMED(GL_PATCH_VERTICES),
                             NAMED(GL_POINT_SIZE),
                             NAMED(GL_POLYGON_MODE),
                             NAMED(GL_POLYGON_OFFSET_FACTOR),
                             NAMED(GL_POLYGON_OFFSET_UNITS),
                             NAMED(GL_PRIMITIVE_RESTART_INDEX),
                             NAMED(GL_PROGRAM_PIPELINE_BINDING),
                             NAMED(GL_PROVOKING_VERTEX),
                             NAMED(GL_READ_BUFFER),
                             NAMED(GL_READ_FRAMEBUFFER_BINDING),
                             NAMED(GL_RENDERBUFFER_BINDING),
                             NAMED(GL_SAMPLE_COVERAGE_INVERT),
                             NAMED(GL_SAMPLE_COVERAGE_VALUE),
                             NAMED(GL_STENCIL_BACK_FAIL),
                             NAMED(GL_STENCIL_BACK_FUNC),
                             NAMED(GL_STENCIL_BACK_PASS_DEPTH_FAIL),
                             NAMED(GL_STENCIL_BACK_PASS_DEPTH_PASS),
                             NAMED(GL_STENCIL_BACK_REF),
                             NAMED(GL_STENCIL_BACK_VALUE_MASK),
                             NAMED(GL_STENCIL_BACK_WRITEMASK),
                             NAMED(GL_STENCIL_CLEAR_VALUE),
                             NAMED(GL_STENCIL_FAIL),
                             NAMED(GL_STENCIL_FUNC),
                             NAMED(GL_STENCIL_PASS_DEPTH_FAIL),
                             NAMED(GL_STENCIL_PASS_DEPTH_PASS),
                             NAMED(GL_STENCIL_REF),
                             NAMED(GL_STENCIL_VALUE_MASK),
                             NAMED(GL_STENCIL_WRITEMASK),
                             NAMED(GL_TRANSFORM_FEEDBACK_BINDING),
                             NAMED(GL_VERTEX_ARRAY_BINDING)};

GLint integer(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

// All there is, by names.
using State = std::map<std::string, std::vector<double>>;

State state() {
  State all;
  const auto add = [&](std::string name, GLuint place, auto value) {
    all[name + ' ' + std::to_string(place)].push_back(static_cast<double>(value));
  };
  for (const Named& name : switches) add(name.name, 0, glIsEnabled(name.value));
  for (const Named& name : numbers) {
    // (OpenGL 4.5)
    if (name.value == GL_CLIP_ORIGIN && epoxy_gl_version() < 45) continue;
    std::vector<double>& values = all[name.name];
    values.assign(4, 0.0);
    glGetDoublev(name.value, values.data());
  }
  for (const Named& name : buffer_bindings) add(name.name, 0, integer(name.value));
  for (const Named& name : pixel_stores) add(name.name, 0, integer(name.value));
  for (const PlaceNames& names : places) {
    for (GLuint i = 0; i < static_cast<GLuint>(integer(names.most)); ++i) {
      GLint buffer = 0;
      std::array<GLint64, 2> range{};
      glGetIntegeri_v(names.buffer, i, &buffer);
      glGetInteger64i_v(names.start, i, range.data());
      glGetInteger64i_v(names.size, i, &range[1]);
      for (const GLint64 value : {GLint64{buffer}, range[0], range[1]}) add(names.name, i, value);
    }
  }
  const GLint active = integer(GL_ACTIVE_TEXTURE);
  for (GLuint i = 0; i < static_cast<GLuint>(integer(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS)); ++i) {
    glActiveTexture(GL_TEXTURE0 + i);
    for (const TextureNames& names : textures) add(std::string("texture ") + names.name, i, integer(names.binding));
    add("sampler", i, integer(GL_SAMPLER_BINDING));
  }
  glActiveTexture(static_cast<GLenum>(active));
  for (GLuint i = 0; i < static_cast<GLuint>(integer(GL_MAX_IMAGE_UNITS)); ++i) {
    for (const GLenum name : {GL_IMAGE_BINDING_NAME, GL_IMAGE_BINDING_LEVEL, GL_IMAGE_BINDING_LAYERED,
                              GL_IMAGE_BINDING_LAYER, GL_IMAGE_BINDING_ACCESS, GL_IMAGE_BINDING_FORMAT}) {
      GLint value = 0;
      glGetIntegeri_v(name, i, &value);
      add("image", i, value);
    }
  }
  for (GLuint i = 0; i < static_cast<GLuint>(integer(GL_MAX_VIEWPORTS)); ++i) {
    std::array<GLfloat, 4> viewport{};
    std::array<GLint, 4> scissor{};
    std::array<GLdouble, 2> depths{};
    glGetFloati_v(GL_VIEWPORT, i, viewport.data());
    glGetIntegeri_v(GL_SCISSOR_BOX, i, scissor.data());
    glGetDoublei_v(GL_DEPTH_RANGE, i, depths.data());
    for (const GLfloat value : viewport) add("viewport", i, value);
    for (const GLint value : scissor) add("scissor", i, value);
    for (const GLdouble value : depths) add("depth range", i, value);
    add("scissor test", i, glIsEnabledi(GL_SCISSOR_TEST, i));
  }
  for (GLuint i = 0; i < static_cast<GLuint>(integer(GL_MAX_DRAW_BUFFERS)); ++i) {
    for (const GLenum name : {GL_BLEND_SRC_RGB, GL_BLEND_DST_RGB, GL_BLEND_SRC_ALPHA, GL_BLEND_DST_ALPHA,
                              GL_BLEND_EQUATION_RGB, GL_BLEND_EQUATION_ALPHA}) {
      GLint value = 0;
      glGetIntegeri_v(name, i, &value);
      add("blending", i, value);
    }
    std::array<GLboolean, 4> mask{};
    glGetBooleani_v(GL_COLOR_WRITEMASK, i, mask.data());
    for (const GLboolean value : mask) add("mask", i, value);
    add("blend", i, glIsEnabledi(GL_BLEND, i));
  }
  for (GLuint i = 0; i < static_cast<GLuint>(integer(GL_MAX_VERTEX_ATTRIBS)); ++i) {
    for (const GLenum name :
         {GL_VERTEX_ATTRIB_ARRAY_ENABLED, GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING, GL_VERTEX_ATTRIB_ARRAY_SIZE,
          GL_VERTEX_ATTRIB_ARRAY_STRIDE, GL_VERTEX_ATTRIB_ARRAY_TYPE}) {
      GLint value = 0;
      glGetVertexAttribiv(i, name, &value);
      add("attribute", i, value);
    }
  }
  add("elements", 0, integer(GL_ELEMENT_ARRAY_BUFFER_BINDING));
  EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
  return all;
}

void expect_same(const State& after, const State& before) {
  ASSERT_EQ(after.size(), before.size());
  for (const auto& [name, values] : before) EXPECT_EQ(after.at(name), values) << name;
}

// A framebuffer of floats, with a texture.
struct Target {
  Target(int width, int height)
      : texture(gl::Texture::make_2d(GL_RGBA32F, width, height)), buffer(gl::make_framebuffer()) {
    glBindFramebuffer(GL_FRAMEBUFFER, buffer.name());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture.name(), 0);
    const std::array<GLfloat, 4> nothing{-1.0F, -1.0F, -1.0F, -1.0F};
    glClearBufferfv(GL_COLOR, 0, nothing.data());
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
  }
  gl::Texture texture;
  gl::Framebuffer buffer;
};

// Makes everything odd, objects and all.
class OddState {
 public:
  // What is drawn goes into `target`.
  explicit OddState(const Target& target) {
    const auto name_of = [](auto generate) {
      GLuint name = 0;
      generate(1, &name);
      return name;
    };
    const auto buffer_of = [&](GLsizeiptr bytes) {
      const GLuint name = name_of(glGenBuffers);
      glBindBuffer(GL_ARRAY_BUFFER, name);
      glBufferData(GL_ARRAY_BUFFER, bytes, nullptr, GL_STATIC_DRAW);
      return name;
    };
    vertex_array = gl::make_vertex_array();
    glBindVertexArray(vertex_array.name());
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer_of(64));
    glBindBuffer(GL_ARRAY_BUFFER, buffer_of(640));
    for (const GLuint i : {0U, 2U, 3U}) {
      glEnableVertexAttribArray(i);
      glVertexAttribPointer(i, 3, GL_SHORT, GL_TRUE, 20, nullptr);
    }
    const GLuint ranges = buffer_of(1 << 20);
    for (const PlaceNames& names : places) {
      for (GLuint i = 0; i < static_cast<GLuint>(integer(names.most)); ++i) {
        glBindBufferRange(names.target, i, ranges, 256 * static_cast<GLintptr>(i + 1), 16);
        if (i % 3 == 2) glBindBufferBase(names.target, i, ranges);
      }
    }
    const auto unit_count = static_cast<GLuint>(integer(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS));
    for (GLuint i = 0; i < unit_count; ++i) {
      glActiveTexture(GL_TEXTURE0 + i);
      for (const TextureNames& names : textures) glBindTexture(names.target, name_of(glGenTextures));
      const GLuint sampler = name_of(glGenSamplers);
      glSamplerParameteri(sampler, GL_TEXTURE_MIN_FILTER, i % 2 == 0 ? GL_LINEAR : GL_NEAREST);
      glSamplerParameteri(sampler, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
      glSamplerParameteri(sampler, GL_TEXTURE_WRAP_S, GL_MIRRORED_REPEAT);
      glSamplerParameteri(sampler, GL_TEXTURE_WRAP_T, GL_REPEAT);
      glBindSampler(i, sampler);
    }
    image = gl::Texture::make_3d(GL_RGBA8, 4, 4, 4);
    for (GLuint i = 0; i < static_cast<GLuint>(integer(GL_MAX_IMAGE_UNITS)); ++i) {
      glBindImageTexture(i, image.name(), 0, i % 2 == 0 ? GL_FALSE : GL_TRUE, 2, GL_READ_WRITE, GL_RGBA8);
    }
    // Textures are made at the unit that is active.
    glActiveTexture(GL_TEXTURE0 + unit_count - 3);
    glBindTexture(GL_TEXTURE_2D, name_of(glGenTextures));
    glBindTexture(GL_TEXTURE_3D, name_of(glGenTextures));
    for (const Named& name : buffers) glBindBuffer(name.value, buffer_of(1 << 16));
    glBindBuffer(GL_ARRAY_BUFFER, buffer_of(1 << 16));
    for (const Named& name : pixel_stores) {
      const bool alignment = name.value == GL_PACK_ALIGNMENT || name.value == GL_UNPACK_ALIGNMENT;
      const bool flag = name.value == GL_PACK_SWAP_BYTES || name.value == GL_UNPACK_SWAP_BYTES ||
                        name.value == GL_PACK_LSB_FIRST || name.value == GL_UNPACK_LSB_FIRST;
      glPixelStorei(name.value, alignment ? 8 : flag ? 1 : 117);
    }
    set_fragment_tests();
    glBindFramebuffer(GL_READ_FRAMEBUFFER, other.buffer.name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.buffer.name());
    glBindRenderbuffer(GL_RENDERBUFFER, name_of(glGenRenderbuffers));
    glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, name_of(glGenTransformFeedbacks));
    glBindProgramPipeline(name_of(glGenProgramPipelines));
    program.use();
    gl::check_errors("making everything odd");
  }

 private:
  static void set_fragment_tests() {
    // Of those that are on by themselves the other way round.
    for (const Named& name : switches) (glIsEnabled(name.value) == GL_TRUE ? glDisable : glEnable)(name.value);
    for (GLuint i = 0; i < static_cast<GLuint>(integer(GL_MAX_VIEWPORTS)); ++i) {
      const auto n = static_cast<GLfloat>(i);
      glViewportIndexedf(i, 1.5F + n, 2.25F + n, 3.0F + n, 4.0F + n);
      glScissorIndexed(i, static_cast<GLint>(i) + 3, 4, 5, 6);
      glDepthRangeIndexed(i, 0.75 - 0.01 * i, 0.1 + 0.01 * i);
      (i % 3 == 0 ? glEnablei : glDisablei)(GL_SCISSOR_TEST, i);
    }
    for (GLuint i = 0; i < static_cast<GLuint>(integer(GL_MAX_DRAW_BUFFERS)); ++i) {
      glBlendFuncSeparatei(i, GL_DST_COLOR, i % 2 == 0 ? GL_ZERO : GL_ONE, GL_SRC_ALPHA, GL_CONSTANT_COLOR);
      glBlendEquationSeparatei(i, i % 2 == 0 ? GL_FUNC_SUBTRACT : GL_MAX, GL_MIN);
      glColorMaski(i, i % 2 == 0, i % 3 == 0, i % 5 == 0, GL_FALSE);
      (i % 2 == 0 ? glEnablei : glDisablei)(GL_BLEND, i);
    }
    glBlendColor(0.1F, 0.2F, 0.3F, 0.4F);
    glClearColor(0.5F, 0.6F, 0.7F, 0.8F);
    glClearDepth(0.25);
    glClearStencil(77);
    glCullFace(GL_FRONT_AND_BACK);
    glFrontFace(GL_CW);
    glDepthFunc(GL_NEVER);
    glDepthMask(GL_FALSE);
    glStencilFuncSeparate(GL_FRONT, GL_NEVER, 5, 0x3C);
    glStencilFuncSeparate(GL_BACK, GL_EQUAL, 6, 0x3D);
    glStencilMaskSeparate(GL_FRONT, 0x0F);
    glStencilMaskSeparate(GL_BACK, 0xF0);
    glStencilOpSeparate(GL_FRONT, GL_INCR, GL_DECR, GL_INVERT);
    glStencilOpSeparate(GL_BACK, GL_ZERO, GL_INCR_WRAP, GL_DECR_WRAP);
    glLogicOp(GL_INVERT);
    glPolygonMode(GL_FRONT_AND_BACK, GL_POINT);
    glPolygonOffset(7.0F, 11.0F);
    glPrimitiveRestartIndex(1);
    glProvokingVertex(GL_FIRST_VERTEX_CONVENTION);
    glSampleCoverage(0.0F, GL_TRUE);
    glSampleMaski(0, 0);
    glPatchParameteri(GL_PATCH_VERTICES, 5);
    glPointSize(3.0F);
  }

 public:
  gl::VertexArray vertex_array;
  gl::Texture image;
  Target other{8, 8};
  gl::Program program = gl::Program::draw("whole_window.vert", "nothing.frag");
};

// What is in it, in a state that lets itself be read.
Image pixels_of(const Target& target) {
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  for (const Named& name : pixel_stores) {
    glPixelStorei(name.value, name.value == GL_PACK_ALIGNMENT || name.value == GL_UNPACK_ALIGNMENT ? 4 : 0);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, target.buffer.name());
  Image image(target.texture.width(), target.texture.height());
  glReadPixels(0, 0, image.width, image.height, GL_RGBA, GL_FLOAT, image.pixels.data());
  gl::check_errors("the test");
  return image;
}

class GlState : public testing::TestWithParam<Projection> {
 protected:
  void SetUp() override {
    subject_ = test::shaken_box(Mode::volume, GetParam(), 40, 30);
    subject_.parameters.volume.alpha_length = 0.6;
    subject_.parameters.volume.color_map.entries = {
        {0.0, {0.1F, 0.2F, 0.8F, 0.1F}}, {0.5, {0.2F, 0.9F, 0.4F, 0.5F}}, {1.0, {0.9F, 0.1F, 0.1F, 1.0F}}};
    subject_.parameters.havs.table_error = 0.01;
  }
  // With every setting of how cells are integrated and put in order.
  template <class Use>
  void with_every_setting(Use&& use) {
    for (const auto integration : {HavsIntegration::automatic, HavsIntegration::exact, HavsIntegration::table}) {
      for (const auto order : {HavsOrder::lists, HavsOrder::k_buffer, HavsOrder::none}) {
        SCOPED_TRACE("integration " + std::to_string(static_cast<int>(integration)) + ", order " +
                     std::to_string(static_cast<int>(order)));
        subject_.parameters.havs.integration = integration;
        subject_.parameters.havs.order = order;
        use();
      }
    }
  }

  // Cards find cells that begin at the same depth in any order.
  static double tolerance() { return gl::current_driver().software ? 0.0 : 2e-3; }

  Subject subject_;
  gl::HeadlessContext context_{true};
  gl::HeadlessContext::Current current_{context_};
};
INSTANTIATE_TEST_SUITE_P(Both, GlState, testing::Values(Projection::parallel, Projection::perspective));

// Every cell's preparation, and pixels to repair.
TEST_P(GlState, IsAsItWasAfterAVolume) {
  for (const bool on_card : {false, true}) {
    with_every_setting([&] {
      const auto draw = [&](const std::function<void(gl::Volume&)>& look) {
        gl::Volume volume;
        volume.set_order_by_faces(false);
        volume.set_prepare_on_card(on_card);
        volume.set_scene(subject_.scene);
        RenderStats stats;
        const auto pixels = static_cast<std::size_t>(subject_.camera.width * subject_.camera.height);
        volume.draw(subject_.camera, subject_.parameters, whole_picture(subject_.camera), {}, stats, no_progress(),
                    std::vector<float>(pixels, 60.0F));
        const Image image = volume.read();
        EXPECT_EQ(volume.last().on_card, on_card);
        EXPECT_EQ(volume.last().repair.draws > 0, subject_.parameters.havs.order != HavsOrder::none);
        EXPECT_TRUE(subject_.parameters.havs.integration != HavsIntegration::table || volume.table().bytes > 0);
        look(volume);
        return image;
      };
      const Image expected = draw([](gl::Volume&) {});
      // A context of its own: what is odd stays odd.
      gl::HeadlessContext context(true);
      const gl::HeadlessContext::Current current(context);
      const Target target(40, 30);
      const OddState odd(target);
      const State before = state();
      const Image image = draw([&](gl::Volume&) { expect_same(state(), before); });
      expect_same(state(), before);
      EXPECT_LE(compare_images(image, expected).max, tolerance());
    });
  }
}

// In parts, in slices of time, with what stands in it.
TEST_P(GlState, IsAsItWasAfterAPicture) {
  subject_.parameters.supersampling = 2;
  subject_.parameters.volume.solid = VolumeSolid::atoms;
  const auto scene = std::make_shared<const Scene>(make_scene(subject_.material, subject_.parameters));
  with_every_setting([&] {
    const auto draw = [&](const std::function<void()>& look) {
      VolumePicture picture(33);
      picture.set_scene(scene);
      picture.begin(subject_.camera, subject_.parameters);
      while (!picture.proceed(1.0)) look();
      look();
      picture.draw(subject_.camera, subject_.parameters);
      look();
    };
    const Target clean(40, 30);
    glBindFramebuffer(GL_FRAMEBUFFER, clean.buffer.name());
    draw([] {});
    const Image expected = pixels_of(clean);
    gl::HeadlessContext context(true);
    const gl::HeadlessContext::Current current(context);
    const Target target(40, 30);
    const OddState odd(target);
    const State before = state();
    draw([&] { expect_same(state(), before); });
    expect_same(state(), before);
    EXPECT_LE(compare_images(pixels_of(target), expected).max, tolerance());
  });
}

}  // namespace
}  // namespace atomesh
