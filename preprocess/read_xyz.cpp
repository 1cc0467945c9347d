// XYZ and extended XYZ. A frame is a line with the number of atoms, a comment line, and a line an atom; a file holds
// one frame or more. A comment with Lattice= or Properties= makes the frame extended XYZ:
//
//   Lattice="ax ay az bx by bz cx cy cz"   box vectors; "…", '…' and {…} all quote
//   Origin="x y z"                         of the box, 0 0 0 without it
//   pbc="T T F"                            periodic axes; all three without it when there is a Lattice
//   Properties=species:S:1:pos:R:3:…       the columns: name, type (S text, R real, I integer, L logical), how many
//
// species (S:1) and pos (R:3) are required, id (I:1) gives the atoms' ids; other numeric properties become columns,
// those of several numbers as name_1, name_2, …; further texts are left out with a note. A frame without Properties
// has species, x, y, z; what follows on the line is left out with a note.

#include <algorithm>
#include <optional>

#include "core/error.h"
#include "preprocess/read_formats.h"
#include "preprocess/xyz_comment.h"

namespace atomesh::reading {

namespace {

struct Frame {
  std::size_t offset;  // of the line with the number of atoms
  std::uint64_t line;  // its number
  std::size_t atoms;
};

struct FrameIndex {
  std::vector<Frame> frames;           // complete ones
  std::optional<InputError> breakage;  // why reading stopped before the end of the file
};

// Finds the frames by counting lines; nothing but the atom counts is looked at.
FrameIndex index_frames(const Input& input) {
  FrameIndex index;
  LineReader lines(input.text);
  LineProgress progress(input);
  std::string_view line;
  try {
    for (;;) {
      const std::size_t offset = lines.offset();
      if (!lines.next(line)) break;
      const std::vector<std::string_view> fields = split_fields(line);
      if (fields.empty()) continue;
      const std::uint64_t count_line = lines.line_number();
      constexpr std::string_view expected = "the number of atoms of a frame";
      std::int64_t declared = 0;
      if (fields.size() != 1 || !parse_integer(fields[0], declared)) fail(input, count_line, expected, quoted(line));
      const std::size_t atoms =
          checked_count(input, count_line, declared, input.text.size() - lines.offset(), 8, "atom");
      for (std::size_t i = 0; i <= atoms; ++i) {
        if (lines.next(line)) {
          progress.at(lines.offset());
          continue;
        }
        if (i == 0 && atoms == 0) break;
        fail(input, lines.line_number(),
             count_of(atoms, "atom") + " after the count on line " + std::to_string(count_line),
             std::to_string(i == 0 ? 0 : i - 1) + " before the end of the file");
      }
      index.frames.push_back({offset, count_line, atoms});
    }
  } catch (const InputError& error) {
    index.breakage = error;
  }
  return index;
}

// What one field of an atom's line means.
struct Field {
  enum class Role { species, position, id, real, logical, skipped } role;
  std::size_t target = 0;  // axis of a position, index of a column
  std::string name;
};

class FrameReader {
 public:
  FrameReader(const Input& input, const Frame& frame, ReadResult& result)
      : input_(input), frame_(frame), result_(result), lines_(input.text.substr(frame.offset)) {}

  void read() {
    std::string_view line;
    lines_.next(line);
    if (lines_.next(line)) read_comment(line);
    // Every field takes a character and a separator: no memory for what the file cannot hold.
    checked_count(input_, frame_.line, static_cast<std::int64_t>(frame_.atoms),
                  input_.text.size() - frame_.offset - lines_.offset(), 2 * fields_.size(), "atom");
    Atoms& atoms = result_.atoms;
    atoms.positions.resize(frame_.atoms);
    atoms.species.resize(frame_.atoms);
    if (has_ids_) atoms.ids.resize(frame_.atoms);
    for (Column& column : atoms.columns) column.values.resize(frame_.atoms);
    SpeciesIndex species(input_, atoms);
    LineProgress progress(input_);
    for (std::size_t atom = 0; atom < frame_.atoms; ++atom) {
      lines_.next(line);
      progress.at(frame_.offset + lines_.offset());
      read_atom(line, atom, species);
    }
    if (more_fields_) result_.report.notes.push_back("Fields after species x y z have no names; they are left out.");
  }

 private:
  std::uint64_t line_number() const { return frame_.line + lines_.line_number() - 1; }

  void read_comment(std::string_view comment) {
    const XyzComment keys = parse_xyz_comment(comment);
    const std::string* lattice = keys.find("Lattice");
    const std::string* properties = keys.find("Properties");
    extended_ = lattice != nullptr || properties != nullptr;
    result_.report.format = extended_ ? "extxyz" : "xyz";
    if (lattice != nullptr) read_lattice(*lattice, keys.find("Origin"), keys.find("pbc"));
    if (properties != nullptr) {
      read_properties(*properties);
    } else {
      fields_ = {{Field::Role::species, 0, "species"},
                 {Field::Role::position, 0, "x"},
                 {Field::Role::position, 1, "y"},
                 {Field::Role::position, 2, "z"}};
      any_more_ = true;
    }
  }

  void read_lattice(const std::string& lattice, const std::string* origin, const std::string* pbc) {
    const std::vector<std::string_view> numbers = split_fields(lattice);
    if (numbers.size() != 9) fail(input_, line_number(), "9 numbers in Lattice", std::to_string(numbers.size()));
    Box& box = result_.atoms.box;
    for (std::size_t i = 0; i < 9; ++i) {
      box.vectors[i / 3][static_cast<int>(i % 3)] = real_of(input_, line_number(), numbers[i], "Lattice");
    }
    if (origin != nullptr) {
      const std::vector<std::string_view> parts = split_fields(*origin);
      if (parts.size() != 3) fail(input_, line_number(), "3 numbers in Origin", std::to_string(parts.size()));
      for (int k = 0; k < 3; ++k) box.origin[k] = real_of(input_, line_number(), parts[k], "Origin");
    }
    box.periodic = {true, true, true};
    if (pbc != nullptr) {
      const std::vector<std::string_view> parts = split_fields(*pbc);
      if (parts.size() != 3) fail(input_, line_number(), "pbc=\"T T F\" or the like", quoted(*pbc));
      for (std::size_t k = 0; k < 3; ++k) box.periodic[k] = logical_of(parts[k], "pbc");
    }
    check_box(input_, line_number(), result_.atoms, result_.report);
  }

  bool logical_of(std::string_view field, std::string_view what) const {
    for (const std::string_view yes : {"T", "True", "true", "TRUE", "1"}) {
      if (field == yes) return true;
    }
    for (const std::string_view no : {"F", "False", "false", "FALSE", "0"}) {
      if (field == no) return false;
    }
    fail(input_, line_number(), "T or F for " + std::string(what), quoted(field));
  }

  void read_properties(const std::string& properties) {
    std::vector<std::string> parts(1);
    for (const char c : properties) {
      if (c == ':') {
        parts.emplace_back();
      } else {
        parts.back() += c;
      }
    }
    if (parts.size() % 3 != 0) {
      fail(input_, line_number(), "Properties as name:type:count three by three", quoted(properties));
    }
    bool has_species = false;
    bool has_position = false;
    for (std::size_t p = 0; p < parts.size(); p += 3) {
      const std::string& name = parts[p];
      const std::string& type = parts[p + 1];
      const std::string where = "property " + quoted(name);
      std::int64_t count = 0;
      // A thousand numbers an atom are more than any program writes, and keep a typing error from filling memory.
      if (!parse_integer(parts[p + 2], count) || count < 1 || count > 1000) {
        fail(input_, line_number(), "a count from 1 to 1000 for " + where, quoted(parts[p + 2]));
      }
      if (name.empty() || type.size() != 1 || std::string_view("SRIL").find(type[0]) == std::string_view::npos) {
        fail(input_, line_number(), "name:type:count with type S, R, I or L", quoted(name + ":" + type));
      }
      if (name == "species" && !has_species) {
        if (type != "S" || count != 1) fail(input_, line_number(), "species:S:1", quoted(type + ":" + parts[p + 2]));
        fields_.push_back({Field::Role::species, 0, name});
        has_species = true;
      } else if (name == "pos" && !has_position) {
        if (type != "R" || count != 3) fail(input_, line_number(), "pos:R:3", quoted(type + ":" + parts[p + 2]));
        for (std::size_t k = 0; k < 3; ++k) {
          fields_.push_back({Field::Role::position, k, std::string(1, "xyz"[k])});
        }
        has_position = true;
      } else if (name == "id" && type == "I" && count == 1 && !has_ids_) {
        fields_.push_back({Field::Role::id, 0, name});
        has_ids_ = true;
      } else {
        add_columns(name, type[0], static_cast<std::size_t>(count));
      }
    }
    if (!has_species) fail(input_, line_number(), "species:S:1 in Properties", "no species");
    if (!has_position) fail(input_, line_number(), "pos:R:3 in Properties", "no pos");
  }

  void add_columns(const std::string& name, char type, std::size_t count) {
    if (type == 'S') {
      result_.report.notes.push_back("Property " + name + " is text; it is left out.");
      fields_.insert(fields_.end(), count, Field{Field::Role::skipped, 0, name});
      return;
    }
    for (std::size_t i = 0; i < count; ++i) {
      Atoms& atoms = result_.atoms;
      const std::string column = count == 1 ? name : name + "_" + std::to_string(i + 1);
      if (atoms.find_column(column) != nullptr) fail(input_, line_number(), "every property once", quoted(column));
      fields_.push_back({type == 'L' ? Field::Role::logical : Field::Role::real, atoms.columns.size(), column});
      atoms.columns.push_back({column, {}});
    }
  }

  void read_atom(std::string_view line, std::size_t atom, SpeciesIndex& species) {
    Atoms& atoms = result_.atoms;
    std::string_view rest = line;
    for (const Field& field : fields_) {
      const std::string_view text = next_field(rest);
      bool good = !text.empty();
      switch (field.role) {
        case Field::Role::species:
          if (good) atoms.species[atom] = species(text, line_number());
          break;
        case Field::Role::position:
          good = parse_real(text, atoms.positions[atom][static_cast<int>(field.target)]);
          break;
        case Field::Role::id:
          good = parse_integer(text, atoms.ids[atom]);
          break;
        case Field::Role::real:
          good = parse_real(text, atoms.columns[field.target].values[atom]);
          break;
        case Field::Role::logical:
          if (good) atoms.columns[field.target].values[atom] = logical_of(text, field.name) ? 1.0 : 0.0;
          break;
        case Field::Role::skipped:
          break;
      }
      if (!good) fail_atom(line, atom, field, text);
    }
    if (rest.empty() || next_field(rest).empty()) return;
    if (!any_more_) fail_atom(line, atom, fields_.back(), {});
    more_fields_ = true;
  }

  [[noreturn]] void fail_atom(std::string_view line, std::size_t atom, const Field& field,
                              std::string_view text) const {
    const std::size_t got = split_fields(line).size();
    const bool count_wrong = any_more_ ? got < fields_.size() : got != fields_.size();
    if (!count_wrong)
      fail(input_, line_number(),
           (field.role == Field::Role::id ? "a whole number for " : "a finite number for ") + field.name, quoted(text));
    const std::string which = "atom " + std::to_string(atom + 1) + " of " + std::to_string(frame_.atoms);
    fail(input_, line_number(),
         which + (extended_ && !any_more_ ? " with the " + count_of(fields_.size(), "field") + " of Properties"
                                          : ", \"species x y z\""),
         count_of(got, "field"));
  }

  const Input& input_;
  const Frame& frame_;
  ReadResult& result_;
  LineReader lines_;
  std::vector<Field> fields_;
  bool extended_ = false;
  bool has_ids_ = false;
  bool any_more_ = false;  // further fields may follow
  bool more_fields_ = false;
};

}  // namespace

ReadResult read_xyz(const Input& input) {
  const FrameIndex index = index_frames(input);
  const std::size_t count = index.frames.size();
  // The last frame is broken and it, or one that is not there, was asked for.
  const long wanted = input.options.frame;
  if (index.breakage && (count == 0 || wanted < 0 || static_cast<std::size_t>(wanted) >= count)) throw *index.breakage;
  if (count == 0) throw InputError(input.path, 0, "holds no frame; expected the number of atoms on the first line");
  ReadResult result;
  result.report.frames = count;
  result.report.frame = chosen_frame(input, count);
  if (index.breakage) {
    result.report.notes.push_back("After " + count_of(count, "frame") +
                                  " the file is damaged: " + index.breakage->what());
  }
  FrameReader(input, index.frames[result.report.frame], result).read();
  return result;
}

}  // namespace atomesh::reading
