#include <algorithm>
#include <charconv>
#include <cstring>

#include "core/crt_material.h"
#include "core/parallel.h"
#include "core/text_file.h"

namespace atomesh {

namespace {

std::string in_quotes(std::string_view text) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (c == '\n') {
      result += "\\n";
    } else if (c == '\t') {
      result += "\\t";
    } else if (byte < 0x20 || byte == 0x7F) {
      result += "\\x";
      result += digits[byte >> 4U];
      result += digits[byte & 15U];
    } else {
      result += c;
    }
  }
  return result + '"';
}

// Appends fields separated by blanks to a text.
class Line {
 public:
  explicit Line(std::string& text) : text_(text) {}

  template <class Number>
  Line& number(Number value) {
    separate();
    char buffer[32];
    const auto result = std::to_chars(buffer, buffer + sizeof(buffer), value);
    text_.append(buffer, result.ptr);
    return *this;
  }
  Line& point(const Vec3& p) { return number(p.x).number(p.y).number(p.z); }
  Line& word(std::string_view word) {
    separate();
    text_ += word;
    return *this;
  }
  void end() {
    text_ += '\n';
    first_ = true;
  }

 private:
  void separate() {
    if (!first_) text_ += ' ';
    first_ = false;
  }

  std::string& text_;
  bool first_ = true;
};

class CrtWriter {
 public:
  CrtWriter(const std::string& path, const Material& material, Progress& progress)
      : m_(material), file_(path), progress_(progress) {
    lines_total_ = m_.atoms.size() + m_.mesh.vertices.size() + m_.mesh.tetrahedra.size() + m_.surface.triangles.size() +
                   m_.defects.positional.size() + (m_.fields.empty() ? 0 : m_.mesh.vertices.size());
  }

  void write() {
    write_heading();
    write_atoms();
    write_mesh();
    write_defects();
    write_fields();
    file_.write("end\n");
    progress_.update(1.0);
    file_.commit();
  }

 private:
  // `line(i, Line&)` appends line i; pieces are made in parallel and written in order.
  template <class MakeLine>
  void write_lines(std::size_t count, MakeLine make_line) {
    constexpr std::size_t piece = 8192;
    constexpr std::size_t batch = 16 * piece;
    for (std::size_t first = 0; first < count; first += batch) {
      const std::size_t last = std::min(count, first + batch);
      std::vector<std::string> texts((last - first + piece - 1) / piece);
      parallel_for(last - first, piece, [&](std::size_t begin, std::size_t end) {
        std::string& text = texts[begin / piece];
        text.reserve((end - begin) * 48);
        Line line(text);
        for (std::size_t i = first + begin; i < first + end; ++i) {
          make_line(i, line);
          line.end();
        }
      });
      for (const std::string& text : texts) file_.write(text);
      lines_done_ += last - first;
      progress_.update(static_cast<double>(lines_done_) / static_cast<double>(lines_total_ + 1));
    }
  }

  void write_heading() {
    std::string text(crt_magic);
    text += " " + std::to_string(crt_version) + "\n";
    text += "# A material: atoms, their volume as tetrahedra, its surface, and crystal defects. Lengths in Å.\n\n";
    Line line(text);
    const Provenance& provenance = m_.provenance;
    line.word("program").word(in_quotes(provenance.program)).end();
    line.word("input").word(in_quotes(provenance.input)).end();
    for (const auto& [name, value] : provenance.options) {
      line.word("option").word(in_quotes(name)).word(in_quotes(value)).end();
    }
    for (const auto& [name, value] : provenance.counts) line.word("count").word(in_quotes(name)).number(value).end();
    for (const StageTime& stage : provenance.stages) {
      line.word("stage").word(in_quotes(stage.name)).number(stage.ms).end();
    }
    text += "\n# name, radius\n";
    line.word("species").number(m_.atoms.species_table.size()).end();
    for (const Species& species : m_.atoms.species_table)
      line.word(in_quotes(species.name)).number(species.radius).end();
    text += '\n';
    const Box& box = m_.atoms.box;
    line.word("box").end();
    line.word("origin").point(box.origin).end();
    for (std::size_t i = 0; i < 3; ++i) {
      line.word("vector").point(box.vectors[i]).word(box.periodic[i] ? "periodic" : "open").end();
    }
    if (m_.unit_cell) {
      text += '\n';
      line.word("unit_cell").number(m_.unit_cell->basis.size()).end();
      for (const Vec3& vector : m_.unit_cell->primitive) line.word("primitive").point(vector).end();
      for (const BasisAtom& atom : m_.unit_cell->basis)
        line.word("basis").word(atom.species).point(atom.position).end();
    }
    file_.write(text);
  }

  void write_atoms() {
    const Atoms& atoms = m_.atoms;
    std::string text;
    Line line(text);
    if (!atoms.columns.empty()) {
      text += '\n';
      line.word("columns").number(atoms.columns.size()).end();
      for (const Column& column : atoms.columns) line.word(in_quotes(column.name)).end();
    }
    const bool ids = !atoms.ids.empty();
    text += "\n# x y z species";
    text += ids ? " id, columns\n" : ", columns\n";
    line.word("atoms").number(atoms.size());
    if (ids) line.word("ids");
    line.end();
    file_.write(text);
    write_lines(atoms.size(), [&](std::size_t i, Line& l) {
      l.point(atoms.positions[i]).word(atoms.species_name(i));
      if (ids) l.number(atoms.ids[i]);
      for (const Column& column : atoms.columns) l.number(column.values[i]);
    });
  }

  void write_mesh() {
    const TetMesh& mesh = m_.mesh;
    const std::vector<Vec3>& positions = m_.atoms.positions;
    const bool own = mesh.vertices.size() != positions.size() ||
                     (!positions.empty() &&
                      std::memcmp(mesh.vertices.data(), positions.data(), positions.size() * sizeof(Vec3)) != 0);
    bool identity = true;
    for (std::size_t v = 0; v < mesh.vertex_atom.size(); ++v) identity = identity && mesh.vertex_atom[v] == v;
    std::string text = "\n# x y z where they are not the atoms' own, atom where it is not the vertex's own number\n";
    Line line(text);
    line.word("vertices").number(mesh.vertices.size()).word(own ? "own" : "atoms");
    if (identity) line.word("atoms");
    line.end();
    file_.write(text);
    if (own || !identity) {
      write_lines(mesh.vertices.size(), [&](std::size_t v, Line& l) {
        if (own) l.point(mesh.vertices[v]);
        if (identity) return;
        if (mesh.vertex_atom[v] == no_index) {
          l.word("-");
        } else {
          l.number(mesh.vertex_atom[v]);
        }
      });
    }
    text = "\n# four vertices each, from 0\n";
    line.word("tetrahedra").number(mesh.tetrahedra.size());
    if (mesh.delaunay) line.word("delaunay");
    line.end();
    file_.write(text);
    write_lines(mesh.tetrahedra.size(), [&](std::size_t t, Line& l) {
      for (const Index vertex : mesh.tetrahedra[t]) l.number(vertex);
    });
    const Surface& surface = m_.surface;
    const bool cells = !surface.tetrahedron.empty();
    text = cells ? "\n# three vertices, the tetrahedron behind and which of its faces\n" : "\n# three vertices\n";
    line.word("surface").number(surface.triangles.size());
    if (cells) line.word("cells");
    line.end();
    file_.write(text);
    write_lines(surface.triangles.size(), [&](std::size_t t, Line& l) {
      for (const Index vertex : surface.triangles[t]) l.number(vertex);
      if (cells) l.number(surface.tetrahedron[t]).number(static_cast<int>(surface.face[t]));
    });
  }

  void write_defects() {
    const Defects& defects = m_.defects;
    std::string text;
    Line line(text);
    if (defects.present()) {
      text = "\n# positional, vacancy and extra of each atom\n";
      line.word("defects").number(defects.positional.size()).end();
      file_.write(text);
      write_lines(defects.positional.size(), [&](std::size_t i, Line& l) {
        l.number(defects.positional[i]).number(defects.vacancy[i]).number(defects.extra[i]);
      });
    }
    text.clear();
    if (!defects.vacancies.empty()) {
      text += "\n# x y z species votes\n";
      line.word("vacancies").number(defects.vacancies.size()).end();
      for (const VacancySite& site : defects.vacancies) {
        line.point(site.position).word(m_.atoms.species_table[site.species].name).number(site.votes).end();
      }
    }
    if (!defects.extras.empty()) {
      text += "\n# atom votes\n";
      line.word("extras").number(defects.extras.size()).end();
      for (const ExtraAtom& extra : defects.extras) line.number(extra.atom).number(extra.votes).end();
    }
    if (!defects.substitutions.empty()) {
      text += "\n# atom, species expected in its place, vacancy that it fills\n";
      line.word("substitutions").number(defects.substitutions.size()).end();
      for (const Substitution& s : defects.substitutions) {
        line.number(s.atom).word(m_.atoms.species_table[s.expected].name).number(s.vacancy).end();
      }
    }
    text += '\n';
    file_.write(text);
  }

  void write_fields() {
    if (m_.fields.empty()) return;
    std::string text = "# names, then a line for each vertex\n";
    Line line(text);
    line.word("fields").number(m_.fields.size()).end();
    for (const VertexField& field : m_.fields) line.word(in_quotes(field.name)).end();
    file_.write(text);
    write_lines(m_.mesh.vertices.size(), [&](std::size_t v, Line& l) {
      for (const VertexField& field : m_.fields) l.number(field.values[v]);
    });
    file_.write("\n");
  }

  const Material& m_;
  AtomicFile file_;
  Progress& progress_;
  std::size_t lines_total_ = 0;
  std::size_t lines_done_ = 0;
};

}  // namespace

void write_crt(const std::string& path, const Material& material, Progress& progress) {
  CrtWriter(path, material, progress).write();
}

}  // namespace atomesh
