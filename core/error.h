// Every exception atomesh throws on purpose. Each kind maps to one exit code of the program, so that a
// subcommand never has to interpret a message.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace atomesh {

// Base of the family. what() is one line (or a few) for a person: what went wrong, where, what to do.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  virtual int exit_code() const noexcept { return 2; }
};

// Wrong use of the program or of a function: unknown option, value out of range (exit code 1).
class UsageError : public Error {
 public:
  using Error::Error;
  int exit_code() const noexcept override { return 1; }
};

// A file (or its content) that cannot be used (exit code 2). The message starts with "FILE:LINE: " or
// "FILE: section NAME: ".
class InputError : public Error {
 public:
  using Error::Error;
  // `line` counts from 1; 0 leaves the line out.
  InputError(std::string_view file, std::uint64_t line, std::string_view message);
};

// Something this machine or build cannot do: no GL, not enough memory, a library left out (exit code 3).
class UnavailableError : public Error {
 public:
  using Error::Error;
  int exit_code() const noexcept override { return 3; }
};

// The user cancelled (exit code 130).
class CancelledError : public Error {
 public:
  CancelledError() : Error("cancelled") {}
  int exit_code() const noexcept override { return 130; }
};

// The candidate with the smallest edit distance to `word` (case-insensitive), or "" when none is near enough
// to be worth suggesting.
template <class Range>
std::string nearest_name(std::string_view word, const Range& candidates);

// Levenshtein distance, case-insensitive.
std::size_t edit_distance(std::string_view a, std::string_view b);

template <class Range>
std::string nearest_name(std::string_view word, const Range& candidates) {
  std::string best;
  std::size_t best_distance = word.size() / 2 + 2;
  for (const auto& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = std::string(candidate);
    }
  }
  return best;
}

}  // namespace atomesh
