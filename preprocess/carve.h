// Removes the tetrahedra that span empty space: cavities, concave outsides, pores.
#pragma once

#include "core/progress.h"
#include "core/tet_mesh.h"

namespace atomesh {

struct CarveOptions {
  double radius = 0.0;  // Å; a tetrahedron whose circumsphere is larger is removed. 0: automatic
};

struct CarveReport {
  double radius = 0.0;           // used, Å
  std::size_t removed = 0;       // tetrahedra
  double nearest_neighbour = 0;  // Å, median over the vertices of the distance to the nearest other vertex
};

// Alpha criterion on the Delaunay mesh (Edelsbrunner & Mücke 1994, doi 10.1145/174462.156635).
TetMesh carve(const TetMesh& mesh, const CarveOptions& options, CarveReport& report,
              Progress& progress = no_progress());

}  // namespace atomesh
