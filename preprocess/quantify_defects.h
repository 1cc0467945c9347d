// Atoms + UnitCell → Defects (seed, appendix A.3), with the sites of what is missing and what is too much.
#pragma once

#include <string>
#include <vector>

#include "core/atoms.h"
#include "core/defects.h"
#include "core/progress.h"
#include "core/unit_cell.h"

namespace atomesh {

struct DefectOptions {
  double neighbourhood = 1.0;  // × the longest primitive vector = neighbourhood radius
  // Å within which an atom matches a site; 0: 0.3 × the nearest-neighbour distance. Above 0.45 × it is limited.
  double tolerance = 0.0;
};

struct DefectReport {
  double radius = 0.0;                                                   // Å, used
  double tolerance = 0.0;                                                // Å, used
  std::size_t positional_atoms = 0, vacancy_atoms = 0, extra_atoms = 0;  // atoms with a value above zero
  std::size_t surface_atoms = 0;   // atoms whose neighbourhood the sample's surface cuts
  double matched_fraction = 0.0;   // matched neighbours / neighbours the perfect crystal has (inside the sample)
  std::vector<std::string> notes;  // e.g. that the cell does not fit the sample
};

// Compares every atom's neighbourhood with the perfect crystal's (the cell's own orientation; its origin does not
// matter) and fills the values of core/defects.h:
// - Neighbours within the radius count, shells exactly at it included. Matching looks beyond the radius, so nothing
//   near the ends of the vectors is counted by accident.
// - positional: displacements up to max(0.2 % of the nearest-neighbour distance, 0.005 Å) are the rounding of a file
//   (three decimals or more, cell included) and count as zero.
// - vacancy: entries whose occupant was displaced by more than the tolerance, and entries that lead to a vacancy site.
//   Entries that lead anywhere else lie outside the sample and do not count. No mesh is needed to tell: a vacancy's
//   own first shells are mostly filled, a site outside the sample has at most what a half-space holds.
// - extra: neighbours that fit no entry; an atom that is on no site itself has the value 1.
// Atoms of a species the cell lacks are extra. When the cell does not fit the sample (matched_fraction below 0.5) no
// sites are reported and a note says so.
// Same answer at any number of threads. Throws Error for a singular or inconsistent unit cell, UsageError for options
// out of range.
Defects quantify_defects(const Atoms& atoms, const UnitCell& cell, const DefectOptions& options, DefectReport& report,
                         Progress& progress = no_progress());

}  // namespace atomesh
