// Atoms → TetMesh: the Delaunay tetrahedralization of their positions, or the crystal's own stamped over them.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/atoms.h"
#include "core/progress.h"
#include "core/tet_mesh.h"
#include "preprocess/crystal.h"
#include "preprocess/tetrahedralize_pattern.h"

namespace atomesh {

struct TetrahedralizeOptions {
  // "delaunay" (CGAL), "tetgen", "pattern" (tetrahedralize_pattern.h), or "auto": the pattern where the crystal allows
  // it, else Delaunay.
  std::string mesher = "auto";
  // Who will remove vertices needs a mesh that is Delaunay: the pattern gives way where it would not be.
  bool must_be_delaunay = false;
};

struct TetrahedralizeReport {
  std::string mesher;               // the one used
  std::string why;                  // one sentence: why auto chose it
  std::size_t merged_vertices = 0;  // atoms that share another atom's exact position
  std::size_t flat_removed = 0;     // tetrahedra of exactly zero volume that the mesher made and that were removed
  std::size_t slivers_removed = 0;  // tetrahedra that only rounding kept from zero volume: see remove_slivers.h
  PatternReport pattern;            // when the pattern was tried
};

// One vertex per distinct position. Fewer than four atoms, or all in one plane, give a mesh without tetrahedra. No flat
// tetrahedron leaves here; the mesh passes validate(). The result does not depend on the number of threads.
//
// The pattern needs to know the crystal, and the radius above which tetrahedra will be carved away: it does not make
// them. 0: the one that carve() finds by itself; infinity: nothing will be carved, and the pattern is of no use. Asked
// for where it does not serve, the pattern gives way to Delaunay, and report.why says why.
// Throws UsageError for an unknown mesher (naming those there are), and for "pattern" where no crystal is known or
// nothing will be carved; UnavailableError for a mesher left out of the build.
TetMesh tetrahedralize(const Atoms& atoms, const Crystal& crystal, double carving_radius,
                       const TetrahedralizeOptions& options, TetrahedralizeReport& report,
                       Progress& progress = no_progress());

// The whole convex hull of atoms of which no crystal is known.
inline TetMesh tetrahedralize(const Atoms& atoms, const TetrahedralizeOptions& options, TetrahedralizeReport& report,
                              Progress& progress = no_progress()) {
  return tetrahedralize(atoms, {}, std::numeric_limits<double>::infinity(), options, report, progress);
}

std::vector<std::string> mesher_names();

// The adapters behind it: points (all distinct, in any order) → positively oriented tetrahedra over their indices, in
// any order.
std::vector<Tetrahedron> delaunay_cgal(std::span<const Vec3> points, Progress& progress);
// Adds what it had to repair to the report. Throws UnavailableError in a build without TetGen.
std::vector<Tetrahedron> delaunay_tetgen(std::span<const Vec3> points, TetrahedralizeReport& report,
                                         Progress& progress);

}  // namespace atomesh
