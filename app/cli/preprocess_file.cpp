#include "app/cli/preprocess_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <new>

#include "app/cli/machine.h"
#include "app/cli/read_mesh.h"
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

Json grains_json(const std::vector<Grain>& grains) {
  Json list = Json::array();
  for (const Grain& grain : grains) {
    list.push(Json::object({{"atoms", grain.atoms},
                            {"center", grain.center},
                            {"rotation", Json::array({grain.rotation[0], grain.rotation[1], grain.rotation[2]})}}));
  }
  return list;
}

Json simplify_json(const PreprocessedFile& file) {
  const SimplifyReport& s = file.report.simplify;
  const std::size_t tetrahedra = file.material.mesh.tetrahedra.size();
  if (s.strategy.empty()) {
    return Json::object({{"tetrahedra_before", tetrahedra}, {"tetrahedra_after", tetrahedra}, {"volume_change", 0.0}});
  }
  return Json::object({{"strategy", s.strategy},
                       {"tetrahedra_before", s.tetrahedra_before},
                       {"tetrahedra_after", s.tetrahedra_after},
                       {"least_tetrahedra", s.least_tetrahedra},
                       {"vertices_before", s.vertices_before},
                       {"vertices_after", s.vertices_after},
                       {"frozen_surface", s.frozen_surface},
                       {"frozen_defect", s.frozen_defect},
                       {"free_vertices", s.free_vertices},
                       {"removed_vertices", s.removed_vertices},
                       {"volume_change", s.volume_change},
                       {"surface_identical", s.surface_identical},
                       {"defect_tetrahedra_identical", s.defect_tetrahedra_identical},
                       {"scalar_error", s.scalar_error},
                       {"picture_difference", file.picture_difference.max},
                       {"picture_difference_where", file.picture_difference.where}});
}

Json unit_cell_json(const Material& material, const PipelineReport& report) {
  Json primitive = Json::array();
  if (material.unit_cell) {
    for (const Vec3& v : material.unit_cell->primitive) primitive.push(v);
  }
  return Json::object({{"source", report.unit_cell_source},
                       {"primitive", material.unit_cell ? primitive : Json()},
                       {"basis", material.unit_cell ? material.unit_cell->basis.size() : 0},
                       {"explained", report.find_cell.found ? Json(report.find_cell.explained) : Json()},
                       {"displacement", report.find_cell.found ? Json(report.find_cell.displacement) : Json()},
                       {"grains", grains_json(report.find_cell.grains)},
                       {"why", report.find_cell.why}});
}

}  // namespace

std::string stage_outcome(const std::string& stage, const Material& material, const PipelineReport& report) {
  if (stage == "read_atoms") {
    std::string text = fmt::format("{} atoms, {}", grouped(report.read.atoms), report.read.format);
    if (report.read.frames > 1) text += fmt::format(", frame {} of {}", report.read.frame, report.read.frames);
    return fmt::format("{}; {} skipped, {} duplicates", text, grouped(report.read.skipped),
                       grouped(report.read.duplicates));
  }
  if (stage == "find_unit_cell") {
    if (!material.unit_cell) return "none";
    const std::size_t basis = material.unit_cell->basis.size();
    if (report.unit_cell_source != "found") return fmt::format("from the file, {} basis atoms", basis);
    const std::size_t grains = report.find_cell.grains.size();
    return fmt::format("found, {} basis atoms{}; explains {:.4g} % of the atoms, {:.3g} Å rms off their sites", basis,
                       grains > 1 ? fmt::format(", {} grains", grains) : "", 100.0 * report.find_cell.explained,
                       report.find_cell.displacement);
  }
  if (stage == "reduce_atoms") {
    return fmt::format("{} atoms left; {} masked, {} thinned out", grouped(material.atoms.size()),
                       grouped(report.reduce.masked), grouped(report.reduce.dropped));
  }
  if (stage == "tetrahedralize") {
    const std::size_t now =
        report.simplify.strategy.empty() ? material.mesh.tetrahedra.size() : report.simplify.tetrahedra_before;
    const std::size_t stamped = report.tetrahedralize.pattern.stamped;
    return fmt::format("{} tetrahedra, {}{}", grouped(now + report.carve.removed), report.tetrahedralize.mesher,
                       report.tetrahedralize.mesher == "pattern" ? fmt::format(", {} stamped", grouped(stamped)) : "");
  }
  if (stage == "carve") {
    return fmt::format("{} removed, radius {:.4g} Å", grouped(report.carve.removed), report.carve.radius);
  }
  if (stage == "extract_surface") {
    const bool measured = report.surface_area > 0.0;
    return fmt::format("{} triangles{}", grouped(material.surface.triangles.size()),
                       !measured               ? ""
                       : report.surface_closed ? ", closed"
                                               : ", NOT closed");
  }
  if (stage == "simplify") {
    const SimplifyReport& simplify = report.simplify;
    return fmt::format("{} tetrahedra left of {}; {} of {} free vertices removed by {}",
                       grouped(simplify.tetrahedra_after), grouped(simplify.tetrahedra_before),
                       grouped(simplify.removed_vertices), grouped(simplify.free_vertices), simplify.strategy);
  }
  if (stage == "measure") {
    return fmt::format("volume {:.6g} Å³, area {:.6g} Å²", report.volume, report.surface_area);
  }
  if (stage == "quantify_defects") {
    const DefectReport& defects = report.defects;
    return fmt::format(
        "neighbours: displaced of {} atoms, missing of {}, too many of {}; sites: {} vacancies, {} extra atoms, {} of "
        "them substitutions{}",
        grouped(defects.positional_atoms), grouped(defects.vacancy_atoms), grouped(defects.extra_atoms),
        grouped(material.defects.vacancies.size()), grouped(material.defects.extras.size()),
        grouped(material.defects.substitutions.size()),
        defects.noise > 0.0 ? fmt::format("; thermal amplitude {:.3g} Å", defects.noise) : "");
  }
  if (stage == "assign_scalar") {
    const auto& values = material.defects.positional;
    return fmt::format("shown from 0 to {:.6g}",
                       values.empty() ? 0.0F : *std::max_element(values.begin(), values.end()));
  }
  return "";
}

std::vector<std::pair<std::string, std::string>> recorded_options(const PreprocessSettings& settings,
                                                                  const std::string& format) {
  auto options = provenance_options(settings.options, format);
  options.emplace_back("compress", settings.compress ? "yes" : "no");
  return options;
}

PreprocessedFile preprocess_file(const PreprocessJob& job, const PreprocessSettings& settings, Progress& progress) {
  PreprocessedFile file = preprocess_input(job.input, settings, progress);
  write_output(file, job.output, settings.compress, progress);
  return file;
}

PreprocessedFile preprocess_input(const std::string& input, const PreprocessSettings& settings, Progress& progress) {
  if (is_material_file(input)) {
    throw UsageError(input + " is preprocessed already; atomesh convert changes its format");
  }
  if (is_mesh_file(input)) {
    throw UsageError(input + " is a mesh, which needs no preprocessing; render it as it is, or use atomesh convert " +
                     input + " OUT.crb");
  }
  const auto start = Clock::now();
  PreprocessedFile file;
  file.job.input = input;
  SimplifyPictures pictures;
  StageTime certify{"certify", 0.0};
  std::uint64_t certify_memory = 0;
  const auto draw = [&](const char* stage, auto&& work) {
    const auto draw_start = Clock::now();
    progress.stage(stage);
    reset_peak_memory();
    work();
    certify.ms += milliseconds_since(draw_start);
    certify_memory = std::max(certify_memory, recent_peak_memory());
  };
  PipelineOptions options = settings.options;
  options.before_simplify = [&](const Material& whole) {
    draw("draw the whole mesh", [&] { pictures.draw(whole, progress); });
  };
  file.material = preprocess(input, options, file.report, progress);
  if (pictures.drawn()) {
    draw("draw the simplified mesh", [&] { file.picture_difference = pictures.compare(file.material, progress); });
  }
  Provenance& provenance = file.material.provenance;
  provenance.options = recorded_options(settings, file.report.read.format);
  provenance.options.emplace_back("input_hash", file.report.read.hash);
  file.stages = provenance.stages;
  file.stage_memory = file.report.stage_memory;
  if (pictures.drawn()) {
    file.pictures = pictures.count();
    file.stages.push_back(certify);
    file.stage_memory.push_back(certify_memory);
  }
  file.total_ms = milliseconds_since(start);
  return file;
}

void write_output(PreprocessedFile& file, const std::string& output, bool compress, Progress& progress) {
  const auto write_start = Clock::now();
  progress.stage("write_material");
  reset_peak_memory();
  try {
    write_material(output, file.material, {.compress = compress}, progress);
  } catch (const std::bad_alloc&) {
    throw UnavailableError("write_material: the memory ran out; " + memory_advice());
  }
  const double ms = milliseconds_since(write_start);
  file.stages.push_back({"write_material", ms});
  file.stage_memory.push_back(recent_peak_memory());
  file.job.output = output;
  file.output_bytes = std::filesystem::file_size(output);
  file.total_ms += ms;
}

std::string certificate_text(const PreprocessedFile& file) {
  const SimplifyReport& s = file.report.simplify;
  if (s.strategy.empty()) return "";
  const double share = s.free_vertices > 0
                           ? 100.0 * static_cast<double>(s.removed_vertices) / static_cast<double>(s.free_vertices)
                           : 100.0;
  const double worst = file.picture_difference.max;
  return fmt::format(
      "certificate of the simplification\n"
      "  tetrahedra       {} of {} left; no mesh that keeps surface and defects has fewer than {}\n"
      "  vertices         {} of {} free ones removed ({:.2f} %); {} on the surface and {} at defects stay\n"
      "  volume change    {:.1e}\n"
      "  surface          {}\n"
      "  defects          {}, largest difference of a value at any original atom {:.1e}\n"
      "  pictures         largest difference of a channel {:.1e} ({:.2f}/255){}\n",
      grouped(s.tetrahedra_after), grouped(s.tetrahedra_before), grouped(s.least_tetrahedra),
      grouped(s.removed_vertices), grouped(s.free_vertices), share, grouped(s.frozen_surface), grouped(s.frozen_defect),
      s.volume_change, s.surface_identical ? "identical" : "CHANGED",
      s.defect_tetrahedra_identical ? "tetrahedra there identical" : "tetrahedra there CHANGED", s.scalar_error, worst,
      255.0 * worst, worst > 0.0 ? ", in " + file.picture_difference.where : "");
}

std::string stage_table(const PreprocessedFile& file) {
  TextTable table({"stage", "ms", "peak MB", "result"});
  for (std::size_t i = 0; i < file.stages.size(); ++i) {
    const StageTime& stage = file.stages[i];
    const std::string result = stage.name == "write_material"
                                   ? fmt::format("{}, {}", file.job.output, byte_size(file.output_bytes))
                               : stage.name == "certify" ? fmt::format("{} pictures of either mesh", file.pictures)
                                                         : stage_outcome(stage.name, file.material, file.report);
    table.row({stage.name, milliseconds(stage.ms), fmt::format("{:.0f}", megabytes(file.stage_memory[i])), result});
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
  for (const auto* list : {&report.read.notes, &report.find_cell.notes, &report.defects.notes, &report.notes}) {
    for (const std::string& note : *list) notes.push(note);
  }
  const std::size_t tetrahedra = material.mesh.tetrahedra.size();

  return Json::object({{"input", Json::object({{"file", file.job.input},
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
                                              {"stamped", report.tetrahedralize.pattern.stamped},
                                              {"delaunay", material.mesh.delaunay},
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
                                                 {"noise", report.defects.noise},
                                                 {"noise_limit", report.defects.noise_limit},
                                                 {"surface_atoms", report.defects.surface_atoms},
                                                 {"matched_fraction", report.defects.matched_fraction}})},
                       {"simplify", simplify_json(file)},
                       {"stages", stage_list},
                       {"total_ms", file.total_ms},
                       {"peak_memory_mb", peak_memory_mb()},
                       {"notes", notes},
                       {"output", Json::object({{"file", file.job.output}, {"bytes", file.output_bytes}})}});
}

}  // namespace atomesh::cli
