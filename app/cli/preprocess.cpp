// atomesh preprocess IN -o OUT: every stage from an atoms file to a .crb or .crt.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>

#include "app/cli/commands.h"
#include "app/cli/load_material.h"
#include "app/cli/machine.h"
#include "app/cli/output_file.h"
#include "app/cli/pipeline_options.h"
#include "app/cli/session.h"
#include "app/cli/species_count.h"
#include "app/cli/text_table.h"
#include "core/error.h"

namespace atomesh::cli {
namespace {

struct PreprocessArguments {
  std::string input;
  std::string output;
  bool compress = true;
  PipelineOptions options;
};

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

Json report_json(const PreprocessArguments& arguments, const Material& material, const PipelineReport& report,
                 const std::vector<StageTime>& stages, double total_ms) {
  const auto& periodic = material.atoms.box.periodic;
  Json stage_list = Json::array();
  for (const StageTime& stage : stages) stage_list.push(Json::object({{"name", stage.name}, {"ms", stage.ms}}));
  Json notes = Json::array();
  for (const auto* list : {&report.read.notes, &report.defects.notes, &report.notes}) {
    for (const std::string& note : *list) notes.push(note);
  }
  const std::size_t tetrahedra = material.mesh.tetrahedra.size();

  return Json::object(
      {{"input", Json::object({{"file", arguments.input},
                               {"format", report.read.format},
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
                                 {"radius", report.defects.radius},
                                 {"tolerance", report.defects.tolerance},
                                 {"surface_atoms", report.defects.surface_atoms},
                                 {"matched_fraction", report.defects.matched_fraction}})},
       // The mesh is not simplified: the same before and after.
       {"simplify",
        Json::object({{"tetrahedra_before", tetrahedra}, {"tetrahedra_after", tetrahedra}, {"volume_change", 0.0}})},
       {"stages", stage_list},
       {"total_ms", total_ms},
       {"peak_memory_mb", peak_memory_mb()},
       {"notes", notes},
       {"output",
        Json::object({{"file", arguments.output}, {"bytes", std::filesystem::file_size(arguments.output)}})}});
}

int run_preprocess(const PreprocessArguments& arguments, Session& session) {
  check_output(arguments.output, {".crb", ".crt"});
  if (is_material_file(arguments.input)) {
    throw UsageError(arguments.input + " is preprocessed already; atomesh convert changes its format");
  }
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed_since = [](auto since) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - since).count();
  };
  PipelineReport report;
  const Material material = preprocess(arguments.input, arguments.options, report, session.progress());
  const auto write_start = std::chrono::steady_clock::now();
  session.progress().stage("write_material");
  write_material(arguments.output, material, {.compress = arguments.compress}, session.progress());
  std::vector<StageTime> stages = material.provenance.stages;
  stages.push_back({"write_material", elapsed_since(write_start)});
  const double total_ms = elapsed_since(start);

  show_notes(report, session);
  const auto bytes = std::filesystem::file_size(arguments.output);
  TextTable table({"stage", "ms", "result"});
  for (const StageTime& stage : stages) {
    const bool last = stage.name == "write_material";
    table.row(
        {stage.name, milliseconds(stage.ms),
         last ? fmt::format("{}, {}", arguments.output, byte_size(bytes)) : outcome(stage.name, material, report)});
  }
  table.row({"total", milliseconds(total_ms), fmt::format("peak memory {:.0f} MB", peak_memory_mb())});
  session.print_text(table.text());
  if (session.json_wanted()) session.write_json(report_json(arguments, material, report, stages, total_ms));
  return exit_done;
}

}  // namespace

Command add_preprocess(CLI::App& app) {
  auto arguments = std::make_shared<PreprocessArguments>();
  app.add_option("IN", arguments->input, "The atoms file: .dat, .xyz, LAMMPS data or dump")->required();
  app.add_option("-o,--output", arguments->output, "The file to write, .crb (binary) or .crt (text)")
      ->type_name("OUT")
      ->required();
  app.add_flag("!--no-compress", arguments->compress, "Write a .crb without compression: larger, faster to read");
  add_pipeline_options(app, arguments->options);
  app.footer(
      "Example:\n"
      "  atomesh preprocess nacl.dat -o nacl.crb\n"
      "  atomesh preprocess dot.xyz -o dot.crb --mask As --keep-every 20 --scalar Ga=0,In=1\n");
  return [arguments](Session& session) { return run_preprocess(*arguments, session); };
}

}  // namespace atomesh::cli
