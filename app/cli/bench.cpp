// atomesh bench SUITE: what things cost, beside published figures.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "app/cli/bench_error.h"
#include "app/cli/bench_havs.h"
#include "app/cli/bench_preprocess.h"
#include "app/cli/bench_render.h"
#include "app/cli/bench_seed_table.h"
#include "app/cli/bench_window.h"
#include "app/cli/commands.h"
#include "app/cli/output_file.h"
#include "app/cli/report_html.h"
#include "app/cli/session.h"
#include "app/cli/text_values.h"
#include "core/error.h"
#include "core/text_file.h"

namespace atomesh::cli {
namespace {

struct BenchArguments {
  std::string suite;
  std::string markdown;
  std::string html;
  std::string svg;
  SeedTableOptions seed_table;
  PreprocessBenchOptions preprocess;
  RenderBenchOptions render;
  std::vector<std::string> parts;
  bool full = false;
  std::size_t atoms = 0;
  int repeats = 0;  // 0: the suite's own
};

const std::vector<std::string>& suite_names() {
  static const std::vector<std::string> names{"seed-table", "preprocess", "render", "error", "havs", "window"};
  return names;
}

void write_text(const std::string& path, const std::string& text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

void write_plots(const std::string& folder, const BenchResult& result) {
  for (const BenchTable& section : result.tables) {
    for (const Plot& plot : section.plots) {
      write_text((std::filesystem::path(folder) / (plot.name + ".svg")).string(), plot_svg(plot));
    }
  }
}

void check_reports(const BenchArguments& arguments) {
  if (!arguments.markdown.empty()) check_output(arguments.markdown, {".md"});
  if (!arguments.html.empty()) check_output(arguments.html, {".html"});
  if (!arguments.svg.empty() && !std::filesystem::is_directory(arguments.svg)) {
    throw UsageError("--svg " + arguments.svg + ": is not a folder; make it first");
  }
}

int run_bench(const BenchArguments& arguments, Session& session) {
  const auto& suites = suite_names();
  if (std::find(suites.begin(), suites.end(), arguments.suite) == suites.end()) {
    throw UsageError(
        fmt::format("bench: there is no suite \"{}\"; there are: {}", arguments.suite, fmt::join(suites, ", ")));
  }
  check_reports(arguments);
  BenchResult result;
  if (arguments.suite == "preprocess") {
    PreprocessBenchOptions options = arguments.preprocess;
    options.atoms = arguments.atoms;
    options.parts = arguments.parts;
    options.full = arguments.full;
    if (arguments.repeats > 0) options.repeats = arguments.repeats;
    bench_preprocess(options, session, result);
  } else if (arguments.suite == "render" || arguments.suite == "error" || arguments.suite == "havs") {
    RenderBenchOptions options = arguments.render;
    options.parts = arguments.parts;
    options.full = arguments.full;
    if (arguments.repeats > 0) options.repeats = arguments.repeats;
    const auto run = arguments.suite == "render" ? bench_render : arguments.suite == "error" ? bench_error : bench_havs;
    run(options, session, result);
  } else if (arguments.suite == "window") {
    WindowBenchOptions options;
    options.quick = arguments.render.quick;
    if (arguments.repeats > 0) options.repeats = arguments.repeats;
    bench_window(options, session, result);
  } else {
    SeedTableOptions options = arguments.seed_table;
    options.atoms = arguments.atoms;
    if (arguments.repeats > 0) options.repeats = arguments.repeats;
    bench_seed_table(options, session, result);
    session.print_text(result.text());
  }
  if (!arguments.markdown.empty()) write_text(arguments.markdown, result.markdown());
  if (!arguments.html.empty()) {
    write_text(arguments.html, report_html("atomesh bench " + arguments.suite, result.tables, report_origin()));
  }
  if (!arguments.svg.empty()) write_plots(arguments.svg, result);
  session.write_json(result.json());
  return exit_done;
}

}  // namespace

Command add_bench(CLI::App& app) {
  auto arguments = std::make_shared<BenchArguments>();
  SeedTableOptions& seed_table = arguments->seed_table;
  RenderBenchOptions& render = arguments->render;
  app.add_option("SUITE", arguments->suite,
                 "seed-table: preprocessing and the five modes on the ten samples, beside the seed's table 5.1; "
                 "preprocess: speed, memory and truth of preprocessing, beside CGAL, TetGen, VTK and LAMMPS; "
                 "render: speed, errors and memory of pictures, beside VTK's volume mappers and the seed; "
                 "error: speed against error of every integrator, errors of all data sets and modes, hard cases; "
                 "havs: volumes on OpenGL beside the CPU renderer and VTK's projected tetrahedra; "
                 "window: how soon the window shows its first picture")
      ->required();
  app.add_option("--sample", seed_table.samples, "seed-table: only these samples; see atomesh sample --list")
      ->type_name("NAME…");
  app.add_option("--part", arguments->parts,
                 fmt::format("Only these parts; preprocess: {}; render: {}; error: {}; havs: {}",
                             fmt::join(preprocess_bench_parts(), ", "), fmt::join(render_bench_parts(), ", "),
                             fmt::join(error_bench_parts(), ", "), fmt::join(havs_bench_parts(), ", ")))
      ->type_name("NAME…");
  app.add_flag("--full", arguments->full,
               "preprocess, render, error, havs: every case, and the largest (about half an hour)");
  app.add_option(
         "--case", render.cases,
         "render, error, havs: only these data sets: a sample, lattice-N, lattice-N-random, comb, blunt-fin, post, "
         "usm3d-box, "
         "quake, chaste-cube, raptor")
      ->type_name("NAME…");
  app.add_option("--data", render.data, "render, error, havs: folder of the public data sets [../shared/data/volume]")
      ->type_name("FOLDER");
  app.add_flag("!--no-peers", render.peers, "render, error, havs: without VTK's mappers");
  app.add_flag("!--no-z-sweep", render.z_sweep, "render: without the slowest of VTK's mappers");
  app.add_flag("--quick", render.quick,
               "render, error, havs, window: tiny data sets and pictures, to see that it works");
  app.add_option_function<std::string>(
         "--atoms", [arguments](const std::string& text) { arguments->atoms = parse_count("--atoms", text); },
         "Atoms of each sample; 0: as many as the seed had, or as the part is defined for [0]")
      ->type_name("N");
  app.add_option_function<std::string>(
         "--size",
         [&seed_table, &render](const std::string& text) {
           std::tie(seed_table.width, seed_table.height) = parse_size(text);
           std::tie(render.width, render.height) = parse_size(text);
         },
         "seed-table: pixels of the pictures [512x512]; render, error, havs: of all [each part's own]")
      ->type_name("WxH");
  app.add_option("--repeats", arguments->repeats,
                 "Measured runs of each [seed-table, render, error, havs: 3, preprocess: 1, window: 5]")
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  app.add_option("--markdown", arguments->markdown, "Also write the tables as Markdown")->type_name("FILE.md");
  app.add_option("--html", arguments->html, "Also write tables and plots as one HTML file that needs no other")
      ->type_name("FILE.html");
  app.add_option("--svg", arguments->svg, "Also write each plot into this folder, as NAME.svg")->type_name("FOLDER");
  app.footer(
      "Example:\n  atomesh bench seed-table --sample nacl-cracked --repeats 5 --json bench.json\n"
      "  atomesh bench preprocess --part tetrahedralize --markdown bench.md\n"
      "  atomesh bench render --part peers --case comb --json bench.json\n"
      "  atomesh bench error --html error.html --svg pictures\n");
  return [arguments](Session& session) { return run_bench(*arguments, session); };
}

}  // namespace atomesh::cli
