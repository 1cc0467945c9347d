#include "preprocess/read_atoms.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/content_hash.h"
#include "core/error.h"
#include "core/file_extension.h"
#include "preprocess/read_formats.h"

namespace atomesh {

namespace {

using reading::Input;

struct Format {
  std::string_view name;
  std::string_view extensions;  // blank-separated, lower case
  ReadResult (*read)(const Input&);
};

constexpr std::array<Format, 4> formats{{
    {"dat", ".dat", reading::read_dat},
    {"xyz", ".xyz .extxyz", reading::read_xyz},
    {"lammps-data", ".data .lmp .lammps", reading::read_lammps_data},
    {"lammps-dump", ".dump .lammpstrj", reading::read_lammps_dump},
}};

const Format& format_named(std::string_view name) {
  for (const Format& format : formats) {
    if (format.name == name) return format;
  }
  const std::vector<std::string> names = read_format_names();
  std::string list;
  for (const std::string& known : names) list += (list.empty() ? "" : ", ") + known;
  const std::string nearest = nearest_name(name, names);
  throw UsageError("format " + reading::in_quotes(name) + ": expected one of " + list +
                   (nearest.empty() ? "" : "; did you mean " + nearest + "?"));
}

const Format* format_by_extension(const std::string& path) {
  const std::string extension = lower_extension(path);
  for (const Format& format : formats) {
    for (const std::string_view known : split_fields(format.extensions)) {
      if (extension == known) return &format;
    }
  }
  return nullptr;
}

// A number in the place of the species is more often another program's index (TetGen's .node) than a name.
bool is_atom_line(std::string_view line) {
  const std::vector<std::string_view> fields = split_fields(reading::strip_comment(line));
  double ignored = 0.0;
  return fields.size() == 4 && !parse_real(fields[0], ignored) && parse_real(fields[1], ignored) &&
         parse_real(fields[2], ignored) && parse_real(fields[3], ignored);
}

// Which format the first lines are written in; nullptr when they could be anything.
const Format* format_by_content(std::string_view text) {
  LineReader lines(text.substr(0, 65536));
  std::string_view line;
  bool first = true;
  const Format* guess = nullptr;
  for (int content = 0; content < 100 && lines.next(line);) {
    const std::vector<std::string_view> fields = split_fields(reading::strip_comment(line));
    std::int64_t integer = 0;
    if (fields.empty()) continue;
    ++content;
    if (fields[0] == "ITEM:") return &format_named("lammps-dump");
    if (first && fields.size() == 1 && parse_integer(fields[0], integer)) return &format_named("xyz");
    if ((fields.size() == 2 && fields[1] == "atoms" && parse_integer(fields[0], integer)) ||
        (fields.size() == 4 && fields[2] == "xlo" && fields[3] == "xhi")) {
      return &format_named("lammps-data");
    }
    const bool block = fields[0] == "primitive" || fields[0] == "basis" || fields[0] == "box" || fields[0] == "radius";
    if (first && (is_atom_line(line) || block)) guess = &format_named("dat");
    first = false;
  }
  return guess;
}

// Formats that are often handed in by mistake, told by their first bytes.
void refuse_binary(const std::string& path, std::string_view text) {
  const auto starts = [text](std::string_view magic) { return text.starts_with(magic); };
  std::string_view packed;
  if (starts("\x1f\x8b")) packed = "gzip";
  if (starts("\xfd"
             "7zXZ")) {
    packed = "xz";
  }
  if (starts("BZh")) packed = "bzip2";
  if (starts("\x28\xb5\x2f\xfd")) packed = "zstd";
  if (starts("PK\x03\x04")) packed = "zip";
  if (!packed.empty()) {
    throw InputError(path, 0, "is compressed (" + std::string(packed) + "); expected text: uncompress it first");
  }
  if (text.substr(0, 4096).find('\0') != std::string_view::npos) {
    throw InputError(path, 0, "is a binary file; expected text (.dat, .xyz, LAMMPS data or dump)");
  }
}

const Format& choose_format(const std::string& path, std::string_view text, const ReadOptions& options) {
  if (!options.format.empty()) return format_named(options.format);
  // What the lines plainly are counts for more than the name: many dumps are called .xyz, many XYZ files .dat.
  if (const Format* format = format_by_content(text)) return *format;
  if (const Format* format = format_by_extension(path)) return *format;
  throw InputError(path, 0,
                   "is in no format that is read; expected .dat, XYZ, LAMMPS data or LAMMPS dump (name the format if "
                   "it is one of them)");
}

std::uint64_t bits_of(double coordinate) {
  return std::bit_cast<std::uint64_t>(coordinate + 0.0);  // -0.0 + 0.0 is 0.0
}

std::uint64_t hash_of(const Vec3& p, std::uint16_t species) {
  std::uint64_t hash = species;
  for (int k = 0; k < 3; ++k) {
    hash = (hash ^ bits_of(p[k])) * 0x9E3779B97F4A7C15u;
    hash ^= hash >> 29;
  }
  return hash;
}

// A metre away an atom's place is rounded to a millionth of an Å. What lies farther is in another unit or damaged, and
// its volumes would overflow.
void check_places(const std::string& path, const Atoms& atoms, Progress& progress) {
  constexpr double farthest = 1e10;  // Å
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    if (i % 65536 == 0) progress.check();
    for (int k = 0; k < 3; ++k) {
      const double x = atoms.positions[i][k];
      if (std::abs(x) <= farthest) continue;
      throw InputError(path, 0,
                       fmt::format("atom {} has {} {:g} Å; expected coordinates within a metre of the origin", i + 1,
                                   std::array{"x", "y", "z"}[static_cast<std::size_t>(k)], x));
    }
  }
}

// Indices of the atoms that equal no earlier one. Open addressing; a slot holds the upper half of the hash beside the
// index, so that the positions are looked at only for likely duplicates, and slots are fetched ahead of their use.
std::vector<Index> distinct_atoms(const Atoms& atoms, Progress& progress) {
  constexpr std::size_t ahead = 32;
  const std::size_t count = atoms.size();
  const std::size_t mask = std::bit_ceil(2 * count + 1) - 1;
  std::vector<std::uint64_t> slots(mask + 1, ~std::uint64_t{0});
  std::array<std::uint64_t, ahead> hashes{};
  std::vector<Index> kept;
  const auto prepare = [&](std::size_t i) {
    hashes[i % ahead] = hash_of(atoms.positions[i], atoms.species[i]);
    __builtin_prefetch(&slots[hashes[i % ahead] & mask], 1);
  };
  for (std::size_t i = 0; i < std::min(ahead, count); ++i) prepare(i);
  bool all = true;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 65536 == 0) progress.check();
    const std::uint64_t hash = hashes[i % ahead];
    const std::uint64_t tag = hash & ~std::uint64_t{0xFFFFFFFF};
    bool duplicate = false;
    std::size_t slot = hash & mask;
    for (; slots[slot] != ~std::uint64_t{0}; slot = (slot + 1) & mask) {
      const auto other = static_cast<Index>(slots[slot]);
      if ((slots[slot] & ~std::uint64_t{0xFFFFFFFF}) == tag && atoms.species[other] == atoms.species[i] &&
          atoms.positions[other] == atoms.positions[i]) {
        duplicate = true;
        break;
      }
    }
    if (duplicate) {
      if (all) {
        for (std::size_t k = 0; k < i; ++k) kept.push_back(static_cast<Index>(k));
        all = false;
      }
    } else {
      slots[slot] = tag | static_cast<Index>(i);
      if (!all) kept.push_back(static_cast<Index>(i));
    }
    if (i + ahead < count) prepare(i + ahead);
  }
  if (all) kept.resize(0);
  return kept;
}

}  // namespace

ReadResult read_atoms(const std::string& path, const ReadOptions& options, Progress& progress) {
  progress.stage("read_atoms");
  ReadResult result;
  {
    const MappedFile file(path);
    if (file.bytes().empty()) throw InputError(path, 0, "is empty; expected atoms");
    refuse_binary(path, file.bytes());
    const Format& format = choose_format(path, file.bytes(), options);
    result = format.read(Input{path, file.bytes(), options, progress});
    if (result.report.format.empty()) result.report.format = format.name;
    result.report.bytes = file.bytes().size();
    result.report.hash = content_hash(file.bytes(), progress);
  }
  ReadReport& report = result.report;
  if (result.atoms.positions.empty()) throw InputError(path, 0, "holds no atoms; expected at least one");
  check_places(path, result.atoms, progress);
  const std::vector<Index> kept = distinct_atoms(result.atoms, progress);
  if (!kept.empty()) {
    report.duplicates = result.atoms.size() - kept.size();
    result.atoms = result.atoms.subset(kept);
    report.notes.push_back(reading::count_of(report.duplicates, "atom") +
                           " dropped: same species and position as an earlier one.");
  }
  report.atoms = result.atoms.size();
  progress.update(1.0);
  return result;
}

std::vector<std::string> read_format_names() {
  std::vector<std::string> names;
  for (const Format& format : formats) names.emplace_back(format.name);
  return names;
}

bool has_atoms_extension(const std::string& path) {
  return format_by_extension(path) != nullptr;
}

UnitCell read_unit_cell(const std::string& path) {
  const MappedFile file(path);
  refuse_binary(path, file.bytes());
  const ReadOptions options;
  std::optional<UnitCell> cell = reading::read_dat_cell(Input{path, file.bytes(), options, no_progress()});
  if (!cell) throw InputError(path, 0, "holds no unit cell; expected a primitive and a basis block");
  return *std::move(cell);
}

}  // namespace atomesh
