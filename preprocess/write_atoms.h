// Atoms → .dat (with unit cell, box and radii) or extended .xyz (with Lattice and every column).
#pragma once

#include <optional>
#include <string>

#include "core/atoms.h"
#include "core/progress.h"
#include "core/unit_cell.h"

namespace atomesh {

// Format by extension; shortest text that reads back to the same doubles. Throws UsageError for an extension that is
// neither; Error when the file cannot be written. Written beside and renamed.
void write_atoms(const std::string& path, const Atoms& atoms, const std::optional<UnitCell>& unit_cell = {},
                 Progress& progress = no_progress());

}  // namespace atomesh
