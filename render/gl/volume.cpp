#include "render/gl/volume.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>

#include "core/error.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "render/gl/front_faces.h"
#include "render/gl/state_guard.h"

namespace atomesh::gl {

namespace {

using Clock = std::chrono::steady_clock;

// A thread's share of a slab, and a slab: 19 MB of vertices.
constexpr std::size_t cells_per_share = 4096;
constexpr std::size_t cells_per_slab = 16 * cells_per_share;
constexpr std::size_t vertices_per_cell = 3 * most_faces;
constexpr std::size_t slab_bytes = cells_per_slab * vertices_per_cell * sizeof(FaceVertex);

// Slabs of a view that is drawn again are kept up to so many bytes.
constexpr std::size_t kept_bytes = std::size_t{512} << 20;

// Of the stencil buffer: a cell came that begins before the last one of its pixel.
constexpr GLuint disorder_bit = 1;

GLint integer(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

// Those of `count` cells that are not among `cells`, which ascend.
std::vector<Index> cells_beside(std::span<const Index> cells, std::size_t count) {
  std::vector<Index> others;
  others.reserve(count - cells.size());
  std::size_t next = 0;
  for (std::size_t cell = 0; cell < count; ++cell) {
    if (next < cells.size() && cells[next] == cell) {
      ++next;
    } else {
      others.push_back(static_cast<Index>(cell));
    }
  }
  return others;
}

// No segment is longer.
double longest_edge(const Scene& scene) {
  std::vector<float> longest((scene.tetrahedra.size() + cells_per_share - 1) / cells_per_share);
  parallel_for(scene.tetrahedra.size(), cells_per_share, [&](std::size_t begin, std::size_t end) {
    float most = 0.0F;
    for (std::size_t i = begin; i < end; ++i) {
      const Tetrahedron& t = scene.tetrahedra[i];
      for (std::size_t a = 0; a < 4; ++a) {
        for (std::size_t b = a + 1; b < 4; ++b) {
          const Vec3f edge = scene.vertices[t[b]] - scene.vertices[t[a]];
          most = std::max(most, glm::dot(edge, edge));
        }
      }
    }
    longest[begin / cells_per_share] = std::sqrt(most);
  });
  return longest.empty() ? 0.0 : static_cast<double>(*std::max_element(longest.begin(), longest.end()));
}

bool same(const Camera& a, const Camera& b) {
  return a.eye == b.eye && a.right == b.right && a.up == b.up && a.forward == b.forward && a.projection == b.projection;
}

}  // namespace

Volume::Volume() : driver_(current_driver()) {
  require_sufficient_driver();
  blend_ = make_programs("blend.frag", {});
  std::array<GLint, 2> viewport{};
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
  viewport_side_ = std::min({viewport[0], viewport[1], 2 * guard_pixels});
  // A power of two: places on the screen are then exact in clip space.
  while ((viewport_side_ & (viewport_side_ - 1)) != 0) viewport_side_ &= viewport_side_ - 1;
  largest_side_ = std::min(integer(GL_MAX_TEXTURE_SIZE), viewport_side_);
  vertex_array_ = make_vertex_array();
  framebuffer_ = make_framebuffer();
}

Volume::Programs Volume::make_programs(std::string_view fragment_file, std::vector<std::string> defines) const {
  Programs programs;
  if (with_table_) defines.emplace_back("TABLE");
  if (with_ray_ends_) defines.emplace_back("RAY_ENDS");
  programs.parallel = Program::draw("cells.vert", fragment_file, defines);
  defines.emplace_back("PERSPECTIVE");
  programs.perspective = Program::draw("cells.vert", fragment_file, defines);
  return programs;
}

bool Volume::make_table(const Parameters& parameters) {
  table_.update(parameters.volume.color_map, parameters.volume.alpha_length);
  if (parameters.havs.integration == HavsIntegration::exact) return false;
  if (parameters.havs.integration == HavsIntegration::automatic && driver_.software) return false;
  if (!(longest_segment_ > 0.0)) longest_segment_ = longest_edge(*scene_);
  return table_.make_table(longest_segment_, parameters.havs.table_error);
}

void Volume::choose_programs(bool table, bool rays_end) {
  if (with_table_ == table && with_ray_ends_ == rays_end) return;
  with_table_ = table;
  with_ray_ends_ = rays_end;
  blend_ = make_programs("blend.frag", {});
  repair_.reset();
}

void Volume::make_repair(const HavsParameters& parameters) {
  RepairSettings settings;
  if (parameters.order == HavsOrder::k_buffer) {
    // Software draws the fragments of a pixel one after the other, as interlock makes cards do.
    settings.method = driver_.interlock || driver_.software ? RepairMethod::keep : RepairMethod::replay;
  }
  settings.k = parameters.k;
  settings.memory = static_cast<std::size_t>(parameters.memory) << 20;
  settings.stencil_bits = disorder_bit;
  if (repair_ && repair_->settings() == settings) return;
  repair_ = std::make_unique<OrderRepair>(settings);
  gather_ = make_programs(repair_->fragment_shader(), repair_->defines());
}

// Texture of unit 9: w (ScreenVertex) of each pixel's ray's end.
void Volume::end_rays(std::span<const float> ray_ends) {
  if (ray_ends.empty()) return;
  if (ray_ends_.width() < columns_ || ray_ends_.height() < rows_) {
    ray_ends_ = Texture::make_2d(GL_R32F, std::max(columns_, ray_ends_.width()), std::max(rows_, ray_ends_.height()));
  }
  const ScreenView& view = mesh_->view();
  std::vector<float> ends(ray_ends.size());
  std::transform(ray_ends.begin(), ray_ends.end(), ends.begin(), [&](float depth) {
    const auto z = static_cast<double>(depth);
    const double w = view.perspective ? -view.reference / z : z - view.reference;
    return static_cast<float>(std::min(w, static_cast<double>(view.last_w)));
  });
  ray_ends_.bind(9);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, columns_, rows_, GL_RED, GL_FLOAT, ends.data());
}

void Volume::set_scene(const Scene& scene) {
  scene_ = &scene;
  view_.reset();
  order_.reset();
  longest_segment_ = 0.0;
}

bool Volume::same_view(const Camera& camera, const PixelGrid& grid, const Parameters& parameters) const {
  return view_ && same(view_->camera, camera) && view_->grid == grid && view_->color_map == parameters.volume.color_map;
}

void Volume::find_cells(const Camera& camera, const PixelGrid& grid, const Parameters& parameters,
                        const Progress& progress) {
  view_.reset();
  const Clock::time_point start = Clock::now();
  mesh_ = std::make_unique<ScreenMesh>(*scene_, camera, grid,
                                       cell_projection::MapIntervals(parameters.volume.color_map), progress);
  last_.project_ms = ms_since(start);
  const Clock::time_point sorting = Clock::now();
  // By faces there is hardly a pixel to repair, but it takes one core 50 ms for a million cells: a card repairs the few
  // pixels that a Delaunay mesh's keys leave sooner.
  if (!order_) order_ = std::make_unique<CellOrder>(*scene_, by_faces_.value_or(driver_.software || !scene_->delaunay));
  std::vector<Index> order;
  CellOrderStats order_stats;
  const std::vector<Index> unseen =
      order_->by_faces() ? cells_beside(mesh_->cells(), scene_->tetrahedra.size()) : std::vector<Index>();
  order_->sort(camera, mesh_->cells(), unseen, order, order_stats);
  parts_ = mesh_->parts(order);
  last_.order_ms = ms_since(sorting);
  last_.cells = order.size();
  slabs_kept_ = false;
  view_ = View{camera, grid, parameters.volume.color_map};
}

void Volume::fill(Slab& slab, std::span<const Index> parts) {
  const std::size_t shares = (parts.size() + cells_per_share - 1) / cells_per_share;
  slab.vertices.reserve(slab_bytes, GL_STREAM_DRAW);
  slab.first.resize(shares);
  slab.count.resize(shares);
  glBindBuffer(GL_ARRAY_BUFFER, slab.vertices.name());
  auto* vertices = static_cast<FaceVertex*>(glMapBufferRange(
      GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(parts.size() * vertices_per_cell * sizeof(FaceVertex)),
      GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT));
  if (vertices == nullptr) {
    check_errors("mapping vertices");
    throw UnavailableError("OpenGL: memory for vertices cannot be mapped (" + driver_.renderer + ")");
  }
  parallel_for(parts.size(), cells_per_share, [&](std::size_t begin, std::size_t end) {
    const std::size_t first = begin * vertices_per_cell;
    std::size_t triangles = 0;
    for (std::size_t i = begin; i < end; ++i) {
      triangles += front_faces(mesh_->corners(parts[i]), mesh_->view().grid, vertices + first + 3 * triangles);
    }
    slab.first[begin / cells_per_share] = static_cast<GLint>(first);
    slab.count[begin / cells_per_share] = static_cast<GLsizei>(3 * triangles);
  });
  glUnmapBuffer(GL_ARRAY_BUFFER);
}

void Volume::resize(int columns, int rows) {
  columns_ = columns;
  rows_ = rows;
  if (color_.width() >= columns && color_.height() >= rows) return;
  const int width = std::max(columns, color_.width());
  const int height = std::max(rows, color_.height());
  color_ = Texture();
  depth_ = Texture();
  color_ = Texture::make_2d(GL_RGBA32F, width, height);
  depth_ = Texture::make_2d(GL_DEPTH24_STENCIL8, width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color_.name(), 0);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, depth_.name(), 0);
  check_errors("making the picture");
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw UnavailableError("OpenGL: the driver \"" + driver_.renderer + "\" cannot draw into floats");
  }
}

void Volume::use(const Programs& programs) const {
  const ScreenView& view = mesh_->view();
  const Program& program = view.perspective ? programs.perspective : programs.parallel;
  program.use();
  const double depth_scale = 2.0 / (static_cast<double>(view.last_w) - static_cast<double>(view.first_w));
  glUniform1f(program.uniform("pixel_scale"), 2.0F / static_cast<float>(viewport_side_));
  glUniform2f(program.uniform("depth_scale"), static_cast<GLfloat>(depth_scale),
              static_cast<GLfloat>(-1.0 - static_cast<double>(view.first_w) * depth_scale));
  glUniform1f(program.uniform("reference"), static_cast<GLfloat>(view.reference));
  glUniform1f(program.uniform("last_w"), view.last_w);
  // gl_FragCoord of pixel (i, j) is (i + 1/2, j + 1/2).
  const PixelGrid& grid = view.grid;
  glUniform4f(program.uniform("direction"), static_cast<GLfloat>(grid.x - 0.5 * grid.dx),
              static_cast<GLfloat>(grid.y + 0.5 * grid.dy), static_cast<GLfloat>(grid.dx),
              static_cast<GLfloat>(-grid.dy));
  table_.bind();
  if (with_ray_ends_) ray_ends_.bind(9);
  glBindVertexArray(vertex_array_.name());
}

void Volume::draw_slab(const Slab& slab) const {
  glBindBuffer(GL_ARRAY_BUFFER, slab.vertices.name());
  glEnableVertexAttribArray(0);
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(FaceVertex), nullptr);
  glVertexAttribPointer(1, 4, GL_FLOAT, GL_FALSE, sizeof(FaceVertex),
                        reinterpret_cast<const void*>(offsetof(FaceVertex, behind)));
  if (!driver_.software) {
    glMultiDrawArrays(GL_TRIANGLES, slab.first.data(), slab.count.data(), static_cast<GLsizei>(slab.first.size()));
    return;
  }
  // Software sorts triangles into tiles before it fills them: in small portions they are still in the caches then, and
  // its threads have something to do sooner (a tenth of the time, llvmpipe).
  for (std::size_t i = 0; i < slab.first.size(); ++i) {
    glDrawArrays(GL_TRIANGLES, slab.first[i], slab.count[i]);
    glFlush();
  }
}

// What a repair asks for: of the parts those alone that lie where pixels are marked.
void Volume::draw_marked(const Progress& progress) {
  const MarkedTiles& tiles = repair_->tiles();
  const PixelGrid& grid = mesh_->view().grid;
  std::vector<std::vector<Index>> found((parts_.size() + cells_per_slab - 1) / cells_per_slab);
  parallel_for(parts_.size(), cells_per_slab, [&](std::size_t begin, std::size_t end) {
    progress.check();
    std::vector<Index>& near = found[begin / cells_per_slab];
    for (std::size_t i = begin; i < end; ++i) {
      const GridBox box = pixels_between(mesh_->corners(parts_[i]), grid);
      if (tiles.meets(box.left, box.right, box.top, box.bottom)) near.push_back(parts_[i]);
    }
  });
  std::vector<Index> near;
  for (std::size_t n = 0; n < found.size(); ++n) {
    near.insert(near.end(), found[n].begin(), found[n].end());
    // A slab that is full, and the last one.
    std::size_t drawn = 0;
    while (near.size() - drawn >= cells_per_slab || (n + 1 == found.size() && near.size() > drawn)) {
      progress.check();
      const std::size_t count = std::min(cells_per_slab, near.size() - drawn);
      fill(marked_, std::span(near).subspan(drawn, count));
      draw_slab(marked_);
      drawn += count;
    }
    near.erase(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(drawn));
  }
}

template <class After>
void Volume::draw_slabs(After&& after) {
  const std::size_t count = (parts_.size() + cells_per_slab - 1) / cells_per_slab;
  const bool keep = count * slab_bytes <= kept_bytes;
  slabs_.resize(keep ? count : 1);
  for (std::size_t n = 0; n < count; ++n) {
    Slab& slab = slabs_[keep ? n : 0];
    if (!slabs_kept_) {
      const std::size_t begin = n * cells_per_slab;
      const Clock::time_point start = Clock::now();
      fill(slab, std::span(parts_).subspan(begin, std::min(cells_per_slab, parts_.size() - begin)));
      last_.faces_ms += ms_since(start);
    }
    draw_slab(slab);
    after(slab, static_cast<double>(n + 1) / static_cast<double>(count));
  }
  slabs_kept_ = keep;
}

void Volume::clear_picture() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, columns_, rows_);
  glViewport(columns_ / 2 - viewport_side_ / 2, rows_ / 2 - viewport_side_ / 2, viewport_side_, viewport_side_);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glStencilMask(0xFF);
  const std::array<GLfloat, 4> nothing{};
  glClearBufferfv(GL_COLOR, 0, nothing.data());
  glClearBufferfi(GL_DEPTH_STENCIL, 0, 0.0F, 0);
}

// Front to back: what comes lies behind what there is. The fixed functions find the pixels whose cells come in another
// order: where one begins before the last one it is not drawn, but leaves its mark.
void Volume::set_blending(bool check_order) {
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE_MINUS_DST_ALPHA, GL_ONE);
  glDisable(GL_CULL_FACE);
  // Steps of 1/4096 of the sample: where cells follow one another, rounding turns no two round.
  glDepthRangef(0.0F, 1.0F / 4096.0F);
  glEnable(GL_DEPTH_CLAMP);  // what rounding puts before the first depth or behind the last
  (check_order ? glEnable : glDisable)(GL_DEPTH_TEST);
  (check_order ? glEnable : glDisable)(GL_STENCIL_TEST);
  glDepthFunc(GL_GEQUAL);
  glStencilFunc(GL_ALWAYS, disorder_bit, disorder_bit);
  glStencilOp(GL_KEEP, GL_REPLACE, GL_KEEP);
}

void Volume::draw(const Camera& camera, const Parameters& parameters, const PixelWindow& window,
                  const PixelLattice& lattice, RenderStats& stats, Progress& progress,
                  std::span<const float> ray_ends) {
  const Clock::time_point start = Clock::now();
  const StateGuard guard;
  const PixelGrid grid = pixel_grid(camera, window, lattice);
  resize(grid.columns, grid.rows);
  if (grid.columns == 0 || grid.rows == 0) return;
  last_.project_ms = last_.order_ms = last_.faces_ms = 0.0;
  if (!same_view(camera, grid, parameters)) find_cells(camera, grid, parameters, progress);
  choose_programs(make_table(parameters), !ray_ends.empty());
  end_rays(ray_ends);
  const bool check_order = parameters.havs.order != HavsOrder::none;
  if (check_order) make_repair(parameters.havs);
  stats.setup_ms += ms_since(start);

  const Clock::time_point drawing = Clock::now();
  clear_picture();
  set_blending(check_order);
  use(blend_);
  last_.triangles = 0;
  last_.repair = {};
  draw_slabs([&](const Slab& slab, double fraction) {
    for (const GLsizei count : slab.count) last_.triangles += static_cast<std::size_t>(count) / 3;
    progress.update(fraction);
  });
  if (check_order) {
    const auto gather = [&] {
      use(gather_);
      draw_marked(progress);
    };
    glFinish();  // what has been drawn is not the repair's time; it has to look at it anyway
    repair_->repair(framebuffer_.name(), columns_, rows_, gather, last_.repair);
  }
  glFinish();
  check_errors("drawing the volume");
  progress.update(1.0);
  last_.draw_ms = ms_since(drawing) - last_.faces_ms - last_.repair.ms;
  stats.render_ms += ms_since(drawing);
}

Image Volume::read() const {
  Image image(columns_, rows_);
  if (image.pixels.empty()) return image;
  const StateGuard guard;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glReadPixels(0, 0, columns_, rows_, GL_RGBA, GL_FLOAT, image.pixels.data());
  check_errors("reading the picture");
  return image;
}

}  // namespace atomesh::gl
