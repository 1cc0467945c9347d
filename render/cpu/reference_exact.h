// The exact sign of a determinant of doubles, with ties broken symbolically.
#pragma once

#include "core/geometry.h"

namespace atomesh::reference {

// Sign (-1, 0, 1) of (x+ε, y+ε², 1) · (a × b) for an infinitely small ε > 0: on which side of the line from a to b
// the image point (x, y), nudged right and by much less up, lies (Edelsbrunner and Mücke 1990, "Simulation of
// simplicity"). a and b are homogeneous image points. Zero only where a and b are the same image point. Exact unless an
// intermediate product of three coordinates leaves the range of double.
int side_of_line(double x, double y, const Vec3& a, const Vec3& b);

// The value of (x, y, 1) · (a × b) to the last bits of double, however much of it cancels.
double value_at_line(double x, double y, const Vec3& a, const Vec3& b);

}  // namespace atomesh::reference
