// Exact signs of the two determinants that decide the topology of a tetrahedral mesh. Right for all finite doubles
// whose products stay in range (coordinates between 1e-50 and 1e60 in magnitude, or 0), at the price of a rounded
// determinant wherever that one's error bound decides.
#pragma once

#include "core/geometry.h"

namespace atomesh {

// Sign of signed_volume(a, b, c, d): 1 for a positively oriented tetrahedron, 0 exactly when the four points lie in
// one plane.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// For a positively oriented (a, b, c, d): 1 when e lies inside the circumsphere, 0 exactly on it, -1 outside. The sign
// turns round with the orientation.
int in_sphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e);

}  // namespace atomesh
