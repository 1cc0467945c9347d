// Atoms → TetMesh: the Delaunay tetrahedralization of their positions.
#pragma once

#include <string>
#include <vector>

#include "core/atoms.h"
#include "core/progress.h"
#include "core/tet_mesh.h"

namespace atomesh {

struct TetrahedralizeOptions {
  std::string mesher = "auto";  // "auto", "delaunay" (CGAL), "tetgen"
};

struct TetrahedralizeReport {
  std::string mesher;               // the one used
  std::string why;                  // one sentence: why auto chose it
  std::size_t merged_vertices = 0;  // atoms that share another atom's exact position
  std::size_t flat_removed = 0;     // tetrahedra of exactly zero volume that the mesher made and that were removed
  std::size_t slivers_removed = 0;  // tetrahedra that only rounding kept from zero volume: see remove_slivers.h
};

// One vertex per distinct position. Fewer than four atoms, or all in one plane, give a mesh without tetrahedra. No flat
// tetrahedron leaves here; the mesh passes validate(). The result does not depend on the number of threads.
// Throws UsageError for an unknown mesher (naming those there are), UnavailableError for one left out of the build.
TetMesh tetrahedralize(const Atoms& atoms, const TetrahedralizeOptions& options, TetrahedralizeReport& report,
                       Progress& progress = no_progress());

std::vector<std::string> mesher_names();

// The adapters behind it: points (all distinct, in any order) → positively oriented tetrahedra over their indices, in
// any order.
std::vector<Tetrahedron> delaunay_cgal(std::span<const Vec3> points, Progress& progress);
// Adds what it had to repair to the report. Throws UnavailableError in a build without TetGen.
std::vector<Tetrahedron> delaunay_tetgen(std::span<const Vec3> points, TetrahedralizeReport& report,
                                         Progress& progress);

}  // namespace atomesh
