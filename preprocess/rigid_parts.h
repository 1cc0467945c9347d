// Pieces of a crystal inside which atoms are on their sites to rounding.
#pragma once

#include <span>
#include <vector>

#include "core/progress.h"
#include "preprocess/lattice_sites.h"

namespace atomesh {

// Of one patch: the lattice that most of its atoms repeat exactly, and the places where pieces of it lie. An atom on
// site (c, b) of piece n is at origins[n] + matrix · c + offsets[b].
struct RigidLattice {
  std::uint16_t patch = 0;
  Mat3 matrix{1.0};
  std::vector<Vec3> offsets;  // Å, of each basis atom
  std::vector<Vec3> origins;  // most atoms first
};

struct RigidParts {
  std::vector<RigidLattice> lattices;
  std::size_t parts = 0;  // origins of all
  double in_place = 0.0;  // share of all points that are within rigid_tolerance of a piece's site
  // Share of all points that are corners of nothing but polytopes all of whose corners are in place, in one piece.
  double undisturbed = 0.0;
};

// As a share of the nearest-neighbour distance.
inline constexpr double rigid_tolerance = 1e-7;

// Matrix and offsets are the values that differences of neighbouring atoms' positions crowd about, so that atoms out of
// place have no say as long as a third are in place. Asks at most some 10,000 points, evenly chosen, of each patch.
RigidParts find_rigid_parts(std::span<const Vec3> points, const LatticeSites& sites,
                            Progress& progress = no_progress());

// Makes each piece a patch of its own, with its exact frame, and its lattice a pattern with the atoms where they really
// are; atoms go to the piece they are nearest to. Patches without a rigid lattice keep theirs.
void split_into_rigid_parts(std::span<const Vec3> points, const RigidParts& parts, LatticeSites& sites);

}  // namespace atomesh
