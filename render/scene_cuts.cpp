#include <algorithm>
#include <cstdint>

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
  std::vector<Tetrahedron> left;
  left.reserve(mesh.tetrahedra.size());
  for (const Tetrahedron& t : mesh.tetrahedra) {
    if ((kept[t[0]] & kept[t[1]] & kept[t[2]] & kept[t[3]]) != 0) left.push_back(t);
  }
  return left;
}

}  // namespace atomesh
