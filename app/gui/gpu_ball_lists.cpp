#include "app/gui/gpu_ball_lists.h"

#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkShaderProgram.h>
#include <vtk_glew.h>

#include <algorithm>

#include "app/gui/gpu_shaders.h"
#include "core/error.h"
#include "render/cpu/atom_balls.h"
#include "render/shared/materials.h"

namespace atomesh::gui {

namespace {

constexpr std::size_t bytes_of_a_hit = 12;
constexpr std::size_t first_room = std::size_t{4} << 20U;  // hits

}  // namespace

GpuBallLists::GpuBallLists()
    : list_program_{"lists of atom balls", list_vertex_shader, list_shader},
      shading_program_{"composed atom balls", list_picture_vertex_shader, list_shading_shader} {}

bool GpuBallLists::possible() {
  return GLEW_VERSION_4_5 != 0;
}

void GpuBallLists::make_room(std::size_t hits) {
  GLint64 block = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block);
  const std::size_t most = std::min(most_bytes_, static_cast<std::size_t>(block));
  const std::size_t room = std::min(hits, most / bytes_of_a_hit);
  if (room <= room_) return;
  try {
    const unsigned larger = make_buffer(nullptr, room * bytes_of_a_hit);
    delete_buffer(hits_);
    hits_ = larger;
    room_ = room;
  } catch (const UnavailableError&) {
    if (hits_ == 0) throw;  // else smaller bands will do
  }
}

std::size_t GpuBallLists::collect(vtkOpenGLRenderWindow& window, const GpuView& view, const GpuBallPart& balls,
                                  const GpuTarget& nearest_opaque, const GpuTarget& heads, const GpuTarget& light,
                                  const Band& band) {
  vtkOpenGLState& state = *window.GetState();
  heads.bind(window);
  heads.clear(window);
  light.bind(window);
  state.vtkglEnable(GL_SCISSOR_TEST);
  state.vtkglScissor(0, band.bottom, view.width, band.height);
  state.vtkglColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  state.vtkglDisable(GL_DEPTH_TEST);
  vtkShaderProgram& program = list_program_.use(window);
  tell(view, program);
  program.SetUniformi("wanted", 2);
  program.SetUniformi("first", balls.first);
  program.SetUniformi("room", static_cast<int>(room_));
  program.SetUniformi("opaque_ball", 0);
  program.SetUniformi("opaque_depth", 1);
  program.SetUniformi("balls", 2);
  bind_buffer_texture(window, 2, balls.texture);
  bind_texture(window, 1, nearest_opaque.depths());
  bind_texture(window, 0, nearest_opaque.texture());
  GLuint used = 0;
  glBindBuffer(GL_ATOMIC_COUNTER_BUFFER, used_);
  glBufferSubData(GL_ATOMIC_COUNTER_BUFFER, 0, sizeof(used), &used);
  glBindBufferBase(GL_ATOMIC_COUNTER_BUFFER, 0, used_);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, hits_);
  glBindImageTexture(0, heads.texture(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  glDrawArrays(GL_TRIANGLES, 0, vertices_of_a_ball * balls.count);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  glGetBufferSubData(GL_ATOMIC_COUNTER_BUFFER, 0, sizeof(used), &used);
  glBindBuffer(GL_ATOMIC_COUNTER_BUFFER, 0);
  state.vtkglColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  return used;
}

void GpuBallLists::shade(vtkOpenGLRenderWindow& window, const GpuView& view) {
  window.GetState()->vtkglDisable(GL_BLEND);
  vtkShaderProgram& program = shading_program_.use(window);
  tell(view, program);
  program.SetUniformi("balls", 2);
  program.SetUniformf("opaque", static_cast<float>(1.0 - faintest));
  program.SetUniformf("ambient_share", optics::ambient_share);
  program.SetUniformf("diffuse_share", optics::diffuse_share);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

bool GpuBallLists::compose(vtkOpenGLRenderWindow& window, const GpuView& view, const GpuBallPart& balls,
                           unsigned no_attributes, const GpuTarget& nearest_opaque, const GpuTarget& heads,
                           const GpuTarget& light) {
  vtkOpenGLState& state = *window.GetState();
  if (used_ == 0) used_ = make_buffer(nullptr, sizeof(GLuint));
  make_room(first_room);
  glBindVertexArray(no_attributes);
  if (rows_ == 0) rows_ = view.height;
  bool done = true;
  Band band;
  while (done && band.bottom < view.height) {
    band.height = std::min(rows_, view.height - band.bottom);
    const std::size_t hits = collect(window, view, balls, nearest_opaque, heads, light, band);
    if (hits > room_) {
      const std::size_t before = room_;
      make_room(hits + hits / 4);
      if (room_ > before) continue;
      done = band.height > 1;
      rows_ = std::max(1, static_cast<int>(0.8 * band.height * static_cast<double>(room_) / static_cast<double>(hits)));
      continue;
    }
    shade(window, view);
    band.bottom += band.height;
    // Where there is room to spare the next one may be higher.
    if (2 * hits < room_) rows_ = std::min(2 * rows_, view.height);
  }
  state.vtkglDisable(GL_SCISSOR_TEST);
  glBindImageTexture(0, 0, 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, 0);
  glBindBufferBase(GL_ATOMIC_COUNTER_BUFFER, 0, 0);
  bind_buffer_texture(window, 2, 0);
  bind_texture(window, 1, 0);
  bind_texture(window, 0, 0);
  return done;
}

void GpuBallLists::release() {
  delete_buffer(hits_);
  delete_buffer(used_);
  room_ = 0;
  rows_ = 0;
  list_program_.program = nullptr;
  shading_program_.program = nullptr;
}

}  // namespace atomesh::gui
