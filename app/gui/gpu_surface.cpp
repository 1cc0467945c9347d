#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkShaderProgram.h>
#include <vtk_glew.h>

#include <algorithm>

#include "app/gui/gpu_buffers.h"
#include "app/gui/gpu_drawing.h"
#include "app/gui/gpu_shaders.h"
#include "render/shared/materials.h"

namespace atomesh::gui {

namespace {

void set_color(vtkShaderProgram& program, const char* name, const Vec3f& color) {
  const std::array<float, 3> rgb{color.r, color.g, color.b};
  program.SetUniform3f(name, rgb.data());
}

class GpuSurface final : public GpuDrawing {
 public:
  GpuSurface(std::shared_ptr<const Scene> scene, const GpuLimits& limits) : scene_(std::move(scene)), limits_(limits) {}

  void draw(vtkOpenGLRenderWindow& window, const GpuView& view, const Parameters& parameters) override {
    if (scene_->surface.empty()) return;
    vtkShaderProgram& program = program_.use(window);
    if (parts_.empty()) upload(program);
    tell(view, program);
    const optics::PhongCoefficients material = optics::surface_material(parameters.surface);
    set_color(program, "ambient", material.ambient);
    set_color(program, "diffuse", material.diffuse);
    set_color(program, "specular", material.specular);
    set_color(program, "emission", material.emission);
    program.SetUniformf("shininess", material.shininess);
    program.SetUniformi("is_smooth", scene_->vertex_normals.empty() ? 0 : 1);
    program.SetUniformi("face_normals", 0);

    vtkOpenGLState& state = *window.GetState();
    state.vtkglEnable(GL_DEPTH_TEST);
    state.vtkglDepthFunc(GL_LESS);
    state.vtkglDepthMask(GL_TRUE);
    state.vtkglDisable(GL_BLEND);
    state.vtkglDisable(GL_CULL_FACE);
    glBindVertexArray(attributes_);
    for (const Part& part : parts_) {
      glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, part.corners);
      bind_buffer_texture(window, 0, part.normals_texture);
      glDrawElements(GL_TRIANGLES, part.count, GL_UNSIGNED_INT, nullptr);
    }
    glBindVertexArray(0);
    bind_buffer_texture(window, 0, 0);
    state.vtkglEnable(GL_BLEND);
    state.vtkglDepthFunc(GL_LEQUAL);
  }

  void release() override {
    for (Part& part : parts_) {
      delete_buffer(part.corners);
      delete_texture(part.normals_texture);
      delete_buffer(part.normals);
    }
    parts_.clear();
    delete_buffer(positions_);
    delete_buffer(vertex_normals_);
    delete_vertex_array(attributes_);
    program_.program = nullptr;
  }

 private:
  // As many triangles as a texture of their normals can hold.
  struct Part {
    unsigned corners = 0;
    unsigned normals = 0;
    unsigned normals_texture = 0;
    int count = 0;  // of corners
  };

  void upload(vtkShaderProgram& program) {
    glGenVertexArrays(1, &attributes_);
    glBindVertexArray(attributes_);
    positions_ = make_buffer(scene_->vertices.data(), scene_->vertices.size() * sizeof(Vec3f));
    set_attribute(program, "position", positions_);
    if (!scene_->vertex_normals.empty()) {
      vertex_normals_ = make_buffer(scene_->vertex_normals.data(), scene_->vertex_normals.size() * sizeof(Vec3f));
      set_attribute(program, "normal", vertex_normals_);
    }
    glBindVertexArray(0);
    const std::size_t most = std::min(largest_buffer_texture(), limits_.texture_floats) / 3;
    for (std::size_t first = 0; first < scene_->surface.size(); first += most) {
      const std::size_t count = std::min(most, scene_->surface.size() - first);
      Part part;
      part.corners = make_buffer(scene_->surface.data() + first, count * sizeof(Triangle));
      part.normals = make_buffer(scene_->face_normals.data() + first, count * sizeof(Vec3f));
      part.normals_texture = make_buffer_texture(part.normals);
      part.count = static_cast<int>(3 * count);
      parts_.push_back(part);
    }
  }

  std::shared_ptr<const Scene> scene_;
  GpuLimits limits_;
  GpuProgram program_{"surfaces", surface_vertex_shader, surface_fragment_shader};
  unsigned attributes_ = 0;
  unsigned positions_ = 0;
  unsigned vertex_normals_ = 0;
  std::vector<Part> parts_;
};

}  // namespace

std::unique_ptr<GpuDrawing> make_gpu_surface(std::shared_ptr<const Scene> scene, const GpuLimits& limits) {
  return std::make_unique<GpuSurface>(std::move(scene), limits);
}

}  // namespace atomesh::gui
