// LAMMPS dumps (text, styles atom and custom): frames of ITEM: sections. Columns are taken by name: of each axis the
// first there is of x, xs (scaled), xu (unwrapped), xsu (both); id orders the atoms; element names the species, else
// type does (with mass to tell the element); other numbers become columns. Boxes: orthogonal, triclinic (the bounds of
// the file enclose the tilted box) and general triclinic ("abc origin").

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "preprocess/atom_rows.h"
#include "preprocess/lammps_types.h"
#include "preprocess/read_formats.h"

namespace atomesh::reading {

namespace {

// The part of a frame before its atoms.
struct Header {
  std::int64_t declared = -1;
  std::uint64_t count_line = 0;
  std::string_view bounds;  // what follows ITEM: BOX BOUNDS
  std::array<std::string_view, 3> bound_lines;
  std::uint64_t bounds_line = 0;
  std::string_view columns;  // what follows ITEM: ATOMS
  std::size_t atoms_offset = 0;
  std::uint64_t columns_line = 0;
  std::size_t atoms = 0;  // declared, checked
};

// Takes `prefix` off the front of `line`.
bool take(std::string_view& line, std::string_view prefix) {
  if (!line.starts_with(prefix)) return false;
  line.remove_prefix(prefix.size());
  return true;
}

class DumpReader {
 public:
  explicit DumpReader(const Input& input) : input_(input), lines_(input.text), progress_(input) {}

  ReadResult read() {
    std::optional<InputError> breakage;
    // Of each frame only its header is kept; atoms are passed over line by line.
    std::vector<Header> frames;
    try {
      Header header;
      while (read_header(header)) {
        skip_atoms(header);
        had_frame_ = true;
        frames.push_back(header);
      }
    } catch (const InputError& error) {
      breakage = error;
    }
    const long wanted = input_.options.frame;
    if (breakage && (wanted < 0 || static_cast<std::size_t>(wanted) >= frames.size())) throw *breakage;
    if (frames.empty()) throw InputError(input_.path, 0, "holds no frame; expected \"ITEM: TIMESTEP\"");
    result_.report.frames = frames.size();
    result_.report.frame = chosen_frame(input_, frames.size());
    if (breakage) {
      note("After " + count_of(frames.size(), "frame") + " the file is damaged: " + breakage->what());
    }
    read_frame(frames[result_.report.frame]);
    return std::move(result_);
  }

 private:
  void note(std::string text) { result_.report.notes.push_back(std::move(text)); }

  // The next line, which must exist.
  std::string_view line_of(std::string_view expected) {
    std::string_view line;
    if (!lines_.next(line)) fail(input_, lines_.line_number(), expected, "the end of the file");
    return line;
  }

  // False at the end of the file.
  bool read_header(Header& header) {
    header = Header{};
    bool begun = false;
    std::string_view line;
    while (lines_.next(line)) {
      std::string_view item = line;
      std::string_view words = line;
      const std::string_view first = next_field(words);
      if (!begun && (first.empty() || is_remark(first, line))) continue;
      begun = true;
      constexpr std::string_view items = "\"ITEM: TIMESTEP\", NUMBER OF ATOMS, BOX BOUNDS or ATOMS";
      if (!take(item, "ITEM: ")) fail(input_, lines_.line_number(), items, in_quotes(line));
      if (take(item, "TIMESTEP")) {
        constexpr std::string_view expected = "the timestep";
        const std::string_view field = only_field(line_of(expected));
        integer_of(input_, lines_.line_number(), field, expected);
      } else if (take(item, "UNITS") || item == "TIME" || item.starts_with("TIME ")) {
        line_of("a line after ITEM: UNITS or TIME");
      } else if (take(item, "NUMBER OF ATOMS")) {
        constexpr std::string_view expected = "the number of atoms";
        const std::string_view field = only_field(line_of(expected));
        header.count_line = lines_.line_number();
        header.declared = integer_of(input_, header.count_line, field, expected);
      } else if (take(item, "BOX BOUNDS")) {
        header.bounds = item;
        header.bounds_line = lines_.line_number();
        for (std::string_view& bound : header.bound_lines) bound = line_of("three lines of box bounds");
      } else if (item == "ATOMS" || item.starts_with("ATOMS ")) {
        take(item, "ATOMS");
        finish_header(header, item);
        return true;
      } else {
        fail(input_, lines_.line_number(), items, in_quotes(line));
      }
    }
    if (begun) fail(input_, lines_.line_number(), "a frame with its ITEM: ATOMS", "the end of the file");
    return false;
  }

  // Some programs write a line of text behind a frame ("Egb = 0.936"). One that begins with a number, or has as many
  // as a position, is an atom too many.
  bool is_remark(std::string_view first, std::string_view line) {
    if (!had_frame_ || first.starts_with("ITEM") || !std::isalpha(static_cast<unsigned char>(first[0]))) return false;
    const std::vector<std::string_view> fields = split_fields(line);
    double ignored = 0.0;
    const auto is_number = [&ignored](std::string_view field) { return parse_real(field, ignored); };
    if (std::count_if(fields.begin(), fields.end(), is_number) >= 3) return false;
    if (result_.report.skipped++ == 0) {
      note("Text behind a frame is not used, first on line " + std::to_string(lines_.line_number()) + ": " +
           in_quotes(line) + ".");
    }
    return true;
  }

  static std::string_view only_field(std::string_view line) {
    const std::vector<std::string_view> fields = split_fields(line);
    return fields.size() == 1 ? fields[0] : line;
  }

  void finish_header(Header& header, std::string_view columns) {
    header.columns = columns;
    header.columns_line = lines_.line_number();
    header.atoms_offset = lines_.offset();
    if (header.count_line == 0) fail(input_, header.columns_line, "ITEM: NUMBER OF ATOMS before ITEM: ATOMS", "none");
    if (header.bounds_line == 0) fail(input_, header.columns_line, "ITEM: BOX BOUNDS before ITEM: ATOMS", "none");
    header.atoms =
        checked_count(input_, header.count_line, header.declared, input_.text.size() - header.atoms_offset, 1, "atom");
  }

  void skip_atoms(const Header& header) {
    std::string_view line;
    for (std::size_t i = 0; i < header.atoms; ++i) {
      const bool ended = !lines_.next(line);
      if (ended || line.starts_with("ITEM:")) {
        fail(input_, lines_.line_number(),
             count_of(header.atoms, "atom") + " as line " + std::to_string(header.count_line) + " says",
             std::to_string(i) + " before " + (ended ? "the end of the file" : "the next ITEM"));
      }
      progress_.at(lines_.offset());
    }
  }

  void read_frame(const Header& header) {
    Atoms& atoms = result_.atoms;
    read_box(header);
    AtomRows rows(input_, atoms, "an atom with the fields of ITEM: ATOMS");
    LineReader lines(input_.text.substr(header.atoms_offset));
    std::string_view first_row;
    if (LineReader ahead = lines; ahead.next(first_row)) choose_columns(header, first_row, rows);
    rows.prepare(header.atoms, header.count_line, input_.text.size() - header.atoms_offset);
    std::string_view line;
    for (std::size_t atom = 0; atom < header.atoms; ++atom) {
      lines.next(line);
      progress_.at(header.atoms_offset + lines.offset());
      rows.read(line, header.columns_line + lines.line_number(), atom);
    }
    if (header.atoms == 0) return;
    unscale(header);
    if (!typed_) {
      const std::vector<std::string>& names = input_.options.type_names;
      atoms.add_species(names.empty() ? "1" : names.front());
      note("The file has neither a type nor an element column; all atoms are one species.");
    } else if (!by_element_) {
      name_types(input_, masses_of_types(), atoms, result_.report);
    }
    sort_by_id(input_, atoms, [&header](std::size_t atom) { return header.columns_line + 1 + atom; });
  }

  void read_box(const Header& header) {
    Box& box = result_.atoms.box;
    std::vector<std::string_view> words = split_fields(header.bounds);
    bool tilted = false;
    bool general = false;
    if (words.size() >= 3 && words[0] == "xy" && words[1] == "xz" && words[2] == "yz") {
      tilted = true;
      words.erase(words.begin(), words.begin() + 3);
    } else if (words.size() >= 2 && words[0] == "abc" && words[1] == "origin") {
      general = true;
      words.erase(words.begin(), words.begin() + 2);
    }
    const std::size_t columns = general ? 4 : tilted ? 3 : 2;
    std::array<std::array<double, 4>, 3> rows{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t line = header.bounds_line + 1 + k;
      const std::vector<std::string_view> fields = split_fields(header.bound_lines[k]);
      // Some programs write a tilt of 0 behind the bounds of an orthogonal box.
      if (fields.size() < columns) {
        fail(input_, line, count_of(columns, "number") + " of the box bounds", in_quotes(header.bound_lines[k]));
      }
      for (std::size_t c = 0; c < columns; ++c) rows[k][c] = real_of(input_, line, fields[c], "the box bounds");
      if (!general && !(rows[k][1] >= rows[k][0]))
        fail(input_, line, "an upper bound not below the lower", in_quotes(header.bound_lines[k]));
    }
    if (general) {
      for (std::size_t k = 0; k < 3; ++k) {
        box.vectors[k] = Vec3(rows[k][0], rows[k][1], rows[k][2]);
        box.origin[static_cast<int>(k)] = rows[k][3];
      }
    } else {
      // The bounds written enclose the tilted box: LAMMPS manual, "Howto triclinic".
      const Vec3 tilt(rows[0][2], rows[1][2], rows[2][2]);
      const Vec3 low(rows[0][0] - std::min({0.0, tilt[0], tilt[1], tilt[0] + tilt[1]}),
                     rows[1][0] - std::min(0.0, tilt[2]), rows[2][0]);
      const Vec3 high(rows[0][1] - std::max({0.0, tilt[0], tilt[1], tilt[0] + tilt[1]}),
                      rows[1][1] - std::max(0.0, tilt[2]), rows[2][1]);
      box = box_from_bounds(low, high, tilt);
    }
    box.periodic = {true, true, true};
    if (words.size() == 3) {
      for (std::size_t k = 0; k < 3; ++k) box.periodic[k] = words[k].starts_with('p');
    } else if (words.empty()) {
      note("The dump does not say which axes are periodic; all three are taken to be.");
    } else {
      fail(input_, header.bounds_line, "three boundary flags such as \"pp pp ff\"", in_quotes(header.bounds));
    }
    check_box(input_, header.bounds_line, result_.atoms, result_.report);
  }

  void choose_columns(const Header& header, std::string_view first_row, AtomRows& rows) {
    const std::vector<std::string_view> names = split_fields(header.columns);
    const std::vector<std::string_view> sample = split_fields(first_row);
    const auto has = [&names](std::string_view name) {
      return std::find(names.begin(), names.end(), name) != names.end();
    };
    std::array<std::string, 3> sources;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string axis(1, "xyz"[k]);
      for (const char* kind : {"", "s", "u", "su"}) {
        if (sources[k].empty() && has(axis + kind)) sources[k] = axis + kind;
      }
      if (sources[k].empty()) {
        fail(input_, header.columns_line, "a column " + axis + ", " + axis + "s, " + axis + "u or " + axis + "su",
             in_quotes(header.columns));
      }
      scaled_[k] = sources[k].find('s') != std::string::npos;
    }
    by_element_ = has("element") && (input_.options.type_names.empty() || !has("type"));
    const std::string_view species = by_element_ ? "element" : "type";
    for (std::size_t c = 0; c < names.size(); ++c) {
      const std::string name(names[c]);
      const auto axis = std::find(sources.begin(), sources.end(), name);
      const bool again = std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(c), names[c]) !=
                         names.begin() + static_cast<std::ptrdiff_t>(c);
      double number = 0.0;
      if (again) fail(input_, header.columns_line, "every column once", in_quotes(name) + " twice");
      if (axis != sources.end()) {
        rows.add_position(static_cast<std::size_t>(axis - sources.begin()), name);
      } else if (name == species) {
        rows.add_species();
        typed_ = true;
      } else if (name == "id") {
        rows.add_id();
      } else if (c < sample.size() && !parse_real(sample[c], number) && !is_not_finite(sample[c])) {
        rows.add_skipped(name);
        if (name != "element") note("Column " + name + " is text; it is left out.");
      } else {
        rows.add_column(name, header.columns_line);
      }
    }
  }

  // "nan" and "inf" are numbers gone wrong, not text.
  static bool is_not_finite(std::string_view field) {
    if (!field.empty() && (field.front() == '-' || field.front() == '+')) field.remove_prefix(1);
    for (const std::string_view word : {"nan", "inf", "NaN", "NAN", "INF", "Inf"}) {
      if (field.starts_with(word)) return true;
    }
    return false;
  }

  void unscale(const Header& header) {
    if (!scaled_[0] && !scaled_[1] && !scaled_[2]) return;
    Atoms& atoms = result_.atoms;
    if (!atoms.box.present())
      throw InputError(input_.path, header.bounds_line, "scaled coordinates need a box with a volume");
    const Mat3 matrix = atoms.box.matrix();
    const Mat3 inverse = glm::inverse(matrix);
    const bool all = scaled_[0] && scaled_[1] && scaled_[2];
    const bool orthogonal = matrix[1][0] == 0.0 && matrix[2][0] == 0.0 && matrix[2][1] == 0.0 && matrix[0][1] == 0.0 &&
                            matrix[0][2] == 0.0 && matrix[1][2] == 0.0;
    if (!all && !orthogonal) {
      throw InputError(input_.path, header.columns_line,
                       "scaled and unscaled coordinates are mixed in a tilted box; expected one kind");
    }
    for (std::size_t i = 0; i < atoms.size(); ++i) {
      Vec3& p = atoms.positions[i];
      Vec3 fraction = p;
      for (int k = 0; k < 3; ++k) {
        if (!scaled_[static_cast<std::size_t>(k)]) fraction[k] = inverse[k][k] * (p[k] - atoms.box.origin[k]);
      }
      const Vec3 position = atoms.box.origin + matrix * fraction;
      for (int k = 0; k < 3; ++k) {
        if (scaled_[static_cast<std::size_t>(k)]) p[k] = position[k];
        if (std::isfinite(p[k])) continue;
        throw InputError(input_.path, header.columns_line + 1 + i,
                         "the position is beyond every number; expected scaled coordinates near 0 to 1");
      }
    }
  }

  // Types of which every atom has the same mass.
  TypeNames masses_of_types() const {
    TypeNames names;
    const Atoms& atoms = result_.atoms;
    const Column* mass = atoms.find_column("mass");
    if (mass == nullptr) return names;
    std::vector<double> masses(atoms.species_table.size(), -1.0);
    std::vector<bool> mixed(atoms.species_table.size(), false);
    for (std::size_t i = 0; i < atoms.size(); ++i) {
      double& known = masses[atoms.species[i]];
      if (known < 0.0) known = mass->values[i];
      if (known != mass->values[i]) mixed[atoms.species[i]] = true;
    }
    for (std::size_t t = 0; t < masses.size(); ++t) {
      if (!mixed[t]) names.masses[atoms.species_table[t].name] = masses[t];
    }
    return names;
  }

  const Input& input_;
  LineReader lines_;
  LineProgress progress_;
  ReadResult result_;
  bool had_frame_ = false;
  std::array<bool, 3> scaled_{};
  bool typed_ = false;       // a column names the species
  bool by_element_ = false;  // and it is "element"
};

}  // namespace

ReadResult read_lammps_dump(const Input& input) {
  return DumpReader(input).read();
}

}  // namespace atomesh::reading
