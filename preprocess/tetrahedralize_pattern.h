// Atoms of a crystal → tetrahedra by its pattern (seed 5.2.1): the unit cell's own, stamped wherever they fit.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "core/progress.h"
#include "preprocess/lattice_sites.h"

namespace atomesh {

struct PatternOptions {
  // Å: tetrahedra with a larger circumsphere are left out, as carve() would. 0: what carve() finds by itself. The
  // pattern fills what is narrower only, so it does not serve where nothing is to be carved (infinity).
  double largest_radius = 0.0;
  // The exact way is taken where this share of the atoms is on its sites to rounding, ...
  double least_in_place = 0.9;
  // ... or this share with all the atoms around: so much it need not triangulate.
  double least_undisturbed = 0.5;
  // The latter where the tolerant way cannot be taken; below it a Delaunay mesh from scratch is as fast.
  double least_undisturbed_alone = 0.3;
  // Share of the atoms that may be on no site of the one crystal for the tolerant way.
  double most_off_sites = 0.03;
};

struct PatternReport {
  bool done = false;
  bool delaunay = false;  // the exact way
  // One sentence, numbers included: how, or why the pattern does not serve.
  std::string why;
  double largest_radius = 0.0;  // Å, used
  double in_place = 0.0;        // share of the atoms that are on their sites to rounding, ...
  double undisturbed = 0.0;     // ... and all around them too
  double rounding = 0.0;        // Å: the coordinates are multiples of this power of ten; 0: of none
  std::size_t parts = 0;        // rigid parts these belong to: grains, slid layers
  std::size_t stamped = 0;      // tetrahedra of the pattern
  std::size_t filled = 0;       // tetrahedra that a Delaunay triangulation of what it left open gave
  std::size_t open_atoms = 0;   // atoms that that was given
  std::size_t off_sites = 0;    // tolerant: atoms on no site of the one crystal, ...
  std::size_t inserted = 0;     // ... and those of them put into the tetrahedra around them
  std::size_t mended = 0;       // tolerant: inverted or flat tetrahedra replaced or, on the outside, removed
  std::size_t bare = 0;         // tolerant: atoms without a tetrahedron, ...
  std::size_t missing = 0;  // ... and those of them that a Delaunay mesh, carved, would hold: at most one in a thousand
};

// Two ways, tried in this order.
//
// Exact: where enough atoms are on their sites to rounding (in one piece, or in rigid parts that have slid or turned
// against each other), stamp_delaunay() on the positions: the Delaunay mesh as carving would leave it.
//
// Tolerant: topology from the perfect crystal, geometry from the atoms. Where thermal noise, rounding in the file or
// smooth strain has moved the atoms, but all of them still number the sites of one crystal, stamp_delaunay() on the
// *ideal* sites gives the tetrahedra, vacancies and surfaces filled alike; the atoms' positions are then put in and
// what they invert is mended (mend_tetrahedra.h); atoms on no site go into the tetrahedra around them
// (insert_points.h). Every tetrahedron is positively oriented; few are slivers, of which Delaunay has many there.
//
// Coordinates rounded in a file are neither exact nor noise. Delaunay's rule, taken literally, makes slivers of the
// rounding, so where that is all that atoms are off by (file_rounding.h) the tolerant way goes first, even where the
// rounded crystal repeats exactly. Where it cannot be taken, the exact way is with a tolerance as wide as the rounding
// needs: the mesh is then cut as the unrounded one, without the claim of being Delaunay.
//
// `points` are all distinct; sites.of[i] is the site of point i, as assign_lattice_sites() gives. Returns nothing with
// report.done false and the reason in report.why where neither way serves: mesh by Delaunay then. Same result at any
// number of threads.
std::vector<Tetrahedron> tetrahedralize_pattern(std::span<const Vec3> points, LatticeSites sites,
                                                const PatternOptions& options, PatternReport& report,
                                                Progress& progress = no_progress());

}  // namespace atomesh
