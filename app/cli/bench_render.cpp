#include "app/cli/bench_render.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "app/cli/machine.h"
#include "core/error.h"
#include "core/parallel.h"

namespace atomesh::cli {

namespace {

// ", which others used as well (load 7.3)": what is measured on the clock is then too long. "" on a quiet machine.
std::string busy_machine() {
  double load = 0.0;  // of the last minute, our own threads included
  if (getloadavg(&load, 1) != 1 || load < threads() + 1.0) return "";
  return fmt::format(", which others used as well (load {:.1f})", load);
}

constexpr std::size_t largest_kept = 2'000'000;  // tetrahedra

struct Part {
  const char* name;
  void (*run)(RenderBench&);
};

constexpr Part parts[] = {
    {"peers", bench_render_peers},     {"modes", bench_render_modes},   {"rates", bench_render_rates},
    {"threads", bench_render_threads}, {"memory", bench_render_memory}, {"frames", bench_render_frames},
    {"seed", bench_render_seed},
};

}  // namespace

std::vector<std::string> render_bench_parts() {
  std::vector<std::string> names;
  for (const Part& part : parts) names.emplace_back(part.name);
  return names;
}

std::vector<std::string> RenderBench::cases(std::vector<std::string> usual,
                                            const std::vector<std::string>& more) const {
  if (!options.cases.empty()) return options.cases;
  if (options.quick) return {"lattice-12"};
  if (options.full) usual.insert(usual.end(), more.begin(), more.end());
  return usual;
}

std::shared_ptr<const BenchScene> RenderBench::scene(const std::string& name) {
  const auto known = kept_.find(name);
  if (known != kept_.end()) return known->second;
  try {
    auto made = std::make_shared<const BenchScene>(
        make_bench_scene(name, options.data, options.quick ? 2000 : 0, session.progress()));
    if (made->material.mesh.tetrahedra.size() <= largest_kept) kept_.emplace(name, made);
    return made;
  } catch (const UnavailableError& error) {
    session.note(error.what());
    return nullptr;
  }
}

std::vector<BenchView> RenderBench::views(const BenchScene& scene) const {
  if (options.full) return scene.views;
  return {scene.views.front()};
}

void bench_render(const RenderBenchOptions& options, Session& session, BenchResult& result) {
  check_parts(options.parts, render_bench_parts());
  RenderBench bench(options, session, result);
  for (const Part& part : parts) {
    const bool wanted = options.parts.empty() ||
                        std::find(options.parts.begin(), options.parts.end(), part.name) != options.parts.end();
    if (!wanted) continue;
    const std::size_t first = result.tables.size();
    part.run(bench);
    session.print_text(result.text(first));  // minutes before the last part is done
  }
  BenchTable requirements = result.requirements();
  requirements.caption += fmt::format(" {}{}. Commit {}. Made by `atomesh bench render{}`.", machine_name(),
                                      busy_machine(), build_commit(), options.full ? " --full" : "");
  result.tables.push_back(std::move(requirements));
  session.print_text(result.text(result.tables.size() - 1));
  // Who reads the file wants the outcome first.
  std::rotate(result.tables.begin(), result.tables.end() - 1, result.tables.end());
}

}  // namespace atomesh::cli
