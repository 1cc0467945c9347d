#include "app/cli/load_material.h"

#include <CLI/CLI.hpp>
#include <chrono>

#include "app/cli/pipeline_options.h"
#include "core/error.h"

namespace atomesh::cli {

LoadedMaterial load_material(const std::string& path, const MaterialParts& wanted, const CLI::App& app,
                             PipelineOptions options, Session& session, const MeshFileOptions& mesh_options) {
  const auto start = std::chrono::steady_clock::now();
  LoadedMaterial loaded;
  const bool is_material = is_material_file(path);
  const bool is_mesh = !is_material && is_mesh_file(path);
  if (!mesh_options.solution.empty() && !is_mesh) {
    throw UsageError("--solution has no effect on " + path + ", which is no PLOT3D grid");
  }
  if (is_mesh) {
    reject_pipeline_options(app, path);
    loaded.mesh.emplace();
    loaded.material = read_mesh_file(path, mesh_options, *loaded.mesh, session.progress());
    loaded.material.provenance.program = program_version();
    for (const std::string& note : loaded.mesh->notes) session.note(note);
  } else if (is_material) {
    reject_pipeline_options(app, path);
    session.progress().stage("read_material");
    loaded.material = read_material(path, wanted, session.progress());
  } else {
    options.wanted = wanted;
    loaded.report.emplace();
    loaded.material = preprocess(path, options, *loaded.report, session.progress());
    show_notes(*loaded.report, session);
  }
  loaded.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return loaded;
}

void add_mesh_options(CLI::App& app, MeshFileOptions& options) {
  app.add_option(
         "--solution", options.solution,
         "Of a PLOT3D grid: the file with its values [the one beside it: combq.bin of combxyz.bin, X.q of X.xyz]")
      ->type_name("FILE");
}

void show_notes(const PipelineReport& report, Session& session) {
  for (const std::string& note : report.read.notes) session.note(note);
  for (const std::string& note : report.find_cell.notes) session.note(note);
  for (const std::string& note : report.defects.notes) session.note(note);
  for (const std::string& note : report.notes) session.note(note);
}

}  // namespace atomesh::cli
