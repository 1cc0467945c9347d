#include "app/cli/preprocess_file.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <new>

#include "app/cli/load_material.h"
#include "app/cli/machine.h"
#include "app/cli/species_count.h"
#include "app/cli/text_table.h"
#include "core/error.h"
#include "core/material_file.h"
#include "core/memory.h"
#include "preprocess/memory_needs.h"

namespace atomesh::cli {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double megabytes(std::uint64_t bytes) {
  return static_cast<double>(bytes) * 1e-6;
}

// What the stage made, in a few words.
std::string outcome(const std::string& stage, const Material& material, const PipelineReport& report) {
  if (stage == "read_atoms") {
    std::string text = fmt::format("{} atoms, {}", grouped(report.read.atoms), report.read.format);
    if (report.read.frames > 1) text += fmt::format(", frame {} of {}", report.read.frame, report.read.frames);
    return fmt::format("{}; {} skipped, {} duplicates", text, grouped(report.read.skipped),
                       grouped(report.read.duplicates));
  }
  if (stage == "find_unit_cell") {
    if (!material.unit_cell) return "none";
    return fmt::format("from the {}, {} basis atoms", report.unit_cell_source, material.unit_cell->basis.size());
  }
  if (stage == "reduce_atoms") {
    return fmt::format("{} atoms left; {} masked, {} thinned out", grouped(material.atoms.size()),
                       grouped(report.reduce.masked), grouped(report.reduce.dropped));
  }
  if (stage == "tetrahedralize") {
    return fmt::format("{} tetrahedra, {}", grouped(material.mesh.tetrahedra.size() + report.carve.removed),
                       report.tetrahedralize.mesher);
  }
  if (stage == "carve") {
    return fmt::format("{} removed, radius {:.4g} Å", grouped(report.carve.removed), report.carve.radius);
  }
  if (stage == "extract_surface") {
    return fmt::format("{} triangles, {}", grouped(material.surface.triangles.size()),
                       report.surface_closed ? "closed" : "NOT closed");
  }
  if (stage == "measure") {
    return fmt::format("volume {:.6g} Å³, area {:.6g} Å²", report.volume, report.surface_area);
  }
  if (stage == "quantify_defects") {
    const DefectReport& defects = report.defects;
    return fmt::format(
        "neighbours: displaced of {} atoms, missing of {}, too many of {}; sites: {} vacancies, {} extra atoms",
        grouped(defects.positional_atoms), grouped(defects.vacancy_atoms), grouped(defects.extra_atoms),
        grouped(material.defects.vacancies.size()), grouped(material.defects.extras.size()));
  }
  if (stage == "assign_scalar") {
    const auto& values = material.defects.positional;
    return fmt::format("shown from 0 to {:.6g}",
                       values.empty() ? 0.0F : *std::max_element(values.begin(), values.end()));
  }
  return "";
}

Json unit_cell_json(const Material& material, const PipelineReport& report) {
  Json primitive = Json::array();
  if (material.unit_cell) {
    for (const Vec3& v : material.unit_cell->primitive) primitive.push(v);
  }
  return Json::object({{"source", report.unit_cell_source},
                       {"primitive", material.unit_cell ? primitive : Json()},
                       {"basis", material.unit_cell ? material.unit_cell->basis.size() : 0}});
}

}  // namespace

std::vector<std::pair<std::string, std::string>> recorded_options(const PreprocessSettings& settings,
                                                                  const std::string& format) {
  auto options = provenance_options(settings.options, format);
  options.emplace_back("compress", settings.compress ? "yes" : "no");
  return options;
}

PreprocessedFile preprocess_file(const PreprocessJob& job, const PreprocessSettings& settings, Session& session) {
  if (is_material_file(job.input)) {
    throw UsageError(job.input + " is preprocessed already; atomesh convert changes its format");
  }
  const auto start = Clock::now();
  PreprocessedFile file;
  file.job = job;
  file.material = preprocess(job.input, settings.options, file.report, session.progress());
  Provenance& provenance = file.material.provenance;
  provenance.options = recorded_options(settings, file.report.read.format);
  provenance.options.emplace_back("input_hash", file.report.read.hash);
  file.stages = provenance.stages;
  file.stage_memory = file.report.stage_memory;

  const auto write_start = Clock::now();
  session.progress().stage("write_material");
  reset_peak_memory();
  try {
    write_material(job.output, file.material, {.compress = settings.compress}, session.progress());
  } catch (const std::bad_alloc&) {
    throw UnavailableError("write_material: the memory ran out; " + memory_advice());
  }
  file.stages.push_back({"write_material", milliseconds_since(write_start)});
  file.stage_memory.push_back(recent_peak_memory());
  file.output_bytes = std::filesystem::file_size(job.output);
  file.total_ms = milliseconds_since(start);
  return file;
}

std::string stage_table(const PreprocessedFile& file) {
  TextTable table({"stage", "ms", "peak MB", "result"});
  for (std::size_t i = 0; i < file.stages.size(); ++i) {
    const StageTime& stage = file.stages[i];
    const bool last = stage.name == "write_material";
    table.row({stage.name, milliseconds(stage.ms), fmt::format("{:.0f}", megabytes(file.stage_memory[i])),
               last ? fmt::format("{}, {}", file.job.output, byte_size(file.output_bytes))
                    : outcome(stage.name, file.material, file.report)});
  }
  table.row({"total", milliseconds(file.total_ms), fmt::format("{:.0f}", peak_memory_mb()), ""});
  return table.text();
}

Json preprocess_json(const PreprocessedFile& file) {
  const Material& material = file.material;
  const PipelineReport& report = file.report;
  const auto& periodic = material.atoms.box.periodic;
  Json stage_list = Json::array();
  for (std::size_t i = 0; i < file.stages.size(); ++i) {
    stage_list.push(Json::object({{"name", file.stages[i].name},
                                  {"ms", file.stages[i].ms},
                                  {"peak_memory_mb", megabytes(file.stage_memory[i])}}));
  }
  Json notes = Json::array();
  for (const auto* list : {&report.read.notes, &report.defects.notes, &report.notes}) {
    for (const std::string& note : *list) notes.push(note);
  }
  const std::size_t tetrahedra = material.mesh.tetrahedra.size();

  return Json::object(
      {{"input", Json::object({{"file", file.job.input},
                               {"format", report.read.format},
                               {"hash", report.read.hash},
                               {"atoms", report.read.atoms},
                               {"skipped", report.read.skipped},
                               {"duplicates", report.read.duplicates},
                               {"frames", report.read.frames},
                               {"frame", report.read.frame},
                               {"species", species_json(material.atoms)},
                               {"periodic", Json::array({periodic[0], periodic[1], periodic[2]})}})},
       {"reduce", Json::object({{"atoms", material.atoms.size()},
                                {"masked", report.reduce.masked},
                                {"kept_boundary", report.reduce.kept_boundary},
                                {"kept_transition", report.reduce.kept_transition},
                                {"kept_sample", report.reduce.kept_sample},
                                {"dropped", report.reduce.dropped}})},
       {"unit_cell", unit_cell_json(material, report)},
       {"mesh", Json::object({{"mesher", report.tetrahedralize.mesher},
                              {"why", report.tetrahedralize.why},
                              {"vertices", material.mesh.vertices.size()},
                              {"tetrahedra", tetrahedra},
                              {"merged_vertices", report.tetrahedralize.merged_vertices},
                              {"carved", report.carve.removed},
                              {"carve_radius", report.carve.radius},
                              {"volume", report.volume},
                              {"min_dihedral_deg", report.min_dihedral_deg}})},
       {"surface", Json::object({{"triangles", material.surface.triangles.size()},
                                 {"area", report.surface_area},
                                 {"closed", report.surface_closed}})},
       {"defects", Json::object({{"positional_atoms", report.defects.positional_atoms},
                                 {"vacancy_atoms", report.defects.vacancy_atoms},
                                 {"extra_atoms", report.defects.extra_atoms},
                                 {"vacancies", material.defects.vacancies.size()},
                                 {"extras", material.defects.extras.size()},
                                 {"substitutions", material.defects.substitutions.size()},
                                 {"radius", report.defects.radius},
                                 {"tolerance", report.defects.tolerance},
                                 {"surface_atoms", report.defects.surface_atoms},
                                 {"matched_fraction", report.defects.matched_fraction}})},
       // The mesh is not simplified: the same before and after.
       {"simplify",
        Json::object({{"tetrahedra_before", tetrahedra}, {"tetrahedra_after", tetrahedra}, {"volume_change", 0.0}})},
       {"stages", stage_list},
       {"total_ms", file.total_ms},
       {"peak_memory_mb", peak_memory_mb()},
       {"notes", notes},
       {"output", Json::object({{"file", file.job.output}, {"bytes", file.output_bytes}})}});
}

}  // namespace atomesh::cli
