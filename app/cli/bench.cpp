// atomesh bench SUITE: what things cost, beside published figures.
#include <CLI/CLI.hpp>
#include <memory>

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
};

const std::vector<std::string>& suite_names() {
  static const std::vector<std::string> names{"seed-table"};
  return names;
}

int run_bench(const BenchArguments& arguments, Session& session) {
  const auto& suites = suite_names();
  if (std::find(suites.begin(), suites.end(), arguments.suite) == suites.end()) {
    throw UsageError(
        fmt::format("bench: there is no suite \"{}\"; there are: {}", arguments.suite, fmt::join(suites, ", ")));
  }
  if (!arguments.markdown.empty()) check_output(arguments.markdown, {".md"});
  const BenchResult result = bench_seed_table(arguments.seed_table, session);
  session.print_text(result.table.text());
  session.print("{}", result.caption);
  if (!arguments.markdown.empty()) {
    AtomicFile file(arguments.markdown);
    file.write(result.table.markdown());
    file.write("\n" + result.caption + "\n");
    file.commit();
  }
  session.write_json(result.json);
  return exit_done;
}

}  // namespace

Command add_bench(CLI::App& app) {
  auto arguments = std::make_shared<BenchArguments>();
  SeedTableOptions& seed_table = arguments->seed_table;
  app.add_option("SUITE", arguments->suite,
                 "seed-table: preprocessing and the five modes on the ten samples, beside the seed's table 5.1")
      ->required();
  app.add_option("--sample", seed_table.samples, "Only these samples; see atomesh sample --list")->type_name("NAME…");
  app.add_option_function<std::string>(
         "--atoms", [&seed_table](const std::string& text) { seed_table.atoms = parse_count("--atoms", text); },
         "Atoms of each sample; 0: as many as the seed had [0]")
      ->type_name("N");
  app.add_option_function<std::string>(
         "--size",
         [&seed_table](const std::string& text) { std::tie(seed_table.width, seed_table.height) = parse_size(text); },
         "Pixels of the pictures [512x512]")
      ->type_name("WxH");
  app.add_option("--repeats", seed_table.repeats, "Measured runs of each, after one that is not counted")
      ->type_name("N")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--markdown", arguments->markdown, "Also write the table as Markdown")->type_name("FILE.md");
  app.footer("Example:\n  atomesh bench seed-table --sample nacl-cracked --repeats 5 --json bench.json\n");
  return [arguments](Session& session) { return run_bench(*arguments, session); };
}

}  // namespace atomesh::cli
