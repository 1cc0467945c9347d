// What a simplification must keep and how far it could go, measured on meshes and not on what was done to them.
#pragma once

#include <span>
#include <vector>

#include "core/progress.h"
#include "core/tet_mesh.h"
#include "core/vertex_defects.h"

namespace atomesh {

// The triangles with one tetrahedron on them, outward, each rotated to begin with its smallest vertex, sorted.
std::vector<Triangle> sorted_triangles(std::vector<Triangle> triangles);

// Those of the mesh's tetrahedra that have a defective vertex, each in canonical rotation, sorted.
std::vector<Tetrahedron> defect_tetrahedra(std::span<const Tetrahedron> tetrahedra,
                                           std::span<const DefectValues> defects);

// No mesh whose tetrahedra include `kept` and whose remaining part has the boundary `border` (outward from that part)
// has fewer tetrahedra. Each triangle of the border needs a tetrahedron in the remaining part; two can share one only
// when they have an edge in common and the tetrahedron they span lies behind both (exact), three and four only when
// that holds with one apex. A triangle that can share with s others thus counts for 1 / (1 + s) of a tetrahedron. Flat
// and hollow parts of the border share nothing: a star-shaped region with flat sides, a crystal without defects say, is
// filled from one vertex with exactly so many.
std::size_t least_tetrahedra(std::size_t kept, const std::vector<Triangle>& border, const std::vector<Vec3>& vertices);

// The largest difference between `values` and the mesh's own defect values interpolated at `points`, none of which need
// be a vertex. Only tetrahedra with a defective vertex are looked at, for everywhere else the mesh's value is 0: a
// point that lies in no tetrahedron counts as one where the value is 0.
double interpolation_error(const TetMesh& mesh, std::span<const DefectValues> defects, std::span<const Vec3> points,
                           std::span<const DefectValues> values, Progress& progress);

}  // namespace atomesh
