// FILE → Material for every subcommand: a .crb or .crt is read, a mesh file split into tetrahedra, an atoms file
// preprocessed on the way.
#pragma once

#include <optional>
#include <string>

#include "app/cli/read_mesh.h"
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
  std::optional<MeshFileReport> mesh;    // when it was a mesh file
  double ms = 0.0;
};

// Only the parts the caller wants are read or made; of a mesh file, all. Options of preprocessing given together with a
// .crb, .crt or mesh file, and those of a mesh file together with any other, are an error (UsageError). Notes of
// preprocessing and of reading a mesh are shown.
LoadedMaterial load_material(const std::string& path, const MaterialParts& wanted, const CLI::App& app,
                             PipelineOptions options, Session& session, const MeshFileOptions& mesh_options = {});

// --solution, of the subcommands that read mesh files.
void add_mesh_options(CLI::App& app, MeshFileOptions& options);

// Every note of reading, meshing and defects, once.
void show_notes(const PipelineReport& report, Session& session);

}  // namespace atomesh::cli
