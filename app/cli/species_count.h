// How many atoms of each species.
#pragma once

#include <string>

#include "app/cli/json.h"
#include "core/atoms.h"

namespace atomesh::cli {

// "Na 1,024, Cl 1,023", in the order of the species table.
std::string species_text(const Atoms& atoms);
// {"Na": 1024, "Cl": 1023}
Json species_json(const Atoms& atoms);

}  // namespace atomesh::cli
