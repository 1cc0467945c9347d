#include "app/cli/check_vtk_file.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

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

// Goes through a legacy file as VTK will. The parts of a grid of cells are walked one by one, so that VTK, which goes
// by the first letters of a keyword and believes every number, cannot lose its place between them; of the other grids
// only the counts are looked at.
class LegacyCheck {
 public:
  LegacyCheck(std::string_view bytes, const std::string& path) : bytes_(bytes), rest_(bytes), path_(path) {}

  void run() {
    if (!bytes_.starts_with("# vtk DataFile Version ")) {
      throw InputError(path_, 1, "expected \"# vtk DataFile Version\"");
    }
    for (int line = 0; line < 2; ++line) end_line();
    const std::string_view coding = next_word(rest_);
    binary_ = same_word(coding, "BINARY");
    if (!binary_ && !same_word(coding, "ASCII")) throw InputError(path_, 3, "expected ASCII or BINARY");
    if (!same_word(next_word(rest_), "DATASET")) throw InputError(path_, 4, "expected DATASET");
    const std::string_view kind = next_word(rest_);
    static constexpr std::array<std::string_view, 3> structured{"STRUCTURED_GRID", "STRUCTURED_POINTS",
                                                                "RECTILINEAR_GRID"};
    if (same_word(kind, "UNSTRUCTURED_GRID")) {
      walk();
    } else if (std::any_of(structured.begin(), structured.end(),
                           [&](std::string_view known) { return same_word(kind, known); })) {
      check_dimensions();
    } else {
      throw InputError(path_, 4,
                       "holds a " + std::string(kind.substr(0, 40)) +
                           "; expected a grid with volume: UNSTRUCTURED_GRID, STRUCTURED_GRID, "
                           "RECTILINEAR_GRID or STRUCTURED_POINTS");
    }
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(path_, 0, "damaged or incomplete: " + message);
  }
  void end_line() { rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size() - 1) + 1); }

  // A count that the file must be long enough for, at so many bytes each.
  std::uint64_t count(const std::string& of, std::uint64_t smallest) {
    std::int64_t value = 0;
    const std::string_view word = next_word(rest_);
    if (!parse_integer(word, value) || value < 0) {
      fail("expected the number of " + of + ", got \"" + std::string(word.substr(0, 40)) + "\"");
    }
    if (static_cast<std::uint64_t>(value) > bytes_.size() / smallest) {
      fail("announces " + std::to_string(value) + " " + of + " in " + std::to_string(bytes_.size()) + " bytes");
    }
    return static_cast<std::uint64_t>(value);
  }

  // ---- grids of cells

  void walk() {
    for (;;) {
      const std::string_view keyword = next_word(rest_);
      if (keyword.empty() || same_word(keyword, "POINT_DATA") || same_word(keyword, "CELL_DATA")) return;
      if (same_word(keyword, "FIELD")) {
        walk_field_data();
      } else if (same_word(keyword, "METADATA")) {
        walk_metadata();
      } else if (same_word(keyword, "POINTS")) {
        const std::uint64_t points = count("points", 6);
        skip_numbers("points", 3 * points, next_word(rest_));
      } else if (same_word(keyword, "CELLS")) {
        walk_cells();
      } else if (same_word(keyword, "CELL_TYPES")) {
        walk_types();
      } else {
        fail("\"" + std::string(keyword.substr(0, 40)) +
             "\" where POINTS, CELLS, CELL_TYPES, POINT_DATA or "
             "CELL_DATA should stand");
      }
    }
  }

  // Bytes of a number; 0 for what is none.
  static std::uint64_t size_of(std::string_view type) {
    static constexpr std::array<std::pair<std::string_view, std::uint64_t>, 14> types{{{"UNSIGNED_CHAR", 1},
                                                                                       {"CHAR", 1},
                                                                                       {"SIGNED_CHAR", 1},
                                                                                       {"UNSIGNED_SHORT", 2},
                                                                                       {"SHORT", 2},
                                                                                       {"UNSIGNED_INT", 4},
                                                                                       {"INT", 4},
                                                                                       {"VTKIDTYPE", 4},
                                                                                       {"FLOAT", 4},
                                                                                       {"DOUBLE", 8},
                                                                                       {"UNSIGNED_LONG", 8},
                                                                                       {"LONG", 8},
                                                                                       {"VTKTYPEINT64", 8},
                                                                                       {"VTKTYPEUINT64", 8}}};
    for (const auto& [name, size] : types) {
      if (same_word(type, name)) return size;
    }
    return 0;
  }

  void skip_numbers(const std::string& of, std::uint64_t numbers, std::string_view type) {
    const std::uint64_t size = size_of(type);
    if (size == 0) fail("\"" + std::string(type.substr(0, 40)) + "\" is no type of number");
    if (binary_) {
      end_line();
      if (numbers > rest_.size() / size) fail("ends among the " + of);
      rest_.remove_prefix(numbers * size);
      return;
    }
    double value = 0.0;
    for (std::uint64_t i = 0; i < numbers; ++i) {
      const std::string_view word = next_word(rest_);
      if (parse_real(word, value)) continue;
      fail("expected a number among the " + of + ", got \"" + std::string(word.substr(0, 40)) + "\"");
    }
  }

  void walk_field_data() {
    next_word(rest_);  // its name
    for (std::uint64_t arrays = count("arrays of a field", 4); arrays > 0; --arrays) {
      std::string_view name = next_word(rest_);
      while (same_word(name, "METADATA")) {
        walk_metadata();
        name = next_word(rest_);
      }
      const std::uint64_t components = count("components of a field", 1);
      const std::uint64_t tuples = count("values of a field", 1);
      if (components != 0 && tuples > 8 * bytes_.size() / components) fail("ends in the field " + std::string(name));
      const std::string_view type = next_word(rest_);
      if (size_of(type) == 0)
        throw InputError(
            path_, 0,
            "a field of " + std::string(type.substr(0, 40)) + " before the points cannot be read; take it out");
      skip_numbers("values of a field", components * tuples, type);
    }
  }

  // Ends with an empty line.
  void walk_metadata() {
    end_line();
    while (!rest_.empty()) {
      const std::string_view line = rest_.substr(0, rest_.find('\n'));
      end_line();
      if (line.find_first_not_of(blanks) == std::string_view::npos) return;
    }
  }

  // The cells' lists as they are in the file: each cell's numbers, one after another, and where each ends.
  void walk_cells() {
    cells_ = count("cells", 2);
    const std::uint64_t numbers = count("numbers in the list of cells", 2);
    ends_.clear();
    list_.clear();
    std::string_view peek = rest_;
    if (same_word(next_word(peek), "OFFSETS")) {  // version 5
      rest_ = peek;
      const std::vector<std::int64_t> offsets = whole_numbers("offsets of cells", cells_, next_word(rest_));
      if (!same_word(next_word(rest_), "CONNECTIVITY")) fail("expected CONNECTIVITY after the cells' offsets");
      list_ = whole_numbers("corners of cells", numbers, next_word(rest_));
      cells_ -= std::min<std::uint64_t>(cells_, 1);
      for (std::size_t i = 0; i < offsets.size(); ++i) {
        const std::int64_t before = i == 0 ? 0 : offsets[i - 1];
        const bool first_is_0 = i > 0 || offsets[i] == 0;
        if (!first_is_0 || offsets[i] < before || static_cast<std::uint64_t>(offsets[i]) > numbers) {
          fail("the offsets of the cells do not ascend within their list");
        }
        if (i > 0) ends_.push_back(static_cast<std::uint64_t>(offsets[i]));
      }
      return;
    }
    const std::vector<std::int64_t> file = whole_numbers("the list of cells", numbers, "INT");
    list_.reserve(file.size());
    for (std::uint64_t at = 0; at < numbers;) {
      const std::int64_t corners = file[at++];
      if (corners < 0 || static_cast<std::uint64_t>(corners) > numbers - at) {
        fail("a cell of " + std::to_string(corners) + " corners runs over the end of the list of cells");
      }
      const auto first = file.begin() + static_cast<std::ptrdiff_t>(at);
      list_.insert(list_.end(), first, first + corners);
      ends_.push_back(list_.size());
      at += static_cast<std::uint64_t>(corners);
    }
    if (ends_.size() != cells_) {
      fail("announces " + std::to_string(cells_) + " cells and lists " + std::to_string(ends_.size()));
    }
  }

  void walk_types() {
    const std::uint64_t count_of_types = count("types of cells", 2);
    if (count_of_types != cells_) {
      fail("announces " + std::to_string(cells_) + " cells and the types of " + std::to_string(count_of_types));
    }
    const std::vector<std::int64_t> types = whole_numbers("types of cells", count_of_types, "INT");
    constexpr std::int64_t polyhedron = 42;
    for (std::size_t c = 0; c < types.size(); ++c) {
      if (types[c] == polyhedron) check_faces(c);
    }
  }

  // A polyhedron's list: the number of faces, then of each the number of corners and these.
  void check_faces(std::size_t cell) const {
    std::uint64_t at = cell == 0 ? 0 : ends_[cell - 1];
    const std::uint64_t end = ends_[cell];
    const auto next = [&]() -> std::uint64_t {
      if (at >= end || list_[at] < 0 || static_cast<std::uint64_t>(list_[at]) > end) {
        fail("the faces of polyhedron " + std::to_string(cell) + " run over the end of its list");
      }
      return static_cast<std::uint64_t>(list_[at++]);
    };
    for (std::uint64_t faces = next(); faces > 0; --faces) {
      const std::uint64_t corners = next();
      if (corners > end - at) fail("a face of polyhedron " + std::to_string(cell) + " runs over the end of its list");
      at += corners;
    }
    if (at != end) fail("the faces of polyhedron " + std::to_string(cell) + " end before its list");
  }

  std::vector<std::int64_t> whole_numbers(const std::string& of, std::uint64_t numbers, std::string_view type) {
    const std::uint64_t size = size_of(type);
    if (size != 4 && size != 8) fail("\"" + std::string(type.substr(0, 40)) + "\" is no type of " + of);
    std::vector<std::int64_t> values;
    if (binary_) {
      end_line();
      if (numbers > rest_.size() / size) fail("ends in " + of);
      values.reserve(numbers);
      for (std::uint64_t i = 0; i < numbers; ++i) values.push_back(binary_number(i, size));
      rest_.remove_prefix(numbers * size);
      return values;
    }
    values.reserve(numbers);
    for (std::uint64_t i = 0; i < numbers; ++i) {
      const std::string_view word = next_word(rest_);
      std::int64_t value = 0;
      if (!parse_integer(word, value)) {
        fail("expected a number in " + of + ", got \"" + std::string(word.substr(0, 40)) + "\"");
      }
      values.push_back(value);
    }
    return values;
  }

  // Big-endian, of 4 or 8 bytes.
  std::int64_t binary_number(std::uint64_t at, std::uint64_t size) const {
    std::uint64_t value = 0;
    for (std::uint64_t byte = 0; byte < size; ++byte) {
      value = value << 8U | static_cast<unsigned char>(rest_[at * size + byte]);
    }
    return size == 4 ? static_cast<std::int32_t>(static_cast<std::uint32_t>(value)) : static_cast<std::int64_t>(value);
  }

  // ---- structured grids

  // The dimensions may stand behind a field; they are the first three numbers after the first word that begins so.
  void check_dimensions() {
    std::uint64_t product = 1;
    for (std::string_view word = next_word(rest_); !word.empty(); word = next_word(rest_)) {
      if (word.size() < 10 || !same_word(word.substr(0, 10), "DIMENSIONS")) continue;
      for (int axis = 0; axis < 3; ++axis) {
        // At least a bit for each point.
        product *= std::max<std::uint64_t>(count("points along an axis", 1), 1);
        if (product > 8 * bytes_.size()) {
          fail("its dimensions need more than " + std::to_string(bytes_.size()) + " bytes");
        }
      }
      return;
    }
    fail("it has no DIMENSIONS");
  }

  const std::string_view bytes_;
  std::string_view rest_;
  const std::string& path_;
  bool binary_ = false;
  std::uint64_t cells_ = 0;
  std::vector<std::int64_t> list_;
  std::vector<std::uint64_t> ends_;
};

// The text of the attribute that begins at `at`, up to its closing quote.
std::string_view attribute_value(std::string_view bytes, std::size_t at) {
  if (at >= bytes.size() || (bytes[at] != '"' && bytes[at] != '\'')) return {};
  const std::size_t end = bytes.find(bytes[at], at + 1);
  return end == std::string_view::npos ? std::string_view() : bytes.substr(at + 1, end - at - 1);
}

// The bytes that the first characters in base64 stand for; fewer where others come between.
std::string from_base64(std::string_view text, std::size_t bytes) {
  static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string result;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const std::size_t digit = digits.find(c);
    if (digit == std::string_view::npos || result.size() >= bytes) break;
    bits = bits << 6U | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    result += static_cast<char>(bits >> static_cast<unsigned>(count) & 255U);
  }
  return result;
}

// Of packed data in XML: each array begins with the number of its blocks, their size and that of the last where it is
// smaller (else 0), and then the size of each as it is packed. VTK makes room for all of them before it looks further.
class PackedXmlCheck {
 public:
  PackedXmlCheck(std::string_view bytes, std::string_view tag, const std::string& path)
      : bytes_(bytes),
        path_(path),
        big_endian_(tag.find("BigEndian") != std::string_view::npos),
        word_(tag.find("UInt64") != std::string_view::npos ? 8 : 4) {}

  void run() const {
    const std::string_view inline_data = "format=\"binary\"";
    for (std::size_t at = bytes_.find(inline_data); at != std::string_view::npos;
         at = bytes_.find(inline_data, at + 1)) {
      std::string_view text = bytes_.substr(std::min(bytes_.find('>', at), bytes_.size() - 1) + 1);
      text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
      check(text.substr(0, text.find('<')), false);
    }
    const std::size_t appended = bytes_.find("<AppendedData");
    if (appended == std::string_view::npos) return;
    const std::size_t close = std::min(bytes_.find('>', appended), bytes_.size());
    const bool raw = bytes_.substr(appended, close - appended).find("raw") != std::string_view::npos;
    const std::size_t data = std::min(bytes_.find('_', close), bytes_.size() - 1) + 1;
    const std::string_view name = " offset=";
    for (std::size_t at = bytes_.find(name); at < appended; at = bytes_.find(name, at + 1)) {
      std::int64_t offset = 0;
      const std::string_view text = attribute_value(bytes_, at + name.size());
      if (!parse_integer(text, offset) || offset < 0 ||
          static_cast<std::uint64_t>(offset) >= bytes_.size() - std::min(data, bytes_.size())) {
        throw InputError(path_, 0, "damaged or incomplete: an array begins behind the end of the file");
      }
      check(bytes_.substr(data + static_cast<std::size_t>(offset)), raw);
    }
  }

 private:
  // `text` begins with the array and may go on behind it.
  void check(std::string_view text, bool raw) const {
    const auto fail = [&] {
      throw InputError(path_, 0, "damaged or incomplete: an array's blocks are not of a size that can be in it");
    };
    std::string header;
    const auto read_words = [&](std::uint64_t words) {
      header = raw ? std::string(text.substr(0, words * word_)) : from_base64(text, words * word_);
      return header.size() == words * word_;
    };
    if (!read_words(3)) {
      if (read_words(1) && number(header, 0) == 0) return;  // an array of nothing
      fail();
    }
    // VTK takes the difference of a last block and a full one off the bytes of none.
    if (number(header, 0) == 0 && number(header, 2) != 0) fail();
    if (number(header, 0) == 0) return;
    const std::uint64_t blocks = number(header, 0);
    const std::uint64_t block_size = number(header, 1);
    const std::uint64_t last_size = number(header, 2) == 0 ? block_size : number(header, 2);
    // No packing makes more than some thousand bytes of one.
    const std::uint64_t most = 1000000 + 8192 * bytes_.size();
    if (blocks > bytes_.size() / word_ || block_size == 0 || block_size > most || last_size > block_size ||
        blocks * block_size > most || !read_words(3 + blocks)) {
      fail();
    }
    // In base64 the header is packed by itself, up to whole groups of four characters.
    const std::uint64_t behind =
        raw ? text.size() - header.size()
            : (text.size() - std::min<std::uint64_t>((header.size() + 2) / 3 * 4, text.size())) / 4 * 3;
    std::uint64_t left = behind;
    for (std::uint64_t block = 0; block < blocks; ++block) {
      const std::uint64_t size = number(header, static_cast<std::size_t>(3 + block));
      const std::uint64_t unpacked = block + 1 == blocks ? last_size : block_size;
      // What cannot be packed grows by its packing's own marks.
      if (size == 0 || size > left || size > unpacked + unpacked / 64 + 1024 || unpacked > 65536 + 8192 * size) fail();
      left -= size;
    }
  }

  std::uint64_t number(const std::string& header, std::size_t at) const {
    std::uint64_t value = 0;
    for (std::size_t b = 0; b < word_; ++b) {
      const std::size_t byte = at * word_ + (big_endian_ ? b : word_ - 1 - b);
      value = value << 8U | static_cast<unsigned char>(header[byte]);
    }
    return value;
  }

  std::string_view bytes_;
  const std::string& path_;
  bool big_endian_;
  std::size_t word_;
};

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
  // Packed, the best that grids come to is some numbers a byte.
  const std::uint64_t most = 100000 + 64 * bytes.size();
  const auto largest = [&](std::string_view name) {
    std::uint64_t result = 1;
    for (std::size_t at = bytes.find(name); at != std::string_view::npos; at = bytes.find(name, at + 1)) {
      const std::string_view text = attribute_value(bytes, at + name.size());
      std::int64_t value = 0;
      if (!parse_integer(text, value) || value < 0 || static_cast<std::uint64_t>(value) > most) {
        throw InputError(path, 0,
                         "damaged or incomplete: " + std::string(name) + "\"" + std::string(text.substr(0, 40)) +
                             "\" in " + std::to_string(bytes.size()) + " bytes");
      }
      result = std::max(result, static_cast<std::uint64_t>(value));
    }
    return result;
  };
  const std::uint64_t items =
      std::max({largest("NumberOfPoints="), largest("NumberOfCells="), largest("NumberOfTuples=")});
  if (items * largest("NumberOfComponents=") > most) {
    throw InputError(
        path, 0,
        "damaged or incomplete: announces more numbers than " + std::to_string(bytes.size()) + " bytes can hold");
  }
  if (tag.find("compressor=") != std::string_view::npos) PackedXmlCheck(bytes, tag, path).run();
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
