// A material's volume for ParaView and VTK.
#pragma once

#include <string>

#include "core/material.h"

namespace atomesh::cli {

// The mesh's vertices as points (double), its tetrahedra as cells; point data "species" (index into the species table),
// "atom" (index of the atom) and, where there are some, "positional", "vacancy" and "extra" and every column of the
// file. Binary, compressed. Written beside and renamed. Throws Error when it cannot be written.
void write_vtu(const std::string& path, const Material& material);

}  // namespace atomesh::cli
