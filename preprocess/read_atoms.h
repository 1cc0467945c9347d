// An atoms file → Atoms (+ the unit cell when the file has one).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/atoms.h"
#include "core/progress.h"
#include "core/unit_cell.h"

namespace atomesh {

struct ReadOptions {
  std::string format;  // "dat", "xyz", "lammps-data", "lammps-dump"; empty: by extension and, failing that, by content
  long frame = -1;     // of a file with several: 0 the first, -1 the last
  std::vector<std::string> type_names;  // LAMMPS: element of type 1, 2, …; empty: from "# El" comments, masses, an
                                        // element column, else "1", "2"
};

struct ReadResult {
  Atoms atoms;
  std::optional<UnitCell> unit_cell;
  ReadReport report;
};

// Exact duplicates (same species, same position bits) are dropped and counted. Throws InputError "FILE:LINE: expected
// …, got …" for anything malformed: wrong field count, a number that is none, NaN or infinity, a count that does not
// match, more than 2^32-2 atoms, no atoms at all.
ReadResult read_atoms(const std::string& path, const ReadOptions& options = {}, Progress& progress = no_progress());

std::vector<std::string> read_format_names();

// Reads only a unit cell: the primitive and basis blocks of a .dat. Throws InputError when there is none.
UnitCell read_unit_cell(const std::string& path);

}  // namespace atomesh
