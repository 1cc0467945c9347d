// How much the atoms of a sample shake, told apart from how much it is strained.
#pragma once

#include <cstddef>
#include <span>

#include "core/atoms.h"
#include "core/progress.h"
#include "preprocess/neighbour_grid.h"

namespace atomesh {

// Displacements of atoms are a smooth field (strain, which neighbours share) and noise (thermal motion, which they do
// not). Along a row of sites a lattice vector apart the differences of high order of a smooth field vanish; those of
// noise of rms u per axis have the rms √(2n choose n)·u per axis at order n: √70·u for n = 4, √924·u for n = 6.
// Rows are looked at through some thousand atoms spread evenly over the sample, along each of `steps` (lattice vectors,
// Å), and along 31 directions of space; the quartile over the rows is taken, so that up to three quarters of them may
// run through defects, cracks and strained parts, and the largest over the directions, the softest of the crystal.
// Rows are of seven atoms (n = 6), or of five (n = 4) where fewer than least_rows of seven are found; atoms next in a
// row are of one species and within `tolerance` Å of the step. Returns Å, rms per axis; 0 where fewer than least_rows
// of five are found either, because then nothing can be said.
double measure_row_noise(const Atoms& atoms, const NeighbourGrid& grid, std::span<const Vec3> steps, double tolerance,
                         Progress& progress);
inline constexpr std::size_t least_rows = 60;

// The rms along the direction in which it is largest, by the quartile of the magnitudes, of vectors whose components
// are normal: robust where up to three quarters of them are too large. 0 without vectors.
double softest_amplitude(std::span<const Vec3> vectors);

}  // namespace atomesh
