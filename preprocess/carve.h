// Removes the tetrahedra that span empty space: cavities, concave outsides, pores.
#pragma once

#include "core/progress.h"
#include "core/tet_mesh.h"

namespace atomesh {

struct CarveOptions {
  double radius = 0.0;  // Å; a tetrahedron whose circumsphere is larger is removed. 0: automatic
};

struct CarveReport {
  double radius = 0.0;            // used, Å
  std::size_t removed = 0;        // tetrahedra
  double nearest_neighbour = 0;   // Å, median over the vertices of the distance to the nearest other vertex
  std::size_t bare_vertices = 0;  // vertices that no tetrahedron is left with
};

// Alpha criterion on the Delaunay mesh (Edelsbrunner & Mücke 1994, doi 10.1145/174462.156635); what encloses nothing
// but empty space goes, whether it is open to the outside or not. Keeps the order of what stays, the vertices and
// TetMesh::delaunay. Throws UsageError for a radius that is negative or not finite.
// Takes 8 bytes a tetrahedron beside a mesh that is moved in.
TetMesh carve(TetMesh mesh, const CarveOptions& options, CarveReport& report, Progress& progress = no_progress());

// The automatic radius, from what the sample's own packing leaves empty. Each vertex's void is the largest
// circumsphere of its tetrahedra; where the packing is whole that is the crystal's largest interstice (0.71 nearest-
// neighbour distances in fcc, 0.87 in NaCl, 1.0 in diamond, 1.4 in graphite), at a surface it is more. The radius is
// `carve_void_factor` times the void that a quarter of the vertices do not exceed, so it holds while a quarter of the
// atoms lie inside the material, but no more than `carve_neighbour_factor` nearest-neighbour distances, for samples
// that are all surface. In a sample of several densities the densest quarter decides, and what is packed much more
// loosely is carved: give a radius there.
inline constexpr double carve_void_factor = 2.0;
inline constexpr double carve_neighbour_factor = 3.5;

}  // namespace atomesh
