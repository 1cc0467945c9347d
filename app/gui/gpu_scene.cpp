#include "app/gui/gpu_scene.h"

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkCullerCollection.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLShaderCache.h>
#include <vtkOpenGLState.h>
#include <vtkProp.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>
#include <vtkShaderProgram.h>
#include <vtkSmartPointer.h>
#include <vtkTextureObject.h>
#include <vtk_glew.h>

#include <algorithm>
#include <exception>

#include "app/gui/gpu_buffers.h"
#include "app/gui/gpu_drawing.h"
#include "app/gui/gpu_shaders.h"
#include "core/error.h"
#include "render/finish.h"

namespace atomesh::gui {

namespace {

// A drawing among VTK's props.
class DrawingProp final : public vtkProp {
 public:
  static DrawingProp* New() { VTK_STANDARD_NEW_BODY(DrawingProp); }
  vtkTypeMacro(DrawingProp, vtkProp)

      GpuDrawing* drawing = nullptr;
  GpuView view;
  const Parameters* parameters = nullptr;
  std::exception_ptr failure;  // VTK's code between us lets none through

  int RenderOpaqueGeometry(vtkViewport* viewport) override {
    auto* window = static_cast<vtkOpenGLRenderWindow*>(viewport->GetVTKWindow());
    if (drawing == nullptr) return 0;
    try {
      drawing->draw(*window, view, *parameters);
    } catch (...) {
      failure = std::current_exception();
    }
    return 1;
  }
};

// VTK's window in a context that is current whenever we are called, and that need not come through GLX: with EGL (as on
// Wayland) GLEW has found OpenGL's functions when it fails at GLX's.
class ForeignWindow final : public vtkGenericOpenGLRenderWindow {
 public:
  static ForeignWindow* New() { VTK_STANDARD_NEW_BODY(ForeignWindow); }
  vtkTypeMacro(ForeignWindow, vtkGenericOpenGLRenderWindow)

      void OpenGLInitContext() override {
    if (Initialized) return;
    ContextCreationTime.Modified();
    const GLenum result = glewInit();
    GlewInitValid = (result == GLEW_OK || result == GLEW_ERROR_NO_GLX_DISPLAY) && GLEW_VERSION_3_2 != 0;
    Initialized = GlewInitValid;
  }
  bool functions_loaded() const { return GlewInitValid; }
};

void answer(vtkObject*, unsigned long event, void*, void* asked) {
  if (event == vtkCommand::WindowIsCurrentEvent) {
    *static_cast<bool*>(asked) = true;
  } else {
    *static_cast<int*>(asked) = 1;
  }
}

// Puts back what OpenGL's other users expect to find: the framebuffer they bound.
class BoundFramebuffer {
 public:
  BoundFramebuffer() { glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &id_); }
  ~BoundFramebuffer() { glBindFramebuffer(GL_FRAMEBUFFER, id()); }
  BoundFramebuffer(const BoundFramebuffer&) = delete;
  BoundFramebuffer& operator=(const BoundFramebuffer&) = delete;
  GLuint id() const { return static_cast<GLuint>(id_); }

 private:
  GLint id_ = 0;
};

}  // namespace

class GpuScene::Pipeline {
 public:
  explicit Pipeline(const GpuLimits& limits) : limits_(limits) {}

  void set_scene(std::shared_ptr<const Scene> scene) {
    if (scene && scene->mode != Mode::surface && scene->mode != Mode::atoms) {
      throw UsageError("the graphics card draws modes surface and atoms, not " + std::string(mode_name(scene->mode)));
    }
    scene_ = std::move(scene);
    stale_ = true;
  }

  void drop_scene() {
    if (!scene_ && !drawing_) return;
    scene_ = nullptr;
    stale_ = true;
    if (window_) take_scene();
  }

  void draw(const Camera& camera, const Parameters& parameters) {
    check_picture(camera, parameters);
    if (!window_) open_window();
    const BoundFramebuffer target;
    const int n = rays_along_a_side(camera, parameters.supersampling);
    take_scene();
    const Camera rays = ray_camera(camera, n);
    if (scene_) prop_->view = gpu_view(*scene_, rays, parameters);
    prop_->drawing = drawing_.get();
    prop_->parameters = &parameters;
    prop_->failure = nullptr;
    const Vec4f& background = parameters.background;
    const Vec3f color = Vec3f(background) * background.a;
    renderer_->SetBackground(color.r, color.g, color.b);
    renderer_->SetBackgroundAlpha(background.a);
    window_->SetSize(rays.width, rays.height);
    window_->Render();
    if (prop_->failure) std::rethrow_exception(prop_->failure);
    show(camera, n, target.id());
  }

  void release() {
    if (!window_) return;
    if (drawing_) drawing_->release();
    delete_vertex_array(whole_picture_);
    mean_program_.program = nullptr;
    window_->Finalize();
    window_ = nullptr;
    renderer_ = nullptr;
    prop_ = nullptr;
  }

 private:
  void open_window() {
    window_ = vtkSmartPointer<ForeignWindow>::New();
    vtkNew<vtkCallbackCommand> answers;
    answers->SetCallback(answer);
    for (const auto event :
         {vtkCommand::WindowIsCurrentEvent, vtkCommand::WindowSupportsOpenGLEvent, vtkCommand::WindowIsDirectEvent}) {
      window_->AddObserver(event, answers);
    }
    window_->SetOwnContext(0);
    window_->SetReadyForRendering(true);
    window_->SetMultiSamples(0);
    window_->SetFrameBlitModeToNoBlit();
    window_->OpenGLInit();
    if (!window_->functions_loaded()) {
      window_ = nullptr;
      throw UnavailableError("there is no OpenGL 3.2 here, or none whose functions are found");
    }
    renderer_ = vtkSmartPointer<vtkRenderer>::New();
    prop_ = vtkSmartPointer<DrawingProp>::New();
    renderer_->AddViewProp(prop_);
    renderer_->GetCullers()->RemoveAllItems();
    window_->AddRenderer(renderer_);
  }

  // What lay on the card for the scene before goes.
  void take_scene() {
    if (!stale_) return;
    if (drawing_) drawing_->release();
    drawing_ = nullptr;
    if (scene_)
      drawing_ = scene_->mode == Mode::atoms ? make_gpu_balls(scene_, limits_) : make_gpu_surface(scene_, limits_);
    stale_ = false;
  }

  // Rays along a pixel's side: as many as asked for, as far as a texture of them can be made and stays below 64
  // million.
  static int rays_along_a_side(const Camera& camera, int wanted) {
    GLint side = 2048;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &side);
    constexpr std::int64_t most = std::int64_t{1} << 26U;
    const auto fits = [&](std::int64_t n) {
      return n * camera.width <= side && n * camera.height <= side && n * n * camera.width * camera.height <= most;
    };
    int n = wanted;
    while (n > 1 && !fits(n)) --n;
    return n;
  }

  void show(const Camera& camera, int n, GLuint target) {
    vtkOpenGLState& state = *window_->GetState();
    if (n == 1) {
      state.vtkglBindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
      window_->BlitDisplayFramebuffer();
      return;
    }
    if (whole_picture_ == 0) glGenVertexArrays(1, &whole_picture_);
    vtkShaderProgram& program = mean_program_.use(*window_);
    state.vtkglBindFramebuffer(GL_FRAMEBUFFER, target);
    state.vtkglViewport(0, 0, camera.width, camera.height);
    state.vtkglDisable(GL_DEPTH_TEST);
    state.vtkglDisable(GL_BLEND);
    state.vtkglDisable(GL_SCISSOR_TEST);
    state.vtkglActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, window_->GetDisplayFramebuffer()->GetColorAttachmentAsTextureObject(0)->GetHandle());
    program.SetUniformi("rays", 0);
    program.SetUniformi("n", n);
    glBindVertexArray(whole_picture_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    glBindTexture(GL_TEXTURE_2D, 0);
    window_->GetShaderCache()->ReleaseCurrentShader();
  }

  GpuLimits limits_;
  std::shared_ptr<const Scene> scene_;
  bool stale_ = false;  // the drawing is not yet the scene's
  std::unique_ptr<GpuDrawing> drawing_;
  vtkSmartPointer<ForeignWindow> window_;
  vtkSmartPointer<vtkRenderer> renderer_;
  vtkSmartPointer<DrawingProp> prop_;
  GpuProgram mean_program_{"supersampled pictures", whole_picture_vertex_shader, mean_shader};
  unsigned whole_picture_ = 0;
};

GpuScene::GpuScene(const GpuLimits& limits) : pipeline_(std::make_unique<Pipeline>(limits)) {}
GpuScene::~GpuScene() = default;

void GpuScene::set_scene(std::shared_ptr<const Scene> scene) {
  pipeline_->set_scene(std::move(scene));
}

void GpuScene::draw(const Camera& camera, const Parameters& parameters) {
  pipeline_->draw(camera, parameters);
}

void GpuScene::drop_scene() {
  pipeline_->drop_scene();
}

void GpuScene::release() {
  pipeline_->release();
}

}  // namespace atomesh::gui
