// A per-atom number of the user's choice in the place of the positional defect value (seed 5.4, "scalar assignment").
#pragma once

#include <string_view>

#include "core/atoms.h"
#include "core/defects.h"

namespace atomesh {

// `scalar` names a column of the atoms, or gives values by species: "Ga=0,In=1" (species not named have 0). Values are
// shifted so that the smallest is 0, since every renderer maps defect values from 0 up; vacancy and extra values are 0.
// Throws UsageError for a column or species that the atoms do not have (naming the nearest) and for a value that is no
// number.
Defects assign_scalar(const Atoms& atoms, std::string_view scalar);

}  // namespace atomesh
