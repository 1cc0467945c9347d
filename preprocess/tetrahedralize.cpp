#include "preprocess/tetrahedralize.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/error.h"
#include "preprocess/canonical_tetrahedra.h"
#include "preprocess/memory_needs.h"
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

void check_options(const Crystal& crystal, double carving_radius, const TetrahedralizeOptions& options) {
  const std::vector<std::string> names = mesher_names();
  if (std::find(names.begin(), names.end(), options.mesher) == names.end()) {
    const std::string nearest = nearest_name(options.mesher, names);
    throw UsageError("unknown mesher \"" + options.mesher + "\"; " +
                     (nearest.empty() ? "" : "did you mean \"" + nearest + "\"? ") +
                     "There are auto, delaunay, pattern and tetgen");
  }
  if (options.mesher != "pattern") return;
  if (!crystal.known()) {
    throw UsageError("the pattern mesher stamps the unit cell, and none is known; give one, or take the mesher auto");
  }
  if (std::isinf(carving_radius)) {
    throw UsageError("the pattern mesher makes no tetrahedra that carving would remove, so it needs carving");
  }
}

// Whether it is worth trying the pattern; otherwise the report says why not.
bool may_stamp(const TetMesh& mesh, const Crystal& crystal, double carving_radius, TetrahedralizeReport& report) {
  // Less is meshed before anybody has looked.
  constexpr std::size_t fewest_atoms = 2000;
  // What stamping takes grows with grains times atoms, and what it saves shrinks as boundaries come close. Of 250,000
  // atoms in 104 grains it took six times as long as Delaunay.
  constexpr std::size_t most_grains = 16;
  report.why = !crystal.known()                      ? "auto: no unit cell is known whose pattern could be stamped"
               : std::isinf(carving_radius)          ? "auto: nothing is carved, and the pattern fills no convex hull"
               : mesh.vertices.size() < fewest_atoms ? "auto: the sample is small"
               : crystal.grains.size() > most_grains ? "auto: the sample has many grains"
                                                     : "";
  return report.why.empty();
}

void stamp(const Atoms& atoms, const Crystal& crystal, double carving_radius, bool must_be_delaunay, TetMesh& mesh,
           TetrahedralizeReport& report, Progress& progress) {
  require_memory_for("stamping", mesh.vertices.size(), "atoms", memory_to_mesh("pattern", mesh.vertices.size()));
  LatticeSites sites;
  if (report.merged_vertices == 0) {
    sites = assign_lattice_sites(atoms, crystal, {}, progress);
  } else {
    Crystal of_vertices{crystal.grains, {}};
    if (!crystal.grain_of.empty()) {
      for (const Index atom : mesh.vertex_atom) of_vertices.grain_of.push_back(crystal.grain_of[atom]);
    }
    sites = assign_lattice_sites(atoms.subset(mesh.vertex_atom), of_vertices, {}, progress);
  }
  PatternOptions options{.largest_radius = carving_radius};
  const bool sited = !sites.patches.empty();
  // No share is small enough: the tolerant way is not taken.
  if (must_be_delaunay) options.most_off_sites = -1.0;
  mesh.tetrahedra = tetrahedralize_pattern(mesh.vertices, std::move(sites), options, report.pattern, progress);
  const PatternReport& told = report.pattern;
  const bool too_few = told.in_place < options.least_in_place && told.undisturbed < options.least_undisturbed_alone;
  if (must_be_delaunay && sited && !told.done && too_few) {
    report.pattern.why = "it would not be Delaunay, as removing vertices needs it: too few atoms are on their sites";
  }
  if (report.pattern.done) mesh.delaunay = report.pattern.delaunay;
}

}  // namespace

std::vector<std::string> mesher_names() {
  return {"auto", "delaunay", "pattern", "tetgen"};
}

TetMesh tetrahedralize(const Atoms& atoms, const Crystal& crystal, double carving_radius,
                       const TetrahedralizeOptions& options, TetrahedralizeReport& report, Progress& progress) {
  report = {};
  check_options(crystal, carving_radius, options);
  if (atoms.size() >= no_index) throw Error("more than 2^32 - 2 atoms cannot be meshed: indices have 32 bits");
  progress.check();

  TetMesh mesh;
  mesh.delaunay = true;
  make_vertices(atoms, mesh, progress);
  report.merged_vertices = atoms.size() - mesh.vertices.size();

  report.why = "asked for";
  if (options.mesher == "pattern" || (options.mesher == "auto" && may_stamp(mesh, crystal, carving_radius, report))) {
    stamp(atoms, crystal, carving_radius, options.must_be_delaunay, mesh, report, progress);
  }
  if (report.pattern.done) {
    report.mesher = "pattern";
    report.why = (options.mesher == "auto" ? "auto: " : "asked for: ") + report.pattern.why;
  } else {
    const std::string mesher = options.mesher == "tetgen" ? "tetgen" : "delaunay";
    report.mesher = mesher;
    if (!report.pattern.why.empty()) report.why = "the pattern does not serve: " + report.pattern.why;
    mesh.tetrahedra =
        mesher == "tetgen" ? delaunay_tetgen(mesh.vertices, report, progress) : delaunay_cgal(mesh.vertices, progress);
    report.slivers_removed = remove_slivers(mesh.tetrahedra, mesh.vertices, progress);
  }
  put_in_canonical_order(mesh.tetrahedra, mesh.vertices.size(), progress);
  progress.update(1.0);
  return mesh;
}

}  // namespace atomesh
