// The whole way from a file of atoms to a Material, stage by stage.
#pragma once

#include <string>

#include "core/material.h"
#include "core/progress.h"
#include "preprocess/carve.h"
#include "preprocess/quantify_defects.h"
#include "preprocess/read_atoms.h"
#include "preprocess/reduce_atoms.h"
#include "preprocess/tetrahedralize.h"

namespace atomesh {

struct PipelineOptions {
  ReadOptions read;
  ReduceOptions reduce;
  TetrahedralizeOptions tetrahedralize;
  bool carve = true;
  CarveOptions carve_options;
  std::string unit_cell =
      "auto";  // "auto" (the file's, else none), "none", or the path of a .dat with primitive and basis
  DefectOptions defects;
  std::string scalar;  // a column of the file to use as positional defect value instead of quantifying; "" none
};

struct PipelineReport {
  ReadReport read;
  ReduceReport reduce;
  TetrahedralizeReport tetrahedralize;
  CarveReport carve;
  DefectReport defects;
  std::string unit_cell_source = "none";  // "file", "found", "none"
  double volume = 0.0;                    // Å³, after carving
  double min_dihedral_deg = 0.0;
};

// Names, times (into Material::provenance.stages) and can cancel each stage.
Material preprocess(const std::string& path, const PipelineOptions& options, PipelineReport& report,
                    Progress& progress = no_progress());

}  // namespace atomesh
