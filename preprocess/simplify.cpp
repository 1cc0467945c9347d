#include "preprocess/simplify.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/vertex_defects.h"
#include "preprocess/canonical_tetrahedra.h"
#include "preprocess/simplify_certificate.h"
#include "preprocess/simplify_collapse.h"
#include "preprocess/simplify_remove.h"
#include "preprocess/star_mesh.h"

namespace atomesh {

namespace {

void check_options(const TetMesh& mesh, const SimplifyOptions& options) {
  const std::vector<std::string> strategies = simplify_strategies();
  if (std::find(strategies.begin(), strategies.end(), options.strategy) == strategies.end()) {
    const std::string nearest = nearest_name(options.strategy, strategies);
    throw UsageError("unknown way to simplify \"" + options.strategy + "\"; " +
                     (nearest.empty() ? "" : "did you mean \"" + nearest + "\"? ") + "There are collapse and remove");
  }
  if (needs_delaunay(options.strategy) && !mesh.delaunay) {
    throw UsageError("vertices can be removed from a Delaunay mesh only, and this one is not; use \"collapse\"");
  }
}

// What may not change, and the border of the part that may.
struct Frozen {
  std::vector<std::uint8_t> free;  // of each vertex: 1 when it may go
  std::vector<Triangle> surface;
  std::vector<Triangle> border;  // of the tetrahedra without a defective vertex, outward
};

Frozen find_frozen(const StarMesh& stars, std::span<const DefectValues> defects, SimplifyReport& report,
                   Progress& progress) {
  Frozen frozen;
  std::vector<std::uint8_t> touched(defects.size(), 0);  // by a tetrahedron with a defective vertex
  const auto defective = [&](const Tetrahedron& tet) {
    return std::any_of(tet.begin(), tet.end(), [&](Index v) { return defects[v].any(); });
  };
  for (std::size_t t = 0; t < stars.tetrahedra(); ++t) {
    if (t % 4096 == 0) progress.check();
    const Tetrahedron& tet = stars.tetrahedron(static_cast<Corner>(4 * t));
    const bool changes = !defective(tet);
    if (!changes) {
      for (const Index v : tet) touched[v] = 1;
    }
    for (Index f = 0; f < 4; ++f) {
      const auto face = static_cast<Corner>(4 * t + f);
      const Index beyond = stars.across(face);
      const Triangle triangle{tet[face_corners[f][0]], tet[face_corners[f][1]], tet[face_corners[f][2]]};
      if (beyond == no_index) frozen.surface.push_back(triangle);
      if (!changes) continue;
      // The tetrahedron beyond has three of its vertices in common with this one, which are not defective.
      if (beyond == no_index || defects[beyond].any()) frozen.border.push_back(triangle);
    }
  }
  frozen.free.assign(defects.size(), 0);
  for (Index v = 0; v < frozen.free.size(); ++v) {
    if (!stars.used(v)) continue;
    ++report.vertices_before;
    if (stars.on_surface(v)) {
      ++report.frozen_surface;
    } else if (touched[v] != 0) {
      ++report.frozen_defect;
    } else {
      ++report.free_vertices;
      frozen.free[v] = 1;
    }
  }
  frozen.surface = sorted_triangles(std::move(frozen.surface));
  return frozen;
}

// Drops the vertices that went. Returns what each that is left was called before.
std::vector<Index> drop_vertices(TetMesh& mesh, const std::vector<std::uint8_t>& gone) {
  std::vector<Index> old_index;
  std::vector<Index> new_index(mesh.vertices.size(), no_index);
  for (Index v = 0; v < new_index.size(); ++v) {
    if (gone[v] != 0) continue;
    const std::size_t place = old_index.size();
    new_index[v] = static_cast<Index>(place);
    mesh.vertices[place] = mesh.vertices[v];
    mesh.vertex_atom[place] = mesh.vertex_atom[v];
    old_index.push_back(v);
  }
  mesh.vertices.resize(old_index.size());
  mesh.vertex_atom.resize(old_index.size());
  for (Tetrahedron& tet : mesh.tetrahedra) {
    for (Index& v : tet) v = new_index[v];
  }
  return old_index;
}

template <class Cell>
Cell renamed(Cell cell, const std::vector<Index>& names) {
  for (Index& v : cell) v = names[v];
  return cell;
}

double difference(const DefectValues& a, const DefectValues& b) {
  return static_cast<double>(
      std::max({std::abs(a.positional - b.positional), std::abs(a.extra - b.extra), std::abs(a.vacancy - b.vacancy)}));
}

std::size_t count_used(const TetMesh& mesh) {
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const Tetrahedron& tet : mesh.tetrahedra) {
    for (const Index v : tet) used[v] = true;
  }
  return static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
}

}  // namespace

void simplify(TetMesh& mesh, Surface& surface, const Atoms& atoms, const Defects& defects,
              const SimplifyOptions& options, SimplifyReport& report, Progress& progress) {
  check_options(mesh, options);
  progress.check();
  report = {};
  report.strategy = options.strategy;
  report.tetrahedra_before = mesh.tetrahedra.size();
  report.volume_before = volume(mesh, progress);
  const std::vector<DefectValues> values = vertex_defects(mesh, atoms, defects);

  const std::vector<Tetrahedron> at_defects = defect_tetrahedra(mesh.tetrahedra, values);

  StarMesh stars(std::move(mesh.tetrahedra), mesh.vertices, progress);
  const Frozen frozen = find_frozen(stars, values, report, progress);
  report.least_tetrahedra = least_tetrahedra(at_defects.size(), frozen.border, mesh.vertices);
  std::vector<std::uint8_t> left = frozen.free;
  std::vector<std::uint8_t> defective(values.size());
  std::transform(values.begin(), values.end(), defective.begin(),
                 [](const DefectValues& d) { return d.any() ? 1 : 0; });
  report.removed_vertices = options.strategy == "remove" ? remove_vertices(stars, left, progress)
                                                         : collapse_edges(stars, left, defective, progress);
  mesh.delaunay = mesh.delaunay && (options.strategy == "remove" || report.removed_vertices == 0);
  mesh.tetrahedra = stars.take();
  progress.check();

  // From here on what is measured is measured on the mesh that leaves.
  std::vector<Vec3> places;  // of the vertices that went, and what their values were
  std::vector<DefectValues> values_there;
  std::vector<std::uint8_t> gone(mesh.vertices.size(), 0);
  for (Index v = 0; v < gone.size(); ++v) {
    if (left[v] == frozen.free[v]) continue;
    gone[v] = 1;
    places.push_back(mesh.vertices[v]);
    values_there.push_back(values[v]);
  }
  const std::vector<Index> old_index = drop_vertices(mesh, gone);
  put_in_canonical_order(mesh.tetrahedra, mesh.vertices.size(), progress);

  const std::vector<DefectValues> values_after = vertex_defects(mesh, atoms, defects);
  for (std::size_t v = 0; v < old_index.size(); ++v) {
    report.scalar_error = std::max(report.scalar_error, difference(values_after[v], values[old_index[v]]));
  }
  report.scalar_error =
      std::max(report.scalar_error, interpolation_error(mesh, values_after, places, values_there, progress));
  std::vector<Tetrahedron> at_defects_after = defect_tetrahedra(mesh.tetrahedra, values_after);
  for (Tetrahedron& tet : at_defects_after) tet = canonical(renamed(tet, old_index));
  std::sort(at_defects_after.begin(), at_defects_after.end());
  report.defect_tetrahedra_identical = at_defects_after == at_defects;

  Surface boundary = extract_surface(mesh, progress);
  std::vector<Triangle> triangles = boundary.triangles;
  for (Triangle& triangle : triangles) triangle = renamed(triangle, old_index);
  report.surface_identical = sorted_triangles(std::move(triangles)) == frozen.surface;
  if (!surface.triangles.empty()) surface = std::move(boundary);

  report.tetrahedra_after = mesh.tetrahedra.size();
  report.vertices_after = count_used(mesh);
  report.volume_after = volume(mesh, progress);
  if (report.volume_before > 0.0) {
    report.volume_change = std::abs(report.volume_after - report.volume_before) / report.volume_before;
  }
  progress.update(1.0);
}

std::vector<std::string> simplify_strategies() {
  return {"collapse", "remove"};
}

bool needs_delaunay(const std::string& strategy) {
  return strategy == "remove";
}

}  // namespace atomesh
