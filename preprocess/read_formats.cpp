#include "preprocess/read_formats.h"

#include <cmath>

#include "core/elements.h"
#include "core/error.h"

namespace atomesh::reading {

void fail(const Input& input, std::uint64_t line, std::string_view expected, std::string_view got) {
  throw InputError(input.path, line, "expected " + std::string(expected) + ", got " + std::string(got));
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 60;
  std::string result = "\"";
  for (const char c : text.substr(0, longest)) {
    const bool printable = static_cast<unsigned char>(c) >= 0x20 && c != 0x7f;
    result += printable ? c : '?';
  }
  result += text.size() > longest ? "…\"" : "\"";
  return result;
}

std::string count_of(std::size_t count, std::string_view noun) {
  return std::to_string(count) + " " + std::string(noun) + (count == 1 ? "" : "s");
}

std::string_view strip_comment(std::string_view line) {
  return line.substr(0, line.find('#'));
}

double real_of(const Input& input, std::uint64_t line, std::string_view field, std::string_view what) {
  double value = 0.0;
  if (!parse_real(field, value)) fail(input, line, "a finite number for " + std::string(what), in_quotes(field));
  return value;
}

std::int64_t integer_of(const Input& input, std::uint64_t line, std::string_view field, std::string_view what) {
  std::int64_t value = 0;
  if (!parse_integer(field, value)) fail(input, line, "a whole number for " + std::string(what), in_quotes(field));
  return value;
}

std::size_t checked_count(const Input& input, std::uint64_t line, std::int64_t declared, std::size_t bytes_left,
                          std::size_t min_bytes, std::string_view noun) {
  const std::string nouns = std::string(noun) + "s";
  if (declared < 0) fail(input, line, "a number of " + nouns, std::to_string(declared));
  const auto count = static_cast<std::uint64_t>(declared);
  // The last line may lack its newline.
  if (count > (bytes_left + 1) / min_bytes) {
    throw InputError(input.path, line,
                     std::to_string(declared) + " " + nouns + " are announced; expected as many lines, but only " +
                         std::to_string(bytes_left) + " bytes follow");
  }
  if (count >= no_index) {
    throw InputError(input.path, line, std::to_string(declared) + " " + nouns + "; expected at most 4,294,967,294");
  }
  return count;
}

void check_box(const Input& input, std::uint64_t line, Atoms& atoms, ReadReport& report) {
  Box& box = atoms.box;
  if (!box.present()) return;
  double product = 1.0;
  for (const Vec3& vector : box.vectors) product *= glm::length(vector);
  const double volume = std::abs(box.volume());
  // Not a plain comparison with 0: vectors meant to be coplanar are so only up to rounding.
  if (std::isfinite(product) && volume > 1e-9 * product) return;
  if (box.any_periodic() || !std::isfinite(product)) {
    throw InputError(input.path, line, "the box has no volume; expected three independent vectors of finite length");
  }
  report.notes.push_back("The box has no volume and no periodic axis; it is not used.");
  box = Box{};
}

std::size_t chosen_frame(const Input& input, std::size_t count) {
  const long frame = input.options.frame;
  if (frame == -1) return count - 1;
  if (frame < -1 || static_cast<std::size_t>(frame) >= count) {
    throw UsageError(input.path + ": frame " + std::to_string(frame) + ": the file has " + count_of(count, "frame") +
                     "; expected 0 to " + std::to_string(count - 1) + ", or -1 for the last");
  }
  return static_cast<std::size_t>(frame);
}

std::uint16_t SpeciesIndex::find(std::string_view name, std::uint64_t packed, std::uint64_t line) {
  const auto [place, added] = all_.try_emplace(std::string(name), std::uint16_t{0});
  if (added) {
    if (atoms_.species_table.size() >= 65535) {
      throw InputError(input_.path, line, "more than 65,535 different species; expected a species name in this field");
    }
    place->second = static_cast<std::uint16_t>(atoms_.species_table.size());
    atoms_.species_table.push_back({place->first, default_species_radius(place->first)});
  }
  if (packed != 0 && recent_count_ < recent_.size()) {
    recent_[recent_count_] = packed;
    recent_species_[recent_count_++] = place->second;
  }
  return place->second;
}

}  // namespace atomesh::reading
