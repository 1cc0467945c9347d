#include "app/cli/bench_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/cli/machine.h"
#include "core/error.h"

namespace atomesh::cli {

namespace {

struct Part {
  const char* name;
  void (*run)(RenderBench&);
};

constexpr Part parts[] = {
    {"curves", bench_error_curves}, {"scenes", bench_error_scenes}, {"hard-cases", bench_error_hard_cases}};

}  // namespace

std::vector<std::string> error_bench_parts() {
  std::vector<std::string> names;
  for (const Part& part : parts) names.emplace_back(part.name);
  return names;
}

double convergence_order(const std::vector<std::pair<int, double>>& points, double floor) {
  double n = 0.0;
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  for (const auto& [samples, error] : points) {
    if (!(error > floor)) continue;
    const double u = std::log(static_cast<double>(samples));
    const double v = std::log(error);
    n += 1.0;
    x += u;
    y += v;
    xx += u * u;
    xy += u * v;
  }
  if (n < 2.0) return std::numeric_limits<double>::quiet_NaN();
  return -(n * xy - x * y) / (n * xx - x * x);
}

void bench_error(const RenderBenchOptions& options, Session& session, BenchResult& result) {
  check_parts(options.parts, error_bench_parts());
  RenderBench bench(options, session, result);
  if (options.full) bench.judge = BenchJudge(1);
  for (const Part& part : parts) {
    const bool wanted = options.parts.empty() ||
                        std::find(options.parts.begin(), options.parts.end(), part.name) != options.parts.end();
    if (!wanted) continue;
    const std::size_t first = result.tables.size();
    part.run(bench);
    session.print_text(result.text(first));  // minutes before the last part is done
  }
  BenchTable requirements = result.requirements();
  requirements.caption += fmt::format(
      " Errors: the largest difference of a channel of premultiplied RGB and coverage, in [0,1], from the judge "
      "(renderer \"reference\": double precision, exact), who looks at {}; in the hard cases at every pixel. {}. "
      "Commit "
      "{}. Made by `atomesh bench error{}`.",
      options.full ? "every pixel" : "one pixel in 32, 3 % of a picture (with --full at every one)", machine_name(),
      build_commit(), options.full ? " --full" : "");
  result.tables.push_back(std::move(requirements));
  session.print_text(result.text(result.tables.size() - 1));
  // Who reads the file wants the outcome first.
  std::rotate(result.tables.begin(), result.tables.end() - 1, result.tables.end());
}

}  // namespace atomesh::cli
