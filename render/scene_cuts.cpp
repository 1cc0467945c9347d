#include <algorithm>
#include <cstdint>
#include <numeric>

#include "core/parallel.h"
#include "render/scene_parts.h"

namespace atomesh {

bool any_cut(const Parameters& parameters) {
  return std::any_of(parameters.cut_planes.begin(), parameters.cut_planes.end(),
                     [](const CutPlane& plane) { return plane.enabled; });
}

bool survives_cuts(const Parameters& parameters, const Vec3& point) {
  return std::all_of(parameters.cut_planes.begin(), parameters.cut_planes.end(),
                     [&point](const CutPlane& plane) { return plane.keeps(point); });
}

std::vector<Tetrahedron> cut_tetrahedra(const TetMesh& mesh, const Parameters& parameters) {
  std::vector<std::uint8_t> kept(mesh.vertices.size());
  parallel_for(kept.size(), 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) kept[v] = survives_cuts(parameters, mesh.vertices[v]) ? 1 : 0;
  });
  const auto survives = [&](const Tetrahedron& t) { return (kept[t[0]] & kept[t[1]] & kept[t[2]] & kept[t[3]]) != 0; };
  // Ranges of tetrahedra are first counted, then each filled into its own part of the list.
  constexpr std::size_t range = 1 << 16;
  const std::vector<Tetrahedron>& all = mesh.tetrahedra;
  std::vector<std::size_t> place(all.size() / range + 2, 0);
  parallel_for(all.size(), range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) place[begin / range + 1] += survives(all[t]) ? 1 : 0;
  });
  std::partial_sum(place.begin(), place.end(), place.begin());
  std::vector<Tetrahedron> left(place.back());
  parallel_for(all.size(), range, [&](std::size_t begin, std::size_t end) {
    std::size_t at = place[begin / range];
    for (std::size_t t = begin; t < end; ++t) {
      if (survives(all[t])) left[at++] = all[t];
    }
  });
  return left;
}

}  // namespace atomesh
