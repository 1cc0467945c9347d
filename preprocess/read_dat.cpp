// The .dat format, a text file read line by line. "#" starts a comment anywhere, blank lines mean nothing, fields are
// separated by blanks, lengths are in Å:
//
//   SPECIES X Y Z              an atom
//   primitive                  then three lines "X Y Z": the primitive vectors of the crystal
//   basis N                    then N lines "SPECIES X Y Z": the basis, Cartesian
//   radius SPECIES R           radius of this species' atom balls, R > 0
//   box                        then three lines "X Y Z periodic" or "X Y Z open": the vectors of the box,
//                              and, if it does not start at 0 0 0, a line "origin X Y Z"
//
// Blocks may stand before or after the atoms, each at most once (radius: once a species), primitive and basis only
// together. SPECIES is an element symbol or any other name without blanks and "#" that is none of the words above.
// Species are numbered in the order in which atom and radius lines first name them.

#include <algorithm>

#include "core/error.h"
#include "preprocess/dat_words.h"
#include "preprocess/memory_needs.h"
#include "preprocess/read_formats.h"

namespace atomesh::reading {

namespace {

class DatReader {
 public:
  explicit DatReader(const Input& input)
      : input_(input), lines_(input.text), progress_(input), species_(input, result_.atoms) {}

  ReadResult read() {
    chosen_frame(input_, 1);
    reserve();
    std::string_view line;
    while (lines_.next(line)) {
      progress_.at(lines_.offset());
      std::string_view rest = line;
      const std::string_view first = next_field(rest);
      if (first.empty() || first.front() == '#') continue;
      if (!is_dat_word(first.substr(0, first.find('#')))) {
        read_atom(line, first, rest);
      } else {
        read_block(strip_comment(line));
      }
    }
    finish();
    return std::move(result_);
  }

 private:
  void reserve() {
    const std::string_view sample = input_.text.substr(0, 65536);
    const auto newlines = static_cast<std::size_t>(std::count(sample.begin(), sample.end(), '\n'));
    if (newlines == 0) return;
    const std::size_t atoms = input_.text.size() / (sample.size() / newlines) + 16;
    require_memory_for(input_.path + ": reading", atoms, "atoms", memory_to_read(atoms, 0, false));
    result_.atoms.positions.reserve(atoms);
    result_.atoms.species.reserve(atoms);
  }

  void read_atom(std::string_view line, std::string_view name, std::string_view rest) {
    Vec3 position;
    bool good = name.find('#') == std::string_view::npos;
    for (int k = 0; k < 3 && good; ++k) good = parse_real(next_field(rest), position[k]);
    if (good) {
      const std::string_view tail = next_field(rest);
      good = tail.empty() || tail.front() == '#';
    }
    if (!good) position = atom_of(line, name);  // a comment without a blank before it, or an error
    if (result_.atoms.positions.size() >= no_index - 1) {
      throw InputError(input_.path, lines_.line_number(), "more atoms than the 4,294,967,294 that are supported");
    }
    result_.atoms.positions.push_back(position);
    result_.atoms.species.push_back(species_(name, lines_.line_number()));
  }

  // The slow way, which says what is wrong. `name` is cut where a comment begins.
  Vec3 atom_of(std::string_view line, std::string_view& name) const {
    const std::vector<std::string_view> fields = fields_of(strip_comment(line), 4, "\"species x y z\"");
    name = fields[0];
    return vector_of(fields, 1);
  }

  std::vector<std::string_view> fields_of(std::string_view line, std::size_t count, std::string_view expected) const {
    std::vector<std::string_view> fields = split_fields(line);
    if (fields.size() != count) fail(input_, lines_.line_number(), expected, count_of(fields.size(), "field"));
    return fields;
  }

  Vec3 vector_of(const std::vector<std::string_view>& fields, std::size_t first) const {
    Vec3 vector;
    for (int k = 0; k < 3; ++k) {
      vector[k] = real_of(input_, lines_.line_number(), fields[first + static_cast<std::size_t>(k)],
                          std::string(1, static_cast<char>('x' + k)));
    }
    return vector;
  }

  // The next line with content, without its comment.
  bool next_content(std::string_view& line) {
    while (lines_.next(line)) {
      line = strip_comment(line);
      std::string_view rest = line;
      if (!next_field(rest).empty()) return true;
    }
    return false;
  }

  std::string_view block_line(std::string_view expected) {
    std::string_view line;
    if (!next_content(line)) fail(input_, lines_.line_number(), expected, "the end of the file");
    return line;
  }

  void read_block(std::string_view line) {
    const std::string_view word = split_fields(line).front();
    if (word == "primitive") {
      read_primitive(line);
    } else if (word == "basis") {
      read_basis(line);
    } else if (word == "radius") {
      read_radius(line);
    } else if (word == "box") {
      read_box(line);
    } else {
      throw InputError(input_.path, lines_.line_number(),
                       "expected \"origin\" only right after the three vectors of a box block");
    }
  }

  void start_block(std::uint64_t& block_line_number, std::string_view name) const {
    if (block_line_number != 0) {
      fail(input_, lines_.line_number(), "one " + std::string(name) + " block",
           "a second one (the first is on line " + std::to_string(block_line_number) + ")");
    }
    block_line_number = lines_.line_number();
  }

  void read_primitive(std::string_view line) {
    start_block(primitive_line_, "primitive");
    fields_of(line, 1, "\"primitive\" alone on its line");
    for (Vec3& vector : cell_.primitive) {
      constexpr std::string_view expected = "a primitive vector \"x y z\"";
      vector = vector_of(fields_of(block_line(expected), 3, expected), 0);
    }
  }

  void read_basis(std::string_view line) {
    start_block(basis_line_, "basis");
    const std::vector<std::string_view> header = fields_of(line, 2, "\"basis N\"");
    const std::int64_t declared = integer_of(input_, basis_line_, header[1], "N of \"basis N\"");
    if (declared < 1) fail(input_, basis_line_, "at least 1 basis atom", std::to_string(declared));
    const std::size_t count =
        checked_count(input_, basis_line_, declared, input_.text.size() - lines_.offset(), 1, "basis atom");
    for (std::size_t i = 0; i < count; ++i) {
      const std::string expected =
          "basis atom " + std::to_string(i + 1) + " of " + std::to_string(count) + ", \"species x y z\"";
      const std::vector<std::string_view> fields = fields_of(block_line(expected), 4, expected);
      if (is_dat_word(fields[0])) fail(input_, lines_.line_number(), expected, in_quotes(fields[0]));
      cell_.basis.push_back({std::string(fields[0]), vector_of(fields, 1)});
    }
  }

  void read_radius(std::string_view line) {
    const std::vector<std::string_view> fields = fields_of(line, 3, "\"radius species r\"");
    const double radius = real_of(input_, lines_.line_number(), fields[2], "the radius");
    if (!(radius > 0.0)) fail(input_, lines_.line_number(), "a radius above 0", std::string(fields[2]));
    if (is_dat_word(fields[1])) fail(input_, lines_.line_number(), "a species", in_quotes(fields[1]));
    const std::uint16_t index = species_(fields[1], lines_.line_number());
    if (index >= radius_lines_.size()) radius_lines_.resize(std::size_t{index} + 1, 0);
    if (radius_lines_[index] != 0) {
      fail(input_, lines_.line_number(), "one radius of " + std::string(fields[1]),
           "a second one (the first is on line " + std::to_string(radius_lines_[index]) + ")");
    }
    radius_lines_[index] = lines_.line_number();
    result_.atoms.species_table[index].radius = radius;
  }

  void read_box(std::string_view line) {
    start_block(box_line_, "box");
    fields_of(line, 1, "\"box\" alone on its line");
    Box& box = result_.atoms.box;
    for (int k = 0; k < 3; ++k) {
      constexpr std::string_view expected = "a box vector \"x y z periodic\" or \"x y z open\"";
      const std::vector<std::string_view> fields = fields_of(block_line(expected), 4, expected);
      box.vectors[k] = vector_of(fields, 0);
      if (fields[3] != "periodic" && fields[3] != "open")
        fail(input_, lines_.line_number(), expected, in_quotes(fields[3]));
      box.periodic[k] = fields[3] == "periodic";
    }
    const LineReader before = lines_;
    std::string_view next;
    if (!next_content(next)) return;
    if (split_fields(next).front() == "origin") {
      box.origin = vector_of(fields_of(next, 4, "\"origin x y z\""), 1);
    } else {
      lines_ = before;
    }
  }

  void finish() {
    if (box_line_ != 0) {
      if (!result_.atoms.box.present()) throw InputError(input_.path, box_line_, "the box has no volume");
      check_box(input_, box_line_, result_.atoms, result_.report);
    }
    if (primitive_line_ == 0 && basis_line_ == 0) return;
    if (basis_line_ == 0) fail(input_, primitive_line_, "a basis block beside the primitive block", "none");
    if (primitive_line_ == 0) fail(input_, basis_line_, "a primitive block beside the basis block", "none");
    try {
      check_unit_cell(cell_);
    } catch (const Error& error) {
      throw InputError(input_.path, primitive_line_, error.what());
    }
    result_.unit_cell = std::move(cell_);
  }

  const Input& input_;
  LineReader lines_;
  LineProgress progress_;
  ReadResult result_;
  SpeciesIndex species_;
  UnitCell cell_;
  // 0 until the block was seen.
  std::uint64_t primitive_line_ = 0, basis_line_ = 0, box_line_ = 0;
  std::vector<std::uint64_t> radius_lines_;
};

}  // namespace

ReadResult read_dat(const Input& input) {
  return DatReader(input).read();
}

std::optional<UnitCell> read_dat_cell(const Input& input) {
  return DatReader(input).read().unit_cell;
}

}  // namespace atomesh::reading
