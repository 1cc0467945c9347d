#include "render/cpu/uniform_medium.h"

#include <atomic>

#include "core/parallel.h"

namespace atomesh::cell_projection {

namespace {

// A triangle of the surface costs about as much as so many cells.
constexpr std::size_t cells_per_triangle = 8;

// The colour that more than half of the vertices have, if there is one (Boyer and Moore's vote).
Vec4f most_frequent(const std::vector<Vec4f>& colors) {
  Vec4f candidate(0.0F);
  std::size_t votes = 0;
  for (const Vec4f& color : colors) {
    if (votes == 0) candidate = color;
    votes = color == candidate ? votes + 1 : votes - 1;
  }
  return candidate;
}

}  // namespace

UniformMedium::UniformMedium(const Scene& scene) {
  if (scene.surface.empty() || scene.tetrahedra.size() < cells_per_triangle * scene.surface.size()) return;
  color_ = most_frequent(scene.colors);
  of_color_.resize(scene.colors.size());
  std::atomic<std::size_t> found{0};
  parallel_for(of_color_.size(), 1 << 15, [&](std::size_t begin, std::size_t end) {
    std::size_t here = 0;
    for (std::size_t v = begin; v < end; ++v) {
      of_color_[v] = scene.colors[v] == color_ ? 1 : 0;
      here += of_color_[v];
    }
    found += here;
  });
  everywhere_ = found == of_color_.size();
  if (2 * found < of_color_.size()) of_color_.clear();
}

}  // namespace atomesh::cell_projection
