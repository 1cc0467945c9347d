#include "app/cli/bench_havs.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/cli/machine.h"

namespace atomesh::cli {

namespace {

struct Part {
  const char* name;
  void (*run)(RenderBench&);
};
constexpr Part parts[] = {{"frames", bench_havs_frames}, {"order", bench_havs_order}};

}  // namespace

std::vector<std::string> havs_bench_parts() {
  std::vector<std::string> names;
  for (const Part& part : parts) names.emplace_back(part.name);
  return names;
}

void bench_havs(const RenderBenchOptions& options, Session& session, BenchResult& result) {
  check_parts(options.parts, havs_bench_parts());
  RenderBench bench(options, session, result);
  const auto wanted = [&](const std::string& part) {
    return options.parts.empty() || std::find(options.parts.begin(), options.parts.end(), part) != options.parts.end();
  };
  for (const Part& part : parts) {
    if (!wanted(part.name)) continue;
    const std::size_t first = result.tables.size();
    part.run(bench);
    session.print_text(result.text(first));
  }
  BenchTable requirements = result.requirements();
  requirements.caption += fmt::format(" {}. Commit {}. Made by `atomesh bench havs{}`.", machine_name(), build_commit(),
                                      options.full ? " --full" : "");
  result.tables.push_back(std::move(requirements));
  session.print_text(result.text(result.tables.size() - 1));
  std::rotate(result.tables.begin(), result.tables.end() - 1, result.tables.end());
}

}  // namespace atomesh::cli
