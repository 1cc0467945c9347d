#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkShaderProgram.h>
#include <vtk_glew.h>

#include <algorithm>
#include <cstddef>

#include "app/gui/gpu_ball_lists.h"
#include "app/gui/gpu_buffers.h"
#include "app/gui/gpu_drawing.h"
#include "app/gui/gpu_shaders.h"
#include "render/cpu/atom_balls.h"
#include "render/shared/materials.h"

namespace atomesh::gui {

namespace {

// Balls lie on the card as they lie in the scene; the shaders count on it.
constexpr std::size_t ball_floats = 9;
static_assert(sizeof(Ball) == ball_floats * sizeof(float));
static_assert(offsetof(Ball, center) == 0 && offsetof(Ball, radius) == 12 && offsetof(Ball, color) == 16);

// While it lives other framebuffers may be bound.
class OwnFramebuffers {
 public:
  explicit OwnFramebuffers(vtkOpenGLState& state) : state_(state) { state_.PushFramebufferBindings(); }
  ~OwnFramebuffers() { state_.PopFramebufferBindings(); }
  OwnFramebuffers(const OwnFramebuffers&) = delete;
  OwnFramebuffers& operator=(const OwnFramebuffers&) = delete;

 private:
  vtkOpenGLState& state_;
};

// As the shader knows them.
enum class Wanted { all, opaque, transparent };

// Each pixel's nearest ball is found first and shaded then, once, however many balls lie behind one another. Balls
// that are not opaque are composed from lists of each pixel's hits or, where there can be none, peeled off layer behind
// layer until no pixel sees further.
class GpuBalls final : public GpuDrawing {
 public:
  GpuBalls(std::shared_ptr<const Scene> scene, const GpuLimits& limits)
      : scene_(std::move(scene)),
        opaque_(std::all_of(scene_->balls.begin(), scene_->balls.end(),
                            [](const Ball& ball) { return ball.color.a >= 1.0F; })),
        limits_(limits) {
    lists_.set_room(limits.list_bytes);
  }

  void draw(vtkOpenGLRenderWindow& window, const GpuView& view, const Parameters&) override {
    if (scene_->balls.empty()) return;
    vtkOpenGLState& state = *window.GetState();
    layers_[0].resize(window, view.width, view.height);
    if (no_attributes_ == 0) glGenVertexArrays(1, &no_attributes_);
    if (parts_.empty()) upload();
    state.vtkglDepthFunc(GL_LESS);
    state.vtkglDisable(GL_CULL_FACE);
    if (opaque_) {
      {
        const OwnFramebuffers own(state);
        draw_layer(window, view, 0, Wanted::all);
      }
      shade_layer(window, view, 0);
    } else {
      {
        const OwnFramebuffers own(state);
        layers_[1].resize(window, view.width, view.height);
        light_.resize(window, view.width, view.height);
        if (!compose_lists(window, view)) peel(window, view);
      }
      lay_light(window);
    }
    glBindVertexArray(0);
    bind_texture(window, 0, 0);
    state.vtkglEnable(GL_DEPTH_TEST);
    state.vtkglDepthFunc(GL_LEQUAL);
    state.vtkglEnable(GL_BLEND);
    state.vtkglBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  }

  void release() override {
    for (GpuBallPart& part : parts_) {
      delete_texture(part.texture);
      delete_buffer(part.buffer);
    }
    parts_.clear();
    for (GpuTarget& layer : layers_) layer.release();
    light_.release();
    lists_.release();
    delete_vertex_array(no_attributes_);
    if (seen_ != 0) glDeleteQueries(1, &seen_);
    seen_ = 0;
    for (GpuProgram* program : {&layer_program_, &shading_program_, &copy_program_}) program->program = nullptr;
  }

 private:
  void upload() {
    const std::size_t most = std::min(largest_buffer_texture(), limits_.texture_floats) / ball_floats;
    for (std::size_t first = 0; first < scene_->balls.size(); first += most) {
      const std::size_t count = std::min(most, scene_->balls.size() - first);
      GpuBallPart part;
      part.buffer = make_buffer(&scene_->balls[first], count * sizeof(Ball));
      part.texture = make_buffer_texture(part.buffer);
      part.first = static_cast<int>(first);
      part.count = static_cast<int>(count);
      parts_.push_back(part);
    }
  }

  // The nearest balls, or those next behind the layer before.
  void draw_layer(vtkOpenGLRenderWindow& window, const GpuView& view, int layer, Wanted wanted) {
    vtkOpenGLState& state = *window.GetState();
    const GpuTarget& before = layers_[static_cast<std::size_t>((layer + 1) % 2)];
    vtkShaderProgram& program = layer_program_.use(window);
    layers_[static_cast<std::size_t>(layer % 2)].bind(window);
    layers_[static_cast<std::size_t>(layer % 2)].clear(window);
    tell(view, program);
    program.SetUniformi("wanted", static_cast<int>(wanted));
    program.SetUniformi("layer", layer);
    program.SetUniformf("opaque", static_cast<float>(1.0 - faintest));
    program.SetUniformi("layer_before", 0);
    program.SetUniformi("depth_before", 1);
    program.SetUniformi("light", 2);
    program.SetUniformi("balls", 3);
    bind_texture(window, 2, layer > 0 ? light_.texture() : 0);
    bind_texture(window, 1, layer > 0 ? before.depths() : 0);
    bind_texture(window, 0, layer > 0 ? before.texture() : 0);
    state.vtkglEnable(GL_DEPTH_TEST);
    state.vtkglDepthMask(GL_TRUE);
    state.vtkglDisable(GL_BLEND);
    glBindVertexArray(no_attributes_);
    for (const GpuBallPart& part : parts_) {
      program.SetUniformi("first", part.first);
      bind_buffer_texture(window, 3, part.texture);
      glDrawArrays(GL_TRIANGLES, 0, vertices_of_a_ball * part.count);
    }
    bind_buffer_texture(window, 3, 0);
    for (const unsigned unit : {2U, 1U, 0U}) bind_texture(window, unit, 0);
  }

  // Into the framebuffer that is bound, which says how it is blended.
  void shade_layer(vtkOpenGLRenderWindow& window, const GpuView& view, int layer) {
    vtkOpenGLState& state = *window.GetState();
    vtkShaderProgram& program = shading_program_.use(window);
    tell(view, program);
    program.SetUniformi("hits", 0);
    program.SetUniformi("balls", 1);
    program.SetUniformf("ambient_share", optics::ambient_share);
    program.SetUniformf("diffuse_share", optics::diffuse_share);
    state.vtkglDisable(GL_DEPTH_TEST);
    bind_texture(window, 0, layers_[static_cast<std::size_t>(layer % 2)].texture());
    glBindVertexArray(no_attributes_);
    for (const GpuBallPart& part : parts_) {
      bind_buffer_texture(window, 1, part.texture);
      program.SetUniformi("first", part.first);
      program.SetUniformi("count", part.count);
      glDrawArrays(GL_TRIANGLES, 0, 3);
    }
    bind_buffer_texture(window, 1, 0);
    bind_texture(window, 0, 0);
  }

  // All layers that are seen, front to back, into light_.
  void peel(vtkOpenGLRenderWindow& window, const GpuView& view) {
    vtkOpenGLState& state = *window.GetState();
    if (seen_ == 0) glGenQueries(1, &seen_);
    light_.bind(window);
    light_.clear(window);
    for (int layer = 0;; ++layer) {
      glBeginQuery(GL_SAMPLES_PASSED, seen_);
      draw_layer(window, view, layer, Wanted::all);
      glEndQuery(GL_SAMPLES_PASSED);
      GLuint pixels = 0;
      glGetQueryObjectuiv(seen_, GL_QUERY_RESULT, &pixels);
      if (pixels == 0) return;
      light_.bind(window);
      blend_behind(state);
      shade_layer(window, view, layer);
    }
  }

  // The same by lists of hits. False where that cannot be.
  bool compose_lists(vtkOpenGLRenderWindow& window, const GpuView& view) {
    if (!limits_.lists || parts_.size() != 1 || !GpuBallLists::possible()) return false;
    draw_layer(window, view, 0, Wanted::opaque);
    light_.bind(window);
    light_.clear(window);
    if (!lists_.compose(window, view, parts_[0], no_attributes_, layers_[0], layers_[1], light_)) return false;
    blend_behind(*window.GetState());
    shade_layer(window, view, 0);
    return true;
  }

  // What is drawn next shines through what is there already.
  static void blend_behind(vtkOpenGLState& state) {
    state.vtkglEnable(GL_BLEND);
    state.vtkglBlendFuncSeparate(GL_ONE_MINUS_DST_ALPHA, GL_ONE, GL_ONE_MINUS_DST_ALPHA, GL_ONE);
  }

  // Over the background.
  void lay_light(vtkOpenGLRenderWindow& window) {
    vtkOpenGLState& state = *window.GetState();
    vtkShaderProgram& program = copy_program_.use(window);
    program.SetUniformi("light", 0);
    bind_texture(window, 0, light_.texture());
    state.vtkglDisable(GL_DEPTH_TEST);
    state.vtkglEnable(GL_BLEND);
    state.vtkglBlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glBindVertexArray(no_attributes_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }

  std::shared_ptr<const Scene> scene_;
  bool opaque_;
  GpuLimits limits_;
  std::vector<GpuBallPart> parts_;  // of as many balls as a texture of them can hold
  GpuProgram layer_program_{"atom balls", ball_vertex_shader, ball_layer_shader};
  GpuProgram shading_program_{"lit atom balls", whole_picture_vertex_shader, ball_shading_shader};
  GpuProgram copy_program_{"pictures", whole_picture_vertex_shader, copy_shader};
  std::array<GpuTarget, 2> layers_{GpuTarget(GpuTarget::Kind::balls), GpuTarget(GpuTarget::Kind::balls)};
  GpuTarget light_{GpuTarget::Kind::light};
  GpuBallLists lists_;
  unsigned no_attributes_ = 0;  // a vertex array: shaders find what they need by the vertices' numbers
  unsigned seen_ = 0;           // a query
};

}  // namespace

std::unique_ptr<GpuDrawing> make_gpu_balls(std::shared_ptr<const Scene> scene, const GpuLimits& limits) {
  return std::make_unique<GpuBalls>(std::move(scene), limits);
}

}  // namespace atomesh::gui
