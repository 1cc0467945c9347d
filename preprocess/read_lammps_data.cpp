// LAMMPS data files: a title line, a header, then sections in any order, of which Atoms, Masses and Atom Type Labels
// are read. The atom style stands behind "Atoms #"; where it does not, it is told from the first line of the section:
//
//   5 fields                                      atomic      id type x y z
//   6, the third a type                           molecular   id molecule type x y z
//   6 otherwise                                   charge      id type q x y z
//   7, the third a type                           full        id molecule type q x y z
//   7 otherwise                                   sphere      id type diameter density x y z
//   8, the last three whole numbers               atomic with image flags
//   8 otherwise                                   electron    id type q spin radius x y z
//   9 or 10, the last three whole numbers         as 6 or 7, with image flags
//
// Image flags are not applied: positions stay in the box. A data file says nothing about boundaries; LAMMPS's own
// default, periodic along all three vectors, is taken. A species is named by the options, a type label or comment
// ("1 28.0855 # Si") that is an element, the element of the mass, or the label or the type itself.

#include <algorithm>
#include <array>

#include "core/error.h"
#include "preprocess/atom_rows.h"
#include "preprocess/lammps_types.h"
#include "preprocess/read_formats.h"

namespace atomesh::reading {

namespace {

struct AtomStyle {
  std::string_view name;
  std::string_view fields;  // "-" is left out; "*": hybrid, whatever follows is left out
};

// LAMMPS manual, read_data, "Atoms section".
constexpr std::array<AtomStyle, 17> styles{{
    {"angle", "id mol type x y z"},
    {"atomic", "id type x y z"},
    {"body", "id type - - x y z"},
    {"bond", "id mol type x y z"},
    {"charge", "id type q x y z"},
    {"dipole", "id type q x y z mux muy muz"},
    {"dpd", "id type - x y z"},
    {"edpd", "id type - - x y z"},
    {"electron", "id type q - - x y z"},
    {"ellipsoid", "id type - - x y z"},
    {"full", "id mol type q x y z"},
    {"hybrid", "id type x y z *"},
    {"line", "id mol type - - x y z"},
    {"molecular", "id mol type x y z"},
    {"peri", "id type - - x y z"},
    {"sphere", "id type - - x y z"},
    {"tri", "id mol type - - x y z"},
}};

const AtomStyle* style_named(std::string_view name) {
  for (const AtomStyle& style : styles) {
    if (style.name == name) return &style;
  }
  return nullptr;
}

class DataReader {
 public:
  explicit DataReader(const Input& input) : input_(input), lines_(input.text), progress_(input) {}

  ReadResult read() {
    chosen_frame(input_, 1);
    std::string_view line;
    if (!lines_.next(line)) fail(input_, 0, "a LAMMPS data file", "an empty one");  // the title, whatever it says
    read_header();
    if (declared_atoms_ < 0) fail(input_, lines_.line_number(), "\"N atoms\" in the header", "none");
    if (declared_atoms_ == 0) fail(input_, atoms_line_, "at least one atom", "0 atoms");
    while (at_section_) read_section();
    if (!has_atoms_) fail(input_, lines_.line_number(), "an Atoms section", "the end of the file");
    finish();
    return std::move(result_);
  }

 private:
  void note(std::string text) { result_.report.notes.push_back(std::move(text)); }

  // The next line with content; comments are left on.
  bool next_content(std::string_view& line) {
    while (lines_.next(line)) {
      progress_.at(lines_.offset());
      std::string_view rest = line;
      const std::string_view first = next_field(rest);
      if (!first.empty() && first.front() != '#') return true;
    }
    return false;
  }

  void read_header() {
    std::string_view line;
    while (next_content(line)) {
      const std::vector<std::string_view> fields = split_fields(strip_comment(line));
      double ignored = 0.0;
      if (!parse_real(fields[0], ignored)) {
        if (is_letter(fields[0].front())) {
          start_section(line);
          return;
        }
        fail(input_, lines_.line_number(), "a line of the header or a section", in_quotes(line));
      }
      read_header_line(fields);
    }
  }

  static bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

  void read_header_line(const std::vector<std::string_view>& fields) {
    const std::uint64_t line = lines_.line_number();
    const auto ends_with = [&fields](std::size_t numbers, std::initializer_list<std::string_view> words) {
      return fields.size() == numbers + words.size() &&
             std::equal(words.begin(), words.end(), fields.begin() + static_cast<std::ptrdiff_t>(numbers));
    };
    const auto number = [&](std::size_t i) { return real_of(input_, line, fields[i], fields.back()); };
    const auto vector = [&] { return Vec3(number(0), number(1), number(2)); };
    if (ends_with(1, {"atoms"})) {
      declared_atoms_ = integer_of(input_, line, fields[0], "the number of atoms");
      atoms_line_ = line;
      checked_count(input_, line, declared_atoms_, input_.text.size() - lines_.offset(), 1, "atom");
    } else if (ends_with(1, {"atom", "types"})) {
      types_ = integer_of(input_, line, fields[0], "the number of atom types");
    } else if (ends_with(3, {"xy", "xz", "yz"})) {
      tilt_ = vector();
    } else if (ends_with(3, {"abc", "origin"})) {
      general_.origin = vector();
    } else {
      for (int k = 0; k < 3; ++k) {
        const std::string axis(1, static_cast<char>('x' + k));
        if (ends_with(2, {axis + "lo", axis + "hi"})) {
          low_[k] = number(0);
          high_[k] = number(1);
          if (!(high_[k] >= low_[k])) fail(input_, line, axis + "hi not below " + axis + "lo", in_quotes(fields[1]));
          box_line_ = line;
        }
        if (ends_with(3, {std::string(1, static_cast<char>('a' + k)) + "vec"})) {
          general_.vectors[static_cast<std::size_t>(k)] = vector();
          box_line_ = line;
        }
      }
      // Anything else counts what is not read: bonds, ellipsoids, …
    }
  }

  // `line` names a section; its comment may name the atom style.
  void start_section(std::string_view line) {
    const std::vector<std::string_view> words = split_fields(strip_comment(line));
    section_.clear();
    for (const std::string_view word : words) section_ += (section_.empty() ? "" : " ") + std::string(word);
    const std::size_t hash = line.find('#');
    const std::vector<std::string_view> comment =
        split_fields(hash == std::string_view::npos ? "" : line.substr(hash + 1));
    section_comment_ = comment.empty() ? "" : std::string(comment[0]);
    at_section_ = true;
  }

  void read_section() {
    at_section_ = false;
    if (section_ == "Atoms") {
      read_atoms();
    } else if (section_ == "Masses") {
      read_masses();
    } else if (section_ == "Atom Type Labels") {
      for (std::int64_t i = 0; i < types_; ++i) {
        const std::vector<std::string_view> fields = split_fields(strip_comment(section_line()));
        if (fields.size() != 2) fail(input_, lines_.line_number(), "\"type label\"", count_of(fields.size(), "field"));
        labels_[std::string(fields[0])] = std::string(fields[1]);
      }
    }
    skip_to_section();
  }

  static bool is_read(std::string_view section) {
    return section == "Atoms" || section == "Masses" || section == "Atom Type Labels";
  }

  // To the next section that is read. The others are not looked into; their lines may begin with anything.
  void skip_to_section() {
    if (!is_read(section_)) skipped_sections_.push_back(section_);
    std::string_view line;
    while (next_content(line)) {
      if (is_letter(line[line.find_first_not_of(" \t")])) {
        start_section(line);
        if (is_read(section_)) return;
        at_section_ = false;
        if (skipped_sections_.size() < 20) skipped_sections_.push_back(section_);
      } else if (is_read(section_)) {
        fail(input_, lines_.line_number(), "the end of section " + section_ + " after as many lines as the header says",
             in_quotes(line));
      }
    }
  }

  std::string_view section_line() {
    std::string_view line;
    if (!next_content(line)) {
      fail(input_, lines_.line_number(), "the next line of section " + section_, "the end of the file");
    }
    return line;
  }

  void read_masses() {
    for (std::int64_t i = 0; i < types_; ++i) {
      const std::string_view line = section_line();
      const std::vector<std::string_view> fields = split_fields(strip_comment(line));
      if (fields.size() != 2) fail(input_, lines_.line_number(), "\"type mass\"", count_of(fields.size(), "field"));
      const std::string type(fields[0]);
      names_.masses[type] = real_of(input_, lines_.line_number(), fields[1], "the mass");
      const std::size_t hash = line.find('#');
      if (hash == std::string_view::npos) continue;
      std::string_view comment = line.substr(hash + 1);
      const std::string_view word = next_field(comment);
      if (!word.empty()) names_.labels[type] = std::string(word);
    }
  }

  void read_atoms() {
    if (has_atoms_) fail(input_, lines_.line_number(), "one Atoms section", "a second one");
    has_atoms_ = true;
    section_offset_ = lines_.offset();
    section_start_ = lines_.line_number();
    const auto count = static_cast<std::size_t>(declared_atoms_);
    std::string_view line = strip_comment(section_line());
    const std::vector<std::string_view> first = split_fields(line);
    const AtomStyle& style = choose_style(first);
    AtomRows rows(input_, result_.atoms, "an atom of style " + std::string(style.name) + " (" + described(style) + ")");
    add_fields(style, first, rows);
    rows.prepare(count, atoms_line_, input_.text.size() - section_offset_);
    for (std::size_t atom = 0;;) {
      rows.read(line, lines_.line_number(), atom);
      if (++atom == count) break;
      if (!next_content(line)) {
        fail(input_, lines_.line_number(),
             count_of(count, "atom") + " as line " + std::to_string(atoms_line_) + " says",
             std::to_string(atom) + " before the end of the file");
      }
      line = strip_comment(line);
    }
  }

  static std::string described(const AtomStyle& style) {
    std::string text(style.fields);
    std::replace(text.begin(), text.end(), '-', '_');
    return text;
  }

  const AtomStyle& choose_style(const std::vector<std::string_view>& first) {
    if (!section_comment_.empty()) {
      if (const AtomStyle* style = style_named(section_comment_)) return *style;
      std::string names;
      for (const AtomStyle& style : styles) names += (names.empty() ? "" : ", ") + std::string(style.name);
      fail(input_, section_start_, "an atom style of " + names, in_quotes(section_comment_));
    }
    const auto whole = [&first](std::size_t i) {
      std::int64_t ignored = 0;
      return parse_integer(first[i], ignored);
    };
    std::size_t fields = first.size();
    const bool images = fields >= 8 && whole(fields - 1) && whole(fields - 2) && whole(fields - 3);
    if (images) fields -= 3;
    std::int64_t third = 0;
    const bool third_is_type = fields > 2 && parse_integer(first[2], third) && third >= 1 && third <= types_;
    std::string_view name;
    if (fields == 5) name = "atomic";
    if (fields == 6) name = third_is_type ? "molecular" : "charge";
    if (fields == 7) name = third_is_type ? "full" : "sphere";
    if (fields == 8) name = "electron";
    if (name.empty()) {
      fail(input_, lines_.line_number(), "the atom style behind \"Atoms\", as in \"Atoms # full\"",
           "none, and atoms of " + count_of(first.size(), "field"));
    }
    note("The file does not name its atom style; its " + count_of(first.size(), "field") + " are read as " +
         std::string(name) + (images ? " with image flags." : "."));
    return *style_named(name);
  }

  void add_fields(const AtomStyle& style, const std::vector<std::string_view>& first, AtomRows& rows) {
    for (const std::string_view field : split_fields(style.fields)) {
      if (field == "id") {
        rows.add_id();
      } else if (field == "type") {
        rows.add_species();
      } else if (field == "-") {
        rows.add_skipped("a number of style " + std::string(style.name));
      } else if (field == "*") {
        rows.allow_more();
        note("Atom style hybrid: the fields after id type x y z are left out.");
        return;
      } else if (field.size() == 1 && field[0] >= 'x' && field[0] <= 'z') {
        rows.add_position(static_cast<std::size_t>(field[0] - 'x'), std::string(field));
      } else {
        rows.add_column(std::string(field), lines_.line_number());
      }
    }
    if (first.size() == rows.fields() + 3) {
      for (const char* flag : {"nx", "ny", "nz"}) rows.add_skipped(flag);
      note("Image flags are not applied.");
    }
  }

  // The line of the atom at index `atom` of the section, for messages.
  std::uint64_t line_of_atom(std::size_t atom) const {
    LineReader lines(input_.text.substr(section_offset_));
    std::string_view line;
    while (lines.next(line)) {
      std::string_view rest = line;
      const std::string_view first = next_field(rest);
      if (!first.empty() && first.front() != '#' && atom-- == 0) break;
    }
    return section_start_ + lines.line_number();
  }

  void finish() {
    Atoms& atoms = result_.atoms;
    atoms.box = general_.present() ? general_ : box_from_bounds(low_, high_, tilt_);
    if (box_line_ != 0) {
      atoms.box.periodic = {true, true, true};
      note("A data file does not say which axes are periodic; all three are taken to be.");
      check_box(input_, box_line_, atoms, result_.report);
    } else {
      atoms.box = Box{};
    }
    check_types();
    for (const auto& [type, label] : labels_) {
      names_.labels[type] = label;
      // Atoms and masses may name the type by its label.
      names_.labels[label] = label;
      if (const auto mass = names_.masses.find(label); mass != names_.masses.end()) names_.masses[type] = mass->second;
      if (const auto mass = names_.masses.find(type); mass != names_.masses.end()) names_.masses[label] = mass->second;
    }
    name_types(input_, names_, atoms, result_.report);
    sort_by_id(input_, atoms, [this](std::size_t atom) { return line_of_atom(atom); });
    std::string skipped;
    for (const std::string& section : skipped_sections_) skipped += (skipped.empty() ? "" : ", ") + section;
    if (!skipped.empty()) note("Sections not used: " + skipped + ".");
  }

  void check_types() const {
    const Atoms& atoms = result_.atoms;
    const auto known = [this](const std::string& type) {
      std::int64_t number = 0;
      if (parse_integer(type, number)) return number >= 1 && number <= types_;
      return std::any_of(labels_.begin(), labels_.end(), [&type](const auto& label) { return label.second == type; });
    };
    for (std::size_t s = 0; s < atoms.species_table.size(); ++s) {
      if (known(atoms.species_table[s].name)) continue;
      const auto at = std::find(atoms.species.begin(), atoms.species.end(), s) - atoms.species.begin();
      fail(input_, line_of_atom(static_cast<std::size_t>(at)), "an atom type from 1 to " + std::to_string(types_),
           in_quotes(atoms.species_table[s].name));
    }
  }

  const Input& input_;
  LineReader lines_;
  LineProgress progress_;
  ReadResult result_;
  std::int64_t declared_atoms_ = -1;
  std::uint64_t atoms_line_ = 0;
  std::int64_t types_ = 0;
  Vec3 low_{-0.5}, high_{0.5}, tilt_{0.0};  // the bounds LAMMPS assumes for an axis that is not given
  Box general_;                             // of a general triclinic cell
  std::uint64_t box_line_ = 0;
  bool at_section_ = false;  // section_ is one to read, and its title line was just taken
  std::string section_, section_comment_;
  bool has_atoms_ = false;
  std::size_t section_offset_ = 0;   // of the line after "Atoms"
  std::uint64_t section_start_ = 0;  // number of the line "Atoms"
  TypeNames names_;
  std::map<std::string, std::string> labels_;  // of the section Atom Type Labels
  std::vector<std::string> skipped_sections_;  // the first ones
};

}  // namespace

ReadResult read_lammps_data(const Input& input) {
  return DataReader(input).read();
}

}  // namespace atomesh::reading
