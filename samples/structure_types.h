// The common crystal structures by name, each with a material that crystallises in it: what unit cells are looked for
// in, and what defects are planted in.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/unit_cell.h"

namespace atomesh {

struct StructureType {
  std::string_view name;      // "zinc-blende"
  std::string_view material;  // "GaAs"
  // Conventional cell at room temperature, right-handed, a along x, b in the xy plane; its basis atoms lie in [0, 1)³.
  UnitCell cell;
  int space_group;              // number in the International Tables
  std::string_view symbol;      // Hermann-Mauguin, short: "F-43m"
  std::size_t primitive_atoms;  // atoms of the primitive cell
  double nearest_neighbour;     // Å, of the cell as it stands
  std::string_view impurity;    // an element that takes a site of this crystal in nature (or nearly)
  std::string_view source;      // of the lattice constants
};

// fcc (Cu), bcc (Fe), hcp (Mg), diamond (C), zinc-blende (GaAs), rock-salt (NaCl), cscl (CsCl), perovskite (SrTiO3),
// graphite (C), fluorite (CaF2), wurtzite (GaN), rutile (TiO2).
const std::vector<StructureType>& structure_types();

// Throws UsageError for an unknown name (naming the nearest).
const StructureType& find_structure_type(std::string_view name);

// The smallest distance between two atoms of the endless crystal, Å.
double nearest_neighbour_distance(const UnitCell& cell);

// The places of the endless crystal that are furthest from every atom, one of each class of translates, and how far
// that is: where an interstitial has most room. A largest empty sphere has four atoms or more on it, so the centre is
// a circumcentre of four; every four within reach are tried. In the cell, sorted by z, y, x.
struct LargestVoids {
  std::vector<Vec3> positions;  // Å, Cartesian, inside the cell
  double radius = 0.0;          // Å, to the nearest atoms
};
LargestVoids largest_voids(const UnitCell& cell);

}  // namespace atomesh
