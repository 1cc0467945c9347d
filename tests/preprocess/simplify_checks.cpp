#include "tests/preprocess/simplify_checks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "preprocess/canonical_tetrahedra.h"
#include "preprocess/carve.h"
#include "preprocess/tetrahedralize.h"
#include "tests/support/lattices.h"

namespace atomesh::test {

namespace {

template <class Cell>
Cell by_atom(Cell cell, const TetMesh& mesh) {
  for (Index& v : cell) v = mesh.vertex_atom[v];
  return cell;
}

std::vector<Triangle> surface_by_atom(const TetMesh& mesh, const Surface& surface) {
  std::vector<Triangle> triangles;
  for (const Triangle& t : surface.triangles) {
    triangles.push_back(by_atom(t, mesh));
    Triangle& back = triangles.back();
    std::rotate(back.begin(), std::min_element(back.begin(), back.end()), back.end());
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

// The tetrahedra that have a vertex that `picks` picks by its atom.
template <class Picks>
std::vector<Tetrahedron> tetrahedra_with(const TetMesh& mesh, Picks&& picks) {
  std::vector<Tetrahedron> found;
  for (const Tetrahedron& tet : mesh.tetrahedra) {
    const Tetrahedron atoms = by_atom(tet, mesh);
    if (std::any_of(atoms.begin(), atoms.end(), picks)) found.push_back(canonical(atoms));
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::set<Index> used_atoms(const TetMesh& mesh) {
  std::set<Index> used;
  for (const Tetrahedron& tet : mesh.tetrahedra) {
    for (const Index v : tet) used.insert(mesh.vertex_atom[v]);
  }
  return used;
}

// Vertices - edges + triangles - tetrahedra: 1 for a ball, one more for each cavity, one less for each handle.
long euler_number(const TetMesh& mesh) {
  std::set<Index> vertices;
  std::set<std::array<Index, 2>> edges;
  std::set<Triangle> triangles;
  for (Tetrahedron tet : mesh.tetrahedra) {
    std::sort(tet.begin(), tet.end());
    for (int i = 0; i < 4; ++i) {
      vertices.insert(tet[i]);
      triangles.insert({tet[i == 0 ? 1 : 0], tet[i < 2 ? 2 : 1], tet[i < 3 ? 3 : 2]});
      for (int j = i + 1; j < 4; ++j) edges.insert({tet[i], tet[j]});
    }
  }
  return static_cast<long>(vertices.size()) - static_cast<long>(edges.size()) + static_cast<long>(triangles.size()) -
         static_cast<long>(mesh.tetrahedra.size());
}

}  // namespace

Simplified simplified(const TetMesh& mesh, const Atoms& atoms, const Defects& defects, const std::string& strategy,
                      const std::string& what) {
  Simplified result;
  result.before = mesh;
  result.after = mesh;
  const Surface surface = extract_surface(mesh);
  result.surface = surface;
  simplify(result.after, result.surface, atoms, defects, {strategy}, result.report);
  const TetMesh& after = result.after;
  const SimplifyReport& report = result.report;
  const std::string label = what + ", " + strategy;

  EXPECT_EQ(validate(after), std::vector<std::string>{}) << label;
  EXPECT_EQ(validate(result.surface, after), std::vector<std::string>{}) << label;
  EXPECT_EQ(surface_by_atom(after, result.surface), surface_by_atom(mesh, surface)) << label;
  EXPECT_NEAR(volume(after), volume(mesh), 1e-12 * volume(mesh)) << label;
  EXPECT_EQ(euler_number(after), euler_number(mesh)) << label;

  const auto defective = [&](Index atom) { return defects.defective(atom); };
  EXPECT_EQ(tetrahedra_with(after, defective), tetrahedra_with(mesh, defective)) << label;
  std::set<Index> frozen;
  for (const Tetrahedron& tet : tetrahedra_with(mesh, defective)) frozen.insert(tet.begin(), tet.end());
  for (const Triangle& triangle : surface_by_atom(mesh, surface)) frozen.insert(triangle.begin(), triangle.end());
  const std::set<Index> used_before = used_atoms(mesh);
  const std::set<Index> used_after = used_atoms(after);
  EXPECT_TRUE(std::includes(used_after.begin(), used_after.end(), frozen.begin(), frozen.end())) << label;
  EXPECT_TRUE(std::includes(used_before.begin(), used_before.end(), used_after.begin(), used_after.end())) << label;
  for (std::size_t v = 0; v < after.vertices.size(); ++v) {
    EXPECT_EQ(after.vertices[v], atoms.positions[after.vertex_atom[v]]) << label;
  }

  EXPECT_EQ(report.strategy, strategy);
  EXPECT_EQ(report.tetrahedra_before, mesh.tetrahedra.size());
  EXPECT_EQ(report.tetrahedra_after, after.tetrahedra.size());
  EXPECT_EQ(report.vertices_before, used_before.size()) << label;
  EXPECT_EQ(report.vertices_after, used_after.size()) << label;
  EXPECT_EQ(report.frozen_surface + report.frozen_defect, frozen.size()) << label;
  EXPECT_EQ(report.free_vertices, used_before.size() - frozen.size()) << label;
  EXPECT_EQ(report.removed_vertices, used_before.size() - used_after.size()) << label;
  EXPECT_EQ(mesh.vertices.size() - after.vertices.size(), report.removed_vertices) << label;
  EXPECT_LE(report.least_tetrahedra, report.tetrahedra_after) << label;
  EXPECT_LE(report.volume_change, 1e-12) << label;
  EXPECT_TRUE(report.surface_identical) << label;
  EXPECT_TRUE(report.defect_tetrahedra_identical) << label;
  EXPECT_EQ(report.scalar_error, 0.0) << label;
  return result;
}

TetMesh carved_mesh(const Atoms& atoms) {
  TetrahedralizeReport tetrahedralize_report;
  CarveReport carve_report;
  return carve(tetrahedralize(atoms, {}, tetrahedralize_report), {}, carve_report);
}

Atoms atoms_of(const TetMesh& mesh) {
  return atoms_at(mesh.vertices);
}

Defects defects_near(const Atoms& atoms, const std::vector<Vec3>& places, double radius) {
  Defects defects;
  defects.positional.assign(atoms.size(), 0.0F);
  defects.vacancy = defects.extra = defects.positional;
  for (std::size_t a = 0; a < atoms.size(); ++a) {
    for (const Vec3& place : places) {
      if (glm::length(atoms.positions[a] - place) < radius) defects.positional[a] = 1.0F;
    }
  }
  return defects;
}

}  // namespace atomesh::test
