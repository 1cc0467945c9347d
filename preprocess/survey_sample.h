// What a look at some thousand atoms, spread evenly, tells before all are compared.
#pragma once

#include <optional>
#include <vector>

#include "core/progress.h"
#include "preprocess/sample_view.h"

namespace atomesh {

struct Survey {
  // The crystal is found around at least a fifth of the atoms. Where it is not, looking for displaced atoms one by one
  // would be long and in vain.
  bool recognised = true;
  // Of each grain: what its cell must be multiplied by to be the sample's own, where that is the same all over it (a
  // lattice constant of another temperature, a tiny rotation) and the cell as given explains less. The identity where
  // it fits, and where strain differs from place to place: that is what the values are to show.
  std::vector<Mat3> frame;
  double amplitude = 0.0;  // Å, rms thermal displacement per axis; 0 where it is below the rounding of a file
};

// `amplitude`: what is known of it; nothing: it is estimated. `factor` as NoiseLevel's.
Survey survey_sample(const SampleView& sample, std::size_t grains, std::optional<double> amplitude, double factor,
                     Progress& progress);

}  // namespace atomesh
