// What the readers of the single formats share. Internal to read_atoms.cpp and read_*.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/text_file.h"
#include "preprocess/read_atoms.h"

namespace atomesh::reading {

struct Input {
  const std::string& path;
  std::string_view text;  // the whole file
  const ReadOptions& options;
  Progress& progress;
};

// One function a format, one file each. They fill atoms, unit cell and the report's frames, notes and skipped; the
// caller drops duplicates and counts. All throw InputError.
ReadResult read_dat(const Input& input);
ReadResult read_xyz(const Input& input);
ReadResult read_lammps_data(const Input& input);
ReadResult read_lammps_dump(const Input& input);
// The primitive and basis blocks of a .dat; its atoms are checked all the same, and may be none.
std::optional<UnitCell> read_dat_cell(const Input& input);

// "FILE:LINE: expected EXPECTED, got GOT", as an InputError; `got` as it should read in the sentence.
[[noreturn]] void fail(const Input& input, std::uint64_t line, std::string_view expected, std::string_view got);
// Text of a file for a message: in quotes, cut after 60 characters, nothing unprintable.
std::string in_quotes(std::string_view text);
// "3 fields", "1 field".
std::string count_of(std::size_t count, std::string_view noun);
// The line without a "#" comment.
std::string_view strip_comment(std::string_view line);

// A field that must be a finite number; `what` names it in the message.
double real_of(const Input& input, std::uint64_t line, std::string_view field, std::string_view what);
std::int64_t integer_of(const Input& input, std::uint64_t line, std::string_view field, std::string_view what);

// A declared number of things, each at least `min_bytes` long, as a size that memory may be reserved for: refused when
// negative, beyond the index limit, or more than the `bytes_left` of the file can hold.
std::size_t checked_count(const Input& input, std::uint64_t line, std::int64_t declared, std::size_t bytes_left,
                          std::size_t min_bytes, std::string_view noun);

// Makes the box usable or throws: a periodic box without volume is an error, an open one is dropped with a note.
void check_box(const Input& input, std::uint64_t line, Atoms& atoms, ReadReport& report);

// Index of the one frame to read of `count`. Throws UsageError when there is no such frame.
std::size_t chosen_frame(const Input& input, std::size_t count);

// Species index by name at the speed of a file: adds new names to the table of `atoms`.
class SpeciesIndex {
 public:
  SpeciesIndex(const Input& input, Atoms& atoms) : input_(input), atoms_(atoms) {}
  std::uint16_t operator()(std::string_view name, std::uint64_t line) {
    const std::uint64_t packed = pack(name);
    if (packed != 0) {
      for (std::size_t i = 0; i < recent_count_; ++i) {
        if (recent_[i] == packed) return recent_species_[i];
      }
    }
    return find(name, packed, line);
  }

 private:
  // Names of up to seven characters as one number with the length on top; 0 for longer ones.
  static std::uint64_t pack(std::string_view name) {
    if (name.size() > 7) return 0;
    std::uint64_t packed = name.size();
    for (const char c : name) packed = packed << 8 | static_cast<unsigned char>(c);
    return packed;
  }
  std::uint16_t find(std::string_view name, std::uint64_t packed, std::uint64_t line);

  const Input& input_;
  Atoms& atoms_;
  std::unordered_map<std::string, std::uint16_t> all_;
  std::array<std::uint64_t, 8> recent_{};
  std::array<std::uint16_t, 8> recent_species_{};
  std::size_t recent_count_ = 0;
};

// Reports progress every few thousand lines.
class LineProgress {
 public:
  explicit LineProgress(const Input& input) : input_(input) {}
  void at(std::size_t offset) {
    if (++lines_ % 16384 == 0) {
      input_.progress.update(static_cast<double>(offset) / static_cast<double>(input_.text.size()));
    }
  }

 private:
  const Input& input_;
  std::size_t lines_ = 0;
};

}  // namespace atomesh::reading
