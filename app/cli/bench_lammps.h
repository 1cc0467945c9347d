// LAMMPS as a peer: its per-atom computes on the same crystal, where an `lmp` executable is found.
#pragma once

#include <optional>
#include <string>

#include "app/cli/bench_tools.h"
#include "app/cli/session.h"
#include "core/atoms.h"

namespace atomesh::cli {

// The path of `lmp` in PATH; "" when it is not installed.
std::string find_lammps();

struct LammpsTimes {
  Times cna;                // compute cna/atom, its neighbour list at hand
  Times cna_with_lists;     // the same with the neighbour lists built anew, as every new snapshot needs
  Times centro;             // compute centro/atom, its list at hand
  Times centro_with_lists;  // the same with the lists built anew
};

// One process, one thread. `cutoff` Å of cna/atom; `neighbours` of centro/atom. The atoms need a periodic box whose
// vectors lie along x, y and z. A call's time is that of steps in which no atom moves and nothing else is computed.
// nullopt when lmp does not do it; `why` then holds its last line.
std::optional<LammpsTimes> time_lammps(const std::string& lmp, const Atoms& atoms, double cutoff, int neighbours,
                                       int calls, Session& session, std::string& why);

}  // namespace atomesh::cli
