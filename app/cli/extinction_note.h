// A mesh file is in any unit: an extinction that suits a sample of some hundred Å can leave it invisible or black.
#pragma once

#include <string>

#include "core/parameters.h"
#include "render/scene.h"

namespace atomesh::cli {

// What to set instead when a ray across the scene meets an optical depth below 0.05 or above 100 (mode xray: as much
// alpha_length times length); "" otherwise, and in the modes without extinction.
std::string extinction_note(const Scene& scene, const Parameters& parameters);

}  // namespace atomesh::cli
