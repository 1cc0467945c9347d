// The table of atoms that XYZ, LAMMPS data and LAMMPS dump files hold: one line an atom, the same fields on each.
// Internal to the readers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "preprocess/read_formats.h"

namespace atomesh::reading {

class AtomRows {
 public:
  // `expected` says in messages what a whole line is, such as "\"species x y z\"".
  AtomRows(const Input& input, Atoms& atoms, std::string expected)
      : input_(input), atoms_(atoms), species_(input, atoms), expected_(std::move(expected)) {}

  // The fields of a line, from the left. Names are for messages and columns.
  void add_species() { fields_.push_back({Role::species, 0, "the species"}); }
  void add_position(std::size_t axis, std::string name) { fields_.push_back({Role::position, axis, std::move(name)}); }
  void add_id() { fields_.push_back({Role::id, 0, "id"}); }
  // A number into a new column of the atoms; `line` is where the columns are named, for the message when the name is
  // taken.
  void add_column(std::string name, std::uint64_t line, bool logical = false);
  void add_skipped(std::string name) { fields_.push_back({Role::skipped, 0, std::move(name)}); }
  // Lines may go on after the last field; what is there is passed over.
  void allow_more() { may_go_on_ = true; }
  bool had_more() const { return had_more_; }
  std::size_t fields() const { return fields_.size(); }

  // Makes room for `count` atoms, having checked that the `bytes_left` of the file can hold them. `line` is where the
  // count stands.
  void prepare(std::size_t count, std::uint64_t line, std::size_t bytes_left);
  void read(std::string_view line, std::uint64_t line_number, std::size_t atom);

 private:
  enum class Role { species, position, id, real, logical, skipped };
  struct Field {
    Role role;
    std::size_t target;  // axis of a position, index of a column
    std::string name;
  };

  [[noreturn]] void fail_row(std::string_view line, std::uint64_t line_number, const Field& field,
                             std::string_view text) const;

  const Input& input_;
  Atoms& atoms_;
  SpeciesIndex species_;
  std::string expected_;
  std::vector<Field> fields_;
  bool may_go_on_ = false;
  bool had_more_ = false;
};

// "T" or "F" and their usual variants; false when `field` is none.
bool parse_logical(std::string_view field, bool& value);

}  // namespace atomesh::reading
