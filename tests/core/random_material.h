// A material that uses every field, with random numbers and valid indices (its geometry makes no sense and need not).
#pragma once

#include <cmath>
#include <cstring>
#include <random>

#include "core/material.h"

namespace atomesh::test {

struct MaterialKind {
  std::size_t atoms = 40;
  std::size_t tetrahedra = 60;
  bool own_vertices = false;  // vertices that are not the atoms, one of them no atom at all
  bool ids = true;
  bool columns = true;
  bool unit_cell = true;
  bool defects = true;
  bool surface_cells = true;
  bool substitutions = true;  // where there are defects
  bool fields = true;
};

inline Material random_material(unsigned seed, const MaterialKind& kind = {}) {
  std::mt19937_64 random(seed);
  // Any finite double: most decimals have 17 digits, exponents from subnormal to huge.
  const auto any_double = [&] {
    for (;;) {
      const std::uint64_t bits = random();
      double value = 0.0;
      std::memcpy(&value, &bits, sizeof(value));
      if (std::isfinite(value)) return value;
    }
  };
  const auto any_float = [&] {
    for (;;) {
      const auto bits = static_cast<std::uint32_t>(random());
      float value = 0.0F;
      std::memcpy(&value, &bits, sizeof(value));
      if (std::isfinite(value)) return value;
    }
  };
  const auto point = [&] { return Vec3(any_double(), any_double(), any_double()); };
  Material m;
  Atoms& atoms = m.atoms;
  atoms.species_table = {{"Na", 1.66}, {"Cl", 0.1 + 0.2}, {"#odd\"name\\", 0.0}};
  for (std::size_t i = 0; i < kind.atoms; ++i) {
    atoms.positions.push_back(i == 0 ? Vec3(-0.0, 0.0, 5e-324) : point());
    atoms.species.push_back(static_cast<std::uint16_t>(random() % 3));
    if (kind.ids) atoms.ids.push_back(static_cast<std::int64_t>(random()));
  }
  if (kind.columns) {
    atoms.columns = {{"energy", {}}, {"a name with \"quotes\", a \\ and\nlines\t\x01", {}}};
    for (Column& column : atoms.columns) {
      for (std::size_t i = 0; i < kind.atoms; ++i) column.values.push_back(any_double());
    }
  }
  atoms.box.origin = point();
  atoms.box.vectors = {point(), point(), point()};
  atoms.box.periodic = {true, false, true};
  if (kind.unit_cell) m.unit_cell = UnitCell{{point(), point(), point()}, {{"Na", point()}, {"Zz", point()}}};
  TetMesh& mesh = m.mesh;
  mesh.delaunay = seed % 2 == 0;
  mesh.vertices = atoms.positions;
  for (std::size_t i = 0; i < kind.atoms; ++i) mesh.vertex_atom.push_back(static_cast<Index>(i));
  if (kind.own_vertices) {
    std::swap(mesh.vertex_atom.front(), mesh.vertex_atom.back());
    mesh.vertices.push_back(point());
    mesh.vertex_atom.push_back(no_index);
  }
  for (std::size_t t = 0; kind.atoms >= 4 && t < kind.tetrahedra; ++t) {
    Tetrahedron tetrahedron{};
    for (std::size_t c = 0; c < 4;) {
      tetrahedron[c] = static_cast<Index>(random() % mesh.vertices.size());
      if (std::find(tetrahedron.begin(), tetrahedron.begin() + static_cast<std::ptrdiff_t>(c), tetrahedron[c]) ==
          tetrahedron.begin() + static_cast<std::ptrdiff_t>(c)) {
        ++c;
      }
    }
    mesh.tetrahedra.push_back(tetrahedron);
    if (t % 3 != 0) continue;
    const auto face = static_cast<std::uint8_t>(random() % 4);
    Triangle triangle{};
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = tetrahedron[static_cast<std::size_t>(face_corners[face][k])];
    m.surface.triangles.push_back(triangle);
    if (!kind.surface_cells) continue;
    m.surface.tetrahedron.push_back(static_cast<Index>(t));
    m.surface.face.push_back(face);
  }
  if (kind.defects && kind.atoms > 0) {
    for (std::size_t i = 0; i < kind.atoms; ++i) {
      m.defects.positional.push_back(any_float());
      m.defects.vacancy.push_back(any_float());
      m.defects.extra.push_back(any_float());
    }
    m.defects.vacancies = {{point(), 2, 17}, {point(), 0, 0}};
    m.defects.extras = {{static_cast<Index>(kind.atoms - 1), 8}};
    if (kind.substitutions) m.defects.substitutions = {{static_cast<Index>(kind.atoms - 1), 2, 1}};
  }
  if (kind.fields) {
    m.fields = {{"Density", {}}, {"a \"field\"\n", {}}, {"constant", {}}};
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      m.fields[0].values.push_back(any_float());
      m.fields[1].values.push_back(any_float());
      m.fields[2].values.push_back(-0.0F);
    }
  }
  m.provenance.program = "atomesh 0.1.0";
  m.provenance.input = "näcl \"1\".dat";
  m.provenance.options = {{"mesher", "auto"}, {"carve", ""}};
  m.provenance.counts = {{"atoms_read", kind.atoms}, {"bytes", ~std::uint64_t{0}}};
  m.provenance.stages = {{"read", 12.25}, {"tetrahedralize", 1.0 / 3.0}};
  return m;
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  static_assert(std::is_trivially_copyable_v<T>);
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

// The name of the first part in which two materials differ in any bit, "" when there is none.
inline std::string difference(const Material& a, const Material& b) {
  if (!same_bits(a.atoms.positions, b.atoms.positions)) return "positions";
  if (a.atoms.species != b.atoms.species) return "species";
  if (a.atoms.ids != b.atoms.ids) return "ids";
  if (a.atoms.species_table.size() != b.atoms.species_table.size()) return "species table";
  for (std::size_t i = 0; i < a.atoms.species_table.size(); ++i) {
    const Species& s = a.atoms.species_table[i];
    const Species& t = b.atoms.species_table[i];
    if (s.name != t.name || s.radius != t.radius) return "species table";
  }
  if (a.atoms.columns.size() != b.atoms.columns.size()) return "columns";
  for (std::size_t i = 0; i < a.atoms.columns.size(); ++i) {
    if (a.atoms.columns[i].name != b.atoms.columns[i].name) return "column names";
    if (!same_bits(a.atoms.columns[i].values, b.atoms.columns[i].values)) return "columns";
  }
  if (a.atoms.box.origin != b.atoms.box.origin || a.atoms.box.vectors != b.atoms.box.vectors) return "box";
  if (a.atoms.box.periodic != b.atoms.box.periodic) return "periodic";
  if (a.unit_cell.has_value() != b.unit_cell.has_value()) return "unit cell";
  if (a.unit_cell) {
    if (a.unit_cell->primitive != b.unit_cell->primitive) return "primitive";
    if (a.unit_cell->basis.size() != b.unit_cell->basis.size()) return "basis";
    for (std::size_t i = 0; i < a.unit_cell->basis.size(); ++i) {
      if (a.unit_cell->basis[i].species != b.unit_cell->basis[i].species) return "basis species";
      if (a.unit_cell->basis[i].position != b.unit_cell->basis[i].position) return "basis";
    }
  }
  if (!same_bits(a.mesh.vertices, b.mesh.vertices)) return "vertices";
  if (a.mesh.vertex_atom != b.mesh.vertex_atom) return "vertex atoms";
  if (a.mesh.tetrahedra != b.mesh.tetrahedra) return "tetrahedra";
  if (a.mesh.delaunay != b.mesh.delaunay) return "delaunay";
  if (a.surface.triangles != b.surface.triangles) return "surface";
  if (a.surface.tetrahedron != b.surface.tetrahedron || a.surface.face != b.surface.face) return "surface cells";
  if (!same_bits(a.defects.positional, b.defects.positional)) return "positional";
  if (!same_bits(a.defects.vacancy, b.defects.vacancy)) return "vacancy";
  if (!same_bits(a.defects.extra, b.defects.extra)) return "extra";
  const auto same_site = [](const VacancySite& s, const VacancySite& t) {
    return s.position == t.position && s.species == t.species && s.votes == t.votes;
  };
  if (!std::equal(a.defects.vacancies.begin(), a.defects.vacancies.end(), b.defects.vacancies.begin(),
                  b.defects.vacancies.end(), same_site)) {
    return "vacancies";
  }
  const auto same_extra = [](const ExtraAtom& s, const ExtraAtom& t) { return s.atom == t.atom && s.votes == t.votes; };
  if (!std::equal(a.defects.extras.begin(), a.defects.extras.end(), b.defects.extras.begin(), b.defects.extras.end(),
                  same_extra)) {
    return "extras";
  }
  const auto same_substitution = [](const Substitution& s, const Substitution& t) {
    return s.atom == t.atom && s.expected == t.expected && s.vacancy == t.vacancy;
  };
  if (!std::equal(a.defects.substitutions.begin(), a.defects.substitutions.end(), b.defects.substitutions.begin(),
                  b.defects.substitutions.end(), same_substitution)) {
    return "substitutions";
  }
  const auto same_field = [](const VertexField& s, const VertexField& t) {
    return s.name == t.name && same_bits(s.values, t.values);
  };
  if (!std::equal(a.fields.begin(), a.fields.end(), b.fields.begin(), b.fields.end(), same_field)) return "fields";
  const Provenance& p = a.provenance;
  const Provenance& q = b.provenance;
  if (p.program != q.program || p.input != q.input || p.options != q.options || p.counts != q.counts)
    return "provenance";
  const auto same_stage = [](const StageTime& s, const StageTime& t) { return s.name == t.name && s.ms == t.ms; };
  if (!std::equal(p.stages.begin(), p.stages.end(), q.stages.begin(), q.stages.end(), same_stage)) return "stages";
  return "";
}

}  // namespace atomesh::test
