// The meshes of the hard cases. Every vertex is an atom with a random defect value, every cell positively oriented.
#pragma once

#include <functional>
#include <vector>

#include "samples/hard_cases.h"

namespace atomesh {

// Planes of a grid: coordinates, ascending, along each axis.
struct GridPlanes {
  std::vector<double> x, y, z;
};
// n + 1 planes along each axis, `step` apart, from the origin.
GridPlanes even_planes(int n, double step);

enum class CubeSplit { five, six };
// The grid's boxes split into five tetrahedra (turn and turn about, so that faces match) or six about the diagonal
// (Kuhn); boxes where `hollow` says so are left out.
Material grid_material(const GridPlanes& planes, CubeSplit split,
                       const std::function<bool(int i, int j, int k)>& hollow = nullptr);

enum class CubicLattice { simple, fcc, bcc, diamond };
// All sites in the cube [0, n·edge]³, its boundary included, meshed by Delaunay: a filled cube. Sites that are not on
// the cube's boundary are moved by up to `noise` along each axis.
Material cubic_lattice_material(CubicLattice lattice, int n, double edge, const DelaunayMesher& delaunay,
                                double noise = 0.0);

// One regular tetrahedron about the origin with corners at distance `radius`.
Material one_cell_material(double radius);
// `count` cells about one edge from -top to top on the z axis, the others' corners on the circle of this radius.
Material fan_material(int count, double radius, double top);
// Cells from the origin to the triangles of a subdivided octahedron with its corners on the sphere.
Material ball_material(int subdivisions, double radius);
// `count` bars of one tetrahedron each, in a circle in the xz plane, each before the next as seen along +y and the last
// before the first.
Material ring_material(int count);
// `side`×`side` rings of four bars, side by side in the xz plane.
Material field_of_rings_material(int side);
// `count` cells with corners at random in a cube.
Material soup_material(int count);
// A grid of cubes whose inner vertices are moved by up to `amount` of the cubes' side along each axis: above 0.5 cells
// turn over. Each cell has its own four vertices, and is turned back where it was inside out unless `inverted`.
Material tangled_material(int n, double amount, bool inverted);

// Every cell a body of its own.
Solid solid_of_cells(const TetMesh& mesh);

}  // namespace atomesh
