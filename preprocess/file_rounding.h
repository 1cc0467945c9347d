// Crystals whose coordinates were rounded when they were written to a file.
#pragma once

#include <span>

#include "core/progress.h"
#include "preprocess/lattice_sites.h"

namespace atomesh {

// Å: the coarsest power of ten, from 0.01 down to 1e-7, that all coordinates are multiples of; 0 when there is none.
// Asks at most some 1000 points, evenly chosen.
double find_rounding(std::span<const Vec3> points);

// The tolerance of stamping (see StampOptions) with which a crystal rounded to `rounding` Å is cut as if it were not:
// wide enough for what rounding does to spheres. 0 where `least` of the points are not within it of the sites fitted,
// where what belongs on one sphere is off it by more than rounding can do, and where the tolerance would be too wide.
double tolerance_of_rounding(std::span<const Vec3> points, const LatticeSites& sites, double rounding, double least,
                             Progress& progress = no_progress());

}  // namespace atomesh
