// The ten generators behind make_sample(); each grows one sample with about `atoms` atoms. samples.cpp has checked that
// `atoms` is not below the sample's smallest and starts the stage "grow".
#pragma once

#include "samples/samples.h"

namespace atomesh {

Sample grow_nacl_cracked(std::size_t atoms, std::uint64_t seed, Progress& progress);
Sample grow_cu_line_defect(std::size_t atoms, std::uint64_t seed, Progress& progress);
Sample grow_diamond_vacancy(std::size_t atoms, std::uint64_t seed, Progress& progress);
Sample grow_diamond_a_centers(std::size_t atoms, std::uint64_t seed, Progress& progress);
Sample grow_graphite_slided(std::size_t atoms, std::uint64_t seed, Progress& progress);
Sample grow_palladium_hydrogen(std::size_t atoms, std::uint64_t seed, Progress& progress);
Sample grow_cacuo2_spiral(std::size_t atoms, std::uint64_t seed, Progress& progress);
Sample grow_sponge(std::size_t atoms, std::uint64_t seed, Progress& progress);
Sample grow_quantum_dot(std::size_t atoms, std::uint64_t seed, Progress& progress);
Sample grow_quantum_dot_alloyed(std::size_t atoms, std::uint64_t seed, Progress& progress);

// Displacements below this are not listed in SampleTruth::displaced, Å.
inline constexpr double displaced_threshold = 0.01;

}  // namespace atomesh
