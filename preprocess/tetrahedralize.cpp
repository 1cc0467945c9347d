#include "preprocess/tetrahedralize.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/error.h"
#include "preprocess/canonical_tetrahedra.h"
#include "preprocess/remove_slivers.h"

namespace atomesh {

namespace {

std::uint64_t hash(const Vec3& p) {
  std::uint64_t h = 0;
  for (const double x : {p.x, p.y, p.z}) {
    h ^= std::bit_cast<std::uint64_t>(x + 0.0);  // -0.0 and 0.0 are one position
    h *= 0x9e3779b97f4a7c15U;
    h ^= h >> 29;
  }
  return h;
}

// Gives every distinct position a vertex that names its first atom, in the atoms' order.
void make_vertices(const Atoms& atoms, TetMesh& mesh, Progress& progress) {
  const std::size_t slots = std::bit_ceil(2 * atoms.size() + 1);
  std::vector<Index> table(slots, no_index);  // open addressing → vertex
  mesh.vertices.reserve(atoms.size());
  mesh.vertex_atom.reserve(atoms.size());
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    if (i % 65536 == 0) progress.check();
    const Vec3& p = atoms.positions[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      throw Error("atom " + std::to_string(i) + " has a position that is not finite; it cannot be meshed");
    }
    std::size_t slot = hash(p) & (slots - 1);
    while (table[slot] != no_index && mesh.vertices[table[slot]] != p) slot = (slot + 1) & (slots - 1);
    if (table[slot] != no_index) continue;
    table[slot] = static_cast<Index>(mesh.vertices.size());
    mesh.vertices.push_back(p);
    mesh.vertex_atom.push_back(static_cast<Index>(i));
  }
}

}  // namespace

std::vector<std::string> mesher_names() {
  return {"auto", "delaunay", "tetgen"};
}

TetMesh tetrahedralize(const Atoms& atoms, const TetrahedralizeOptions& options, TetrahedralizeReport& report,
                       Progress& progress) {
  report = {};
  const std::vector<std::string> names = mesher_names();
  if (std::find(names.begin(), names.end(), options.mesher) == names.end()) {
    const std::string nearest = nearest_name(options.mesher, names);
    throw UsageError("unknown mesher \"" + options.mesher + "\"; " +
                     (nearest.empty() ? "" : "did you mean \"" + nearest + "\"? ") +
                     "There are auto, delaunay and tetgen");
  }
  if (atoms.size() >= no_index) throw Error("more than 2^32 - 2 atoms cannot be meshed: indices have 32 bits");
  progress.check();

  TetMesh mesh;
  mesh.delaunay = true;
  make_vertices(atoms, mesh, progress);
  report.merged_vertices = atoms.size() - mesh.vertices.size();

  if (options.mesher == "tetgen") {
    report.mesher = "tetgen";
    report.why = "asked for";
    mesh.tetrahedra = delaunay_tetgen(mesh.vertices, report, progress);
  } else {
    report.mesher = "delaunay";
    report.why = options.mesher == "auto"
                     ? "auto: exact, leaves no flat tetrahedron in a perfect crystal, and the fastest there"
                     : "asked for";
    mesh.tetrahedra = delaunay_cgal(mesh.vertices, progress);
  }
  report.slivers_removed = remove_slivers(mesh.tetrahedra, mesh.vertices);
  put_in_canonical_order(mesh.tetrahedra, mesh.vertices.size(), progress);
  progress.update(1.0);
  return mesh;
}

}  // namespace atomesh
