// TetMesh → TetMesh: fewer tetrahedra where nothing happens, without any loss (seed 5.2.3, A.4).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

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

// The certificate: what was kept, and how near to what could go.
struct SimplifyReport {
  std::string strategy;
  std::size_t tetrahedra_before = 0, tetrahedra_after = 0;
  std::size_t vertices_before = 0, vertices_after = 0;  // vertices that some tetrahedron uses
  // Vertices that may not go: on the surface, defective, or in a tetrahedron with a defective vertex.
  std::size_t frozen_surface = 0, frozen_defect = 0;
  std::size_t free_vertices = 0;     // all others: no strategy can remove more than these
  std::size_t removed_vertices = 0;  // of them
  // No mesh that keeps the frozen vertices, the surface's triangles and the tetrahedra at defects has fewer tetrahedra.
  std::size_t least_tetrahedra = 0;
  double volume_before = 0.0, volume_after = 0.0;  // Å³
  double volume_change = 0.0;                      // |after - before| / before
  bool surface_identical = false;                  // the same triangles over the same atoms
  // Largest difference of any defect value, interpolated at the place of any original atom, from its original value.
  double scalar_error = 0.0;
};

// Frozen vertices stay where they are; no edge or triangle of the surface and no tetrahedron with a defective vertex
// changes; no tetrahedron inverts or becomes flat (exact); the topology stays (link condition). Deterministic.
// `mesh` is changed in place: vertices that no tetrahedron uses any more are dropped and the surface's indices follow.
// mesh.delaunay becomes false after a collapse. Defects not present(): every vertex counts as perfect.
// Throws UsageError for an unknown strategy or "remove" on a mesh that is not Delaunay.
void simplify(TetMesh& mesh, Surface& surface, const Defects& defects, const SimplifyOptions& options,
              SimplifyReport& report, Progress& progress = no_progress());

std::vector<std::string> simplify_strategies();

}  // namespace atomesh
