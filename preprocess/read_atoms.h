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
  // "dat", "xyz", "lammps-data" or "lammps-dump"; empty: what the first lines plainly are and, where they could be
  // anything, by extension (.dat; .xyz .extxyz; .data .lmp .lammps; .dump .lammpstrj).
  std::string format;
  long frame = -1;                      // of a file with several: 0 the first, -1 the last
  std::vector<std::string> type_names;  // LAMMPS: element of type 1, 2, …; empty: from "# El" comments, masses, an
                                        // element column, else "1", "2"
};

struct ReadResult {
  Atoms atoms;
  std::optional<UnitCell> unit_cell;
  ReadReport report;
};

// The grammars, and what is taken and left out of each, stand at the top of read_dat.cpp, read_xyz.cpp,
// read_lammps_data.cpp and read_lammps_dump.cpp. Only the chosen frame is read; the others are passed over, and one
// that is damaged is an error only when it, or the last one, is asked for. LAMMPS atoms come in ascending order of
// their ids, others in that of the file.
// Exact duplicates (same species, same position bits; -0 is 0) are dropped and counted. Throws InputError "FILE:LINE:
// expected …, got …" for anything malformed: wrong field count, a number expected …, got …" for anything malformed:
// wrong field count, a number that is none, NaN or infinity, a count that does not match, more than 2^32-2 atoms, no
// atoms at all, an atom farther than a metre from the origin. more than 2^32-2 atoms, no atoms at all. Throws
// UsageError for an unknown format, a frame the file does not have, or too few type_names.
ReadResult read_atoms(const std::string& path, const ReadOptions& options = {}, Progress& progress = no_progress());

std::vector<std::string> read_format_names();
// Whether the name ends like that of a format that is read (".dat", ".xyz", …).
bool has_atoms_extension(const std::string& path);

// Reads only a unit cell: the primitive and basis blocks of a .dat, which may hold atoms or none. Throws InputError
// when there is no cell.
UnitCell read_unit_cell(const std::string& path);

}  // namespace atomesh
