// VTK's quadric decimation of tetrahedra, a peer of simplify() for the bench. It is lossy: surfaces and values move.
#pragma once

#include <span>

#include "core/tet_mesh.h"

namespace atomesh::cli {

struct VtkDecimation {
  double ms = 0.0;      // on the clock
  double cpu_ms = 0.0;  // of processor time
  std::size_t tetrahedra_before = 0, tetrahedra_after = 0;
  double volume_change = 0.0;  // |after - before| / before
  std::size_t inverted = 0;    // tetrahedra of the result that are flat or turned inside out
};

// vtkUnstructuredGridQuadricDecimation over a scalar for each vertex; `reduction` is the share of tetrahedra to remove.
// Only the filter is timed, not the copies into and out of VTK. Cannot be cancelled.
VtkDecimation decimate_with_vtk(const TetMesh& mesh, std::span<const float> scalars, double reduction);

}  // namespace atomesh::cli
