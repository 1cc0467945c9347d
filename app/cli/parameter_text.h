// The display parameters as a picture carries them, and as --set names them.
#pragma once

#include <string>

#include "core/atoms.h"
#include "core/parameters.h"

namespace atomesh::cli {

// "key=value" lines that --set reads back to exactly these parameters; species keys where they say something.
std::string parameter_lines(const Parameters& parameters);

// Throws UsageError when `key` names a species ("atoms.color.Nq") that the atoms do not have.
void check_species_key(const std::string& key, const Atoms& atoms);

}  // namespace atomesh::cli
