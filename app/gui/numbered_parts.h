// Lights and cut planes as lists that grow and shrink, over the eight of each that the parameters always have.
#pragma once

#include "core/geometry.h"
#include "core/parameters.h"

namespace atomesh::gui {

// How many there are to see: up to the last one that is not as if never touched (off, and all else as in Light{}).
// At least one light; planes from 0 on.
int light_count(const Parameters& parameters);
int cut_plane_count(const Parameters& parameters);

// Longer: the new lights shine, weakly, each from another side. Shorter: the last ones are as if never touched. Throws
// UsageError outside 1 to 8.
void set_light_count(Parameters& parameters, int count);
// Longer: the new planes cut, through the middle of the sample, across x, y, z in turn. Throws UsageError outside 0
// to 8.
void set_cut_plane_count(Parameters& parameters, int count, const Bounds& bounds);

// Takes number n (from 1) out; those after it move up. The last light stays, switched off. Throws UsageError for a
// number that there is not.
void remove_light(Parameters& parameters, int n);
void remove_cut_plane(Parameters& parameters, int n);
// The other side of plane n stays.
void flip_cut_plane(Parameters& parameters, int n);

}  // namespace atomesh::gui
