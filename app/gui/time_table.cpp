#include "app/gui/time_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/memory.h"

namespace atomesh::gui {

FrameTimes FrameClock::shown(FrameTimes frame, std::uint64_t number, double ms, double now) {
  if (number != number_ || !first_ms_) {
    number_ = number;
    first_ms_ = ms;
    if (!recent_.empty() && now - recent_.back() > pause_ms) recent_.clear();
    recent_.push_back(now);
    if (recent_.size() > most) recent_.erase(recent_.begin());
  }
  frame.first_ms = first_ms_;
  frame.whole_ms = frame.level == frame.levels ? std::optional(ms) : std::nullopt;
  const double span = recent_.back() - recent_.front();
  frame.per_second.reset();
  if (recent_.size() > 1 && span > 0.0) frame.per_second = 1000.0 * static_cast<double>(recent_.size() - 1) / span;
  frame.memory = current_memory();
  return frame;
}

double total_ms(const std::vector<StageTime>& stages) {
  double total = 0.0;
  for (const StageTime& stage : stages) total += stage.ms;
  return total;
}

std::vector<TimeRow> time_rows(const std::vector<StageTime>& stages, const std::vector<std::uint64_t>& memory) {
  const double total = total_ms(stages);
  double longest = 0.0;
  for (const StageTime& stage : stages) longest = std::max(longest, stage.ms);
  std::vector<TimeRow> rows;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    TimeRow row{stages[i].name, stages[i].ms, 0.0, 0.0, std::nullopt};
    if (longest > 0.0) row.of_longest = row.ms / longest;
    if (total > 0.0) row.of_all = row.ms / total;
    if (i < memory.size() && memory[i] > 0) row.memory = memory[i];
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string time_text(double ms) {
  if (!(ms >= 0.0)) return "";
  if (ms < 9.995) return fmt::format("{:.2f} ms", ms);
  if (ms < 99.95) return fmt::format("{:.1f} ms", ms);
  if (ms < 999.5) return fmt::format("{:.0f} ms", ms);
  if (ms < 9995.0) return fmt::format("{:.2f} s", ms * 1e-3);
  if (ms < 59950.0) return fmt::format("{:.1f} s", ms * 1e-3);
  const auto seconds = static_cast<std::uint64_t>(std::llround(ms * 1e-3));
  return fmt::format("{} min {} s", seconds / 60, seconds % 60);
}

}  // namespace atomesh::gui
