// The perfect crystal a sample is compared with: one unit cell, or one for each grain.
#pragma once

#include <cstdint>
#include <vector>

#include "core/unit_cell.h"

namespace atomesh {

inline constexpr std::uint16_t no_grain = 0xFFFF;

struct Crystal {
  // One cell a grain, each turned as the grain lies in the sample. A single crystal has one; none: nothing is known.
  // All describe the same crystal unless the sample has several phases.
  std::vector<UnitCell> grains;
  // Of each atom: the grain it belongs to (index into `grains`), or no_grain where nothing tells (a grain boundary, a
  // melt). Empty with at most one grain: every atom belongs to grain 0.
  std::vector<std::uint16_t> grain_of;

  bool known() const { return !grains.empty(); }
  std::uint16_t grain(std::size_t atom) const {
    return grains.empty() ? no_grain : grain_of.empty() ? std::uint16_t{0} : grain_of[atom];
  }
};

}  // namespace atomesh
