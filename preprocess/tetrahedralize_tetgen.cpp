// The only file that includes TetGen.
#include "core/error.h"
#include "preprocess/tetrahedralize.h"

namespace atomesh {

std::vector<Tetrahedron> delaunay_tetgen(std::span<const Vec3>, TetrahedralizeReport&, Progress&) {
  throw UnavailableError("this build of atomesh has no TetGen; use --mesher delaunay");
}

}  // namespace atomesh
