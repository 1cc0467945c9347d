// What GpuScene is made of: the numbers its shaders are told of a view, and one drawing for each mode.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "app/gui/gpu_scene.h"
#include "core/camera.h"
#include "core/parameters.h"
#include "render/scene.h"

class vtkOpenGLRenderWindow;
class vtkShaderProgram;

namespace atomesh::gui {

// Shaders work in the eye's space: the camera's axes (x right, y up, z forward) about its eye, Å. Doubles end here;
// where a difference of large numbers would be left to a float, the number comes in two.
struct GpuView {
  int width = 1;  // pixels
  int height = 1;
  bool perspective = true;
  float pixel = 1.0F;  // Camera::pixel
  // A point of the line of sight about Scene::center, rounded to float, what rounding took away, and its depth. The eye
  // itself or, with parallel projection, where the eye is far, what is looked at.
  std::array<float, 3> anchor{};
  std::array<float, 3> anchor_rest{};
  float anchor_depth = 0.0F;
  std::array<float, 9> axes{};  // matrix of a point about the anchor to eye space, but for its depth, column by column
  float reach = 1.0F;           // 1 / a length that nothing of the scene is farther away than
  int light_count = 0;          // of enabled lights
  std::array<float, 3 * max_lights> light_positions{};  // eye space
  std::array<float, 3 * max_lights> light_colors{};     // colour × intensity
};
GpuView gpu_view(const Scene& scene, const Camera& camera, const Parameters& parameters);
// Sets the uniforms that view_declarations() (gpu_shaders.h) declares. The program is the one in use.
void tell(const GpuView& view, vtkShaderProgram& program);

// A program of the window's, compiled when first used. Forget it when the context goes.
struct GpuProgram {
  const char* name;  // of what it draws
  std::string (*vertex)();
  std::string (*fragment)();
  vtkShaderProgram* program = nullptr;

  // In use from now on. Throws UnavailableError when the driver refuses it.
  vtkShaderProgram& use(vtkOpenGLRenderWindow& window);
};

// One scene on the graphics card. All calls with the context current.
class GpuDrawing {
 public:
  virtual ~GpuDrawing() = default;
  // Into the window's framebuffer, which holds the background (premultiplied) and no depths yet. Uploads first what
  // is not there yet. Throws UnavailableError when the card has no room for it.
  virtual void draw(vtkOpenGLRenderWindow& window, const GpuView& view, const Parameters& parameters) = 0;
  // Gives everything back; the next draw() uploads again.
  virtual void release() = 0;
};
std::unique_ptr<GpuDrawing> make_gpu_surface(std::shared_ptr<const Scene> scene, const GpuLimits& limits);
std::unique_ptr<GpuDrawing> make_gpu_balls(std::shared_ptr<const Scene> scene, const GpuLimits& limits);

}  // namespace atomesh::gui
