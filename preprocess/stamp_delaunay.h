// Delaunay tetrahedra by stamping the crystal's own where it is undisturbed, and by CGAL elsewhere.
#pragma once

#include <span>
#include <vector>

#include "core/geometry.h"
#include "core/progress.h"
#include "preprocess/lattice_sites.h"

namespace atomesh {

struct StampOptions {
  // Å: tetrahedra with a larger circumsphere are not made. What carve() would keep of the full Delaunay mesh.
  double largest_radius = 0.0;
  // Polytopes whose corners are off their common sphere by more than this share of its radius are not stamped, and what
  // is off by so much counts as on it where cells are filled in. Below 0.01.
  //
  // Up to 1e-7 the mesh is Delaunay as validate() means it. Coordinates rounded to d Å need about 20 d over the radius:
  // then a crystal from a file is cut as the exact one is, watertight and without the slivers that Delaunay's rule,
  // taken literally, makes of rounding; it is Delaunay but for about that share of the radius.
  double tolerance = 1e-7;
  // What is left open along a crystal's face repeats as the crystal does: it is filled once and copied. The same mesh
  // without, only later.
  bool copy_fill = true;
};

struct StampReport {
  std::size_t stamped = 0;     // tetrahedra taken from the pattern
  std::size_t open_atoms = 0;  // atoms that CGAL was given
  std::size_t filled = 0;      // tetrahedra it added, copies included
  std::size_t copied = 0;      // atoms that cells were copied to
  std::size_t rounds = 0;      // times that stamps at the seam were taken back
  double tolerance = 0.0;      // the one that was used
};

// All Delaunay tetrahedra of the points with a circumsphere of at most options.largest_radius, ties between equal
// spheres cut as the pattern cuts them.
//
// A polytope of the pattern is stamped where its corners are occupied, each within a few hundredths of the nearest-
// neighbour distance of its site and all on one sphere, and no other point lies in that sphere: then it is a Delaunay
// cell. So is what the occupied corners span where others are empty, at a surface or beside a vacancy. Every Delaunay
// cell not stamped has only *open* points as corners, points whose surroundings the stamped cells do not fill (which
// they are is proved in stamp_sample.cpp). A Delaunay cell of all points is one of any subset that holds its corners,
// so the triangulation of the open points holds every cell that is missing; those of its cells whose sphere holds any
// other point are not Delaunay and are dropped. Both halves speak of the same complex, so they fit without gap or
// overlap. That is checked on every triangle between them. Where it does not hold, as it may when atoms are off their
// sites by about as much as the tolerance allows, stamps there are taken back, or all is done again with a hundredth of
// the tolerance, twice at most; when nothing helps, or where hardly anything can be stamped, all points are
// triangulated as if there were no pattern (nothing stamped then).
//
// What is open repeats, along a face or from vacancy to vacancy, as the crystal does: around equal neighbourhoods cells
// are found once and copied (what "equal" has to mean is proved in stamp_copies.cpp).
//
// `points` are positions to mesh, all distinct and finite, sites.of[i] the site of point i. Positively oriented, in a
// fixed order whatever the number of threads. Throws UsageError for options out of range and sites that do not belong
// to the points.
std::vector<Tetrahedron> stamp_delaunay(std::span<const Vec3> points, const LatticeSites& sites,
                                        const StampOptions& options, StampReport& report,
                                        Progress& progress = no_progress());

}  // namespace atomesh
