#include "preprocess/write_atoms.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "core/error.h"
#include "core/text_file.h"
#include "preprocess/dat_words.h"

namespace atomesh {

namespace {

// Text gathered in large pieces on its way into a file.
class TextWriter {
 public:
  explicit TextWriter(AtomicFile& file) : file_(file) { buffer_.reserve(capacity + 4096); }

  TextWriter& operator<<(std::string_view text) {
    buffer_ += text;
    return *this;
  }
  // The shortest text that reads back to the same bits.
  TextWriter& operator<<(double value) { return number(value); }
  TextWriter& operator<<(std::int64_t value) { return number(value); }
  TextWriter& operator<<(const Vec3& v) { return *this << v.x << " " << v.y << " " << v.z; }
  void end_line() {
    buffer_ += '\n';
    if (buffer_.size() >= capacity) flush();
  }
  void flush() {
    file_.write(buffer_);
    buffer_.clear();
  }

 private:
  static constexpr std::size_t capacity = 1 << 20;

  template <class Number>
  TextWriter& number(Number value) {
    char digits[32];
    const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
    buffer_.append(digits, end);
    return *this;
  }

  AtomicFile& file_;
  std::string buffer_;
};

bool finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool has_any_of(std::string_view text, std::string_view characters) {
  return text.find_first_of(characters) != std::string_view::npos;
}

constexpr std::string_view blanks = " \t\r\n\v\f";

// Nothing is written that the readers would refuse.
void check_writable(const std::string& path, const Atoms& atoms) {
  if (atoms.positions.empty()) throw Error(path + ": there are no atoms to write");
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    if (!finite(atoms.positions[i])) {
      throw Error(path + ": atom " + std::to_string(i) + " has a position that is not finite; it cannot be written");
    }
  }
}

void check_dat_name(const std::string& path, std::string_view name) {
  if (name.empty() || has_any_of(name, blanks) || has_any_of(name, "#") || is_dat_word(name)) {
    throw Error(path + ": a species named \"" + std::string(name) +
                "\" cannot be written to .dat; expected a name without blanks and \"#\" that is no word of the format");
  }
}

void check_xyz_name(const std::string& path, std::string_view kind, std::string_view name, std::string_view forbidden) {
  if (name.empty() || has_any_of(name, blanks) || has_any_of(name, forbidden)) {
    throw Error(path + ": a " + std::string(kind) + " named \"" + std::string(name) + "\" cannot be written to .xyz");
  }
}

void write_dat(const std::string& path, TextWriter& text, const Atoms& atoms, const std::optional<UnitCell>& cell,
               Progress& progress) {
  // The radius lines also keep the order of the species.
  for (const Species& species : atoms.species_table) {
    check_dat_name(path, species.name);
    (text << "radius " << species.name << " " << species.radius).end_line();
  }
  if (cell) {
    (text << "primitive").end_line();
    for (const Vec3& vector : cell->primitive) (text << vector).end_line();
    (text << "basis " << static_cast<std::int64_t>(cell->basis.size())).end_line();
    for (const BasisAtom& atom : cell->basis) {
      check_dat_name(path, atom.species);
      (text << atom.species << " " << atom.position).end_line();
    }
  }
  if (atoms.box.present()) {
    (text << "box").end_line();
    for (std::size_t k = 0; k < 3; ++k) {
      (text << atoms.box.vectors[k] << (atoms.box.periodic[k] ? " periodic" : " open")).end_line();
    }
    if (atoms.box.origin != Vec3(0.0)) (text << "origin " << atoms.box.origin).end_line();
  }
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    (text << atoms.species_name(i) << " " << atoms.positions[i]).end_line();
    if (i % 16384 == 0) progress.update(static_cast<double>(i) / static_cast<double>(atoms.size()));
  }
}

void write_xyz(const std::string& path, TextWriter& text, const Atoms& atoms, Progress& progress) {
  (text << static_cast<std::int64_t>(atoms.size())).end_line();
  if (atoms.box.present()) {
    const auto& [a, b, c] = atoms.box.vectors;
    text << "Lattice=\"" << a << " " << b << " " << c << "\" Origin=\"" << atoms.box.origin << "\" pbc=\"";
    for (std::size_t k = 0; k < 3; ++k) text << (k > 0 ? " " : "") << (atoms.box.periodic[k] ? "T" : "F");
    text << "\" ";
  }
  for (const Species& species : atoms.species_table) check_xyz_name(path, "species", species.name, "");
  text << "Properties=species:S:1:pos:R:3";
  if (!atoms.ids.empty()) text << ":id:I:1";
  for (const Column& column : atoms.columns) {
    check_xyz_name(path, "column", column.name, ":\"'{}=\\");
    text << ":" << column.name << ":R:1";
  }
  text.end_line();
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    text << atoms.species_name(i) << " " << atoms.positions[i];
    if (!atoms.ids.empty()) text << " " << atoms.ids[i];
    for (const Column& column : atoms.columns) text << " " << column.values[i];
    text.end_line();
    if (i % 16384 == 0) progress.update(static_cast<double>(i) / static_cast<double>(atoms.size()));
  }
}

}  // namespace

void write_atoms(const std::string& path, const Atoms& atoms, const std::optional<UnitCell>& unit_cell,
                 Progress& progress) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension != ".dat" && extension != ".xyz") {
    throw UsageError(path + ": atoms are written as .dat or .xyz; expected one of these extensions, got \"" +
                     extension + "\"");
  }
  progress.stage("write_atoms");
  check_writable(path, atoms);
  AtomicFile file(path);
  TextWriter text(file);
  if (extension == ".dat") {
    write_dat(path, text, atoms, unit_cell, progress);
  } else {
    write_xyz(path, text, atoms, progress);
  }
  text.flush();
  file.commit();
  progress.update(1.0);
}

}  // namespace atomesh
