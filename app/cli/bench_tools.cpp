#include "app/cli/bench_tools.h"

#include <unistd.h>

#include <cmath>
#include <span>

#include "app/cli/machine.h"
#include "core/error.h"
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

void check_parts(const std::vector<std::string>& parts, const std::vector<std::string>& names) {
  for (const std::string& part : parts) {
    if (std::find(names.begin(), names.end(), part) != names.end()) continue;
    const std::string nearest = nearest_name(part, names);
    throw UsageError(fmt::format("--part: there is no \"{}\"{}; there are: {}", part,
                                 nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?", fmt::join(names, ", ")));
  }
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

void BenchResult::not_measured(std::string what, std::string option) {
  unmeasured_.emplace_back(std::move(what), std::move(option));
}

BenchTable BenchResult::requirements() const {
  struct Line {
    const Requirement* worst;
    const std::string* where;
    std::size_t met = 0, cases = 0;
  };
  std::vector<Line> lines;
  for (const auto& [name, requirement] : required_) {
    auto line = std::find_if(lines.begin(), lines.end(), [&](const Line& l) {
      return l.worst->what == requirement.what && l.worst->target == requirement.target;
    });
    if (line == lines.end()) line = lines.insert(line, Line{&requirement, &name});
    ++line->cases;
    line->met += requirement.met() ? 1 : 0;
    const bool worse = requirement.at_least ? requirement.measured < line->worst->measured
                                            : requirement.measured > line->worst->measured;
    if (worse) {
      line->worst = &requirement;
      line->where = &name;
    }
  }
  BenchTable result{"Requirements", TextTable({"what", "required", "worst", "where", "cases met", "met"}), ""};
  std::size_t met = 0;
  for (const Line& line : lines) {
    const Requirement& worst = *line.worst;
    const bool all = line.met == line.cases;
    met += all ? 1 : 0;
    result.table.row(
        {worst.what,
         fmt::format("{} {}{}", worst.at_least ? "at least" : "at most", short_number(worst.target), worst.unit),
         short_number(worst.measured) + worst.unit, *line.where, fmt::format("{} of {}", line.met, line.cases),
         all ? "yes" : "NO"});
  }
  for (const auto& [what, option] : unmeasured_) result.table.row({what, "", "", "", "", "not measured: " + option});
  result.caption =
      lines.empty() ? "Nothing is required of the cases measured." : fmt::format("{} of {} met.", met, lines.size());
  return result;
}

std::string BenchResult::text(std::size_t first) const {
  std::string out;
  for (const BenchTable& table : std::span(tables).subspan(first)) {
    if (!table.title.empty()) out += table.title + "\n";
    if (!table.table.empty()) out += table.table.text();
    if (!table.caption.empty()) out += table.caption + "\n";
    out += "\n";
  }
  return out;
}

std::string BenchResult::markdown() const {
  std::string out;
  for (const BenchTable& table : tables) {
    if (!table.title.empty()) out += "#### " + table.title + "\n\n";
    if (!table.table.empty()) out += table.table.markdown() + "\n";
    if (!table.caption.empty()) out += table.caption + "\n";
    out += "\n";
  }
  return out;
}

}  // namespace atomesh::cli
