#include "render/gl/order_repair.h"

#include <algorithm>
#include <chrono>

#include "render/gl/context.h"

namespace atomesh::gl {

namespace {

// Bindings of repair.glsl, list.glsl and kept_fragments.glsl.
constexpr GLuint kept_pixels_binding = 4;
constexpr GLuint heads_binding = 5;
constexpr GLuint kept_depths_binding = 5;
constexpr GLuint nodes_binding = 6;
constexpr GLuint repair_binding = 7;

constexpr std::size_t node_bytes = 16;
constexpr std::size_t head_bytes = 4;
constexpr std::size_t kept_pixel_bytes = 32;
constexpr std::size_t kept_depth_bytes = 4;
constexpr std::size_t kept_light_bytes = 8;
constexpr std::size_t least_memory = 1 << 16;
// Fragments a marked pixel is expected to have before it is known, and all together.
constexpr std::size_t usual_length = 256;
constexpr std::size_t least_nodes = 1 << 16;
// Of which lists are made at once, so that their fragments can be counted in 32 bits.
constexpr std::uint64_t most_pixels = std::uint64_t{1} << 21;

std::size_t ceil_quotient(std::size_t a, std::size_t b) {
  return (a + b - 1) / b;
}

void clear(const Buffer& buffer, std::size_t bytes) {
  const GLuint zero = 0;
  glBindBuffer(GL_COPY_WRITE_BUFFER, buffer.name());
  glClearBufferSubData(GL_COPY_WRITE_BUFFER, GL_R32UI, 0, static_cast<GLsizeiptr>(bytes), GL_RED_INTEGER,
                       GL_UNSIGNED_INT, &zero);
  glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
}

void write_colors(bool write) {
  const GLboolean on = write ? GL_TRUE : GL_FALSE;
  glColorMask(on, on, on, on);
}

double ms_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

OrderRepair::OrderRepair(const RepairSettings& settings)
    : settings_(settings), whole_window_(make_vertex_array()), marked_(make_query()) {
  settings_.memory = std::max(settings_.memory, least_memory);
  GLint64 largest = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest);
  largest_storage_ = static_cast<std::size_t>(largest);
  std::vector<std::string> resolving = defines();
  if (settings_.method == RepairMethod::sort) resolving.emplace_back("SORT");
  if (settings_.method == RepairMethod::replay) resolving.emplace_back("REPLAY");
  // Resolved are pixels that nothing else is drawn to.
  std::erase(resolving, "INTERLOCK");
  resolve_ = Program::draw("whole_window.vert", "resolve.frag", resolving);
  count_ = Program::draw("whole_window.vert", "nothing.frag");
}

std::string_view OrderRepair::fragment_shader() const {
  return settings_.method == RepairMethod::keep ? "keep.frag" : "list.frag";
}

std::vector<std::string> OrderRepair::defines() const {
  std::vector<std::string> defines;
  if (settings_.method != RepairMethod::sort) defines.push_back("K " + std::to_string(settings_.k));
  if (settings_.method == RepairMethod::keep && current_driver().interlock) defines.emplace_back("INTERLOCK");
  return defines;
}

std::vector<OrderRepair::Part> OrderRepair::split(const Part& part, std::size_t count) {
  const bool rows = part.height > 1;
  const GLint length = rows ? part.height : part.width;
  const auto parts = static_cast<GLint>(std::clamp<std::size_t>(count, 1, static_cast<std::size_t>(length)));
  std::vector<Part> split;
  for (GLint i = 0; i < parts; ++i) {
    const auto edge = [&](GLint n) { return static_cast<GLint>(std::int64_t{length} * n / parts); };
    const GLint first = edge(i);
    const GLint size = edge(i + 1) - first;
    split.push_back(rows ? Part{part.left, part.bottom + first, part.width, size}
                         : Part{part.left + first, part.bottom, size, part.height});
  }
  return split;
}

std::uint64_t OrderRepair::marked_pixels() {
  write_colors(false);
  count_.use();
  glBindVertexArray(whole_window_.name());
  glBeginQuery(GL_SAMPLES_PASSED, marked_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEndQuery(GL_SAMPLES_PASSED);
  GLuint64 pixels = 0;
  glGetQueryObjectui64v(marked_.name(), GL_QUERY_RESULT, &pixels);
  return pixels;
}

void OrderRepair::reserve(std::size_t pixels, std::size_t nodes) {
  if (settings_.method == RepairMethod::keep) {
    const std::size_t kept = pixels * static_cast<std::size_t>(settings_.k);
    pixels_.reserve(pixels * kept_pixel_bytes);
    depths_.reserve(kept * kept_depth_bytes);
    nodes_.reserve(kept * kept_light_bytes);
  } else {
    pixels_.reserve(pixels * head_bytes);
    nodes_.reserve(nodes * node_bytes);
  }
  check_errors("taking memory for repairing the order of cells");
}

MarkedTiles OrderRepair::marked_tiles(const Part& window) const {
  std::vector<std::uint8_t> pixels(window.pixels());
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, window.width, window.height, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, pixels.data());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  return MarkedTiles(pixels, window.width, window.height, static_cast<std::uint8_t>(settings_.stencil_bits));
}

OrderRepair::Gathered OrderRepair::gather(const Part& part, const std::function<void()>& draw) {
  const bool keep = settings_.method == RepairMethod::keep;
  const std::size_t capacity = keep ? 0 : nodes_.bytes() / node_bytes;
  Gathered start;
  start.capacity = static_cast<GLuint>(capacity);
  start.part = part;
  repair_.write(std::span<const Gathered>(&start, 1));
  clear(pixels_, part.pixels() * (keep ? kept_pixel_bytes : head_bytes));
  pixels_.bind_storage(keep ? kept_pixels_binding : heads_binding);
  if (keep) depths_.bind_storage(kept_depths_binding);
  nodes_.bind_storage(nodes_binding);
  repair_.bind_storage(repair_binding);
  glScissor(part.left, part.bottom, part.width, part.height);
  write_colors(false);
  tiles_->look_at(part.left, part.bottom, part.width, part.height);
  draw();
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  return repair_.read<Gathered>(1).front();
}

OrderRepair::Gathered OrderRepair::resolve() {
  write_colors(true);
  resolve_.use();
  glBindVertexArray(whole_window_.name());
  const GLint first_draw = resolve_.uniform("first_draw");
  for (bool first = true;; first = false) {
    glUniform1i(first_draw, first ? 1 : 0);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    Gathered resolved = repair_.read<Gathered>(1).front();
    if (resolved.unsorted == 0) return resolved;
    resolved.unsorted = 0;
    repair_.write(std::span<const Gathered>(&resolved, 1));
  }
}

void OrderRepair::repair(GLuint framebuffer, int width, int height, const std::function<void()>& draw,
                         RepairStats& stats) {
  const auto start = std::chrono::steady_clock::now();
  const Part window{0, 0, width, height};
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_NOTEQUAL, 0, settings_.stencil_bits);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, width, height);
  const std::uint64_t marked = marked_pixels();
  if (marked > 0) {
    const bool keep = settings_.method == RepairMethod::keep;
    // what fits into the memory: pixels with k-buffers, or fragments in lists
    const auto k = static_cast<std::size_t>(settings_.k);
    const std::size_t pixels =
        std::min({window.pixels(), settings_.memory / (kept_pixel_bytes + k * (kept_depth_bytes + kept_light_bytes)),
                  largest_storage_ / std::max(kept_pixel_bytes, k * kept_light_bytes)});
    const std::size_t heads = window.pixels() * head_bytes;
    const std::size_t most_nodes =
        std::min({std::max(settings_.memory, heads + least_memory) - heads, largest_storage_}) / node_bytes;
    const std::size_t first_nodes = std::min(most_nodes, std::max<std::size_t>(marked * usual_length, least_nodes));
    keep ? reserve(pixels, 0) : reserve(window.pixels(), first_nodes);

    tiles_ = marked_tiles(window);
    std::vector<Part> parts =
        split(window, keep ? ceil_quotient(window.pixels(), pixels) : ceil_quotient(marked, most_pixels));
    while (!parts.empty()) {
      const Part part = parts.back();
      parts.pop_back();
      if (keep && part.pixels() > pixels) {
        const std::vector<Part> smaller = split(part, 2);
        parts.insert(parts.end(), smaller.begin(), smaller.end());
        continue;
      }
      const Gathered gathered = gather(part, draw);
      ++stats.draws;
      const bool overflow = gathered.fragments > gathered.capacity;
      if (overflow && gathered.capacity < most_nodes && gathered.fragments <= most_nodes) {
        reserve(window.pixels(), gathered.fragments);
        parts.push_back(part);
        continue;
      }
      if (overflow && part.pixels() > 1) {
        reserve(window.pixels(), most_nodes);
        // somewhat smaller than needed: fragments are spread unevenly
        const std::size_t count = std::max<std::size_t>(2, ceil_quotient(gathered.fragments, most_nodes / 4 * 3));
        const std::vector<Part> smaller = split(part, count);
        parts.insert(parts.end(), smaller.begin(), smaller.end());
        continue;
      }
      const Gathered resolved = resolve();
      stats.wrong_pixels += overflow ? 1 : resolved.wrong_pixels;
      stats.fragments += resolved.fragments;
      stats.longest = std::max<std::uint64_t>(stats.longest, resolved.longest);
    }
  }
  stats.pixels += marked;
  write_colors(true);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_SCISSOR_TEST);
  glBindVertexArray(0);
  stats.ms += ms_since(start);
}

}  // namespace atomesh::gl
