#include "app/cli/bench_tools.h"

#include <unistd.h>

#include <cmath>
#include <span>

#include "app/cli/machine.h"
#include "core/memory.h"

namespace atomesh::cli {

Times times_of(const std::vector<Run>& runs) {
  const auto sorted = [&runs](double Run::*member) {
    std::vector<double> values;
    for (const Run& run : runs) values.push_back(run.*member);
    std::sort(values.begin(), values.end());
    return values;
  };
  const auto median = [](const std::vector<double>& v) { return 0.5 * (v[(v.size() - 1) / 2] + v[v.size() / 2]); };
  const std::vector<double> ms = sorted(&Run::ms);
  return {median(ms), ms.front(), ms.back(), median(sorted(&Run::cpu_ms))};
}

PeakMemory::PeakMemory() {
  release_free_memory();
  reset_peak_memory();
  before_ = static_cast<double>(current_memory());
}

double PeakMemory::grown() const {
  return std::max(0.0, held() - before_);
}

double PeakMemory::held() const {
  return static_cast<double>(recent_peak_memory());
}

TemporaryFolder::TemporaryFolder()
    : path_(std::filesystem::temp_directory_path() / ("atomesh-bench-" + std::to_string(getpid()))) {
  std::filesystem::create_directories(path_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string short_number(double value) {
  const double size = std::abs(value);
  if (!std::isfinite(value)) return "-";
  if (size >= 999.5) return (value < 0.0 ? "-" : "") + grouped(static_cast<std::uint64_t>(std::llround(size)));
  if (size != 0.0 && size < 0.001) return fmt::format("{:.1e}", value);
  return fmt::format("{:.3g}", value);
}

std::string Requirement::text() const {
  return fmt::format("required {}{}{}: {}{}{}", at_least ? "" : "at most ", short_number(target), unit,
                     short_number(measured), unit, met() ? "" : " MISSED");
}

void BenchResult::add(BenchRow row) {
  const auto time = [&row](double Times::*member) { return row.times ? Json((*row.times).*member) : Json(); };
  Json json = Json::object({{"suite", row.suite},
                            {"case", row.name},
                            {"what", row.what},
                            {"settings", std::move(row.settings)},
                            {"peer", row.peer.empty() ? Json() : Json(row.peer)},
                            {"ms_median", time(&Times::median)},
                            {"ms_min", time(&Times::min)},
                            {"ms_max", time(&Times::max)},
                            {"max_error", std::move(row.max_error)},
                            {"rmse", std::move(row.rmse)},
                            {"psnr", std::move(row.psnr)}});
  if (row.times && row.times->cpu > 0.0) json.set("cpu_ms", row.times->cpu);
  for (auto& [key, value] : row.more) json.set(key, std::move(value));
  Json requirements = Json::array();
  for (Requirement& requirement : row.requirements) {
    requirements.push(Json::object({{"what", requirement.what},
                                    {requirement.at_least ? "at_least" : "at_most", requirement.target},
                                    {"measured", requirement.measured},
                                    {"unit", requirement.unit},
                                    {"met", requirement.met()}}));
    required_.emplace_back(row.name, std::move(requirement));
  }
  if (!row.requirements.empty()) json.set("requirements", requirements);
  rows_.push(std::move(json));
}

Json BenchResult::json() const {
  return Json::object({{"machine", machine_name()}, {"commit", build_commit()}, {"rows", rows_}});
}

BenchTable BenchResult::requirements() const {
  BenchTable result{"Requirements", TextTable({"case", "what", "required", "measured", "met"}), ""};
  std::size_t met = 0;
  for (const auto& [name, requirement] : required_) {
    met += requirement.met() ? 1 : 0;
    result.table.row({name, requirement.what,
                      fmt::format("{} {}{}", requirement.at_least ? "at least" : "at most",
                                  short_number(requirement.target), requirement.unit),
                      short_number(requirement.measured) + requirement.unit, requirement.met() ? "yes" : "NO"});
  }
  result.caption = fmt::format("{} of {} met.", met, required_.size());
  return result;
}

std::string BenchResult::text(std::size_t first) const {
  std::string out;
  for (const BenchTable& table : std::span(tables).subspan(first)) {
    if (!table.title.empty()) out += table.title + "\n";
    out += table.table.text();
    if (!table.caption.empty()) out += table.caption + "\n";
    out += "\n";
  }
  return out;
}

std::string BenchResult::markdown() const {
  std::string out;
  for (const BenchTable& table : tables) {
    if (!table.title.empty()) out += "## " + table.title + "\n\n";
    out += table.table.markdown();
    if (!table.caption.empty()) out += "\n" + table.caption + "\n";
    out += "\n";
  }
  return out;
}

}  // namespace atomesh::cli
