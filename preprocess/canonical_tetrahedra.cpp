#include "preprocess/canonical_tetrahedra.h"

#include <algorithm>

#include "core/parallel.h"

namespace atomesh {

Tetrahedron canonical(Tetrahedron t) {
  const auto smallest = static_cast<std::size_t>(std::min_element(t.begin(), t.end()) - t.begin());
  // A swap of two pairs is an even permutation.
  if (smallest == 1) t = {t[1], t[0], t[3], t[2]};
  if (smallest == 2) t = {t[2], t[3], t[0], t[1]};
  if (smallest == 3) t = {t[3], t[2], t[1], t[0]};
  // So is a rotation of three.
  std::rotate(t.begin() + 1, std::min_element(t.begin() + 1, t.end()), t.end());
  return t;
}

void put_in_canonical_order(std::vector<Tetrahedron>& tetrahedra, std::size_t vertices) {
  std::vector<std::size_t> first(vertices + 1, 0);  // of each vertex's tetrahedra, filed under their smallest vertex
  for (Tetrahedron& t : tetrahedra) {
    t = canonical(t);
    ++first[t[0] + 1];
  }
  for (std::size_t v = 0; v < vertices; ++v) first[v + 1] += first[v];
  std::vector<Tetrahedron> ordered(tetrahedra.size());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (const Tetrahedron& t : tetrahedra) ordered[next[t[0]]++] = t;
  constexpr std::size_t vertices_per_range = 4096;
  parallel_for(vertices, vertices_per_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      std::sort(ordered.begin() + static_cast<std::ptrdiff_t>(first[v]),
                ordered.begin() + static_cast<std::ptrdiff_t>(first[v + 1]));
    }
  });
  tetrahedra = std::move(ordered);
}

}  // namespace atomesh
