// The whole way from a file of atoms to a Material, stage by stage.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/material.h"
#include "core/material_file.h"
#include "core/progress.h"
#include "preprocess/carve.h"
#include "preprocess/find_unit_cell.h"
#include "preprocess/quantify_defects.h"
#include "preprocess/read_atoms.h"
#include "preprocess/reduce_atoms.h"
#include "preprocess/simplify.h"
#include "preprocess/tetrahedralize.h"

namespace atomesh {

struct PipelineReport;

struct PipelineOptions {
  ReadOptions read;
  ReduceOptions reduce;
  TetrahedralizeOptions tetrahedralize;
  bool carve = true;
  CarveOptions carve_options;
  // "auto" (the file's own, else found), "found" (from the atoms, whatever the file says), "none", or the path of a
  // .dat with primitive and basis.
  std::string unit_cell = "auto";
  FindCellOptions find_cell;
  DefectOptions defects;
  // What takes the place of the positional defect value instead of quantifying defects: the name of a column of the
  // file, or values by species, "Ga=0,In=1" (species not named have 0). The smallest value is shifted to zero. "" none.
  std::string scalar;
  bool simplify = false;
  SimplifyOptions simplify_options;
  // Called with the whole mesh, its surface and defects before they are simplified, by who wants to compare.
  std::function<void(const Material&)> before_simplify;
  // Called between stages (and after the last), on the thread that does the work: what of the material and the report
  // is made so far, by who wants to show it.
  std::function<void(const StageTime& finished, const Material&, const PipelineReport&)> after_stage;
  // What the caller will use. Stages that only make something else are left out: atoms alone need no mesh, a surface
  // needs no defects.
  MaterialParts wanted;
};

struct PipelineReport {
  ReadReport read;
  ReduceReport reduce;
  TetrahedralizeReport tetrahedralize;
  CarveReport carve;
  DefectReport defects;
  FindCellReport find_cell;               // when it was looked for
  SimplifyReport simplify;                // when it was simplified
  std::string unit_cell_source = "none";  // "file", "found", "none"
  double volume = 0.0;                    // Å³, after carving
  double min_dihedral_deg = 0.0;          // of the mesh in the end
  double surface_area = 0.0;              // Å²
  bool surface_closed = false;
  // Of each of Material::provenance.stages: the most memory that the process held while it ran, bytes.
  std::vector<std::uint64_t> stage_memory;
  std::vector<std::string> notes;  // what a person should know, one sentence each; the readers' own are in `read`
};

// Names, times (into Material::provenance.stages) and can cancel each stage. Apart from those times the result depends
// only on the file and the options. Throws what the stages throw, UsageError for a scalar that the file does not have,
// and UnavailableError before a stage that would take more memory than there is (memory_needs.h), or when one ran out.
Material preprocess(const std::string& path, const PipelineOptions& options, PipelineReport& report,
                    Progress& progress = no_progress());

// The options that decide the result, by name, as they are written into Provenance::options. `format` is the one that
// was read, or empty where that is not known yet; a unit cell from a file counts by that file's content.
std::vector<std::pair<std::string, std::string>> provenance_options(const PipelineOptions& options,
                                                                    const std::string& format);
// Provenance::program of what this build makes.
std::string program_version();

}  // namespace atomesh
