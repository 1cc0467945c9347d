// Defective atoms and sites gathered into clusters a person can check one by one.
#pragma once

#include <string_view>
#include <vector>

#include "core/material.h"
#include "core/progress.h"

namespace atomesh {

enum class DefectKind { vacancy, extra, positional, mixed, substitution };

struct DefectCluster {
  DefectKind kind;
  Vec3 centre;                   // Å
  double radius;                 // Å, of the sphere about the centre that holds every member
  std::vector<Index> atoms;      // defective atoms, ascending
  std::vector<Index> vacancies;  // into Defects::vacancies
  std::vector<Index> extras;     // into Defects::extras
  // Into Defects::substitutions; their sites and atoms are among the vacancies and extras above.
  std::vector<Index> substitutions;
  float peak;  // largest single defect value of its atoms
};

std::string_view defect_kind_name(DefectKind kind);  // "vacancy", "extra", "positional", "mixed", "substitution"
// Throws UsageError naming the nearest.
DefectKind defect_kind_from_name(std::string_view name);

// Atoms whose values are not zero, extra atoms and vacancies are joined when closer than `distance` (Å; 0: 1.3 × the
// median nearest-neighbour distance), through periodic boundaries; sorted by number of atoms, largest first. A cluster
// is named by the sites in it (substitution: each vacancy is filled by one of its extra atoms and none is left over;
// mixed: both vacancies and extra atoms otherwise), one without sites by its largest values. The
// centre is that of the members' bounding box. Throws UsageError for a distance that is negative or no number.
std::vector<DefectCluster> cluster_defects(const Material& material, double distance = 0.0,
                                           Progress& progress = no_progress());

}  // namespace atomesh
