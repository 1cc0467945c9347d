// Atoms + UnitCell → Defects (seed, appendix A.3), with the sites of what is missing and what is too much.
#pragma once

#include "core/atoms.h"
#include "core/defects.h"
#include "core/progress.h"
#include "core/surface.h"
#include "core/tet_mesh.h"
#include "core/unit_cell.h"

namespace atomesh {

struct DefectOptions {
  double neighbourhood = 1.0;  // × the longest primitive vector = neighbourhood radius
  double tolerance = 0.0;  // Å within which an atom matches a site; 0: a fraction of the nearest-neighbour distance
};

struct DefectReport {
  double radius = 0.0;                                                   // Å, used
  double tolerance = 0.0;                                                // Å, used
  std::size_t positional_atoms = 0, vacancy_atoms = 0, extra_atoms = 0;  // atoms with a value above zero
  std::size_t surface_atoms = 0;   // atoms whose neighbourhood the sample's surface cuts
  double matched_fraction = 0.0;   // matched neighbours / neighbours the perfect crystal has (inside the sample)
  std::vector<std::string> notes;  // e.g. that the cell does not fit the sample
};

// `mesh` (carved) and `surface` tell inside from outside; both may be empty (then the sample has no inside and only
// periodic neighbours count). Same answer at any thread count. Throws Error for a singular or inconsistent unit cell.
Defects quantify_defects(const Atoms& atoms, const UnitCell& cell, const TetMesh& mesh, const Surface& surface,
                         const DefectOptions& options, DefectReport& report, Progress& progress = no_progress());

}  // namespace atomesh
