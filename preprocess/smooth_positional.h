// Positional values after displacements were averaged over neighbours, so that strain emerges from thermal noise.
#pragma once

#include <vector>

#include "core/defects.h"
#include "core/progress.h"
#include "preprocess/sample_view.h"

namespace atomesh {

// Share of an atom's thermal amplitude that is left after `rounds` of averaging with its counted neighbours, if every
// atom moves on its own: √Σw² over the weights w with which atoms enter. At most three rounds are followed; more leave
// no more.
double smoothed_share(const FeatureSet& features, int rounds);

// Each round moves every atom to the mean of its own place and the places that its neighbours say it should have (their
// own less the crystal's offset). Then positional values are made anew as examine_atoms.h makes them, displacements up
// to `factor` times what is left of `amplitude` counting as zero. Atoms of no standing (see SiteSearch) stay where they
// are and keep their values.
void smooth_positional(const SampleView& sample, int rounds, const NoiseLevel& noise,
                       const std::vector<std::uint16_t>& standing, Defects& defects, Progress& progress);

}  // namespace atomesh
