// The sphere through the four corners of a tetrahedron.
#pragma once

#include "core/geometry.h"

namespace atomesh {

struct Sphere {
  Vec3 center;    // Å
  double radius;  // Å
};

// Accurate for slivers too: where the tetrahedron is so thin that doubles would lose the sphere, 106 bits find it.
// Radius infinity (and the first corner as centre) for four points in one plane.
Sphere circumsphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace atomesh
