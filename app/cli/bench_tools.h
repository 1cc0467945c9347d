// What every bench shares: measured times and memory, rows for machines, tables and requirements for people.
#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/json.h"
#include "app/cli/report_plot.h"
#include "app/cli/session.h"
#include "app/cli/text_table.h"

namespace atomesh::cli {

struct Times {
  double median = 0.0;  // ms on the clock
  double min = 0.0;
  double max = 0.0;
  // Median ms of processor time, all threads together: what rates "per core" are made of. Unlike the clock it leaves
  // out the waiting for a core that somebody else uses. 0 where it is not known.
  double cpu = 0.0;

  // `count` things a second of one core.
  double per_core(double count) const { return count / (1e-3 * cpu); }
};

struct Run {
  double ms = 0.0;
  double cpu_ms = 0.0;
};
// `runs` must not be empty.
Times times_of(const std::vector<Run>& runs);

// `warm_up` runs that are not counted (caches, first touch of memory), then `repeats` that are. `what` is the stage
// shown while it goes on.
Times measure(int repeats, Session& session, const std::string& what, auto&& work, int warm_up = 1) {
  std::vector<Run> runs;
  for (int run = -warm_up; run < repeats; ++run) {
    session.progress().stage(what);
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t cpu = std::clock();
    work();
    const std::clock_t cpu_ticks = std::clock() - cpu;
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
    if (run >= 0) runs.push_back({elapsed.count(), 1e3 * static_cast<double>(cpu_ticks) / CLOCKS_PER_SEC});
  }
  return times_of(runs);
}

// The most memory the process holds from construction on: what was freed before is first given back to the system, so
// that it does not hide what comes.
class PeakMemory {
 public:
  PeakMemory();
  // Bytes more than at construction.
  double grown() const;
  // Bytes in all.
  double held() const;

 private:
  double before_ = 0.0;
};

// Removed with everything in it, whatever happens.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

// Something that must hold: "required at least 20×: 43×, met".
struct Requirement {
  std::string what;  // "tetrahedralize: times CGAL's sequential Delaunay"; the same for every case of one requirement
  double target = 0.0;
  bool at_least = true;  // else at most
  double measured = 0.0;
  std::string unit;  // "×", " MB", "%"

  bool met() const { return at_least ? measured >= target : measured <= target; }
  std::string text() const;
};

// One row of the bench's JSON, see design.md; `more` stands beside its keys.
struct BenchRow {
  std::string suite, name, what;  // `name` is the key "case"
  Json settings = Json::object();
  std::string peer;  // "" for ours alone
  std::optional<Times> times;
  Json max_error;  // null where the bench has none, these and the two below
  std::vector<Json::Member> more;
  std::vector<Requirement> requirements;
  Json rmse{}, psnr{};
};

// One section of a report. The plots stand above the table in the HTML report, and become files of their own; text and
// Markdown leave them out. A table without rows, TextTable({}), is left out too.
struct BenchTable {
  std::string title;
  TextTable table;
  std::string caption;
  std::vector<Plot> plots{};
};

// What a suite hands back.
class BenchResult {
 public:
  std::vector<BenchTable> tables;

  void add(BenchRow row);
  // {machine, commit, rows}.
  Json json() const;
  // A requirement that this run leaves out, and the option that takes it in.
  void not_measured(std::string what, std::string option);
  // One line for each requirement, in the order they came: how many cases there were of it, the worst, and whether it
  // is met, which it is when every case meets it.
  BenchTable requirements() const;
  // Of the tables from the `first` on.
  std::string text(std::size_t first = 0) const;
  std::string markdown() const;

 private:
  Json rows_ = Json::array();
  std::vector<std::pair<std::string, Requirement>> required_;    // by case
  std::vector<std::pair<std::string, std::string>> unmeasured_;  // what, option
};

// The words of --part. Throws UsageError naming the nearest for one that is none of `names`.
void check_parts(const std::vector<std::string>& parts, const std::vector<std::string>& names);

// About three significant digits: "0.042", "8.31", "1,234".
std::string short_number(double value);

}  // namespace atomesh::cli
