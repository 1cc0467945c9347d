#include "app/cli/bench_preprocess.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/cli/machine.h"
#include "core/error.h"

namespace atomesh::cli {

namespace {

struct Part {
  const char* name;
  void (*run)(const PreprocessBench&);
};

constexpr Part parts[] = {
    {"tetrahedralize", bench_tetrahedralize},
    {"quantify_defects", bench_quantify_defects},
    {"simplify", bench_simplify},
    {"pipeline", bench_pipeline},
    {"truth", bench_truth},
    {"find_unit_cell", bench_find_unit_cell},
};

}  // namespace

std::vector<std::string> preprocess_bench_parts() {
  std::vector<std::string> names;
  for (const Part& part : parts) names.emplace_back(part.name);
  return names;
}

void bench_preprocess(const PreprocessBenchOptions& options, Session& session, BenchResult& result) {
  check_parts(options.parts, preprocess_bench_parts());
  for (const Part& part : parts) {
    const bool wanted = options.parts.empty() ||
                        std::find(options.parts.begin(), options.parts.end(), part.name) != options.parts.end();
    if (!wanted) continue;
    const std::size_t first = result.tables.size();
    part.run({options, session, result});
    session.print_text(result.text(first));  // minutes before the last part is done
  }
  BenchTable requirements = result.requirements();
  requirements.caption += fmt::format(
      " Numerical hard cases and the answer to a cancel are tests. {}. Commit {}. Made by `atomesh bench "
      "preprocess{}`.",
      machine_name(), build_commit(), options.full ? " --full" : "");
  result.tables.push_back(std::move(requirements));
  session.print_text(result.text(result.tables.size() - 1));
  // Who reads the file wants the outcome first.
  std::rotate(result.tables.begin(), result.tables.end() - 1, result.tables.end());
}

}  // namespace atomesh::cli
