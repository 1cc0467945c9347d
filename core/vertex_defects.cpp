#include "core/vertex_defects.h"

#include <algorithm>
#include <bit>

namespace atomesh {

namespace {

DefectValues largest(const DefectValues& a, const DefectValues& b) {
  return {std::max(a.positional, b.positional), std::max(a.extra, b.extra), std::max(a.vacancy, b.vacancy)};
}

struct PositionHash {
  std::size_t operator()(const Vec3& p) const {
    std::uint64_t h = 0;
    // Adding zero makes -0 and +0, which compare equal, hash equal.
    for (const double c : {p.x, p.y, p.z}) h = (h ^ std::bit_cast<std::uint64_t>(c + 0.0)) * 0x9E3779B97F4A7C15U;
    return static_cast<std::size_t>(h ^ (h >> 32U));
  }
};

}  // namespace

VertexDefects::VertexDefects(const TetMesh& mesh, const Atoms& atoms, const Defects& defects)
    : mesh_(mesh), defects_(defects), present_(defects.present()) {
  if (!present_ || mesh.vertices.size() >= atoms.size()) return;
  std::vector<bool> named(atoms.size(), false);
  for (const Index atom : mesh.vertex_atom) {
    if (atom != no_index) named[atom] = true;
  }
  // Most of the unnamed were simplified away and have no defect.
  std::unordered_map<Vec3, DefectValues, PositionHash> unnamed;
  for (std::size_t a = 0; a < atoms.size(); ++a) {
    if (named[a] || !defects.defective(a)) continue;
    DefectValues& there = unnamed[atoms.positions[a]];
    there = largest(there, of_atom(a));
  }
  if (unnamed.empty()) return;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto found = unnamed.find(mesh.vertices[v]);
    if (found == unnamed.end() || mesh.vertex_atom[v] == no_index) continue;
    merged_.emplace(static_cast<Index>(v), largest(of_atom(mesh.vertex_atom[v]), found->second));
  }
}

std::vector<DefectValues> vertex_defects(const TetMesh& mesh, const Atoms& atoms, const Defects& defects) {
  const VertexDefects look_up(mesh, atoms, defects);
  std::vector<DefectValues> values(mesh.vertices.size());
  for (std::size_t v = 0; v < values.size(); ++v) values[v] = look_up[v];
  return values;
}

}  // namespace atomesh
