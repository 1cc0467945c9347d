#include "app/gui/material_facts.h"

#include <fmt/format.h>

#include <filesystem>

namespace atomesh::gui {

namespace {

using Rows = std::vector<std::pair<std::string, std::string>>;

std::string grouped(std::size_t number) {
  std::string digits = std::to_string(number);
  for (std::size_t end = digits.size(); end > 3; end -= 3) digits.insert(end - 3, ",");
  return digits;
}

std::string vector_text(const Vec3& v) {
  return fmt::format("{:.4f}, {:.4f}, {:.4f} Å", v.x, v.y, v.z);
}

Rows file_rows(const Document& document) {
  const std::filesystem::path path(document.path);
  Rows rows{{"Name", path.filename().string()}, {"Folder", path.parent_path().string()}};
  std::error_code ignored;
  const auto bytes = std::filesystem::file_size(path, ignored);
  if (!ignored) rows.emplace_back("Size", fmt::format("{} bytes", grouped(bytes)));
  if (document.mesh) rows.emplace_back("Format", document.mesh->format);
  return rows;
}

Rows atom_rows(const Document& document) {
  const Atoms& atoms = document.material->atoms;
  Rows rows{{"Atoms", grouped(atoms.size())}};
  std::vector<std::size_t> counts(atoms.species_table.size(), 0);
  for (const std::uint16_t species : atoms.species) ++counts[species];
  for (std::size_t s = 0; s < counts.size(); ++s) rows.emplace_back(atoms.species_table[s].name, grouped(counts[s]));
  return rows;
}

Rows size_rows(const Document& document) {
  const Material& material = *document.material;
  const bool atoms = material.atoms.size() > 0;
  const Bounds bounds = bounds_of(atoms ? material.atoms.positions : material.mesh.vertices);
  const Vec3 extent = bounds.extent();
  Rows rows{{"Extent", fmt::format("{:.2f} × {:.2f} × {:.2f}{}", extent.x, extent.y, extent.z, atoms ? " Å" : "")}};
  const Box& box = material.atoms.box;
  if (!box.present()) return rows;
  const char* const names[] = {"Box a", "Box b", "Box c"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    rows.emplace_back(names[axis], vector_text(box.vectors[axis]) + (box.periodic[axis] ? ", periodic" : ", open"));
  }
  return rows;
}

Rows mesh_rows(const Document& document) {
  const Material& material = *document.material;
  Rows rows;
  if (!material.mesh.vertices.empty()) rows.emplace_back("Vertices", grouped(material.mesh.vertices.size()));
  if (!material.mesh.tetrahedra.empty()) {
    rows.emplace_back("Tetrahedra", grouped(material.mesh.tetrahedra.size()));
    rows.emplace_back("Delaunay", material.mesh.delaunay ? "yes" : "no");
  }
  if (!material.surface.triangles.empty()) {
    rows.emplace_back("Surface triangles", grouped(material.surface.triangles.size()));
  }
  for (const VertexField& field : material.fields) rows.emplace_back("Field", field.name);
  return rows;
}

Rows cell_rows(const UnitCell& cell) {
  Rows rows;
  const char* const names[] = {"a", "b", "c"};
  for (std::size_t i = 0; i < 3; ++i) {
    rows.emplace_back(names[i], fmt::format("{}  (|{}| = {:.4f} Å)", vector_text(cell.primitive[i]), names[i],
                                            glm::length(cell.primitive[i])));
  }
  rows.emplace_back("Volume", fmt::format("{:.3f} Å³", cell.volume()));
  for (const BasisAtom& atom : cell.basis) rows.emplace_back(atom.species, vector_text(atom.position));
  return rows;
}

Rows defect_rows(const Defects& defects) {
  std::size_t defective = 0;
  for (std::size_t atom = 0; atom < defects.positional.size(); ++atom) defective += defects.defective(atom) ? 1 : 0;
  return {{"Defective atoms", grouped(defective)},
          {"Vacancies", grouped(defects.vacancies.size())},
          {"Extra atoms", grouped(defects.extras.size())},
          {"Substitutions", grouped(defects.substitutions.size())}};
}

}  // namespace

std::vector<MaterialFacts> material_facts(const Document& document) {
  const Material& material = *document.material;
  std::vector<MaterialFacts> facts{{"File", file_rows(document)}};
  if (material.atoms.size() > 0) facts.push_back({"Atoms", atom_rows(document)});
  facts.push_back({"Size", size_rows(document)});
  if (Rows rows = mesh_rows(document); !rows.empty()) facts.push_back({"Mesh", std::move(rows)});
  if (material.unit_cell) facts.push_back({"Unit cell", cell_rows(*material.unit_cell)});
  if (material.defects.present()) facts.push_back({"Defects", defect_rows(material.defects)});
  const Provenance& provenance = material.provenance;
  Rows made;
  if (!provenance.program.empty()) made.emplace_back("Program", provenance.program);
  if (!provenance.input.empty()) made.emplace_back("From", provenance.input);
  for (const auto& [key, value] : provenance.options) made.emplace_back(key, value);
  for (const auto& [key, count] : provenance.counts) made.emplace_back(key, grouped(count));
  for (const StageTime& stage : provenance.stages) made.emplace_back(stage.name, fmt::format("{:.1f} ms", stage.ms));
  if (!made.empty()) facts.push_back({"How it was made", std::move(made)});
  return facts;
}

}  // namespace atomesh::gui
