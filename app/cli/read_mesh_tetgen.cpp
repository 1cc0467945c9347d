// TetGen's .node and .ele (https://wias-berlin.de/software/tetgen/fformats.html): text, # comments, numbered from 0
// or 1.
#include <filesystem>

#include "app/cli/mesh_cells.h"
#include "core/error.h"
#include "core/text_file.h"

namespace atomesh::cli {

namespace {

constexpr std::uint64_t lines_per_check = 1 << 14;

// One of the two files: a line that says how many, then as many lines.
class TetgenFile {
 public:
  TetgenFile(const std::string& path, Progress& progress) : file_(path), lines_(file_.bytes()), progress_(progress) {}

  void next_line(const char* expected) {
    std::string_view line;
    while (lines_.next(line)) {
      if (lines_.line_number() % lines_per_check == 0) progress_.check();
      rest_ = line.substr(0, line.find('#'));
      std::string_view peek = rest_;
      if (!next_field(peek).empty()) return;
    }
    fail(std::string("the file ends too early; expected ") + expected);
  }
  std::int64_t integer(const char* expected) {
    std::int64_t value = 0;
    const std::string_view field = next_field(rest_);
    if (!parse_integer(field, value))
      fail(std::string("expected ") + expected + ", got \"" + std::string(field) + "\"");
    return value;
  }
  double real(const char* expected) {
    double value = 0.0;
    const std::string_view field = next_field(rest_);
    if (!parse_real(field, value)) fail(std::string("expected ") + expected + ", got \"" + std::string(field) + "\"");
    return value;
  }
  bool more() const {
    std::string_view peek = rest_;
    return !next_field(peek).empty();
  }
  // A number of lines with so many fields each; no more than the file has room for.
  std::uint64_t count(const char* of, std::uint64_t fields) {
    const std::int64_t value = integer(of);
    if (value < 0 || static_cast<std::uint64_t>(value) > file_.bytes().size() / (2 * fields)) {
      fail(std::to_string(value) + " " + of + " cannot be in this file");
    }
    return static_cast<std::uint64_t>(value);
  }
  // Of the lines' attributes: none is more than a file of this size can have.
  std::uint64_t attributes() {
    if (!more()) return 0;
    const std::int64_t value = integer("a number of attributes");
    if (value < 0 || static_cast<std::uint64_t>(value) > file_.bytes().size() / 2) {
      fail(std::to_string(value) + " attributes cannot be in this file");
    }
    return static_cast<std::uint64_t>(value);
  }
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(file_.path(), lines_.line_number(), message);
  }
  std::uint64_t bytes() const { return file_.bytes().size(); }

 private:
  MappedFile file_;
  LineReader lines_;
  Progress& progress_;
  std::string_view rest_;
};

// Named attribute_1, attribute_2, … as nobody else names them.
void make_fields(std::vector<VertexField>& fields, const char* name, std::uint64_t count, std::uint64_t lines) {
  for (std::uint64_t a = 0; a < count; ++a) {
    fields.push_back({name + std::to_string(a + 1), std::vector<float>(lines)});
  }
}

// Returns the number of the first point.
std::int64_t read_nodes(const std::string& path, MeshCells& cells, Progress& progress) {
  TetgenFile file(path, progress);
  file.next_line("the number of points");
  const std::uint64_t points = file.count("points", 4);
  if (file.more() && file.integer("the dimension, 3") != 3) file.fail("expected points in three dimensions");
  const std::uint64_t attributes = file.attributes();
  if (points * attributes > file.bytes() / 2) file.fail("the file is too short for its attributes");
  if (points >= no_index) file.fail("more than 4,294,967,294 points");
  make_fields(cells.point_fields, "attribute_", attributes, points);
  std::int64_t first = 0;
  for (std::uint64_t p = 0; p < points; ++p) {
    file.next_line("a point");
    const std::int64_t number = file.integer("a point's number");
    if (p == 0) first = number;
    if (number != first + static_cast<std::int64_t>(p) || (first != 0 && first != 1)) {
      file.fail("expected the points numbered one after another from 0 or 1, got " + std::to_string(number));
    }
    Vec3 at{};
    for (int axis = 0; axis < 3; ++axis) at[axis] = file.real("a coordinate");
    cells.points.push_back(at);
    for (auto& field : cells.point_fields) field.values[p] = static_cast<float>(file.real("an attribute"));
  }
  return first;
}

void read_elements(const std::string& path, std::int64_t first_point, MeshCells& cells, Progress& progress) {
  TetgenFile file(path, progress);
  file.next_line("the number of tetrahedra");
  const std::uint64_t count = file.count("tetrahedra", 5);
  const std::int64_t corners = file.more() ? file.integer("the corners of each, 4 or 10") : 4;
  if (corners != 4 && corners != 10) file.fail("expected tetrahedra of 4 or 10 points, got " + std::to_string(corners));
  const std::uint64_t attributes = file.attributes();
  if (count * attributes > file.bytes() / 2) file.fail("the file is too short for its attributes");
  make_fields(cells.cell_fields, "region_", attributes, count);
  for (std::uint64_t t = 0; t < count; ++t) {
    file.next_line("a tetrahedron");
    file.integer("a tetrahedron's number");
    for (std::int64_t c = 0; c < corners; ++c) {
      const std::int64_t corner = file.integer("a corner") - first_point;
      if (corner < 0 || static_cast<std::uint64_t>(corner) >= cells.points.size()) {
        file.fail("point " + std::to_string(corner + first_point) + " is not among the " +
                  std::to_string(cells.points.size()) + " points");
      }
      // Of ten, those in the middle of the edges come last.
      if (c < 4) cells.corners.push_back(static_cast<std::uint64_t>(corner));
    }
    for (auto& field : cells.cell_fields) field.values[t] = static_cast<float>(file.real("an attribute"));
    cells.kinds.push_back(FileCell::simple);
    cells.shapes.push_back(CellShape::tetrahedron);
    cells.first.push_back(cells.corners.size());
  }
  if (corners == 10) cells.notes.push_back("curved tetrahedra are shown with straight edges");
}

}  // namespace

MeshCells read_tetgen_cells(const std::string& path, Progress& progress) {
  const std::filesystem::path given(path);
  const std::string nodes = std::filesystem::path(given).replace_extension(".node").string();
  const std::string elements = std::filesystem::path(given).replace_extension(".ele").string();
  for (const std::string& file : {nodes, elements}) {
    if (!std::filesystem::exists(file)) {
      throw InputError(path, 0,
                       "expected " + std::filesystem::path(file).filename().string() +
                           " beside it: TetGen's points and tetrahedra stand in two files");
    }
  }
  MeshCells cells;
  const std::int64_t first = read_nodes(nodes, cells, progress);
  read_elements(elements, first, cells, progress);
  return cells;
}

}  // namespace atomesh::cli
