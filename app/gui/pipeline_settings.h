// The options of preprocessing as a table for a form: the command line's own, with its names, help, defaults and
// checks.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "preprocess/pipeline.h"

namespace atomesh::gui {

struct PipelineSetting {
  std::string name;                  // of the option, without dashes: "unit-cell"
  std::string label;                 // "Unit cell"
  std::string group;                 // "Reading atoms", "Preprocessing", "Fewer atoms"
  std::string type;                  // "auto|off|RADIUS", as --help has it
  std::string help;                  // one or a few sentences
  std::vector<std::string> choices;  // to offer
  bool open = true;                  // other text than the choices may stand there
  bool file = false;                 // and it may be the path of a file
  std::string initial;               // the text that stands for the default; "" for nothing
};

const std::vector<PipelineSetting>& pipeline_settings();

// By name, those that are not the default. Throws UsageError that names the option and says what is expected.
using PipelineValues = std::map<std::string, std::string>;
PipelineOptions pipeline_options(const PipelineValues& values);
// The same of what a material's provenance has recorded (provenance_options()).
PipelineValues recorded_values(const std::vector<std::pair<std::string, std::string>>& options);

}  // namespace atomesh::gui
