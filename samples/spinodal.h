// Spinodal decomposition of a binary mixture in a periodic cube: a Cahn-Hilliard phase field.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry.h"
#include "core/progress.h"

namespace atomesh {

struct SpinodalOptions {
  double side = 0.0;             // Å, of the periodic cube
  double minority = 0.4;         // volume share of the phase that ends near +1
  double interface_width = 4.0;  // Å, ε below; the pattern's first wavelength is about 12 ε
  // Units of ε²/mobility. By 90 the waves have become two phases with interfaces, then they coarsen. A minority of 0.4
  // stays one connected piece; at 0.3 it breaks up into droplets.
  double duration = 150.0;
  double noise = 0.1;      // amplitude of the initial composition, averaged over ε³
  std::uint64_t seed = 1;  // of that noise
};

// Composition on a grid of n³ points, x fastest, point (i, j, k) at side/n · (i, j, k); periodic.
struct PhaseField {
  std::size_t n = 0;
  double side = 0.0;           // Å
  std::vector<double> values;  // about -1 in one phase, about +1 in the other

  // Trilinear interpolation; p may lie outside the cube.
  double at(const Vec3& p) const;
};

// ∂c/∂t = ∇²(c³ - c - ε²∇²c) from a uniform mixture with a little noise (Cahn and Hilliard, J. Chem. Phys. 28, 258
// (1958)), linearly stabilised semi-implicit steps in Fourier space (Eyre 1998; Shen and Yang, DCDS-A 28, 1669 (2010)).
// Over one step of time τ = 1 a small wave grows by (1 + τ k²(2 - f'')) / (1 + τ k²(2 + k²)), f'' = 3·mean² - 1, k in
// 1/ε. The mean composition, 2·minority - 1, is kept to rounding. Same answer at any number of threads.
PhaseField decompose(const SpinodalOptions& options, Progress& progress = no_progress());

}  // namespace atomesh
