// Atoms + UnitCell → Defects (seed, appendix A.3), with the sites of what is missing and what is too much.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/atoms.h"
#include "core/defects.h"
#include "core/progress.h"
#include "core/unit_cell.h"
#include "preprocess/crystal.h"

namespace atomesh {

struct DefectOptions {
  double neighbourhood = 1.0;  // × the longest of the (reduced) cell vectors = neighbourhood radius
  // Å within which an atom matches a site; 0: 0.3 × the nearest-neighbour distance, or noise_factor × the thermal
  // amplitude where that is more. Above 0.45 × the distance it is limited.
  double tolerance = 0.0;
  // Thermal amplitude: Å, rms displacement of an atom from its site along one axis; 0: none, nothing: estimated from
  // the sample (noise is what neighbours do not share; strain, which they do, is no noise).
  std::optional<double> noise = std::nullopt;
  // Displacements between neighbours up to so many amplitudes are thermal and count as zero. Two atoms move against
  // each other with √2 amplitudes per axis, so that 9 is 6.4 standard deviations: one pair in 10⁸ exceeds it, one atom
  // in some million. 0 counts every displacement that is not a file's rounding.
  double noise_factor = 9.0;
  // Rounds in which each atom's displacement is averaged with its neighbours' before positional values are made, 0 to
  // 10. Averaging n neighbours lets √n less noise through and strain as it is: what is displaced together emerges from
  // the noise, an atom displaced alone drowns in its neighbours'. The limit below which displacements count as zero is
  // lowered accordingly. Without noise nothing is averaged.
  int smoothing = 0;
};

struct DefectReport {
  double radius = 0.0;       // Å, used
  double tolerance = 0.0;    // Å, used
  double noise = 0.0;        // Å, thermal amplitude used: estimated or given
  double noise_limit = 0.0;  // Å: displacements up to it counted as zero
  std::size_t positional_atoms = 0, vacancy_atoms = 0, extra_atoms = 0;  // atoms with a value above zero
  std::size_t surface_atoms = 0;   // atoms whose neighbourhood the sample's surface cuts
  double matched_fraction = 0.0;   // matched neighbours / neighbours the perfect crystal has (inside the sample)
  std::vector<std::string> notes;  // e.g. that the cell does not fit the sample
};

// Compares every atom's neighbourhood with the perfect crystal's, that of the grain it belongs to (its cell's own
// orientation; origins do not matter), and fills the values of core/defects.h:
// - Neighbours within the radius count, shells exactly at it included. Matching looks beyond the radius, so nothing
//   near the ends of the vectors is counted by accident.
// - positional: displacements up to max(0.2 % of the nearest-neighbour distance, 0.005 Å) are the rounding of a file
//   (three decimals or more, cell included) and count as zero, and so do those that are thermal (DefectOptions).
// - vacancy: entries whose occupant was displaced by more than the tolerance, and entries that lead to a vacancy site.
//   Entries that lead anywhere else lie outside the sample and do not count. No mesh is needed to tell: a vacancy's
//   own first shells are mostly filled, a site outside the sample has at most what a half-space holds.
// - extra: neighbours that fit no entry; an atom that is on no site itself has the value 1.
// - substitutions: extra atoms on vacancy sites of another species; both stay listed as such.
// A cell that is off by the same little everywhere (thermal expansion, a rotation of up to some degrees) is fitted to
// the sample first, which a note says; strain that differs from place to place is left for the values to show.
// Atoms of no_grain are compared with the cells of the grains around them and belong to the one that fits best. Across
// a grain boundary the values count what the grain lacks and has too much; sites are listed only inside grains
// (find_vacancies, find_extras).
// Atoms of a species the cell lacks are extra. When the cell does not fit the sample (matched_fraction below 0.5) no
// sites are reported and a note says so.
// Same answer at any number of threads; at most 100 bytes an atom beside the input and the result. Throws Error for a
// singular or inconsistent unit cell and for grain numbers that are not one for each atom, UsageError for options out
// of range or a crystal that is not known().
Defects quantify_defects(const Atoms& atoms, const Crystal& crystal, const DefectOptions& options, DefectReport& report,
                         Progress& progress = no_progress());
// All atoms in one grain.
Defects quantify_defects(const Atoms& atoms, const UnitCell& cell, const DefectOptions& options, DefectReport& report,
                         Progress& progress = no_progress());

}  // namespace atomesh
