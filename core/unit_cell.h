// The crystal's repeating unit.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/geometry.h"

namespace atomesh {

struct BasisAtom {
  std::string species;
  Vec3 position;  // Cartesian, Å, relative to the cell's origin
};

// A perfect crystal has an atom of species basis[i].species at
//   origin + basis[i].position + a·primitive[0] + b·primitive[1] + c·primitive[2]   for all integers a, b, c;
// the origin is any lattice translation of the sample and is not stored: only differences of positions matter.
struct UnitCell {
  std::array<Vec3, 3> primitive{};
  std::vector<BasisAtom> basis;

  Mat3 matrix() const { return Mat3(primitive[0], primitive[1], primitive[2]); }
  double volume() const { return std::abs(glm::determinant(matrix())); }
  double longest_primitive() const;
};

// Throws Error naming what is wrong: a primitive vector that is zero or not finite, three that are (nearly) coplanar,
// no basis, two basis atoms on the same site (modulo the lattice). A left-handed triple is fine and is left as it is.
void check_unit_cell(const UnitCell& cell);

// An equivalent set of primitive vectors that is short and right-handed (Minkowski-reduced), same lattice.
std::array<Vec3, 3> reduce_lattice(const std::array<Vec3, 3>& primitive);

}  // namespace atomesh
