// atomesh info FILE: what a file holds, how it came to be, whether it is sound.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/cli/commands.h"
#include "app/cli/load_material.h"
#include "app/cli/machine.h"
#include "app/cli/pipeline_options.h"
#include "app/cli/session.h"
#include "app/cli/species_count.h"
#include "app/cli/text_table.h"
#include "core/crb_format.h"
#include "core/text_file.h"
#include "preprocess/find_unit_cell.h"

namespace atomesh::cli {
namespace {

struct InfoArguments {
  std::string input;
  MeshFileOptions mesh;
  PipelineOptions options;
};

struct Range {
  std::string name;
  double min;
  double max;
};

template <class T>
void add_range(std::vector<Range>& ranges, std::string name, const std::vector<T>& values) {
  if (values.empty()) return;
  const auto [min, max] = std::minmax_element(values.begin(), values.end());
  ranges.push_back({std::move(name), static_cast<double>(*min), static_cast<double>(*max)});
}

std::vector<Range> ranges_of(const Material& material) {
  std::vector<Range> ranges;
  add_range(ranges, "positional", material.defects.positional);
  add_range(ranges, "vacancy", material.defects.vacancy);
  add_range(ranges, "extra", material.defects.extra);
  for (const Column& column : material.atoms.columns) add_range(ranges, column.name, column.values);
  for (const VertexField& field : material.fields) add_range(ranges, field.name, field.values);
  return ranges;
}

template <class T>
std::size_t bytes_of(const std::vector<T>& values) {
  return values.size() * sizeof(T);
}

std::size_t memory_of(const Material& m) {
  std::size_t bytes = bytes_of(m.atoms.positions) + bytes_of(m.atoms.species) + bytes_of(m.atoms.ids);
  for (const Column& column : m.atoms.columns) bytes += bytes_of(column.values);
  bytes += bytes_of(m.mesh.vertices) + bytes_of(m.mesh.tetrahedra) + bytes_of(m.mesh.vertex_atom);
  bytes += bytes_of(m.surface.triangles) + bytes_of(m.surface.tetrahedron) + bytes_of(m.surface.face);
  bytes += bytes_of(m.defects.positional) + bytes_of(m.defects.vacancy) + bytes_of(m.defects.extra);
  for (const VertexField& field : m.fields) bytes += bytes_of(field.values);
  return bytes + bytes_of(m.defects.vacancies) + bytes_of(m.defects.extras) + bytes_of(m.defects.substitutions);
}

std::vector<std::string> problems_of(const Material& material, Progress& progress) {
  std::vector<std::string> problems = validate(material.mesh, 10, progress);
  for (std::string& problem : validate(material.surface, material.mesh, 10, progress))
    problems.push_back(std::move(problem));
  return problems;
}

// Of the atoms, or of a mesh without any.
Bounds material_bounds(const Material& material) {
  return bounds_of(material.atoms.size() > 0 ? material.atoms.positions : material.mesh.vertices);
}

Json box_json(const Material& material) {
  const Box& box = material.atoms.box;
  const Bounds bounds = material_bounds(material);
  return Json::object({{"present", box.present()},
                       {"origin", box.origin},
                       {"vectors", Json::array({box.vectors[0], box.vectors[1], box.vectors[2]})},
                       {"periodic", Json::array({box.periodic[0], box.periodic[1], box.periodic[2]})},
                       {"bounds", Json::array({bounds.min, bounds.max})}});
}

Json provenance_json(const Provenance& provenance) {
  Json options = Json::object();
  for (const auto& [name, value] : provenance.options) options.set(name, value);
  Json counts = Json::object();
  for (const auto& [name, count] : provenance.counts) counts.set(name, count);
  Json stages = Json::array();
  for (const StageTime& stage : provenance.stages) {
    stages.push(Json::object({{"name", stage.name}, {"ms", stage.ms}}));
  }
  return Json::object({{"program", provenance.program},
                       {"input", provenance.input},
                       {"options", options},
                       {"counts", counts},
                       {"stages", stages}});
}

Json cell_json(const UnitCell& cell) {
  Json primitive = Json::array();
  for (const Vec3& v : cell.primitive) primitive.push(v);
  Json basis = Json::array();
  for (const BasisAtom& atom : cell.basis) {
    basis.push(Json::object({{"species", atom.species}, {"position", atom.position}}));
  }
  return Json::object({{"primitive", primitive}, {"basis", basis}});
}

// The sample's own cell and what its symmetry says; null without one.
Json unit_cell_json(const Material& material, const std::optional<SpaceGroup>& group) {
  if (!material.unit_cell) return {};
  Json json = cell_json(*material.unit_cell);
  if (!group) return json;
  json.set("space_group", Json::object({{"number", group->number},
                                        {"symbol", group->symbol},
                                        {"point_group", group->point_group},
                                        {"conventional", cell_json(group->conventional)},
                                        {"lengths", Json::array({group->a, group->b, group->c})},
                                        {"angles_deg", Json::array({group->alpha, group->beta, group->gamma})}}));
  return json;
}

// Of the file format, as it stands in the file, which has been read already. Atoms files have none.
Json version_of(const std::string& kind, const std::string& path) {
  if (kind != "crb" && kind != "crt") return {};
  const MappedFile file(path);
  if (kind == "crb") {
    CrbHeader header{};
    std::memcpy(&header, file.bytes().data(), std::min(sizeof(header), file.bytes().size()));
    return header.version;
  }
  std::string_view line = file.bytes().substr(0, file.bytes().find('\n'));
  next_field(line);  // the name of the format
  std::int64_t version = 0;
  parse_integer(next_field(line), version);
  return version;
}

// "crb" and "crt" are material files; atoms and mesh files say how they were read.
std::string kind_of(const std::string& path, const LoadedMaterial& loaded) {
  if (loaded.report) return loaded.report->read.format;
  if (loaded.mesh) return loaded.mesh->format;
  return std::filesystem::path(path).extension() == ".crt" ? "crt" : "crb";
}

// What a cell that was found on the way explains; "" for others.
std::string found_text(const LoadedMaterial& loaded) {
  if (!loaded.report || !loaded.report->find_cell.found) return "";
  const FindCellReport& found = loaded.report->find_cell;
  return fmt::format(", found; explains {:.4g} % of the atoms in {} {}", 100.0 * found.explained, found.grains.size(),
                     found.grains.size() == 1 ? "grain" : "grains");
}

void print_info(const InfoArguments& arguments, const LoadedMaterial& loaded, const std::vector<SectionInfo>& sections,
                const std::vector<std::string>& problems, const std::optional<SpaceGroup>& group, Session& session) {
  const Material& material = loaded.material;
  const Bounds bounds = material_bounds(material);
  // Nobody says in which unit a mesh file is.
  const char* unit = material.atoms.size() > 0 ? " Å" : "";
  const Box& box = material.atoms.box;
  session.print("{} ({})", arguments.input, kind_of(arguments.input, loaded));
  if (material.atoms.size() > 0) {
    session.print("atoms        {} ({})", grouped(material.atoms.size()), species_text(material.atoms));
  }
  if (loaded.mesh) {
    session.print("cells        {} of {} points", grouped(loaded.mesh->cells), grouped(loaded.mesh->points));
  }
  session.print("vertices     {}", grouped(material.mesh.vertices.size()));
  session.print("tetrahedra   {}", grouped(material.mesh.tetrahedra.size()));
  session.print("triangles    {}", grouped(material.surface.triangles.size()));
  session.print("bounds       {:.4f} {:.4f} {:.4f} to {:.4f} {:.4f} {:.4f}{}", bounds.min.x, bounds.min.y, bounds.min.z,
                bounds.max.x, bounds.max.y, bounds.max.z, unit);
  if (box.present()) {
    session.print("box          {:.4f} × {:.4f} × {:.4f} Å, periodic: {}{}{}", glm::length(box.vectors[0]),
                  glm::length(box.vectors[1]), glm::length(box.vectors[2]), box.periodic[0] ? "x" : "-",
                  box.periodic[1] ? "y" : "-", box.periodic[2] ? "z" : "-");
  }
  if (material.unit_cell) {
    session.print("unit cell    {} basis atoms{}", material.unit_cell->basis.size(), found_text(loaded));
    if (group) {
      session.print("space group  {} (no. {}); conventional a {:.5g} b {:.5g} c {:.5g} Å, α {:.5g} β {:.5g} γ {:.5g}°",
                    group->symbol, group->number, group->a, group->b, group->c, group->alpha, group->beta,
                    group->gamma);
    }
  }
  if (material.defects.present()) {
    session.print("defects      {} vacancies, {} extra atoms, {} of them substitutions",
                  grouped(material.defects.vacancies.size()), grouped(material.defects.extras.size()),
                  grouped(material.defects.substitutions.size()));
  }
  session.print("memory       {}", byte_size(memory_of(material)));
  const std::vector<Range> ranges = ranges_of(material);
  if (!ranges.empty()) {
    TextTable table({"scalar", "min", "max"});
    for (const Range& range : ranges) {
      table.row({range.name, fmt::format("{:.6g}", range.min), fmt::format("{:.6g}", range.max)});
    }
    session.print("");
    session.print_text(table.text());
  }
  const Provenance& provenance = material.provenance;
  session.print("\nmade by {} from {}", provenance.program, provenance.input);
  for (const auto& [name, value] : provenance.options) {
    if (!value.empty()) session.print("  {} = {}", name, value);
  }
  if (!sections.empty()) {
    TextTable table({"section", "size", "in the file"});
    for (const SectionInfo& section : sections) {
      table.row({section.name, byte_size(section.bytes), byte_size(section.stored_bytes)});
    }
    session.print("");
    session.print_text(table.text());
  }
  session.print("\n{}", problems.empty() ? "valid: mesh and surface keep every invariant" : "NOT valid:");
  for (const std::string& problem : problems) session.print("  {}", problem);
}

int run_info(const InfoArguments& arguments, const CLI::App& app, Session& session) {
  const LoadedMaterial loaded = load_material(arguments.input, {}, app, arguments.options, session, arguments.mesh);
  const Material& material = loaded.material;
  const std::string kind = kind_of(arguments.input, loaded);
  const std::vector<SectionInfo> sections = kind == "crb" ? list_sections(arguments.input) : std::vector<SectionInfo>();
  session.progress().stage("validate");
  const std::vector<std::string> problems = problems_of(material, session.progress());
  const std::optional<SpaceGroup> group =
      material.unit_cell ? find_space_group(*material.unit_cell) : std::optional<SpaceGroup>();
  print_info(arguments, loaded, sections, problems, group, session);

  if (session.json_wanted()) {
    Json scalars = Json::object();
    for (const Range& range : ranges_of(material)) scalars.set(range.name, Json::array({range.min, range.max}));
    Json section_list = Json::array();
    for (const SectionInfo& section : sections) {
      section_list.push(
          Json::object({{"name", section.name}, {"bytes", section.bytes}, {"stored_bytes", section.stored_bytes}}));
    }
    Json problem_list = Json::array();
    for (const std::string& problem : problems) problem_list.push(problem);
    session.write_json(Json::object({{"file", arguments.input},
                                     {"kind", kind},
                                     {"version", version_of(kind, arguments.input)},
                                     {"bytes", std::filesystem::file_size(arguments.input)},
                                     {"atoms", material.atoms.size()},
                                     {"tetrahedra", material.mesh.tetrahedra.size()},
                                     {"triangles", material.surface.triangles.size()},
                                     {"box", box_json(material)},
                                     {"species", species_json(material.atoms)},
                                     {"scalars", scalars},
                                     {"unit_cell", unit_cell_json(material, group)},
                                     {"vacancies", material.defects.vacancies.size()},
                                     {"extras", material.defects.extras.size()},
                                     {"substitutions", material.defects.substitutions.size()},
                                     {"memory_bytes", memory_of(material)},
                                     {"provenance", provenance_json(material.provenance)},
                                     {"sections", section_list},
                                     {"valid", problems.empty()},
                                     {"problems", problem_list},
                                     {"peak_memory_mb", peak_memory_mb()}}));
  }
  return exit_done;
}

}  // namespace

Command add_info(CLI::App& app) {
  auto arguments = std::make_shared<InfoArguments>();
  app.add_option("FILE", arguments->input, "A .crb or .crt, a mesh file, or an atoms file to preprocess on the way")
      ->required();
  add_mesh_options(app, arguments->mesh);
  add_pipeline_options(app, arguments->options);
  app.footer(
      "Of a mesh file: vertices that hang in a neighbour's face, and faces that neighbours split differently, stay as "
      "inner walls; a note counts them.\n\n"
      "Example:\n  atomesh info nacl.crb --json -\n");
  return [arguments, &app](Session& session) { return run_info(*arguments, app, session); };
}

}  // namespace atomesh::cli
