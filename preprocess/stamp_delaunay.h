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
  // Polytopes whose corners differ from the pattern by more than this share of their radius are not stamped.
  double tolerance = 1e-7;
};

struct StampReport {
  std::size_t stamped = 0;     // tetrahedra taken from the pattern
  std::size_t open_atoms = 0;  // atoms that CGAL was given
  std::size_t filled = 0;      // tetrahedra it added
};

// All Delaunay tetrahedra of the points with a circumsphere of at most options.largest_radius, ties between equal
// spheres cut as the pattern cuts them.
//
// A polytope of the pattern is stamped where every corner is occupied (relative to its other corners, so that patches
// may be strained or displaced as long as it is less than the tolerance) and no other point lies in its sphere: then it
// is a Delaunay cell. Every Delaunay cell not stamped has only *open* points as corners, points whose surroundings the
// stamped cells do not fill. A Delaunay cell of all points is one of any subset that holds its corners, so the
// triangulation of the open points holds every cell that is missing; those of its cells whose sphere holds any other
// point are not Delaunay and are dropped. Both halves speak of the same complex, so they fit without gap or overlap.
//
// `points` are positions to mesh, sites.of[i] the site of point i. Positively oriented, in any order.
std::vector<Tetrahedron> stamp_delaunay(std::span<const Vec3> points, const LatticeSites& sites,
                                        const StampOptions& options, StampReport& report,
                                        Progress& progress = no_progress());

}  // namespace atomesh
