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

#include <optional>

#include "core/error.h"
#include "preprocess/atom_rows.h"
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
      if (fields.size() != 1 || !parse_integer(fields[0], declared)) fail(input, count_line, expected, in_quotes(line));
      const std::size_t atoms =
          checked_count(input, count_line, declared, input.text.size() - lines.offset(), 1, "atom");
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

class FrameReader {
 public:
  FrameReader(const Input& input, const Frame& frame, ReadResult& result)
      : input_(input), frame_(frame), result_(result), lines_(input.text.substr(frame.offset)) {}

  void read() {
    std::string_view line;
    lines_.next(line);
    lines_.next(line);
    const XyzComment keys = parse_xyz_comment(line);
    const std::string* lattice = keys.find("Lattice");
    const std::string* properties = keys.find("Properties");
    result_.report.format = lattice != nullptr || properties != nullptr ? "extxyz" : "xyz";
    if (lattice != nullptr) read_lattice(*lattice, keys.find("Origin"), keys.find("pbc"));
    AtomRows rows(input_, result_.atoms,
                  properties != nullptr ? "an atom with the fields of Properties" : "\"species x y z\"");
    if (properties != nullptr) {
      read_properties(*properties, rows);
    } else {
      rows.add_species();
      for (std::size_t k = 0; k < 3; ++k) rows.add_position(k, std::string(1, "xyz"[k]));
      rows.allow_more();
    }
    rows.prepare(frame_.atoms, frame_.line, input_.text.size() - frame_.offset - lines_.offset());
    LineProgress progress(input_);
    for (std::size_t atom = 0; atom < frame_.atoms; ++atom) {
      lines_.next(line);
      progress.at(frame_.offset + lines_.offset());
      rows.read(line, line_number(), atom);
    }
    if (rows.had_more()) note("The fields after species x y z have no names and are left out.");
  }

 private:
  std::uint64_t line_number() const { return frame_.line + lines_.line_number() - 1; }
  void note(std::string text) { result_.report.notes.push_back(std::move(text)); }

  void read_lattice(const std::string& lattice, const std::string* origin, const std::string* pbc) {
    Box& box = result_.atoms.box;
    const std::vector<double> numbers = numbers_of(lattice, 9, "Lattice");
    for (std::size_t i = 0; i < 9; ++i) box.vectors[i / 3][static_cast<int>(i % 3)] = numbers[i];
    if (origin != nullptr) {
      const std::vector<double> parts = numbers_of(*origin, 3, "Origin");
      box.origin = Vec3(parts[0], parts[1], parts[2]);
    }
    box.periodic = {true, true, true};
    if (pbc != nullptr) {
      const std::vector<std::string_view> parts = split_fields(*pbc);
      bool good = parts.size() == 3;
      for (std::size_t k = 0; k < 3 && good; ++k) good = parse_logical(parts[k], box.periodic[k]);
      if (!good) fail(input_, line_number(), "pbc=\"T T F\" or the like", in_quotes(*pbc));
    }
    check_box(input_, line_number(), result_.atoms, result_.report);
  }

  std::vector<double> numbers_of(const std::string& text, std::size_t count, const std::string& key) const {
    std::vector<double> numbers;
    for (const std::string_view field : split_fields(text)) {
      numbers.push_back(real_of(input_, line_number(), field, key));
    }
    if (numbers.size() != count) {
      fail(input_, line_number(), std::to_string(count) + " numbers in " + key, std::to_string(numbers.size()));
    }
    return numbers;
  }

  void read_properties(const std::string& properties, AtomRows& rows) {
    std::vector<std::string> parts(1);
    for (const char c : properties) {
      if (c == ':') {
        parts.emplace_back();
      } else {
        parts.back() += c;
      }
    }
    if (parts.size() % 3 != 0) {
      fail(input_, line_number(), "Properties as name:type:count three by three", in_quotes(properties));
    }
    bool has_species = false;
    bool has_position = false;
    bool has_id = false;
    for (std::size_t p = 0; p < parts.size(); p += 3) {
      const std::string& name = parts[p];
      const std::string kind = parts[p + 1] + ":" + parts[p + 2];
      if (name == "species" && !has_species) {
        if (kind != "S:1") fail(input_, line_number(), "species:S:1", in_quotes(name + ":" + kind));
        rows.add_species();
        has_species = true;
      } else if (name == "pos" && !has_position) {
        if (kind != "R:3") fail(input_, line_number(), "pos:R:3", in_quotes(name + ":" + kind));
        for (std::size_t k = 0; k < 3; ++k) rows.add_position(k, std::string(1, "xyz"[k]));
        has_position = true;
      } else if (name == "id" && kind == "I:1" && !has_id) {
        rows.add_id();
        has_id = true;
      } else {
        add_columns(name, parts[p + 1], parts[p + 2], rows);
      }
    }
    if (!has_species) fail(input_, line_number(), "species:S:1 in Properties", "no species");
    if (!has_position) fail(input_, line_number(), "pos:R:3 in Properties", "no pos");
  }

  void add_columns(const std::string& name, const std::string& type, const std::string& count_text, AtomRows& rows) {
    std::int64_t count = 0;
    // A thousand numbers an atom are more than any program writes, and keep a typing error from filling memory.
    if (!parse_integer(count_text, count) || count < 1 || count > 1000) {
      fail(input_, line_number(), "a count from 1 to 1000 for property " + in_quotes(name), in_quotes(count_text));
    }
    if (name.empty() || type.size() != 1 || std::string_view("SRIL").find(type[0]) == std::string_view::npos) {
      fail(input_, line_number(), "name:type:count with type S, R, I or L",
           in_quotes(name + ":" + type + ":" + count_text));
    }
    if (type == "S") note("Property " + name + " is text; it is left out.");
    for (std::int64_t i = 1; i <= count; ++i) {
      if (type == "S") {
        rows.add_skipped(name);
      } else {
        rows.add_column(count == 1 ? name : name + "_" + std::to_string(i), line_number(), type == "L");
      }
    }
  }

  const Input& input_;
  const Frame& frame_;
  ReadResult& result_;
  LineReader lines_;
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
