// atomesh bench SUITE: what things cost, beside published figures.
#include <CLI/CLI.hpp>
#include <memory>

#include "app/cli/bench_preprocess.h"
#include "app/cli/bench_seed_table.h"
#include "app/cli/commands.h"
#include "app/cli/output_file.h"
#include "app/cli/session.h"
#include "app/cli/text_values.h"
#include "core/error.h"
#include "core/text_file.h"

namespace atomesh::cli {
namespace {

struct BenchArguments {
  std::string suite;
  std::string markdown;
  SeedTableOptions seed_table;
  PreprocessBenchOptions preprocess;
  std::size_t atoms = 0;
  int repeats = 0;  // 0: the suite's own
};

const std::vector<std::string>& suite_names() {
  static const std::vector<std::string> names{"seed-table", "preprocess"};
  return names;
}

int run_bench(const BenchArguments& arguments, Session& session) {
  const auto& suites = suite_names();
  if (std::find(suites.begin(), suites.end(), arguments.suite) == suites.end()) {
    throw UsageError(
        fmt::format("bench: there is no suite \"{}\"; there are: {}", arguments.suite, fmt::join(suites, ", ")));
  }
  if (!arguments.markdown.empty()) check_output(arguments.markdown, {".md"});
  BenchResult result;
  if (arguments.suite == "preprocess") {
    PreprocessBenchOptions options = arguments.preprocess;
    options.atoms = arguments.atoms;
    if (arguments.repeats > 0) options.repeats = arguments.repeats;
    bench_preprocess(options, session, result);
  } else {
    SeedTableOptions options = arguments.seed_table;
    options.atoms = arguments.atoms;
    if (arguments.repeats > 0) options.repeats = arguments.repeats;
    bench_seed_table(options, session, result);
    session.print_text(result.text());
  }
  if (!arguments.markdown.empty()) {
    AtomicFile file(arguments.markdown);
    file.write(result.markdown());
    file.commit();
  }
  session.write_json(result.json());
  return exit_done;
}

}  // namespace

Command add_bench(CLI::App& app) {
  auto arguments = std::make_shared<BenchArguments>();
  SeedTableOptions& seed_table = arguments->seed_table;
  PreprocessBenchOptions& preprocess = arguments->preprocess;
  app.add_option("SUITE", arguments->suite,
                 "seed-table: preprocessing and the five modes on the ten samples, beside the seed's table 5.1; "
                 "preprocess: speed, memory and truth of preprocessing, beside CGAL, TetGen, VTK and LAMMPS")
      ->required();
  app.add_option("--sample", seed_table.samples, "seed-table: only these samples; see atomesh sample --list")
      ->type_name("NAME…");
  app.add_option("--part", preprocess.parts,
                 fmt::format("preprocess: only these parts: {}", fmt::join(preprocess_bench_parts(), ", ")))
      ->type_name("NAME…");
  app.add_flag("--full", preprocess.full, "preprocess: every case, and the largest (about half an hour)");
  app.add_option_function<std::string>(
         "--atoms", [arguments](const std::string& text) { arguments->atoms = parse_count("--atoms", text); },
         "Atoms of each sample; 0: as many as the seed had, or as the part is defined for [0]")
      ->type_name("N");
  app.add_option_function<std::string>(
         "--size",
         [&seed_table](const std::string& text) { std::tie(seed_table.width, seed_table.height) = parse_size(text); },
         "seed-table: pixels of the pictures [512x512]")
      ->type_name("WxH");
  app.add_option("--repeats", arguments->repeats, "Measured runs of each [seed-table: 3, preprocess: 1]")
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  app.add_option("--markdown", arguments->markdown, "Also write the tables as Markdown")->type_name("FILE.md");
  app.footer(
      "Example:\n  atomesh bench seed-table --sample nacl-cracked --repeats 5 --json bench.json\n"
      "  atomesh bench preprocess --part tetrahedralize --markdown bench.md\n");
  return [arguments](Session& session) { return run_bench(*arguments, session); };
}

}  // namespace atomesh::cli
