#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLShaderCache.h>
#include <vtkShaderProgram.h>

#include <algorithm>
#include <string>

#include "app/gui/gpu_drawing.h"
#include "core/error.h"
#include "render/shared/lights.h"

namespace atomesh::gui {

namespace {

void set_vector(float* to, const Vec3& from) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(from[i]);
}

}  // namespace

GpuView gpu_view(const Scene& scene, const Camera& camera, const Parameters& parameters) {
  GpuView view;
  view.width = camera.width;
  view.height = camera.height;
  view.perspective = camera.projection == Projection::perspective;
  view.pixel = static_cast<float>(camera.pixel);
  const Vec3 eye = camera.eye - scene.center;
  const double radius = scene.bounds.empty() ? 0.0 : 0.5 * scene.bounds.diagonal();
  const double anchor_depth = view.perspective ? 0.0 : 2.0 * radius;  // as make_camera() has it
  const Vec3 anchor = eye + anchor_depth * camera.forward;
  set_vector(view.anchor.data(), anchor);
  set_vector(view.anchor_rest.data(), anchor - Vec3(Vec3f(anchor)));
  view.anchor_depth = static_cast<float>(anchor_depth);
  for (int i = 0; i < 3; ++i) {
    set_vector(&view.axes[static_cast<std::size_t>(3 * i)], {camera.right[i], camera.up[i], camera.forward[i]});
  }
  const double away = glm::length(scene.bounds.center() - camera.eye);
  view.reach = static_cast<float>(1.0 / (1.001 * (away + radius) + 1e-30));
  for (const optics::LightRay& light : optics::scene_lights(parameters, scene, camera)) {
    const Vec3 p = Vec3(light.position) - eye;
    const auto at = static_cast<std::size_t>(3 * view.light_count++);
    set_vector(&view.light_positions[at],
               {glm::dot(p, camera.right), glm::dot(p, camera.up), glm::dot(p, camera.forward)});
    set_vector(&view.light_colors[at], Vec3(light.color));
  }
  return view;
}

void tell(const GpuView& view, vtkShaderProgram& program) {
  const std::array<float, 2> picture{static_cast<float>(view.width), static_cast<float>(view.height)};
  std::array<float, 9> axes = view.axes;
  program.SetUniform2f("picture", picture.data());
  program.SetUniformi("perspective", view.perspective ? 1 : 0);
  program.SetUniformf("pixel", view.pixel);
  program.SetUniformf("reach", view.reach);
  program.SetUniform3f("anchor", view.anchor.data());
  program.SetUniform3f("anchor_rest", view.anchor_rest.data());
  program.SetUniformf("anchor_depth", view.anchor_depth);
  program.SetUniformMatrix3x3("axes", axes.data());
  program.SetUniformi("light_count", view.light_count);
  program.SetUniform3fv("light_positions", max_lights, view.light_positions.data());
  program.SetUniform3fv("light_colors", max_lights, view.light_colors.data());
}

vtkShaderProgram& GpuProgram::use(vtkOpenGLRenderWindow& window) {
  vtkOpenGLShaderCache& cache = *window.GetShaderCache();
  vtkShaderProgram* ready = program != nullptr ? cache.ReadyShaderProgram(program)
                                               : cache.ReadyShaderProgram(vertex().c_str(), fragment().c_str(), "");
  if (ready == nullptr || !ready->GetCompiled()) {
    throw UnavailableError(std::string("the graphics driver does not take the shader of ") + name);
  }
  program = ready;
  return *program;
}

}  // namespace atomesh::gui
