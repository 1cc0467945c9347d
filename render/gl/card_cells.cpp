#include "render/gl/card_cells.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "render/gl/context.h"
#include "render/gl/state_guard.h"

namespace atomesh::gl {

namespace {

constexpr std::size_t cells_per_range = 16384;
// project_vertices.comp
constexpr std::size_t vertices_per_group = 256;
// order_clusters.comp
constexpr std::size_t clusters_per_group = 64;
// How near to a face's plane, in ways to the eye, floats do not tell its sides.
constexpr double seen_from_the_side = 1e-6;
// front_faces.comp
constexpr std::size_t cells_per_group = 1024;
constexpr std::size_t groups_per_slab = cells_per_slab / cells_per_group;
static_assert(cells_per_slab % cells_per_group == 0);
constexpr std::size_t command_bytes = 20;

std::size_t ceil_quotient(std::size_t a, std::size_t b) {
  return (a + b - 1) / b;
}

void set_vector(GLint uniform, const Vec3& v) {
  glUniform3d(uniform, v.x, v.y, v.z);
}

}  // namespace

CardCells::CardCells(const Scene& scene, int guard, std::size_t kept)
    : scene_(scene),
      guard_(guard),
      kept_(kept),
      project_(Program::compute("project_vertices.comp")),
      faces_(Program::compute("front_faces.comp")),
      marked_faces_(Program::compute("front_faces.comp", std::array{std::string("MARKED")})),
      cluster_order_(Program::compute("order_clusters.comp")) {
  static_assert(sizeof(Command) == command_bytes);
  static_assert(sizeof(Tetrahedron) == 16 && sizeof(ScreenVertex) == 16);
  GLint64 largest = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest);
  largest_storage_ = static_cast<std::size_t>(largest);
  const std::size_t vertex_count = scene.vertices.size();
  const std::size_t cell_count = scene.tetrahedra.size();
  if (std::max({16 * vertex_count, 16 * cell_count, slab_bytes}) > largest_storage_) {
    throw UnavailableError("OpenGL: the driver's storage buffers are too small for the mesh");
  }
  std::vector<Vec4f> vertices(vertex_count);
  for (std::size_t v = 0; v < vertex_count; ++v) {
    vertices[v] = Vec4f(scene.vertices[v], scene.scalars[v]);
    bounds_.add(Vec3(scene.vertices[v]));
  }
  vertices_.write(std::span<const Vec4f>(vertices), GL_STATIC_DRAW);
  tetrahedra_.write(std::span<const Tetrahedron>(scene.tetrahedra.begin(), cell_count), GL_STATIC_DRAW);
  projected_.reserve(vertex_count * sizeof(ScreenVertex), GL_DYNAMIC_COPY);
  std::vector<OrderPoint> points;
  {
    const CellOrder order(scene, false);
    points.assign(order.points().begin(), order.points().end());
  }
  if (scene.delaunay) clusters_ = find_cell_clusters(scene, points);
  order_.emplace(points);
  clustered_.assign(cell_count, 0);
  for (const Index cell : clusters_.cells) clustered_[cell] = 1;
  std::vector<Vec4f> planes;
  std::vector<std::uint32_t> pairs;
  for (const CellClusters::Face& face : clusters_.faces) {
    planes.push_back(face.plane);
    pairs.push_back(face.pair);
  }
  cluster_starts_.write(std::span<const CellClusters::Start>(clusters_.starts), GL_STATIC_DRAW);
  cluster_cells_.write(std::span<const Index>(clusters_.cells), GL_STATIC_DRAW);
  cluster_planes_.write(std::span<const Vec4f>(planes), GL_STATIC_DRAW);
  cluster_pairs_.write(std::span<const std::uint32_t>(pairs), GL_STATIC_DRAW);
  clusters_.faces = {};
  commands_.reserve(ceil_quotient(cell_count, cells_per_group) * command_bytes, GL_DYNAMIC_COPY);
  check_errors("taking memory for cells");
}

std::array<Vec3, 8> CardCells::box_before_eye(const Camera& camera) const {
  std::array<Vec3, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) {
    const Vec3 corner((i & 1U) != 0 ? bounds_.max.x : bounds_.min.x, (i & 2U) != 0 ? bounds_.max.y : bounds_.min.y,
                      (i & 4U) != 0 ? bounds_.max.z : bounds_.min.z);
    corners[i] = before_eye(corner, scene_.center - camera.eye, camera);
  }
  return corners;
}

// What lies in the box is seen between its corners, if all of them are before the eye.
bool CardCells::fits(const Camera& camera, const PixelGrid& grid) const {
  const ScreenView view = screen_view(scene_, camera, grid, guard_);
  const double most = static_cast<double>(guard_) * subpixels;
  const std::array<Vec3, 8> corners = box_before_eye(camera);
  return std::all_of(corners.begin(), corners.end(), [&](const Vec3& corner) {
    if (corner.z < view.near) return false;
    const glm::dvec2 place = subpixel_place(view, corner);
    return std::abs(place.x) <= most && std::abs(place.y) <= most;
  });
}

void CardCells::find_candidates(const ColorMap& color_map, const Progress& progress) {
  if (color_map_ && *color_map_ == color_map) return;
  color_map_.reset();
  const cell_projection::MapIntervals map(color_map);
  const std::size_t count = scene_.tetrahedra.size();
  std::vector<std::uint8_t> visible(count);
  parallel_for(count, cells_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t i = begin; i < end; ++i) {
      const Tetrahedron& t = scene_.tetrahedra[i];
      const auto [a, b, c, d] =
          std::array{scene_.scalars[t[0]], scene_.scalars[t[1]], scene_.scalars[t[2]], scene_.scalars[t[3]]};
      visible[i] = map.transparent(std::min({a, b, c, d}), std::max({a, b, c, d})) ? 0 : 1;
    }
  });
  std::vector<Index> all;
  all.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (visible[i] != 0 && clustered_[i] == 0) all.push_back(static_cast<Index>(i));
  }
  std::vector<glm::uvec2> blocks(clusters_.count());  // start, which are visible
  for (std::size_t n = 0; n < blocks.size(); ++n) {
    blocks[n] = {all.size(), 0};
    const std::uint32_t first = clusters_.starts[n].cell;
    for (std::uint32_t at = first; at < clusters_.starts[n + 1].cell; ++at) {
      const Index cell = clusters_.cells[at];
      if (visible[cell] == 0) continue;
      all.push_back(cell);
      blocks[n].y |= 1U << (at - first);
    }
  }
  blocks_.write(std::span<const glm::uvec2>(blocks));
  candidates_.write(std::span<const Index>(all));
  places_ = all.size();
  color_map_ = color_map;
}

void CardCells::reserve_slabs() {
  const std::size_t count = ceil_quotient(places_, cells_per_slab);
  // Two in turn: while one is drawn, the next is made.
  slabs_.resize(keep(places_, kept_) ? count : std::min<std::size_t>(count, 2));
  for (Buffer& slab : slabs_) {
    slab.reserve(std::min(places_, cells_per_slab) * vertices_per_cell * sizeof(FaceVertex), GL_DYNAMIC_COPY);
  }
  slab_numbers_.assign(slabs_.size(), count);  // none
}

void CardCells::project(const Camera& camera, const PixelGrid& grid, const ColorMap& color_map,
                        const Progress& progress) {
  find_candidates(color_map, progress);
  reserve_slabs();
  check_errors("taking memory for cells");
  view_ = screen_view(scene_, camera, grid, guard_);
  const std::array<Vec3, 8> corners = box_before_eye(camera);
  const auto [nearest, furthest] =
      std::minmax_element(corners.begin(), corners.end(), [](const Vec3& a, const Vec3& b) { return a.z < b.z; });
  view_.first_w = static_cast<float>(screen_w(view_, *nearest));
  view_.last_w = static_cast<float>(screen_w(view_, *furthest));
  if (!(view_.last_w > view_.first_w)) view_.last_w = view_.first_w + 1.0F;

  vertices_.bind_storage(0);
  projected_.bind_storage(1);
  project_.use();
  glUniform1ui(project_.uniform("count"), static_cast<GLuint>(scene_.vertices.size()));
  glUniform1i(project_.uniform("perspective"), view_.perspective ? 1 : 0);
  glUniform1d(project_.uniform("reference"), view_.reference);
  glUniform4d(project_.uniform("grid"), grid.x, grid.y, grid.dx, grid.dy);
  glUniform2i(project_.uniform("middle"), grid.columns / 2, grid.rows / 2);
  glUniform1i(project_.uniform("guard"), guard_ * subpixels);
  set_vector(project_.uniform("offset"), scene_.center - camera.eye);
  set_vector(project_.uniform("right"), camera.right);
  set_vector(project_.uniform("up"), camera.up);
  set_vector(project_.uniform("forward"), camera.forward);
  dispatch(ceil_quotient(scene_.vertices.size(), vertices_per_group));
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void CardCells::order_clusters(const Camera& camera) const {
  if (clusters_.count() == 0) return;
  cluster_starts_.bind_storage(0);
  cluster_cells_.bind_storage(1);
  cluster_planes_.bind_storage(2);
  cluster_pairs_.bind_storage(3);
  blocks_.bind_storage(4);
  candidates_.bind_storage(5);
  const Vec3 eye = view_.perspective ? camera.eye - scene_.center : -camera.forward;
  cluster_order_.use();
  glUniform1ui(cluster_order_.uniform("count"), static_cast<GLuint>(clusters_.count()));
  glUniform4f(cluster_order_.uniform("eye"), static_cast<GLfloat>(eye.x), static_cast<GLfloat>(eye.y),
              static_cast<GLfloat>(eye.z), view_.perspective ? 1.0F : 0.0F);
  glUniform1f(cluster_order_.uniform("least"), static_cast<GLfloat>(seen_from_the_side * glm::length(eye)));
  dispatch(ceil_quotient(clusters_.count(), clusters_per_group));
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void CardCells::order(const Camera& camera, Progress& /*progress*/) {
  order_clusters(camera);
  order_->sort(key_scale(camera, scene_), candidates_, places_);
  slab_numbers_.assign(slabs_.size(), ceil_quotient(places_, cells_per_slab));  // none
  totals_.reset();
}

const Buffer& CardCells::slab_at(std::size_t begin) const {
  return slabs_[begin / cells_per_slab % slabs_.size()];
}

void CardCells::make_faces(const Program& program, std::size_t begin, std::size_t end, const Buffer& faces,
                           const Buffer& commands, std::size_t first_command) const {
  // What was drawn of these buffers before is drawn.
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  order_->order().bind_storage(0);
  tetrahedra_.bind_storage(1);
  projected_.bind_storage(2);
  faces.bind_storage(3);
  commands.bind_storage(4);
  program.use();
  glUniform1ui(program.uniform("first"), static_cast<GLuint>(begin));
  glUniform1ui(program.uniform("end"), static_cast<GLuint>(end));
  glUniform1ui(program.uniform("first_command"), static_cast<GLuint>(first_command));
  glUniform2i(program.uniform("pixels"), view_.grid.columns, view_.grid.rows);
  glDispatchCompute(static_cast<GLuint>(ceil_quotient(end - begin, cells_per_group)), 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

void CardCells::draw_commands(const Buffer& faces, const Buffer& commands, std::size_t first, std::size_t count) {
  bind_vertices(faces);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands.name());
  glMultiDrawArraysIndirect(GL_TRIANGLES, reinterpret_cast<const void*>(first * command_bytes),
                            static_cast<GLsizei>(count), command_bytes);
}

bool CardCells::make_slab(std::size_t begin) {
  const std::size_t n = begin / cells_per_slab;
  std::size_t& number = slab_numbers_[n % slabs_.size()];
  if (number == n) return false;
  make_faces(faces_, n * cells_per_slab, slab_end(begin, places_), slab_at(begin), commands_, n * groups_per_slab);
  number = n;
  return true;
}

std::size_t CardCells::draw(std::size_t begin, std::size_t most, const UseProgram& use) {
  use(CellKind::segment);
  const std::size_t rest = slab_end(begin, places_) - begin;
  const std::size_t groups = ceil_quotient(std::min(most, rest), cells_per_group);
  draw_commands(slab_at(begin), commands_, begin / cells_per_group, groups);
  return std::min(groups * cells_per_group, rest);
}

void CardCells::draw_marked(const MarkedTiles& tiles, const Progress& progress) {
  GLint drawing = 0;
  glGetIntegerv(GL_CURRENT_PROGRAM, &drawing);
  tiles_.write(tiles.sums());
  for (Buffer& slab : marked_) {
    slab.reserve(std::min(places_, cells_per_slab) * vertices_per_cell * sizeof(FaceVertex), GL_DYNAMIC_COPY);
  }
  marked_commands_.reserve(2 * groups_per_slab * command_bytes, GL_DYNAMIC_COPY);
  check_errors("taking memory for cells");
  const MarkedTiles::Window window = tiles.window();
  for (std::size_t begin = 0; begin < places_; begin += cells_per_slab) {
    progress.check();
    const std::size_t end = slab_end(begin, places_);
    const std::size_t turn = begin / cells_per_slab % 2;
    {
      const StorageGuard guard;  // the fragments' buffers
      marked_faces_.use();
      glUniform4i(marked_faces_.uniform("window"), window.left, window.right, window.bottom, window.top);
      glUniform1i(marked_faces_.uniform("tile_shift"), MarkedTiles::shift);
      glUniform1ui(marked_faces_.uniform("line"), static_cast<GLuint>(tiles.line()));
      tiles_.bind_storage(5);
      make_faces(marked_faces_, begin, end, marked_[turn], marked_commands_, turn * groups_per_slab);
    }
    glUseProgram(static_cast<GLuint>(drawing));
    draw_commands(marked_[turn], marked_commands_, turn * groups_per_slab, ceil_quotient(end - begin, cells_per_group));
  }
}

CardCells::Totals CardCells::read_totals() const {
  if (totals_) return *totals_;
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  Totals totals{};
  for (const Command& command : commands_.read<Command>(ceil_quotient(places_, cells_per_group))) {
    totals.cells += command.cells;
    totals.triangles += command.count / 3;
  }
  totals_ = totals;
  return totals;
}

std::vector<FaceVertex> CardCells::faces(std::size_t begin) const {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  const std::size_t groups = ceil_quotient(slab_end(begin, places_) - begin, cells_per_group);
  std::vector<FaceVertex> all;
  for (const Command& command : commands_.read<Command>(groups, begin / cells_per_group * command_bytes)) {
    const std::vector<FaceVertex> some =
        slab_at(begin).read<FaceVertex>(command.count, command.first * sizeof(FaceVertex));
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

}  // namespace atomesh::gl
