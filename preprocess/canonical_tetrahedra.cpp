#include "preprocess/canonical_tetrahedra.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "core/parallel.h"

namespace atomesh {

namespace {

// What is left of a tetrahedron once it is filed under its smallest vertex.
using Rest = std::array<Index, 3>;

// Sorts the few tetrahedra of one vertex; std::sort would take as long to find out that they are few.
void sort_rests(Rest* first, Rest* last) {
  constexpr std::ptrdiff_t few = 32;
  if (last - first > few) {
    std::sort(first, last);
    return;
  }
  const auto pair_of = [](const Rest& r) { return std::uint64_t{r[0]} << 32 | r[1]; };
  const auto less = [&](const Rest& a, const Rest& b) {
    const std::uint64_t pa = pair_of(a), pb = pair_of(b);
    return pa != pb ? pa < pb : a[2] < b[2];
  };
  for (Rest* next = first + 1; next < last; ++next) {
    const Rest moved = *next;
    Rest* place = next;
    for (; place > first && less(moved, place[-1]); --place) *place = place[-1];
    *place = moved;
  }
}

}  // namespace

// Which corner is smallest is as good as random, so nothing here branches on it.
Tetrahedron canonical(Tetrahedron t) {
  // A swap of two pairs is an even permutation.
  const bool back = std::min(t[2], t[3]) < std::min(t[0], t[1]);
  const Index a = back ? t[2] : t[0], b = back ? t[3] : t[1];
  const Index c = back ? t[0] : t[2], d = back ? t[1] : t[3];
  const bool swap = b < a;
  const Index e = swap ? a : b, f = swap ? d : c, g = swap ? c : d;
  // So is a rotation of three.
  const bool f_first = (f < e) & (f <= g);
  const bool g_first = (g < e) & (g < f);
  return {swap ? b : a, g_first ? g : (f_first ? f : e), g_first ? e : (f_first ? g : f),
          g_first ? f : (f_first ? e : g)};
}

void put_in_canonical_order(std::vector<Tetrahedron>& tetrahedra, std::size_t vertices, Progress& progress) {
  constexpr std::size_t tetrahedra_per_check = 1 << 14, vertices_per_range = 4096, most_parts = 4;
  const std::size_t count = tetrahedra.size();
  if (count == 0) return;
  // Each part counts, and later files, its own tetrahedra. How many parts there are has no say in the result.
  const std::size_t parts = std::clamp<std::size_t>(static_cast<std::size_t>(threads()), 1, most_parts);
  const std::size_t part_size = (count + parts - 1) / parts;
  std::vector<std::vector<Index>> filed(parts);  // of each vertex: how many of its tetrahedra the part holds
  parallel_for(count, part_size, [&](std::size_t begin, std::size_t end) {
    std::vector<Index>& own = filed[begin / part_size];
    own.assign(vertices, 0);
    for (std::size_t i = begin; i < end; ++i) {
      if (i % tetrahedra_per_check == 0) progress.check();
      tetrahedra[i] = canonical(tetrahedra[i]);
      ++own[tetrahedra[i][0]];
    }
  });
  // From now on: where among its vertex's tetrahedra the part's next one goes.
  std::vector<std::size_t> first(vertices + 1);
  std::size_t total = 0;
  for (std::size_t v = 0; v < vertices; ++v) {
    first[v] = total;
    Index before = 0;
    for (std::vector<Index>& own : filed) {
      if (!own.empty()) before += std::exchange(own[v], before);
    }
    total += before;
  }
  first[vertices] = total;
  const auto rest = std::make_unique_for_overwrite<Rest[]>(count);
  parallel_for(count, part_size, [&](std::size_t begin, std::size_t end) {
    std::vector<Index>& own = filed[begin / part_size];
    for (std::size_t i = begin; i < end; ++i) {
      if (i % tetrahedra_per_check == 0) progress.check();
      const Tetrahedron& t = tetrahedra[i];
      rest[first[t[0]] + own[t[0]]++] = {t[1], t[2], t[3]};
    }
  });
  parallel_for(vertices, vertices_per_range, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t v = begin; v < end; ++v) {
      sort_rests(rest.get() + first[v], rest.get() + first[v + 1]);
      for (std::size_t i = first[v]; i < first[v + 1]; ++i) {
        tetrahedra[i] = {static_cast<Index>(v), rest[i][0], rest[i][1], rest[i][2]};
      }
    }
  });
}

}  // namespace atomesh
