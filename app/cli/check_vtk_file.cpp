#include "app/cli/check_vtk_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>

#include "app/cli/next_word.h"
#include "core/error.h"
#include "core/text_file.h"

namespace atomesh::cli {

namespace {

constexpr std::string_view blanks = " \t\r\n";

bool same_word(std::string_view a, std::string_view upper) {
  return a.size() == upper.size() && std::equal(a.begin(), a.end(), upper.begin(), [](char x, char y) {
           return (x >= 'a' && x <= 'z' ? static_cast<char>(x - 'a' + 'A') : x) == y;
         });
}

class LegacyCheck {
 public:
  LegacyCheck(std::string_view bytes, const std::string& path) : bytes_(bytes), path_(path) {}

  void run() {
    std::string_view head = bytes_;
    const std::string_view magic = "# vtk DataFile Version ";
    if (!head.starts_with(magic)) throw InputError(path_, 1, "expected \"# vtk DataFile Version\"");
    for (int line = 0; line < 2; ++line) head.remove_prefix(std::min(head.find('\n'), head.size() - 1) + 1);
    const std::string_view coding = next_word(head);
    binary_ = same_word(coding, "BINARY");
    if (!binary_ && !same_word(coding, "ASCII")) throw InputError(path_, 3, "expected ASCII or BINARY");
    check_kind(head);
    check_points();
    check_dimensions();
    check_cells();
  }

 private:
  // What follows the first `keyword` in capitals or small letters that stands between blanks.
  std::optional<std::string_view> behind(std::string_view keyword) const {
    const char small = static_cast<char>(keyword[0] - 'A' + 'a');
    for (std::size_t i = 1; i + keyword.size() < bytes_.size(); ++i) {
      if ((bytes_[i] != keyword[0] && bytes_[i] != small) || blanks.find(bytes_[i - 1]) == std::string_view::npos) {
        continue;
      }
      if (blanks.find(bytes_[i + keyword.size()]) == std::string_view::npos) continue;
      if (same_word(bytes_.substr(i, keyword.size()), keyword)) return bytes_.substr(i + keyword.size());
    }
    return {};
  }

  // A count that the file must be long enough for, at so many bytes each.
  std::uint64_t count(std::string_view& rest, const char* of, std::uint64_t smallest) const {
    std::int64_t value = 0;
    if (!parse_integer(next_word(rest), value) || value < 0) {
      throw InputError(path_, 0, std::string("damaged: the number of ") + of + " is none");
    }
    if (static_cast<std::uint64_t>(value) > bytes_.size() / smallest) {
      throw InputError(path_, 0,
                       "damaged or incomplete: announces " + std::to_string(value) + " " + of + " in " +
                           std::to_string(bytes_.size()) + " bytes");
    }
    return static_cast<std::uint64_t>(value);
  }

  void check_kind(std::string_view head) const {
    static constexpr std::array<std::string_view, 4> with_volume{"UNSTRUCTURED_GRID", "STRUCTURED_GRID",
                                                                 "STRUCTURED_POINTS", "RECTILINEAR_GRID"};
    if (!same_word(next_word(head), "DATASET")) throw InputError(path_, 4, "expected DATASET");
    const std::string_view kind = next_word(head);
    for (const std::string_view known : with_volume) {
      if (same_word(kind, known)) return;
    }
    throw InputError(path_, 4,
                     "holds a " + std::string(kind.substr(0, 40)) +
                         "; expected a grid with volume: UNSTRUCTURED_GRID, STRUCTURED_GRID, "
                         "RECTILINEAR_GRID or STRUCTURED_POINTS");
  }

  void check_points() const {
    if (auto rest = behind("POINTS")) count(*rest, "points", 6);
  }

  void check_dimensions() const {
    auto rest = behind("DIMENSIONS");
    if (!rest) return;
    std::uint64_t product = 1;
    for (int axis = 0; axis < 3; ++axis) {
      // At least a bit for each point.
      product *= std::max<std::uint64_t>(count(*rest, "points along an axis", 1), 1);
      if (product > 8 * bytes_.size()) {
        throw InputError(
            path_, 0,
            "damaged or incomplete: its dimensions need more than " + std::to_string(bytes_.size()) + " bytes");
      }
    }
  }

  void check_cells() const {
    auto rest = behind("CELLS");
    if (!rest) return;
    const std::uint64_t cells = count(*rest, "cells", 2);
    const std::uint64_t numbers = count(*rest, "numbers in the list of cells", 2);
    std::string_view peek = *rest;
    if (same_word(next_word(peek), "OFFSETS")) return;  // version 5: offsets, which are checked when they are used
    std::uint64_t listed = 0;
    if (binary_) {
      rest->remove_prefix(std::min(rest->find('\n'), rest->size() - 1) + 1);
      if (numbers > rest->size() / 4) throw InputError(path_, 0, "damaged or incomplete: the list of cells ends early");
      for (std::uint64_t at = 0; at < numbers; ++listed) at = behind_cell(at, binary_number(*rest, at), numbers);
    } else {
      for (std::uint64_t at = 0; at < numbers; ++listed) {
        const std::uint64_t next = behind_cell(at, text_number(*rest), numbers);
        for (++at; at < next; ++at) text_number(*rest);
      }
    }
    if (listed != cells) {
      throw InputError(path_, 0,
                       "damaged: announces " + std::to_string(cells) + " cells and lists " + std::to_string(listed));
    }
  }

  std::uint64_t behind_cell(std::uint64_t at, std::int64_t corners, std::uint64_t numbers) const {
    if (corners < 0 || static_cast<std::uint64_t>(corners) >= numbers - at) {
      throw InputError(
          path_, 0,
          "damaged: a cell of " + std::to_string(corners) + " corners runs over the end of the list of cells");
    }
    return at + static_cast<std::uint64_t>(corners) + 1;
  }

  static std::int64_t binary_number(std::string_view list, std::uint64_t at) {
    std::array<unsigned char, 4> bytes{};
    std::memcpy(bytes.data(), list.data() + 4 * at, 4);
    return static_cast<std::int32_t>(std::uint32_t{bytes[0]} << 24U | std::uint32_t{bytes[1]} << 16U |
                                     std::uint32_t{bytes[2]} << 8U | std::uint32_t{bytes[3]});
  }
  std::int64_t text_number(std::string_view& rest) const {
    std::int64_t value = 0;
    const std::string_view word = next_word(rest);
    if (!parse_integer(word, value)) {
      throw InputError(path_, 0,
                       "damaged or incomplete: expected a number in the list of cells, got \"" +
                           std::string(word.substr(0, 40)) + "\"");
    }
    return value;
  }

  const std::string_view bytes_;
  const std::string& path_;
  bool binary_ = false;
};

// The text of the attribute that begins at `at`, up to its closing quote.
std::string_view attribute_value(std::string_view bytes, std::size_t at) {
  if (at >= bytes.size() || (bytes[at] != '"' && bytes[at] != '\'')) return {};
  const std::size_t end = bytes.find(bytes[at], at + 1);
  return end == std::string_view::npos ? std::string_view() : bytes.substr(at + 1, end - at - 1);
}

void check_xml(std::string_view bytes, const std::string& path) {
  const std::size_t start = bytes.substr(0, 65536).find("<VTKFile");
  if (start == std::string_view::npos) throw InputError(path, 0, "expected a VTK file in XML, which begins <VTKFile");
  const std::string_view tag = bytes.substr(start, bytes.find('>', start) - start);
  const std::size_t type = tag.find("type=");
  const std::string_view kind = type == std::string_view::npos ? "" : attribute_value(tag, type + 5);
  if (kind != "UnstructuredGrid") {
    throw InputError(path, 0,
                     "holds a VTK file of type \"" + std::string(kind.substr(0, 40)) +
                         "\"; expected UnstructuredGrid (others can be saved as legacy .vtk)");
  }
  // Compressed, the best packed data take a byte for each few thousand.
  const std::uint64_t most = 1000000 + 8192 * bytes.size();
  for (const std::string_view name : {"NumberOfPoints=", "NumberOfCells=", "NumberOfTuples=", "NumberOfComponents="}) {
    for (std::size_t at = bytes.find(name); at != std::string_view::npos; at = bytes.find(name, at + 1)) {
      const std::string_view text = attribute_value(bytes, at + name.size());
      std::int64_t value = 0;
      const bool read = parse_integer(text, value);
      if (read && value >= 0 && static_cast<std::uint64_t>(value) <= most) continue;
      throw InputError(path, 0,
                       "damaged or incomplete: " + std::string(name) + "\"" + std::string(text.substr(0, 40)) +
                           "\" in " + std::to_string(bytes.size()) + " bytes");
    }
  }
}

}  // namespace

void check_vtk_file(const std::string& path, const std::string& format) {
  const MappedFile file(path);
  if (format == "vtu") {
    check_xml(file.bytes(), path);
  } else {
    LegacyCheck(file.bytes(), path).run();
  }
}

}  // namespace atomesh::cli
