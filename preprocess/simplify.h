// TetMesh → TetMesh: fewer tetrahedra where nothing happens, without any loss (seed 5.2.3, A.4).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/atoms.h"
#include "core/defects.h"
#include "core/progress.h"
#include "core/surface.h"
#include "core/tet_mesh.h"

namespace atomesh {

struct SimplifyOptions {
  // "collapse": edges, shortest first, each onto one of its ends. "remove": vertices out of the Delaunay mesh, which
  // stays Delaunay (needs TetMesh::delaunay).
  std::string strategy = "collapse";
};

// The certificate: what was kept, measured on the two meshes, and how near to what could go.
struct SimplifyReport {
  std::string strategy;
  std::size_t tetrahedra_before = 0, tetrahedra_after = 0;
  std::size_t vertices_before = 0, vertices_after = 0;  // vertices that some tetrahedron uses
  // vertices_before is the sum of these three. Not allowed to go: vertices of the surface; others of a tetrahedron with
  // a defective vertex. No strategy can remove more than the free ones.
  std::size_t frozen_surface = 0, frozen_defect = 0, free_vertices = 0;
  std::size_t removed_vertices = 0;  // free ones that went
  // No mesh with the same surface and the same tetrahedra at defects has fewer tetrahedra: see least_tetrahedra() in
  // simplify_certificate.h.
  std::size_t least_tetrahedra = 0;
  double volume_before = 0.0, volume_after = 0.0;  // Å³
  double volume_change = 0.0;                      // |after - before| / before
  bool surface_identical = false;                  // the same triangles over the same atoms
  bool defect_tetrahedra_identical = false;        // the same tetrahedra with a defective vertex over the same atoms
  // Largest difference of any defect value, interpolated at the place of any original atom, from its original value.
  double scalar_error = 0.0;
};

// Frozen vertices stay where they are; no edge or triangle of the surface and no tetrahedron with a defective vertex
// changes; no tetrahedron inverts or becomes flat (exact); the topology stays (link condition). Every vertex that is
// left is one of before. Deterministic, whatever the number of threads.
//
// The mesh must pass validate() and its tetrahedra must not overlap. It is changed in place: vertices that went are
// dropped (those in no tetrahedron before stay), `surface` follows (empty stays empty), the tetrahedra are put in
// canonical order, mesh.delaunay becomes false after a collapse. Afterwards the atoms of dropped vertices have none.
// Defects not present(): every vertex counts as perfect. Atoms that share a vertex all count for it.
// After an exception (a cancel, say) the mesh is not usable. Throws UsageError for an unknown strategy or "remove" on a
// mesh that is not Delaunay, before anything is changed.
void simplify(TetMesh& mesh, Surface& surface, const Atoms& atoms, const Defects& defects,
              const SimplifyOptions& options, SimplifyReport& report, Progress& progress = no_progress());

std::vector<std::string> simplify_strategies();
// Whether the strategy can take only a mesh that is Delaunay.
bool needs_delaunay(const std::string& strategy);

}  // namespace atomesh
