// Surfaces and atom balls by VTK on the graphics card, in an OpenGL context of somebody else's.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/camera.h"
#include "core/parameters.h"
#include "render/scene.h"

namespace atomesh::gui {

// Draws the same pictures as render() does in modes surface and atoms: camera, lights, cut planes, background, colours,
// opacities; a test compares them. All calls with the context current.
class GpuScene {
 public:
  GpuScene();
  ~GpuScene();
  GpuScene(const GpuScene&) = delete;
  GpuScene& operator=(const GpuScene&) = delete;

  // What is drawn from now on: mode surface or atoms. Uploaded at the next draw().
  void set_scene(std::shared_ptr<const Scene> scene);
  // Into the framebuffer object that is bound, camera.width × camera.height device pixels, background included.
  void draw(const Camera& camera, const Parameters& parameters);
  // Before the context goes: gives back what lies on the card.
  void release();

 private:
  class Pipeline;
  std::unique_ptr<Pipeline> pipeline_;
};

struct GpuInfo {
  std::string renderer;     // GL_RENDERER
  std::string version;      // GL_VERSION
  bool sufficient = false;  // OpenGL 3.2 or later
  bool software = false;    // llvmpipe, softpipe, swrast, SwiftShader, …
};
// Of the current context; `proc` gives a function's address by name (QOpenGLContext::getProcAddress).
GpuInfo gpu_info(const std::function<void*(const char*)>& proc);

}  // namespace atomesh::gui
