// Crystals for tests: unit cells of the common lattices, and samples cut from them.
#pragma once

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "core/atoms.h"
#include "core/unit_cell.h"

namespace atomesh::test {

struct Lattice {
  std::string name;
  UnitCell cell;             // conventional: its vectors are orthogonal except for graphite's 120°
  double nearest_neighbour;  // Å
};

// sc, fcc, bcc, diamond, nacl, graphite, perovskite.
const std::vector<Lattice>& lattices();
// Throws std::out_of_range for a name that is not in lattices().
const Lattice& lattice(const std::string& name);

// The site basis[b] of cell (i, j, k).
Vec3 site(const UnitCell& cell, std::size_t b, int i, int j, int k);

// na × nb × nc cells from the origin, without a box.
Atoms cut_block(const UnitCell& cell, int na, int nb, int nc);
// The same in a box periodic along all three vectors.
Atoms periodic_block(const UnitCell& cell, int na, int nb, int nc);
// Every site with |position| <= radius.
Atoms cut_sphere(const UnitCell& cell, double radius);
// Every site of the block centred on the origin, of half-widths `half_size`, for which `keep` is true.
Atoms cut_where(const UnitCell& cell, const Vec3& half_size, const std::function<bool(const Vec3&)>& keep);

// Atoms of one species at these places.
Atoms atoms_at(std::vector<Vec3> positions, const std::string& species = "C");
// `count` atoms, uniform in [0, size]³.
Atoms random_atoms(std::size_t count, double size, std::uint64_t seed);

// Removes the atom nearest to `position` and returns where it was.
Vec3 remove_nearest(Atoms& atoms, const Vec3& position);
// Moves every atom by up to `amplitude` along each axis.
void shake(Atoms& atoms, double amplitude, std::uint64_t seed);
void translate(Atoms& atoms, const Vec3& offset);
// A rotation about no axis of any lattice.
Mat3 odd_rotation();
void transform(Atoms& atoms, const Mat3& matrix);
// Reorders the atoms at random.
Atoms shuffled(const Atoms& atoms, std::uint64_t seed);

}  // namespace atomesh::test
