#include "app/gui/document.h"

#include <chrono>
#include <filesystem>
#include <utility>

#include "core/error.h"
#include "core/file_extension.h"
#include "core/stopwatch.h"

namespace atomesh::gui {

FileKind file_kind(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".png") return FileKind::picture;
  // What it says it is and is not, its reader explains best.
  if (is_material_file(path) || extension == ".crb" || extension == ".crt") return FileKind::material;
  return cli::is_mesh_file(path) ? FileKind::mesh : FileKind::atoms;
}

std::vector<std::string> Document::species() const {
  std::vector<std::string> names;
  for (const Species& species : material->atoms.species_table) names.push_back(species.name);
  return names;
}

bool covers(const MaterialParts& parts, const MaterialParts& wanted) {
  const auto has = [](bool part, bool want) { return part || !want; };
  return has(parts.atoms, wanted.atoms) && has(parts.tetrahedra, wanted.tetrahedra) &&
         has(parts.surface, wanted.surface) && has(parts.defects, wanted.defects) && has(parts.fields, wanted.fields);
}

MaterialParts united(const MaterialParts& a, const MaterialParts& b) {
  return {.atoms = a.atoms || b.atoms,
          .tetrahedra = a.tetrahedra || b.tetrahedra,
          .surface = a.surface || b.surface,
          .defects = a.defects || b.defects,
          .fields = a.fields || b.fields};
}

Document open_document(const std::string& path, const MaterialParts& parts, Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  Document document;
  document.path = std::filesystem::absolute(path).lexically_normal().string();
  document.kind = file_kind(path);
  progress.stage("read");
  switch (document.kind) {
    case FileKind::material:
      document.material = std::make_shared<const Material>(read_material(path, parts, progress));
      document.parts = parts;
      break;
    case FileKind::mesh: {
      document.mesh.emplace();
      Material material = cli::read_mesh_file(path, {}, *document.mesh, progress);
      material.provenance.program = program_version();
      document.material = std::make_shared<const Material>(std::move(material));
      document.parts = {};  // all of them
      document.notes = document.mesh->notes;
      break;
    }
    case FileKind::atoms:
      throw UsageError(path + ": a file of atoms, which must be preprocessed first");
    case FileKind::picture:
      throw UsageError(path + ": a picture, not a material");
  }
  document.times = {{"read", ms_since(start)}};
  return document;
}

Document with_parts(const Document& document, const MaterialParts& wanted, Progress& progress) {
  if (covers(document.parts, wanted)) return document;
  const MaterialParts parts = united(document.parts, wanted);
  Document more = document;
  const auto start = std::chrono::steady_clock::now();
  progress.stage("read");
  Material material = read_material(document.path, parts, progress);
  const Provenance& before = document.material->provenance;
  if (material.provenance.input != before.input || material.provenance.options != before.options ||
      material.provenance.counts != before.counts || material.atoms.size() != document.material->atoms.size()) {
    throw InputError(document.path, 0, "is no longer the file that was opened; open it again");
  }
  more.material = std::make_shared<const Material>(std::move(material));
  more.parts = parts;
  more.times = {{"read", ms_since(start)}};
  return more;
}

}  // namespace atomesh::gui
