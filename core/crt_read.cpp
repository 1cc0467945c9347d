#include <fast_float/fast_float.h>

#include <charconv>
#include <cmath>
#include <unordered_map>

#include "core/check_material.h"
#include "core/crt_material.h"
#include "core/error.h"
#include "core/text_file.h"

namespace atomesh {

namespace {

class CrtReader {
 public:
  CrtReader(std::string_view bytes, const std::string& path, Progress& progress)
      : bytes_(bytes), path_(path), lines_(bytes), progress_(progress) {}

  Material read() {
    read_heading();
    read_species();
    read_box();
    if (word() == "unit_cell") read_unit_cell();
    if (word() == "columns") read_columns();
    read_atoms();
    read_vertices();
    read_tetrahedra();
    read_surface();
    read_defects();
    if (version_ > 2 && word() == "fields") read_fields();
    expect_word("end");
    end_of_line();
    if (advance()) fail("expected nothing after \"end\"");
    check();
    progress_.update(1.0);
    return std::move(m_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw InputError(path_, lines_.line_number(), message); }

  // ---- lines and fields

  // To the next line with something on it; false at the end of the file.
  bool advance() {
    std::string_view line;
    while (lines_.next(line)) {
      if ((lines_.line_number() & 0xFFFFU) == 0) {
        progress_.update(static_cast<double>(lines_.offset()) / static_cast<double>(bytes_.size() + 1));
      }
      rest_ = line;
      const std::size_t first = line.find_first_not_of(" \t");
      if (first != std::string_view::npos && line[first] != '#') return true;
    }
    rest_ = {};
    return false;
  }
  void next_line(const char* expected) {
    if (!advance()) fail(std::string("the file ends too early; expected ") + expected);
  }
  void end_of_line() {
    const std::string_view field = next_field(rest_);
    if (!field.empty()) fail("unexpected \"" + std::string(field) + "\" at the end of the line");
  }
  // The first word of the current line, without taking it.
  std::string_view word() const {
    std::string_view line = rest_;
    return next_field(line);
  }
  void expect_word(std::string_view expected) {
    const std::string_view field = next_field(rest_);
    if (field != expected) fail("expected \"" + std::string(expected) + "\", got \"" + std::string(field) + "\"");
  }
  bool flag(std::string_view name) {
    if (word() != name) return false;
    next_field(rest_);
    return true;
  }
  double real(const char* expected) {
    double value = 0.0;
    const std::string_view field = next_field(rest_);
    if (!parse_real(field, value)) fail("expected " + std::string(expected) + ", got \"" + std::string(field) + "\"");
    return value;
  }
  float real_float(const char* expected) {
    // Read as float: by way of double some decimals would be rounded twice.
    const std::string_view field = next_field(rest_);
    float value = 0.0F;
    const auto result = fast_float::from_chars(field.data(), field.data() + field.size(), value);
    if (result.ec != std::errc() || result.ptr != field.data() + field.size() || !std::isfinite(value)) {
      fail("expected " + std::string(expected) + ", got \"" + std::string(field) + "\"");
    }
    return value;
  }
  Vec3 point(const char* expected) {
    const double x = real(expected);
    const double y = real(expected);
    return {x, y, real(expected)};
  }
  std::int64_t integer(const char* expected) {
    std::int64_t value = 0;
    const std::string_view field = next_field(rest_);
    if (!parse_integer(field, value))
      fail("expected " + std::string(expected) + ", got \"" + std::string(field) + "\"");
    return value;
  }
  // An index below `count`.
  Index index(std::size_t count, const char* expected) {
    const std::int64_t value = integer(expected);
    if (value < 0 || static_cast<std::uint64_t>(value) >= count) {
      fail("expected " + std::string(expected) + " from 0 to " + std::to_string(count) + " (exclusive), got " +
           std::to_string(value));
    }
    return static_cast<Index>(value);
  }
  Index votes() { return index(no_index, "a number of votes"); }
  // How many lines a section has; no more than the rest of the file can hold at that many bytes a line.
  std::size_t count_of_lines(std::size_t smallest_line) {
    const std::int64_t value = integer("a number of lines");
    const std::size_t left = bytes_.size() - lines_.offset();
    if (value < 0 || static_cast<std::uint64_t>(value) > (left + 1) / smallest_line) {
      fail(std::to_string(value) + " lines cannot follow: the file is too short (or the number wrong)");
    }
    if (value >= no_index) fail("more than 4,294,967,294 of something");
    return static_cast<std::size_t>(value);
  }
  std::uint16_t species() {
    const std::string_view name = next_field(rest_);
    const auto found = species_.find(name);
    if (found == species_.end()) fail("\"" + std::string(name) + "\" is not in the list of species");
    return found->second;
  }
  std::string string() {
    const std::size_t start = rest_.find_first_not_of(" \t");
    if (start == std::string_view::npos || rest_[start] != '"') fail("expected text in \"quotes\"");
    std::string text;
    for (std::size_t i = start + 1; i < rest_.size(); ++i) {
      if (rest_[i] == '"') {
        rest_.remove_prefix(i + 1);
        if (!rest_.empty() && rest_[0] != ' ' && rest_[0] != '\t') fail("expected a blank after the closing quote");
        return text;
      }
      if (rest_[i] != '\\') {
        text += rest_[i];
        continue;
      }
      text += escaped(i);
    }
    fail("the closing quote is missing");
  }
  // The character that the backslash at rest_[i] stands for; leaves i on the last character used.
  char escaped(std::size_t& i) const {
    const char kind = i + 1 < rest_.size() ? rest_[i + 1] : '\0';
    ++i;
    if (kind == '"' || kind == '\\') return kind;
    if (kind == 'n') return '\n';
    if (kind == 't') return '\t';
    unsigned byte = 0;
    if (kind != 'x' || i + 2 >= rest_.size() ||
        std::from_chars(rest_.data() + i + 1, rest_.data() + i + 3, byte, 16).ptr != rest_.data() + i + 3) {
      fail("expected \\\", \\\\, \\n, \\t or \\xHH after a backslash");
    }
    i += 2;
    return static_cast<char>(byte);
  }

  // ---- sections; each starts with its first line at hand and leaves with the next section's

  void read_heading() {
    if (!advance()) throw InputError(path_, 0, "not a .crt file (it is empty)");
    if (next_field(rest_) != crt_magic) fail("not a .crt file (expected \"atomesh-crt\")");
    const std::int64_t version = integer("the format's version");
    if (version < crt_oldest_version || version > crt_version) {
      fail("this is .crt version " + std::to_string(version) + ", this program reads versions " +
           std::to_string(crt_oldest_version) + " to " + std::to_string(crt_version) +
           "; make the file anew from its atoms, or use the program that wrote it");
    }
    end_of_line();
    version_ = version;
    Provenance& provenance = m_.provenance;
    next_line("program");
    expect_word("program");
    provenance.program = string();
    finish_line("input");
    expect_word("input");
    provenance.input = string();
    finish_line("species");
    while (flag("option")) {
      std::string name = string();
      provenance.options.emplace_back(std::move(name), string());
      finish_line("species");
    }
    while (flag("count")) {
      std::string name = string();
      provenance.counts.emplace_back(std::move(name), natural());
      finish_line("species");
    }
    while (flag("stage")) {
      std::string name = string();
      provenance.stages.push_back({std::move(name), real("a time in ms")});
      finish_line("species");
    }
  }
  void finish_line(const char* next) {
    end_of_line();
    next_line(next);
  }
  std::uint64_t natural() {
    const std::string_view field = next_field(rest_);
    std::uint64_t value = 0;
    const auto result = std::from_chars(field.data(), field.data() + field.size(), value);
    if (result.ec != std::errc() || result.ptr != field.data() + field.size()) {
      fail("expected a count, got \"" + std::string(field) + "\"");
    }
    return value;
  }

  void read_species() {
    expect_word("species");
    const std::size_t count = count_of_lines(4);
    if (count > 65535) fail("more than 65,535 species");
    end_of_line();
    std::vector<Species>& table = m_.atoms.species_table;
    table.reserve(count);  // species_ looks into its names
    for (std::size_t i = 0; i < count; ++i) {
      next_line("a species");
      std::string name = string();
      table.push_back({std::move(name), real("a radius")});
      end_of_line();
      if (!species_.emplace(table.back().name, static_cast<std::uint16_t>(i)).second) {
        fail(table.back().name + " stands twice in the list of species");
      }
    }
    next_line("box");
  }

  void read_box() {
    Box& box = m_.atoms.box;
    expect_word("box");
    finish_line("origin");
    expect_word("origin");
    box.origin = point("a coordinate");
    for (std::size_t i = 0; i < 3; ++i) {
      finish_line("vector");
      expect_word("vector");
      box.vectors[i] = point("a coordinate");
      box.periodic[i] = flag("periodic");
      if (!box.periodic[i]) expect_word("open");
    }
    finish_line("atoms");
  }

  void read_unit_cell() {
    expect_word("unit_cell");
    UnitCell& cell = m_.unit_cell.emplace();
    cell.basis.resize(count_of_lines(13));
    for (Vec3& vector : cell.primitive) {
      finish_line("primitive");
      expect_word("primitive");
      vector = point("a coordinate");
    }
    for (BasisAtom& atom : cell.basis) {
      finish_line("basis");
      expect_word("basis");
      atom.species = next_field(rest_);
      atom.position = point("a coordinate");
    }
    finish_line("atoms");
  }

  void read_columns() {
    expect_word("columns");
    m_.atoms.columns.resize(count_of_lines(3));
    for (Column& column : m_.atoms.columns) {
      finish_line("a column's name");
      column.name = string();
    }
    finish_line("atoms");
  }

  void read_atoms() {
    Atoms& atoms = m_.atoms;
    expect_word("atoms");
    const std::size_t count = count_of_lines(8);
    const bool ids = flag("ids");
    // Every line has a value for each column, at least two bytes.
    if (count > (bytes_.size() + 1) / (8 + 2 * atoms.columns.size())) fail("the file is too short for its columns");
    atoms.positions.resize(count);
    atoms.species.resize(count);
    if (ids) atoms.ids.resize(count);
    for (Column& column : atoms.columns) column.values.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      finish_line("an atom");
      atoms.positions[i] = point("a coordinate");
      atoms.species[i] = species();
      if (ids) atoms.ids[i] = integer("an id");
      for (Column& column : atoms.columns) column.values[i] = real("a column's value");
    }
    finish_line("vertices");
  }

  void read_vertices() {
    TetMesh& mesh = m_.mesh;
    const Atoms& atoms = m_.atoms;
    expect_word("vertices");
    std::string_view peek = rest_;
    next_field(peek);
    const bool own = next_field(peek) == "own";
    const bool identity = next_field(peek) == "atoms";
    // Only vertices with lines of their own are bounded by what is left of the file.
    const std::size_t count = own || !identity ? count_of_lines(own ? 6 : 2) : index(std::size_t{no_index}, "a number");
    expect_word(own ? "own" : "atoms");
    if (identity) expect_word("atoms");
    if (!own && count != atoms.size()) fail("expected as many vertices as atoms, " + std::to_string(atoms.size()));
    if (identity && count > atoms.size()) fail("expected no more vertices than atoms, " + std::to_string(atoms.size()));
    mesh.vertices = own ? std::vector<Vec3>(count) : atoms.positions;
    mesh.vertex_atom.resize(count);
    for (std::size_t v = 0; v < count; ++v) {
      if (own || !identity) finish_line("a vertex");
      if (own) mesh.vertices[v] = point("a coordinate");
      mesh.vertex_atom[v] = static_cast<Index>(v);
      if (!identity) mesh.vertex_atom[v] = flag("-") ? no_index : index(atoms.size(), "an atom");
    }
    finish_line("tetrahedra");
  }

  void read_tetrahedra() {
    TetMesh& mesh = m_.mesh;
    expect_word("tetrahedra");
    mesh.tetrahedra.resize(count_of_lines(8));
    mesh.delaunay = flag("delaunay");
    for (Tetrahedron& tetrahedron : mesh.tetrahedra) {
      finish_line("a tetrahedron");
      for (Index& vertex : tetrahedron) vertex = index(mesh.vertices.size(), "a vertex");
    }
    finish_line("surface");
  }

  void read_surface() {
    Surface& surface = m_.surface;
    expect_word("surface");
    const std::size_t count = count_of_lines(6);
    const bool cells = flag("cells");
    surface.triangles.resize(count);
    if (cells) surface.tetrahedron.resize(count);
    if (cells) surface.face.resize(count);
    for (std::size_t t = 0; t < count; ++t) {
      finish_line("a triangle");
      for (Index& vertex : surface.triangles[t]) vertex = index(m_.mesh.vertices.size(), "a vertex");
      if (!cells) continue;
      surface.tetrahedron[t] = index(m_.mesh.tetrahedra.size(), "a tetrahedron");
      surface.face[t] = static_cast<std::uint8_t>(index(4, "a face"));
    }
    finish_line("end");
  }

  void read_defects() {
    Defects& defects = m_.defects;
    if (flag("defects")) {
      const std::size_t count = count_of_lines(6);
      if (count != m_.atoms.size())
        fail("expected one line for each of the " + std::to_string(m_.atoms.size()) + " atoms");
      for (auto* values : {&defects.positional, &defects.vacancy, &defects.extra}) values->resize(count);
      for (std::size_t i = 0; i < count; ++i) {
        finish_line("an atom's defects");
        defects.positional[i] = real_float("a value");
        defects.vacancy[i] = real_float("a value");
        defects.extra[i] = real_float("a value");
      }
      finish_line("end");
    }
    if (flag("vacancies")) {
      defects.vacancies.resize(count_of_lines(10));
      for (VacancySite& site : defects.vacancies) {
        finish_line("a vacancy");
        site.position = point("a coordinate");
        site.species = species();
        site.votes = votes();
      }
      finish_line("end");
    }
    if (flag("extras")) {
      defects.extras.resize(count_of_lines(4));
      for (ExtraAtom& extra : defects.extras) {
        finish_line("an extra atom");
        extra.atom = index(m_.atoms.size(), "an atom");
        extra.votes = votes();
      }
      finish_line("end");
    }
    if (version_ > 1 && flag("substitutions")) {
      defects.substitutions.resize(count_of_lines(6));
      for (Substitution& substitution : defects.substitutions) {
        finish_line("a substitution");
        substitution.atom = index(m_.atoms.size(), "an atom");
        substitution.expected = species();
        substitution.vacancy = index(defects.vacancies.size(), "a vacancy");
      }
      finish_line("end");
    }
  }

  void read_fields() {
    expect_word("fields");
    const std::size_t count = count_of_lines(3);
    const std::size_t vertices = m_.mesh.vertices.size();
    // Every value is at least two bytes.
    if (count != 0 && vertices > (bytes_.size() - lines_.offset() + 1) / (2 * count))
      fail("the file is too short for its fields");
    m_.fields.resize(count);
    for (VertexField& field : m_.fields) {
      finish_line("a field's name");
      field.name = string();
      field.values.resize(vertices);
    }
    for (std::size_t v = 0; v < vertices && count != 0; ++v) {
      finish_line("the fields of a vertex");
      for (VertexField& field : m_.fields) field.values[v] = real_float("a value");
    }
    finish_line("end");
  }

  // What needs more than one line to see.
  void check() const {
    if (const auto problem = find_problem(m_, counts_of(m_))) {
      throw InputError(path_, 0, "section " + problem->section + ": " + problem->what);
    }
  }

  const std::string_view bytes_;
  const std::string& path_;
  LineReader lines_;
  Progress& progress_;
  std::string_view rest_;
  std::int64_t version_ = 0;
  std::unordered_map<std::string_view, std::uint16_t> species_;
  Material m_;
};

}  // namespace

Material read_crt(std::string_view bytes, const std::string& path, const MaterialParts& parts, Progress& progress) {
  Material material = CrtReader(bytes, path, progress).read();
  if (!parts.atoms) {
    std::vector<Species> species = std::move(material.atoms.species_table);
    material.atoms = {};
    material.atoms.species_table = std::move(species);
  }
  if (!parts.tetrahedra) {
    material.mesh.tetrahedra = {};
    material.surface.tetrahedron = {};
    material.surface.face = {};
  }
  if (!parts.surface) material.surface = {};
  if (!parts.tetrahedra && !parts.surface) {
    material.mesh.vertices = {};
    material.mesh.vertex_atom = {};
  }
  if (!parts.fields || (!parts.tetrahedra && !parts.surface)) material.fields = {};
  if (!parts.defects) material.defects = {};
  return material;
}

}  // namespace atomesh
