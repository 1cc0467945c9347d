// Where the time went: the stages of what was last done, and the frames of the view.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/material.h"

namespace atomesh::gui {

// Of the picture that is shown now, and the one before.
struct FrameTimes {
  std::string drawn_by;  // "CPU", "graphics card"
  int width = 0;         // pixels
  int height = 0;
  double scene_ms = 0.0;             // making the scene; 0 where it was there
  double setup_ms = 0.0;             // acceleration structures, projection, sorting
  std::optional<double> first_ms;    // from the order to the first, coarse picture
  std::optional<double> whole_ms;    // to the complete one
  std::optional<double> per_second;  // pictures, over the last ones that came without a pause
  std::uint64_t steps = 0;           // ray–primitive intersections that contributed
  int level = 1;                     // of a progressive picture: this one of so many
  int levels = 1;
  std::uint64_t memory = 0;  // bytes, held by the process; 0 where unknown
};

// Follows the pictures as they come. Times are of the caller's clock, ms.
class FrameClock {
 public:
  // A picture was shown at `now`. `number` is that of its order (FrameTimes::level 1 begins a new one); takes
  // drawn_by, size, scene_ms, setup_ms, steps, level and levels from `frame`, `ms` since the order.
  FrameTimes shown(FrameTimes frame, std::uint64_t number, double ms, double now);

 private:
  static constexpr double pause_ms = 500.0;  // what is further apart is not one movement
  static constexpr std::size_t most = 30;

  std::uint64_t number_ = 0;
  std::optional<double> first_ms_;
  std::vector<double> recent_;  // when the first pictures of the last orders were shown
};

// One bar: a name, how long, and its part of the longest (0 to 1) and of all.
struct TimeRow {
  std::string name;
  double ms = 0.0;
  double of_longest = 0.0;
  double of_all = 0.0;
  std::optional<std::uint64_t> memory;  // bytes, where known
};
// `memory`: of each stage, or shorter where it is not known.
std::vector<TimeRow> time_rows(const std::vector<StageTime>& stages, const std::vector<std::uint64_t>& memory);
double total_ms(const std::vector<StageTime>& stages);
// "0.42 ms", "831 ms", "12.4 s", "3 min 20 s".
std::string time_text(double ms);

}  // namespace atomesh::gui
