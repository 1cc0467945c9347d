#include "preprocess/atom_rows.h"

#include <algorithm>

#include "preprocess/memory_needs.h"

namespace atomesh::reading {

bool parse_logical(std::string_view field, bool& value) {
  value = field == "T" || field == "True" || field == "true" || field == "TRUE" || field == "1";
  return value || field == "F" || field == "False" || field == "false" || field == "FALSE" || field == "0";
}

void AtomRows::add_column(std::string name, std::uint64_t line, bool logical) {
  if (atoms_.find_column(name) != nullptr) fail(input_, line, "every column once", in_quotes(name) + " twice");
  fields_.push_back({logical ? Role::logical : Role::real, atoms_.columns.size(), name});
  atoms_.columns.push_back({std::move(name), {}});
}

void AtomRows::prepare(std::size_t count, std::uint64_t line, std::size_t bytes_left) {
  // A field takes at least a character and a separator; a quarter of that bounds the memory well enough and leaves it
  // to the line that lacks fields to say so.
  const std::size_t min_bytes = std::max<std::size_t>(1, fields_.size() / 2);
  checked_count(input_, line, static_cast<std::int64_t>(count), bytes_left, min_bytes, "atom");
  const std::size_t columns = atoms_.columns.size();
  bool ids = false;
  for (const Field& field : fields_) ids = ids || field.role == Role::id;
  require_memory_for(input_.path + ": reading", count, "atoms", memory_to_read(count, columns + (ids ? 1 : 0), ids));
  atoms_.positions.resize(count);
  atoms_.species.resize(count);
  for (const Field& field : fields_) {
    if (field.role == Role::id) atoms_.ids.resize(count);
  }
  for (Column& column : atoms_.columns) column.values.resize(count);
}

void AtomRows::read(std::string_view line, std::uint64_t line_number, std::size_t atom) {
  std::string_view rest = line;
  for (const Field& field : fields_) {
    const std::string_view text = next_field(rest);
    bool good = !text.empty();
    switch (field.role) {
      case Role::species:
        if (good) atoms_.species[atom] = species_(text, line_number);
        break;
      case Role::position:
        good = parse_real(text, atoms_.positions[atom][static_cast<int>(field.target)]);
        break;
      case Role::id:
        good = parse_integer(text, atoms_.ids[atom]);
        break;
      case Role::real:
        good = parse_real(text, atoms_.columns[field.target].values[atom]);
        break;
      case Role::logical: {
        bool value = false;
        good = parse_logical(text, value);
        atoms_.columns[field.target].values[atom] = value ? 1.0 : 0.0;
        break;
      }
      case Role::skipped:
        break;
    }
    if (!good) fail_row(line, line_number, field, text);
  }
  if (rest.empty() || next_field(rest).empty()) return;
  if (!may_go_on_) fail_row(line, line_number, fields_.back(), {});
  had_more_ = true;
}

void AtomRows::fail_row(std::string_view line, std::uint64_t line_number, const Field& field,
                        std::string_view text) const {
  const std::size_t got = split_fields(line).size();
  if (got < fields_.size() || (got > fields_.size() && !may_go_on_)) {
    fail(input_, line_number, expected_, count_of(got, "field"));
  }
  const std::string_view kind = field.role == Role::id        ? "a whole number for "
                                : field.role == Role::logical ? "T or F for "
                                                              : "a finite number for ";
  fail(input_, line_number, std::string(kind) + field.name, in_quotes(text));
}

}  // namespace atomesh::reading
