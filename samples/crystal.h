// Lattices and the blocks cut from them: what the generators of crystalline samples share.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/atoms.h"
#include "core/unit_cell.h"

namespace atomesh {

// Conventional cubic cells, edges along x, y, z. Their edge is the longest primitive vector and thereby the radius of
// the neighbourhood in which defects are sought; the primitive cells of these lattices would reach the first shell
// only.
UnitCell fcc_cell(std::string_view species, double edge);
UnitCell rock_salt_cell(std::string_view cation, std::string_view anion, double edge);
// Diamond when both species are equal. Basis: the four sites of the fcc lattice hold `first`, those a quarter of the
// body diagonal further `second`.
UnitCell zinc_blende_cell(std::string_view first, std::string_view second, double edge);

struct BlockShape {
  std::array<std::size_t, 3> cells{};  // along each primitive vector
  std::size_t total() const { return cells[0] * cells[1] * cells[2]; }
};

// The block of whole cells that holds nearly `cells` of them with nearly the edge lengths `proportions` (any unit).
// `extent` is a cell's size along each edge, Å. A cell count that is off by 0.01 % weighs as much as edges that are off
// by 10 %.
BlockShape choose_block(double cells, const Vec3& extent, const Vec3& proportions);

// The atom of basis index b in cell (i, j, k) has index ((k·cells[1] + j)·cells[0] + i)·basis.size() + b and stands at
// i·primitive[0] + j·primitive[1] + k·primitive[2] + basis[b].position.
Atoms build_block(const UnitCell& cell, const BlockShape& shape);

// The atoms of a crystal without some of them: `removed` is one flag per atom.
Atoms without(const Atoms& atoms, const std::vector<bool>& removed);

}  // namespace atomesh
