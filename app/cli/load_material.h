// FILE → Material for every subcommand: a .crb or .crt is read, an atoms file is preprocessed on the way.
#pragma once

#include <optional>
#include <string>

#include "app/cli/session.h"
#include "core/material.h"
#include "core/material_file.h"
#include "preprocess/pipeline.h"

namespace CLI {
class App;
}

namespace atomesh::cli {

struct LoadedMaterial {
  Material material;
  std::optional<PipelineReport> report;  // when it was preprocessed on the way
  double ms = 0.0;
};

// Only the parts the caller wants are read or made. Options of preprocessing given together with a .crb or .crt are an
// error (UsageError). Notes of preprocessing are shown.
LoadedMaterial load_material(const std::string& path, const MaterialParts& wanted, const CLI::App& app,
                             PipelineOptions options, Session& session);

// Every note of reading, meshing and defects, once.
void show_notes(const PipelineReport& report, Session& session);

}  // namespace atomesh::cli
