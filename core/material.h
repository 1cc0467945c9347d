// What preprocessing makes and rendering shows: the only door between the two rooms.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/atoms.h"
#include "core/defects.h"
#include "core/surface.h"
#include "core/tet_mesh.h"
#include "core/unit_cell.h"

namespace atomesh {

struct StageTime {
  std::string name;
  double ms = 0.0;
};

// How a material came to be; travels with it into .crb and .crt.
struct Provenance {
  std::string program;                                        // "atomesh 0.1.0"
  std::string input;                                          // the atoms file's name, without its folder
  std::vector<std::pair<std::string, std::string>> options;   // as given on the command line, defaults included
  std::vector<std::pair<std::string, std::uint64_t>> counts;  // "atoms_read", "duplicates", "carved", …
  std::vector<StageTime> stages;
};

// One number for each vertex of the mesh: what an imported mesh brings along.
struct VertexField {
  std::string name;           // not empty; names differ
  std::vector<float> values;  // finite
};

struct Material {
  Atoms atoms;
  std::optional<UnitCell> unit_cell;
  TetMesh mesh;
  Surface surface;
  Defects defects;
  std::vector<VertexField> fields;
  Provenance provenance;
};

}  // namespace atomesh
