// What a material must satisfy to be written to, and to be believed from, a file.
#pragma once

#include <optional>
#include <string>

#include "core/material.h"
#include "core/progress.h"

namespace atomesh {

// How many of each there are, also of what a partial read left out.
struct MaterialCounts {
  std::uint64_t atoms = 0;
  std::uint64_t vertices = 0;
  std::uint64_t tetrahedra = 0;
};

MaterialCounts counts_of(const Material& material);

struct MaterialProblem {
  std::string section;  // of crb_format.h
  std::string what;     // "index 7 of triangle 3 is beyond the 5 vertices"
};

// The first thing wrong, if any: arrays of different lengths, numbers that are not finite, indices out of range, a
// tetrahedron that names a vertex twice, a surface triangle that is not the face of its tetrahedron, species names that
// are empty, repeated or have blanks, fields without a name of their own. Arrays that are empty are taken as not read.
// Geometry (orientation, closedness) is not looked at: validate() does that.
std::optional<MaterialProblem> find_problem(const Material& material, const MaterialCounts& counts,
                                            Progress& progress = no_progress());

}  // namespace atomesh
