// How the numbers lie in a PLOT3D file, which does not say so itself: found from its size and its first numbers.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace atomesh::cli {

struct Plot3dLayout {
  bool text = false;
  bool big_endian = false;
  bool record_marks = false;  // Fortran's length before and after each record
  bool multi_grid = false;    // the number of grids stands first
  bool double_precision = false;
  bool iblank = false;
  std::vector<std::array<std::uint64_t, 3>> grids;  // points along i, j, k
};

// Of a grid file, all of whose bytes must be accounted for (zeros may follow); nothing when no layout fits. Grids of
// three coordinates only.
std::optional<Plot3dLayout> find_plot3d_layout(std::string_view bytes);

// Whether `bytes` can be the solution (Q file) that belongs to a grid of this layout: its own dimensions, and four
// numbers and five variables for each grid. Says in words why not.
std::string plot3d_solution_problem(std::string_view bytes, const Plot3dLayout& grid);
// Whether this is a solution rather than a grid: its bytes are exactly those of one.
bool is_plot3d_solution(std::string_view bytes);

}  // namespace atomesh::cli
