// atomesh convert IN OUT: the same content in another format.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "app/cli/commands.h"
#include "app/cli/load_material.h"
#include "app/cli/output_file.h"
#include "app/cli/pipeline_options.h"
#include "app/cli/session.h"
#include "app/cli/text_table.h"
#include "app/cli/write_vtu.h"
#include "core/error.h"
#include "preprocess/write_atoms.h"

namespace atomesh::cli {
namespace {

struct ConvertArguments {
  std::string input;
  std::string output;
  MeshFileOptions mesh;
  PipelineOptions options;
};

// Defect values travel as columns, so that OVITO and others can colour by them.
Atoms with_defect_columns(Atoms atoms, const Defects& defects) {
  if (!defects.present()) return atoms;
  const std::pair<const char*, const std::vector<float>*> values[] = {{"positional_defect", &defects.positional},
                                                                      {"vacancy_defect", &defects.vacancy},
                                                                      {"extra_defect", &defects.extra}};
  for (const auto& [name, column] : values) {
    if (atoms.find_column(name) == nullptr) {
      atoms.columns.push_back({name, std::vector<double>(column->begin(), column->end())});
    }
  }
  return atoms;
}

int run_convert(const ConvertArguments& arguments, const CLI::App& app, Session& session) {
  check_output(arguments.output, {".dat", ".xyz", ".crb", ".crt", ".vtu"});
  const std::string extension = std::filesystem::path(arguments.output).extension().string();
  const bool only_atoms = extension == ".dat" || extension == ".xyz";
  // A material file already has its defect values; from atoms to atoms nothing needs to be meshed.
  const bool defects = !only_atoms || (extension == ".xyz" && is_material_file(arguments.input));
  const LoadedMaterial loaded = load_material(
      arguments.input, {.atoms = true, .tetrahedra = !only_atoms, .surface = !only_atoms, .defects = defects}, app,
      arguments.options, session, arguments.mesh);
  const Material& material = loaded.material;
  if (only_atoms && material.atoms.size() == 0) {
    throw InputError(arguments.input, 0, "is a mesh without atoms; it can be converted to .crb, .crt and .vtu");
  }
  session.progress().stage("write");
  if (extension == ".dat") {
    write_atoms(arguments.output, material.atoms, material.unit_cell, session.progress());
  } else if (extension == ".xyz") {
    write_atoms(arguments.output, with_defect_columns(material.atoms, material.defects), material.unit_cell,
                session.progress());
  } else if (extension == ".vtu") {
    write_vtu(arguments.output, material);
  } else {
    write_material(arguments.output, material, {}, session.progress());
  }
  const auto bytes = std::filesystem::file_size(arguments.output);
  const std::string atoms = material.atoms.size() > 0 ? fmt::format("{} atoms", grouped(material.atoms.size())) : "";
  const std::string mesh = only_atoms ? "" : fmt::format("{} tetrahedra", grouped(material.mesh.tetrahedra.size()));
  session.print("{}: {}{}{}, {}", arguments.output, atoms, atoms.empty() || mesh.empty() ? "" : ", ", mesh,
                byte_size(bytes));
  session.write_json(Json::object({{"input", arguments.input},
                                   {"atoms", material.atoms.size()},
                                   {"tetrahedra", material.mesh.tetrahedra.size()},
                                   {"output", Json::object({{"file", arguments.output}, {"bytes", bytes}})}}));
  return exit_done;
}

}  // namespace

Command add_convert(CLI::App& app) {
  auto arguments = std::make_shared<ConvertArguments>();
  app.add_option("IN", arguments->input, "A .crb or .crt, a mesh file (.vtu, .vtk, PLOT3D, TetGen), or an atoms file")
      ->required();
  app.add_option("OUT", arguments->output, "The file to write: .dat, .xyz, .crb, .crt or .vtu")->required();
  add_mesh_options(app, arguments->mesh);
  add_pipeline_options(app, arguments->options);
  app.footer(
      "Atoms to atoms copies them; atoms to .crb, .crt or .vtu preprocesses them on the way. A .xyz made from a .crb\n"
      "carries the defect values as columns.\n"
      "Example:\n  atomesh convert nacl.crb nacl.vtu\n");
  return [arguments, &app](Session& session) { return run_convert(*arguments, app, session); };
}

}  // namespace atomesh::cli
