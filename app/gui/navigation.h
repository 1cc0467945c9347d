// What mouse and keys do to the view: plain functions on the view's parameters (azimuth, elevation, roll, zoom, pan).
// Angles stay within ±180 degrees, zoom and pan within the table's ranges.
#pragma once

#include <array>

#include "core/camera.h"
#include "core/parameters.h"
#include "core/unit_cell.h"

namespace atomesh::gui {

// Turns the view about `pivot` (Å), which stays at its place in the picture. `right` and `down` are how far the mouse
// went, in shorter sides of the picture; a whole side turns by 180 degrees, and what is in front goes with the mouse.
// upright: about z and the axis across it that the picture has, never past the poles; else about the picture's two
// axes.
void rotate_view(Parameters& parameters, const Bounds& bounds, const Vec3& pivot, double right, double down,
                 bool upright);
// Turns the picture about the pivot's place in it; counter-clockwise, degrees.
void roll_view(Parameters& parameters, const Bounds& bounds, const Vec3& pivot, double degrees);
// Moves the sample by so many pixels of a width × height picture; at the pivot's depth it follows the mouse exactly. (A
// pivot that is not in front of the eye is none: then, and in zoom_view(), the depth is that of the point looked at.)
void pan_view(Parameters& parameters, const Bounds& bounds, const Vec3& pivot, double right, double down, int width,
              int height);
// zoom × factor, within the table's range; the point under (column, row) at the pivot's depth stays there. Whole
// numbers are the centres of pixels. In perspective the eye goes towards that point.
void zoom_view(Parameters& parameters, const Bounds& bounds, const Vec3& pivot, double factor, double column,
               double row, int width, int height);

// Looks along `forward`, `up` upwards: both unit vectors, at right angles to one another. At a pole of the elevation
// the turn about the line of sight is the azimuth's, and roll is 0.
void set_orientation(Parameters& parameters, const Vec3& forward, const Vec3& up);
// Looks along `direction` with `up` upwards in the picture (as far as it can be; where they are parallel the one of z,
// y, x takes its place that is nearest to a right angle with the direction). Zoom and pan stay. Throws UsageError for a
// direction without length.
void look_along(Parameters& parameters, const Vec3& direction, const Vec3& up);
// Along [uvw] of the crystal's own cell, c (or, looking along it, b) upwards; and at the lattice plane (hkl) from its
// front, along its normal. Throws UsageError for 0 0 0.
void look_along_crystal(Parameters& parameters, const UnitCell& cell, const Vec3& uvw);
void look_at_plane(Parameters& parameters, const UnitCell& cell, const Vec3& hkl);
// Unit normal of (hkl): h a* + k b* + l c*. Throws UsageError for 0 0 0.
Vec3 plane_normal(const UnitCell& cell, const Vec3& hkl);
// Å between neighbouring planes (hkl). Throws UsageError for 0 0 0.
double plane_spacing(const UnitCell& cell, const Vec3& hkl);

// The sphere (Å) comes to the middle, half as high as the picture's shorter side; nothing turns. A point (radius 0)
// comes to the middle and the zoom stays.
void fly_to(Parameters& parameters, const Bounds& bounds, const Vec3& center, double radius);
// As the file was first shown: azimuth, elevation, roll, zoom, pan of the defaults.
void reset_orientation(Parameters& parameters);

}  // namespace atomesh::gui
