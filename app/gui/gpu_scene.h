// Surfaces and atom balls by VTK on the graphics card, in an OpenGL context of somebody else's.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <string>

#include "core/camera.h"
#include "core/parameters.h"
#include "render/scene.h"

namespace atomesh::gui {

// What a card is taken to be capable of, at most; less than it is, for tests.
struct GpuLimits {
  bool lists = true;  // transparent balls by OpenGL 4.5 where there is that, not peeled as OpenGL 3.2 can
  std::size_t list_bytes = std::size_t{400} * 1000 * 1000;       // of those lists
  std::size_t texture_floats = std::numeric_limits<int>::max();  // of a buffer texture
};

// Draws the same pictures as render() does in modes surface and atoms: camera, lights, cut planes, background, colours,
// opacities, supersampling; a test compares them. On the card lie 36 bytes a ball, or 24 a vertex and 24 a triangle; a
// view that changes sends nothing but a few numbers. All calls with the context current, which has OpenGL 3.2 (core) or
// later; whether it came through GLX or EGL does not matter.
class GpuScene {
 public:
  explicit GpuScene(const GpuLimits& limits = {});
  // release() before, unless the context is gone already.
  ~GpuScene();
  GpuScene(const GpuScene&) = delete;
  GpuScene& operator=(const GpuScene&) = delete;

  // What is drawn from now on: mode surface or atoms (UsageError for another); none draws the background. Uploaded at
  // the next draw(), from the scene as it is then.
  void set_scene(std::shared_ptr<const Scene> scene);
  // Into the framebuffer object that is bound, camera.width × camera.height device pixels, background included. Colours
  // are premultiplied by their coverage, as compositors take them (the same where the background is opaque). Of n × n
  // rays a pixel (Parameters::supersampling) as many are drawn as the card's textures hold. Throws UnavailableError
  // where this OpenGL will not do, and nothing is drawn.
  void draw(const Camera& camera, const Parameters& parameters);
  // set_scene(nullptr), and what lies on the card for the scene goes at once.
  void drop_scene();
  // Before the context goes: gives back what lies on the card. The scene stays; the next draw(), also in another
  // context, uploads it again.
  void release();

 private:
  class Pipeline;
  std::unique_ptr<Pipeline> pipeline_;
};

struct GpuInfo {
  std::string renderer;     // GL_RENDERER
  std::string version;      // GL_VERSION
  bool sufficient = false;  // OpenGL 3.2 or later, not OpenGL ES
  bool volumes = false;     // OpenGL 4.3 or later, for gl::VolumePicture
  bool software = false;    // llvmpipe, softpipe, swrast, SwiftShader, …
};
// Of the current context; `proc` gives a function's address by name (QOpenGLContext::getProcAddress).
GpuInfo gpu_info(const std::function<void*(const char*)>& proc);

}  // namespace atomesh::gui
