#include "render/gl/volume.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "render/gl/state_guard.h"

namespace atomesh::gl {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t cells_per_range = 4096;

// Of the stencil buffer: a cell came that begins before the last one of its pixel.
constexpr GLuint disorder_bit = 1;

GLint integer(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

// No segment is longer.
double longest_edge(const Scene& scene) {
  std::vector<float> longest((scene.tetrahedra.size() + cells_per_range - 1) / cells_per_range);
  parallel_for(scene.tetrahedra.size(), cells_per_range, [&](std::size_t begin, std::size_t end) {
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
    longest[begin / cells_per_range] = std::sqrt(most);
  });
  return longest.empty() ? 0.0 : static_cast<double>(*std::max_element(longest.begin(), longest.end()));
}

bool same(const Camera& a, const Camera& b) {
  return a.eye == b.eye && a.right == b.right && a.up == b.up && a.forward == b.forward && a.projection == b.projection;
}

}  // namespace

// Of one call of proceed(). Portions are half of what fits into the rest of the time each, until an eighth of it is
// left: they are not all alike.
struct Volume::Pace {
  explicit Pace(double milliseconds) : budget(milliseconds) {}
  bool limited() const { return std::isfinite(budget); }
  bool over() const { return ms_since(start) >= 0.875 * budget; }
  double rest() const { return std::max(0.875 * budget - ms_since(start), 0.0); }
  std::size_t portion(double places_per_ms) const {
    if (!limited()) return cells_per_slab;
    if (!(places_per_ms > 0.0)) return first_portion;
    const double fit = 0.5 * std::max(budget - ms_since(start), 0.0) * places_per_ms;
    return static_cast<std::size_t>(std::clamp<double>(fit, least_portion, cells_per_slab));
  }

  static constexpr std::size_t first_portion = 64;
  static constexpr std::size_t least_portion = 16;
  Clock::time_point start = Clock::now();
  double budget;
};

Volume::Volume() : driver_(current_driver()) {
  require_sufficient_driver();
  blend(CellKind::segment) = make_programs("cells.vert", "blend.frag", {});
  std::array<GLint, 2> viewport{};
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
  viewport_side_ = std::min({viewport[0], viewport[1], 2 * guard_pixels});
  // A power of two: places on the screen are then exact in clip space.
  while ((viewport_side_ & (viewport_side_ - 1)) != 0) viewport_side_ &= viewport_side_ - 1;
  largest_side_ = std::min(integer(GL_MAX_TEXTURE_SIZE), viewport_side_);
  vertex_array_ = make_vertex_array();
  framebuffer_ = make_framebuffer();
}

Volume::Programs Volume::make_programs(std::string_view vertex_file, std::string_view fragment_file,
                                       std::vector<std::string> defines) const {
  Programs programs;
  if (with_table_) defines.emplace_back("TABLE");
  if (with_ray_ends_) defines.emplace_back("RAY_ENDS");
  programs.parallel = Program::draw(vertex_file, fragment_file, defines);
  defines.emplace_back("PERSPECTIVE");
  programs.perspective = Program::draw(vertex_file, fragment_file, defines);
  return programs;
}

// A card has its table.
bool Volume::by_ramps(const Parameters& parameters) const {
  return driver_.software && parameters.havs.integration == HavsIntegration::automatic;
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
  blend_ = {};
  blend(CellKind::segment) = make_programs("cells.vert", "blend.frag", {});
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
  gather_ = make_programs("cells.vert", repair_->fragment_shader(), repair_->defines());
}

// Texture of unit 9: w (ScreenVertex) of each pixel's ray's end.
void Volume::end_rays(std::span<const float> ray_ends) {
  if (ray_ends.empty()) return;
  if (ray_ends_.width() < columns_ || ray_ends_.height() < rows_) {
    ray_ends_ = Texture::make_2d(GL_R32F, std::max(columns_, ray_ends_.width()), std::max(rows_, ray_ends_.height()));
  }
  const ScreenView& view = cells_->view();
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
  preparing_.give_up();
  scene_ = &scene;
  begun_.reset();
  view_.reset();
  cells_ = nullptr;
  processor_cells_.reset();
  card_cells_.reset();
  card_fails_ = false;
  longest_segment_ = 0.0;
}

bool Volume::same_view(const Camera& camera, const PixelGrid& grid, const Parameters& parameters) const {
  return view_ && same(view_->camera, camera) && view_->grid == grid && view_->color_map == parameters.volume.color_map;
}

void Volume::wait_if_timed() const {
  if (timed_steps_) glFinish();
}

bool Volume::project(Begun& begun, const Pace& pace, const Progress& progress) {
  last_.project_ms = last_.order_ms = last_.faces_ms = 0.0;
  last_.repair = {};
  resize(begun.grid.columns, begun.grid.rows);
  if (begun.grid.columns == 0 || begun.grid.rows == 0) return false;
  if (same_view(begun.camera, begun.grid, begun.parameters)) return true;
  view_.reset();
  const Clock::time_point start = Clock::now();
  last_.on_card = project_on_card(begun, progress);
  if (!last_.on_card) {
    // By faces there is hardly a pixel to repair, but it takes one core 50 ms for a million cells: a card repairs the
    // few pixels that a Delaunay mesh's keys leave sooner.
    if (!processor_cells_) {
      const bool by_faces = by_faces_.value_or(driver_.software || !scene_->delaunay);
      processor_cells_ = std::make_unique<ProcessorCells>(*scene_, by_faces, driver_.software);
    }
    cells_ = processor_cells_.get();
    begun.beside = pace.limited();
    if (!begun.beside) {
      cells_->project(begun.camera, begun.grid, begun.parameters.volume.color_map, progress);
    }
  }
  wait_if_timed();
  last_.project_ms = ms_since(start);
  return true;
}

// Whether it does.
bool Volume::project_on_card(const Begun& begun, const Progress& progress) {
  const bool wanted = prepare_on_card_.value_or(!driver_.software && !by_faces_.value_or(false));
  if (!wanted || card_fails_ || scene_->tetrahedra.empty()) return false;
  try {
    if (!card_cells_) card_cells_ = std::make_unique<CardCells>(*scene_, std::min(guard_pixels, viewport_side_ / 2));
    if (!card_cells_->fits(begun.camera, begun.grid)) return false;
    card_cells_->project(begun.camera, begun.grid, begun.parameters.volume.color_map, progress);
  } catch (const UnavailableError&) {
    // No memory, or a driver that does not take the shaders: the processor needs less of both.
    card_cells_.reset();
    card_fails_ = true;
    return false;
  }
  cells_ = card_cells_.get();
  return true;
}

bool Volume::order(const Begun& begun, const Pace& pace, Progress& progress) {
  if (view_) return true;  // the one before
  if (begun.beside) {
    progress.check();
    if (!preparing_.started()) {
      preparing_.start([cells = processor_cells_.get(), prepared = &prepared_, camera = begun.camera, grid = begun.grid,
                        color_map = begun.parameters.volume.color_map](Progress& own) {
        const Clock::time_point start = Clock::now();
        cells->project(camera, grid, color_map, own);
        own.check();
        prepared->project_ms = ms_since(start);
        cells->order(camera, own);
        prepared->order_ms = ms_since(start) - prepared->project_ms;
      });
    }
    if (!preparing_.over(pace.rest())) return false;
    preparing_.take();
    last_.project_ms = prepared_.project_ms;
    last_.order_ms = prepared_.order_ms;
  } else {
    const Clock::time_point start = Clock::now();
    Progress unheard(progress, 0.0, 0.0);  // what is reported are the cells drawn
    cells_->order(begun.camera, unheard);
    wait_if_timed();
    last_.order_ms = ms_since(start);
  }
  view_ = View{begun.camera, begun.grid, begun.parameters.volume.color_map};
  return true;
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
  const ScreenView& view = cells_->view();
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
  glUniform2f(program.uniform("middle"), static_cast<GLfloat>(grid.columns / 2), static_cast<GLfloat>(grid.rows / 2));
  table_.bind();
  if (with_ray_ends_) ray_ends_.bind(9);
}

void Volume::bind_picture() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, columns_, rows_);
  glViewport(columns_ / 2 - viewport_side_ / 2, rows_ / 2 - viewport_side_ / 2, viewport_side_, viewport_side_);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glStencilMask(0xFF);
  glBindVertexArray(vertex_array_.name());
}

// Front to back: what comes lies behind what there is.
void Volume::set_blending() {
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE_MINUS_DST_ALPHA, GL_ONE);
  glDisable(GL_CULL_FACE);
}

// The fixed functions find the pixels whose cells come in another order: where one begins before the last one it is not
// drawn, but leaves its mark.
void Volume::set_order_check(bool on) {
  // Steps of 1/4096 of the sample: where cells follow one another, rounding turns no two round.
  glDepthRangef(0.0F, 1.0F / 4096.0F);
  glEnable(GL_DEPTH_CLAMP);  // what rounding puts before the first depth or behind the last
  (on ? glEnable : glDisable)(GL_DEPTH_TEST);
  (on ? glEnable : glDisable)(GL_STENCIL_TEST);
  glDepthFunc(GL_GEQUAL);
  glStencilFunc(GL_ALWAYS, disorder_bit, disorder_bit);
  glStencilOp(GL_KEEP, GL_REPLACE, GL_KEEP);
}

void Volume::clear(const Begun& begun) {
  choose_programs(make_table(begun.parameters), !begun.ray_ends.empty());
  if (by_ramps(begun.parameters)) {
    if (!blend(CellKind::ramps).perspective) {
      blend(CellKind::piece) = make_programs("ramp_cells.vert", "blend.frag", {"RAMPS", "ONE_PIECE"});
      blend(CellKind::ramps) = make_programs("ramp_cells.vert", "blend.frag", {"RAMPS"});
    }
    cells_->use_ramps(begun.parameters.volume.color_map, begun.parameters.volume.alpha_length, !begun.ray_ends.empty());
  } else {
    cells_->use_no_ramps();
  }
  end_rays(begun.ray_ends);
  if (begun.parameters.havs.order != HavsOrder::none) make_repair(begun.parameters.havs);
  bind_picture();
  const std::array<GLfloat, 4> nothing{};
  glClearBufferfv(GL_COLOR, 0, nothing.data());
  glClearBufferfi(GL_DEPTH_STENCIL, 0, 0.0F, 0);
}

// Of the slab that is next.
void Volume::draw_portion(Begun& begun, const Pace& pace, Progress& progress) {
  const std::size_t places = cells_->places();
  const Clock::time_point start = Clock::now();
  if (cells_->make_slab(begun.drawn)) {
    wait_if_timed();
    last_.faces_ms += ms_since(start);
  }
  const Clock::time_point drawing = Clock::now();
  bind_picture();
  set_blending();
  // Software takes a fifth longer where it has to look at depths.
  set_order_check(begun.parameters.havs.order != HavsOrder::none && !cells_->outside_shows_order());
  const std::size_t count =
      cells_->draw(begun.drawn, pace.portion(begun.places_per_ms), [this](CellKind kind) { use(blend(kind)); });
  begun.drawn += count;
  if (pace.limited()) {
    glFinish();
    begun.places_per_ms = static_cast<double>(count) / std::max(ms_since(drawing), 1e-3);
  }
  progress.update(static_cast<double>(begun.drawn) / static_cast<double>(places));
}

// Marks the pixels whose cells came in a wrong order, where cells did not do so themselves.
void Volume::check_outside() {
  if (!cells_->outside_shows_order()) return;
  if (!outside_.perspective) outside_ = make_programs("cells.vert", "nothing.frag", {});
  bind_picture();
  glDisable(GL_CULL_FACE);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  set_order_check(true);
  use(outside_);
  cells_->draw_outside();
}

void Volume::repair(const Progress& progress) {
  const auto gather = [&] {
    use(gather_);
    cells_->draw_marked(repair_->tiles(), progress);
  };
  glFinish();  // what has been drawn is not the repair's time; it has to look at it anyway
  bind_picture();
  set_order_check(true);  // depths as before
  repair_->repair(framebuffer_.name(), columns_, rows_, gather, last_.repair);
}

void Volume::step(Begun& begun, const Pace& pace, Progress& progress) {
  using Step = Begun::Step;
  switch (begun.step) {
    case Step::project:
      // What was prepared for a picture that is given up comes to its end first.
      if (pace.limited() && !preparing_.over(pace.rest())) break;
      preparing_.give_up();
      begun.step = project(begun, pace, progress) ? Step::order : Step::done;
      break;
    case Step::order:
      if (order(begun, pace, progress)) begun.step = Step::clear;
      break;
    case Step::clear:
      clear(begun);
      begun.step = Step::draw;
      break;
    case Step::draw:
      if (begun.drawn < cells_->places()) draw_portion(begun, pace, progress);
      if (begun.drawn == cells_->places()) begun.step = Step::check;
      break;
    case Step::check:
      if (begun.parameters.havs.order != HavsOrder::none) check_outside();
      begun.step = Step::repair;
      break;
    case Step::repair:
      if (begun.parameters.havs.order != HavsOrder::none) repair(progress);
      begun.step = Step::done;
      break;
    case Step::done:
      break;
  }
}

void Volume::begin(const Camera& camera, const Parameters& parameters, const PixelWindow& window,
                   const PixelLattice& lattice, std::span<const float> ray_ends) {
  give_up();
  begun_.emplace();
  begun_->camera = camera;
  begun_->parameters = parameters;
  begun_->grid = pixel_grid(camera, window, lattice);
  begun_->ray_ends.assign(ray_ends.begin(), ray_ends.end());
}

void Volume::give_up() {
  begun_.reset();
  preparing_.cancel();
}

bool Volume::proceed(double milliseconds, RenderStats& stats, Progress& progress) {
  using Step = Begun::Step;
  if (!begun_) return true;
  const Pace pace(milliseconds);
  const StateGuard guard;
  // Dropped where something is thrown.
  Begun begun = std::move(*begun_);
  begun_.reset();
  for (bool end = false; !end;) {
    const Clock::time_point start = Clock::now();
    const bool drawing = begun.step >= Step::draw;
    step(begun, pace, progress);
    end = begun.step == Step::done || pace.over();
    if (end) {
      glFinish();
      check_errors("drawing the volume");
    }
    begun.drawing_ms += drawing ? ms_since(start) : 0.0;
    (drawing ? stats.render_ms : stats.setup_ms) += ms_since(start);
  }
  if (begun.step != Step::done) {
    begun_ = std::move(begun);
    return false;
  }
  if (view_) {
    last_.cells = cells_->cells();
    last_.triangles = cells_->triangles();
    last_.ramp_triangles = cells_->ramp_triangles();
  }
  last_.draw_ms = begun.drawing_ms - last_.faces_ms - last_.repair.ms;
  progress.update(1.0);
  return true;
}

void Volume::draw(const Camera& camera, const Parameters& parameters, const PixelWindow& window,
                  const PixelLattice& lattice, RenderStats& stats, Progress& progress,
                  std::span<const float> ray_ends) {
  begin(camera, parameters, window, lattice, ray_ends);
  proceed(std::numeric_limits<double>::infinity(), stats, progress);
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
