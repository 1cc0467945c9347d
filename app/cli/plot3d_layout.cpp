#include "app/cli/plot3d_layout.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>

#include "app/cli/next_word.h"
#include "core/geometry.h"
#include "core/text_file.h"

namespace atomesh::cli {

namespace {

constexpr std::uint64_t most_grids = 100000;

// Reads numbers of a binary file one after another; fails at its end.
class Cursor {
 public:
  Cursor(std::string_view bytes, bool big_endian) : bytes_(bytes), big_endian_(big_endian) {}

  std::optional<std::uint32_t> number() {
    if (at_ + 4 > bytes_.size()) return {};
    std::uint32_t value = 0;
    std::memcpy(&value, bytes_.data() + at_, 4);
    at_ += 4;
    if (!big_endian_) return value;
    return value >> 24U | (value >> 8U & 0xFF00U) | (value << 8U & 0xFF0000U) | value << 24U;
  }
  // A record's length, before or after it.
  bool mark(std::uint64_t length) { return number() == static_cast<std::uint32_t>(length); }
  void skip(std::uint64_t bytes) { at_ += bytes; }
  std::uint64_t at() const { return at_; }

 private:
  std::string_view bytes_;
  bool big_endian_;
  std::uint64_t at_ = 0;
};

std::uint64_t points_of(const std::array<std::uint64_t, 3>& grid) {
  return grid[0] * grid[1] * grid[2];
}

// No number of points whose product could overflow passes.
bool sensible(const std::array<std::uint64_t, 3>& grid) {
  if (std::any_of(grid.begin(), grid.end(), [](std::uint64_t n) { return n < 1 || n > 1000000; })) return false;
  return points_of(grid) < no_index;
}

// What both kinds of file begin with.
bool read_dimensions(Cursor& cursor, Plot3dLayout& layout) {
  std::uint64_t grids = 1;
  if (layout.multi_grid) {
    if (layout.record_marks && !cursor.mark(4)) return false;
    const auto count = cursor.number();
    if (!count || *count < 1 || *count > most_grids) return false;
    if (layout.record_marks && !cursor.mark(4)) return false;
    grids = *count;
  }
  if (layout.record_marks && !cursor.mark(12 * grids)) return false;
  for (std::uint64_t g = 0; g < grids; ++g) {
    std::array<std::uint64_t, 3> grid{};
    for (std::uint64_t& n : grid) {
      const auto number = cursor.number();
      if (!number) return false;
      n = *number;
    }
    if (!sensible(grid)) return false;
    layout.grids.push_back(grid);
  }
  return !layout.record_marks || cursor.mark(12 * grids);
}

bool only_zeros(std::string_view bytes) {
  return bytes.find_first_not_of('\0') == std::string_view::npos;
}

// Where the file of this layout ends; 0 when its marks are wrong or it is too short.
std::uint64_t end_of_grids(std::string_view bytes, Plot3dLayout& layout) {
  Cursor cursor(bytes, layout.big_endian);
  if (!read_dimensions(cursor, layout)) return 0;
  for (const auto& grid : layout.grids) {
    const std::uint64_t each = 3 * (layout.double_precision ? 8 : 4) + (layout.iblank ? 4 : 0);
    const std::uint64_t size = points_of(grid) * each;
    if (layout.record_marks && !cursor.mark(size)) return 0;
    cursor.skip(size);
    if (cursor.at() > bytes.size()) return 0;
    if (layout.record_marks && !cursor.mark(size)) return 0;
  }
  return cursor.at();
}

std::uint64_t end_of_solutions(std::string_view bytes, Plot3dLayout& layout) {
  Cursor cursor(bytes, layout.big_endian);
  if (!read_dimensions(cursor, layout)) return 0;
  const std::uint64_t real = layout.double_precision ? 8 : 4;
  for (const auto& grid : layout.grids) {
    for (const std::uint64_t size : {4 * real, 5 * real * points_of(grid)}) {
      if (layout.record_marks && !cursor.mark(size)) return 0;
      cursor.skip(size);
      if (cursor.at() > bytes.size()) return 0;
      if (layout.record_marks && !cursor.mark(size)) return 0;
    }
  }
  return cursor.at();
}

// ---- text: numbers with blanks between them

std::size_t count_numbers(std::string_view text) {
  std::size_t count = 0;
  while (!next_word(text).empty()) ++count;
  return count;
}

bool looks_like_numbers(std::string_view bytes) {
  const std::string_view start = bytes.substr(0, 4096);
  return !start.empty() && start.find_first_not_of("0123456789+-.eEdD \t\r\n") == std::string_view::npos;
}

bool read_text_dimensions(std::string_view& rest, Plot3dLayout& layout) {
  const auto number = [&](std::uint64_t& n) {
    std::int64_t value = 0;
    if (!parse_integer(next_word(rest), value) || value < 1) return false;
    n = static_cast<std::uint64_t>(value);
    return true;
  };
  std::uint64_t grids = 1;
  if (layout.multi_grid && (!number(grids) || grids > most_grids)) return false;
  for (std::uint64_t g = 0; g < grids; ++g) {
    std::array<std::uint64_t, 3> grid{};
    for (std::uint64_t& n : grid) {
      if (!number(n)) return false;
    }
    if (!sensible(grid)) return false;
    layout.grids.push_back(grid);
  }
  return true;
}

std::optional<Plot3dLayout> find_text_layout(std::string_view bytes) {
  for (const bool multi_grid : {false, true}) {
    Plot3dLayout layout;
    layout.text = true;
    layout.multi_grid = multi_grid;
    std::string_view rest = bytes;
    if (!read_text_dimensions(rest, layout)) continue;
    std::uint64_t points = 0;
    for (const auto& grid : layout.grids) points += points_of(grid);
    const std::uint64_t numbers = count_numbers(rest);
    layout.iblank = numbers == 4 * points;
    if (layout.iblank || numbers == 3 * points) return layout;
  }
  return {};
}

template <class Visit>
void for_each_binary_layout(Visit&& visit) {
  for (const bool multi_grid : {false, true}) {
    for (const bool record_marks : {true, false}) {
      for (const bool big_endian : {false, true}) {
        for (const bool double_precision : {false, true}) {
          Plot3dLayout layout;
          layout.big_endian = big_endian;
          layout.record_marks = record_marks;
          layout.multi_grid = multi_grid;
          layout.double_precision = double_precision;
          visit(layout);
        }
      }
    }
  }
}

}  // namespace

std::optional<Plot3dLayout> find_plot3d_layout(std::string_view bytes) {
  if (looks_like_numbers(bytes)) return find_text_layout(bytes);
  if (is_plot3d_solution(bytes)) return {};  // whose last variable may be zero everywhere
  std::optional<Plot3dLayout> best;
  std::uint64_t best_end = 0;
  for_each_binary_layout([&](const Plot3dLayout& candidate) {
    for (const bool iblank : {false, true}) {
      Plot3dLayout layout = candidate;
      layout.iblank = iblank;
      const std::uint64_t end = end_of_grids(bytes, layout);
      if (end <= best_end || !only_zeros(bytes.substr(end))) continue;
      best = layout;
      best_end = end;
    }
  });
  return best;
}

std::string plot3d_solution_problem(std::string_view bytes, const Plot3dLayout& grid) {
  const std::string dimensions = std::to_string(grid.grids.front()[0]) + " x " + std::to_string(grid.grids.front()[1]) +
                                 " x " + std::to_string(grid.grids.front()[2]);
  Plot3dLayout layout = grid;
  layout.grids.clear();
  if (grid.text) {
    std::string_view rest = bytes;
    if (!looks_like_numbers(bytes) || !read_text_dimensions(rest, layout) || layout.grids != grid.grids) {
      return "expected a PLOT3D solution in text of the grid's " + dimensions + " points";
    }
    std::uint64_t numbers = 0;
    for (const auto& g : grid.grids) numbers += 4 + 5 * points_of(g);
    return count_numbers(rest) == numbers ? ""
                                          : "expected " + std::to_string(numbers) + " numbers after the dimensions";
  }
  Cursor cursor(bytes, layout.big_endian);
  if (!read_dimensions(cursor, layout) || layout.grids != grid.grids) {
    return "expected a PLOT3D solution of the grid's " + dimensions + " points, in the grid's byte order and records";
  }
  layout.grids.clear();
  if (end_of_solutions(bytes, layout) == 0) {
    return "too short for five variables at each of the " + dimensions + " points, or of another kind";
  }
  return "";
}

bool is_plot3d_solution(std::string_view bytes) {
  if (looks_like_numbers(bytes)) return false;
  bool found = false;
  for_each_binary_layout([&](Plot3dLayout layout) {
    const std::uint64_t end = end_of_solutions(bytes, layout);
    found = found || end == bytes.size();
  });
  return found;
}

}  // namespace atomesh::cli
