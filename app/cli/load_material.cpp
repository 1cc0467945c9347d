#include "app/cli/load_material.h"

#include <chrono>

#include "app/cli/pipeline_options.h"

namespace atomesh::cli {

LoadedMaterial load_material(const std::string& path, const MaterialParts& wanted, const CLI::App& app,
                             PipelineOptions options, Session& session) {
  const auto start = std::chrono::steady_clock::now();
  LoadedMaterial loaded;
  if (is_material_file(path)) {
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

void show_notes(const PipelineReport& report, Session& session) {
  for (const std::string& note : report.read.notes) session.note(note);
  for (const std::string& note : report.find_cell.notes) session.note(note);
  for (const std::string& note : report.defects.notes) session.note(note);
  for (const std::string& note : report.notes) session.note(note);
}

}  // namespace atomesh::cli
