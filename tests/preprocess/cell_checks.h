// What tests of found unit cells share.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/unit_cell.h"
#include "preprocess/find_unit_cell.h"

namespace atomesh::test {

// Largest deviation of m from whole numbers.
inline double from_whole(const Mat3& m) {
  double worst = 0.0;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) worst = std::max(worst, std::abs(m[c][r] - std::round(m[c][r])));
  }
  return worst;
}

// Empty when `found` is a primitive cell of the crystal that `truth` describes, in its orientation: truth's vectors are
// whole combinations of found's (to `strain`) as many times larger as it has more atoms, and with one shift every atom
// of truth sits on a site of its species within `tolerance` Å. Else what differs.
inline std::string difference_of_cells(const UnitCell& found, const UnitCell& truth, double strain, double tolerance) {
  const Mat3 combination = glm::inverse(found.matrix()) * truth.matrix();
  if (from_whole(combination) > strain * 10.0) return "vectors are no whole combinations";
  const double ratio = truth.volume() / found.volume();
  const double atoms = static_cast<double>(truth.basis.size()) / static_cast<double>(found.basis.size());
  if (std::abs(ratio / atoms - 1.0) > 3.0 * strain) {
    return "volume per atom differs by a factor " + std::to_string(ratio / atoms);
  }
  std::string why = "no shift puts the atoms on the sites";
  for (const BasisAtom& from : found.basis) {
    const Vec3 shift = from.position - truth.basis[0].position;
    bool all = true;
    for (const BasisAtom& atom : truth.basis) {
      bool met = false;
      for (const BasisAtom& site : found.basis) {
        Vec3 f = glm::inverse(found.matrix()) * (atom.position + shift - site.position);
        f -= glm::round(f);
        met = met || (site.species == atom.species && glm::length(found.matrix() * f) < tolerance);
      }
      all = all && met;
    }
    if (all) return "";
  }
  return why;
}

// Length of `a` beside `b`, relative.
inline double relative(double a, double b) {
  return std::abs(a / b - 1.0);
}

}  // namespace atomesh::test
