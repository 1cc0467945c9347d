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

void put_in_canonical_order(std::vector<Tetrahedron>& tetrahedra, std::size_t vertices, Progress& progress) {
  constexpr std::size_t tetrahedra_per_range = 1 << 14;
  const std::size_t count = tetrahedra.size();
  parallel_for(count, tetrahedra_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t i = begin; i < end; ++i) tetrahedra[i] = canonical(tetrahedra[i]);
  });
  // Of each vertex's tetrahedra, filed under their smallest vertex; counted two places ahead, so that filling moves
  // each start to where it belongs.
  std::vector<std::size_t> first(vertices + 2, 0);
  for (const Tetrahedron& t : tetrahedra) ++first[std::size_t{t[0]} + 2];
  for (std::size_t v = 2; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<Tetrahedron> ordered(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (i % tetrahedra_per_range == 0) progress.check();
    ordered[first[std::size_t{tetrahedra[i][0]} + 1]++] = tetrahedra[i];
  }
  constexpr std::size_t vertices_per_range = 4096;
  parallel_for(vertices, vertices_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t v = begin; v < end; ++v) {
      std::sort(ordered.begin() + static_cast<std::ptrdiff_t>(first[v]),
                ordered.begin() + static_cast<std::ptrdiff_t>(first[v + 1]));
    }
  });
  tetrahedra = std::move(ordered);
}

}  // namespace atomesh
