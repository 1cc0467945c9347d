#include "core/check_material.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

namespace atomesh {

namespace {

constexpr std::size_t items_per_check = 1 << 16;

// "" when all is well. The loops run over whole arrays without leaving early, so that they vectorise: files are sound
// nearly always.
template <class Number>
std::string check_finite(std::span<const Number> values, std::size_t per_item, const char* item, Progress& progress) {
  bool sound = true;
  for (std::size_t first = 0; first < values.size(); first += items_per_check) {
    progress.check();
    for (const Number value : values.subspan(first, std::min(items_per_check, values.size() - first))) {
      sound &= std::isfinite(value);
    }
  }
  if (sound) return "";
  const auto at = std::find_if(values.begin(), values.end(), [](Number v) { return !std::isfinite(v); });
  return std::string(item) + " " + std::to_string(static_cast<std::size_t>(at - values.begin()) / per_item) +
         " is not a finite number";
}

std::string check_points(std::span<const Vec3> points, const char* item, Progress& progress) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  return points.empty() ? "" : check_finite(std::span(&points[0].x, 3 * points.size()), 3, item, progress);
}

template <std::size_t N>
std::string check_corners(const std::vector<std::array<Index, N>>& cells, std::uint64_t vertices, const char* item,
                          Progress& progress) {
  Index largest = 0;
  bool distinct = true;
  for (std::size_t first = 0; first < cells.size(); first += items_per_check) {
    progress.check();
    for (const auto& cell : std::span(cells).subspan(first, std::min(items_per_check, cells.size() - first))) {
      for (std::size_t i = 0; i < N; ++i) {
        largest = std::max(largest, cell[i]);
        for (std::size_t j = i + 1; j < N; ++j) distinct &= cell[i] != cell[j];
      }
    }
  }
  if (cells.empty() || (largest < vertices && distinct)) return "";
  for (std::size_t c = 0; c < cells.size(); ++c) {
    for (std::size_t i = 0; i < N; ++i) {
      const std::string what =
          std::string(item) + " " + std::to_string(c) + " names vertex " + std::to_string(cells[c][i]);
      if (cells[c][i] >= vertices) return what + ", but there are " + std::to_string(vertices);
      if (std::count(cells[c].begin(), cells[c].end(), cells[c][i]) > 1) return what + " twice";
    }
  }
  return "";
}

std::string check_species(const std::vector<Species>& table) {
  if (table.size() > 65535) return "more than 65,535 species";
  std::set<std::string_view> names;
  for (const Species& species : table) {
    const auto blank = [](char c) { return static_cast<unsigned char>(c) <= ' '; };
    if (species.name.empty() || std::any_of(species.name.begin(), species.name.end(), blank)) {
      return "\"" + species.name + "\" is no name of a species (empty, or with blanks)";
    }
    if (!names.insert(species.name).second) return species.name + " stands twice";
    if (!std::isfinite(species.radius) || species.radius < 0.0) {
      return "the radius of " + species.name + " is not a finite number of 0 or more";
    }
  }
  return "";
}

// Each triangle is the named face of its tetrahedron, in any order of corners.
std::string check_surface_cells(const Surface& surface, const TetMesh& mesh, std::uint64_t tetrahedra,
                                Progress& progress) {
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (t % items_per_check == 0) progress.check();
    const Index cell = surface.tetrahedron[t];
    if (cell >= tetrahedra) {
      return "triangle " + std::to_string(t) + " names tetrahedron " + std::to_string(cell) + ", but there are " +
             std::to_string(tetrahedra);
    }
    if (mesh.tetrahedra.empty()) continue;
    const auto& face = face_corners[surface.face[t]];
    for (const Index corner : surface.triangles[t]) {
      const Tetrahedron& tet = mesh.tetrahedra[cell];
      if (corner != tet[static_cast<std::size_t>(face[0])] && corner != tet[static_cast<std::size_t>(face[1])] &&
          corner != tet[static_cast<std::size_t>(face[2])]) {
        return "triangle " + std::to_string(t) + " is not face " + std::to_string(surface.face[t]) +
               " of tetrahedron " + std::to_string(cell);
      }
    }
  }
  return "";
}

class Finder {
 public:
  Finder(const Material& material, const MaterialCounts& counts, Progress& progress)
      : m_(material), counts_(counts), progress_(progress) {}

  std::optional<MaterialProblem> find() {
    check_atoms();
    check_mesh();
    check_surface();
    check_defects();
    check_fields();
    for (const StageTime& stage : m_.provenance.stages) {
      if (!std::isfinite(stage.ms)) report("provenance", "the time of stage " + stage.name + " is not a number");
    }
    return problem_;
  }

 private:
  // Keeps the first problem.
  void report(const char* section, const std::string& what) {
    if (!problem_ && !what.empty()) problem_ = MaterialProblem{section, what};
  }

  template <class T>
  void check_length(const char* section, const std::vector<T>& values, std::uint64_t count) {
    if (!values.empty() && values.size() != count) {
      report(section, std::to_string(values.size()) + " values for " + std::to_string(count) + " items");
    }
  }

  void check_atoms() {
    const Atoms& atoms = m_.atoms;
    report("species", check_species(atoms.species_table));
    report("box", check_points(std::span(&atoms.box.origin, 1), "the origin, number", progress_));
    report("box", check_points(atoms.box.vectors, "vector", progress_));
    if (m_.unit_cell) {
      report("unit cell", check_points(m_.unit_cell->primitive, "primitive vector", progress_));
      for (const BasisAtom& atom : m_.unit_cell->basis) {
        report("unit cell", check_points(std::span(&atom.position, 1), "a basis atom, number", progress_));
        report("unit cell", check_species({{atom.species, 0.0}}));
      }
    }
    if (counts_.atoms >= no_index) report("positions", "more than 4,294,967,294 atoms");
    check_length("positions", atoms.positions, counts_.atoms);
    report("positions", check_points(atoms.positions, "atom", progress_));
    if (atoms.species.size() != atoms.positions.size()) report("atom species", "not one for each atom");
    std::uint16_t largest = 0;
    for (const std::uint16_t species : atoms.species) largest = std::max(largest, species);
    if (!atoms.species.empty() && largest >= atoms.species_table.size()) {
      report("atom species", "an atom names species " + std::to_string(largest) + ", but there are " +
                                 std::to_string(atoms.species_table.size()));
    }
    check_length("ids", atoms.ids, counts_.atoms);
    for (const Column& column : atoms.columns) {
      if (column.values.size() != counts_.atoms) report("scalars", column.name + ": not one value for each atom");
      report("scalars",
             check_finite(std::span<const double>(column.values), 1, (column.name + ": atom").c_str(), progress_));
    }
  }

  void check_mesh() {
    const TetMesh& mesh = m_.mesh;
    if (counts_.vertices >= no_index) report("vertices", "more than 4,294,967,294 vertices");
    if (counts_.tetrahedra >= no_index) report("tetrahedra", "more than 4,294,967,294 tetrahedra");
    check_length("vertices", mesh.vertices, counts_.vertices);
    report("vertices", check_points(mesh.vertices, "vertex", progress_));
    if (mesh.vertex_atom.size() != mesh.vertices.size()) report("vertex atoms", "not one for each vertex");
    for (std::size_t v = 0; v < mesh.vertex_atom.size(); ++v) {
      if (mesh.vertex_atom[v] < counts_.atoms || mesh.vertex_atom[v] == no_index) continue;
      report("vertex atoms", "vertex " + std::to_string(v) + " names atom " + std::to_string(mesh.vertex_atom[v]) +
                                 ", but there are " + std::to_string(counts_.atoms));
      break;
    }
    check_length("tetrahedra", mesh.tetrahedra, counts_.tetrahedra);
    report("tetrahedra", check_corners(mesh.tetrahedra, counts_.vertices, "tetrahedron", progress_));
  }

  void check_surface() {
    const Surface& surface = m_.surface;
    report("surface", check_corners(surface.triangles, counts_.vertices, "triangle", progress_));
    if (surface.triangles.size() >= no_index) report("surface", "more than 4,294,967,294 triangles");
    check_length("surface cells", surface.tetrahedron, surface.triangles.size());
    if (surface.face.size() != surface.tetrahedron.size()) report("surface faces", "not one for each triangle");
    if (std::any_of(surface.face.begin(), surface.face.end(), [](std::uint8_t f) { return f > 3; })) {
      report("surface faces", "a face beyond 3");
    }
    if (!problem_ && !surface.tetrahedron.empty()) {
      report("surface cells", check_surface_cells(surface, m_.mesh, counts_.tetrahedra, progress_));
    }
  }

  void check_defects() {
    const Defects& defects = m_.defects;
    for (const auto* values : {&defects.positional, &defects.vacancy, &defects.extra}) {
      check_length("defects", *values, counts_.atoms);
      report("defects", check_finite(std::span<const float>(*values), 1, "value of atom", progress_));
    }
    if (defects.vacancy.size() != defects.positional.size() || defects.extra.size() != defects.positional.size()) {
      report("defects", "some of the three values are missing");
    }
    for (const VacancySite& site : defects.vacancies) {
      report("vacancies", check_points(std::span(&site.position, 1), "a position, number", progress_));
      if (site.species >= m_.atoms.species_table.size()) report("vacancies", "a species that is not in the table");
    }
    for (const ExtraAtom& extra : defects.extras) {
      if (extra.atom >= counts_.atoms) report("extras", "atom " + std::to_string(extra.atom) + " does not exist");
    }
    std::vector<Index> extras;
    for (const ExtraAtom& extra : defects.extras) extras.push_back(extra.atom);
    std::sort(extras.begin(), extras.end());
    for (const Substitution& substitution : defects.substitutions) {
      if (substitution.atom >= counts_.atoms) {
        report("substitutions", "atom " + std::to_string(substitution.atom) + " does not exist");
      }
      if (!std::binary_search(extras.begin(), extras.end(), substitution.atom)) {
        report("substitutions", "atom " + std::to_string(substitution.atom) + " is not among the extra atoms");
      }
      if (substitution.expected >= m_.atoms.species_table.size()) {
        report("substitutions", "a species that is not in the table");
      }
      if (substitution.vacancy >= defects.vacancies.size()) {
        report("substitutions", "vacancy " + std::to_string(substitution.vacancy) + " does not exist");
      }
    }
  }

  void check_fields() {
    std::set<std::string_view> names;
    for (const VertexField& field : m_.fields) {
      if (field.name.empty()) report("field names", "a field without a name");
      if (!names.insert(field.name).second) report("field names", field.name + " stands twice");
      if (field.values.size() != counts_.vertices) report("fields", field.name + ": not one value for each vertex");
      report("fields",
             check_finite(std::span<const float>(field.values), 1, (field.name + ": vertex").c_str(), progress_));
    }
  }

  const Material& m_;
  const MaterialCounts counts_;
  Progress& progress_;
  std::optional<MaterialProblem> problem_;
};

}  // namespace

MaterialCounts counts_of(const Material& material) {
  return {material.atoms.size(), material.mesh.vertices.size(), material.mesh.tetrahedra.size()};
}

std::optional<MaterialProblem> find_problem(const Material& material, const MaterialCounts& counts,
                                            Progress& progress) {
  return Finder(material, counts, progress).find();
}

}  // namespace atomesh
