#include "render/gl/radix_sort.h"

#include <utility>

namespace atomesh::gl {

namespace {

// radix.glsl
constexpr int digit_bits = 4;
constexpr std::size_t digit_values = 16;
constexpr std::size_t tile_size = 2048;
// order_keys.comp
constexpr std::size_t group_size = 256;

// The next shader sees what this one wrote.
void finish_storage() {
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

}  // namespace

RadixSort::RadixSort()
    : count_(Program::compute("radix_count.comp")),
      scan_(Program::compute("radix_scan.comp")),
      scatter_(Program::compute("radix_scatter.comp")) {}

void RadixSort::sort(Buffer& cells, std::size_t count) {
  if (count < 2) return;
  const std::size_t tiles = (count + tile_size - 1) / tile_size;
  scratch_.reserve(count * sizeof(KeyedCell));
  places_.reserve(digit_values * tiles * sizeof(GLuint));
  const auto set = [](const Program& program, const char* name, std::size_t value) {
    glUniform1ui(program.uniform(name), static_cast<GLuint>(value));
  };
  const Buffer* from = &cells;
  const Buffer* to = &scratch_;
  places_.bind_storage(2);
  for (int shift = 0; shift < 32; shift += digit_bits) {
    from->bind_storage(0);
    to->bind_storage(1);
    for (const Program* program : {&count_, &scan_, &scatter_}) {
      program->use();
      set(*program, "count", program == &scan_ ? digit_values * tiles : count);
      set(*program, "shift", static_cast<std::size_t>(shift));
      glDispatchCompute(program == &scan_ ? 1 : static_cast<GLuint>(tiles), 1, 1);
      finish_storage();
    }
    std::swap(from, to);
  }
  // Eight passes: what was in `cells` is there again.
  static_assert(32 / digit_bits % 2 == 0);
}

CardOrder::CardOrder(std::span<const OrderPoint> points) : keys_(Program::compute("order_keys.comp")) {
  static_assert(sizeof(OrderPoint) == 16);
  points_.write(points, GL_STATIC_DRAW);
}

void CardOrder::sort(const KeyScale& scale, const Buffer& cells, std::size_t count) {
  keyed_.reserve(count * sizeof(KeyedCell));
  if (count == 0) return;
  points_.bind_storage(0);
  cells.bind_storage(1);
  keyed_.bind_storage(2);
  keys_.use();
  glUniform1ui(keys_.uniform("count"), static_cast<GLuint>(count));
  glUniform3d(keys_.uniform("direction"), scale.direction.x, scale.direction.y, scale.direction.z);
  glUniform1d(keys_.uniform("weight_factor"), scale.weight_factor);
  glUniform1d(keys_.uniform("low"), scale.low);
  glUniform1d(keys_.uniform("over_range"), scale.over_range);
  dispatch((count + group_size - 1) / group_size);
  finish_storage();
  sort_.sort(keyed_, count);
}

}  // namespace atomesh::gl
