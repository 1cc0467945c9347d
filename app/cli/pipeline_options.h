// The options of preprocessing, the same for every subcommand that takes an atoms file.
#pragma once

#include <string>

#include "preprocess/pipeline.h"

namespace CLI {
class App;
}

namespace atomesh::cli {

// Adds them all; `options` is filled while the command line is read. `tolerance_names` are the names of the matching
// tolerance: `render` has another --tolerance.
void add_pipeline_options(CLI::App& app, PipelineOptions& options,
                          const char* tolerance_names = "--tolerance,--site-tolerance");

// Throws UsageError when one of them was given for `path`, a material file: nothing would read it.
void reject_pipeline_options(const CLI::App& app, const std::string& path);

}  // namespace atomesh::cli
