// atomesh compare A.png B.png: how far apart two pictures are.
#include <CLI/CLI.hpp>
#include <memory>

#include "app/cli/commands.h"
#include "app/cli/output_file.h"
#include "app/cli/picture_comparison.h"
#include "app/cli/session.h"
#include "app/cli/text_values.h"

namespace atomesh::cli {
namespace {

struct CompareArguments {
  std::string a;
  std::string b;
  std::string output;
  double tolerance = 0.0;
};

int run_compare(const CompareArguments& arguments, Session& session) {
  if (!arguments.output.empty()) check_output(arguments.output, {".png"});
  const PictureComparison result =
      compare_pictures(arguments.a, arguments.b, arguments.tolerance, arguments.output, true, session);
  session.write_json(result.json);
  return result.passed ? exit_done : exit_comparison_failed;
}

}  // namespace

Command add_compare(CLI::App& app) {
  auto arguments = std::make_shared<CompareArguments>();
  app.add_option("A", arguments->a, "A PNG picture")->required();
  app.add_option("B", arguments->b, "Another of the same size")->required();
  app.add_option("-o,--output", arguments->output, "Also write a picture of the difference")->type_name("DIFF.png");
  app.add_option_function<std::string>(
         "--tolerance", [arguments](const std::string& text) { arguments->tolerance = parse_tolerance(text); },
         "Largest channel difference that still passes, 0 to 1 or as 2/255 [0]")
      ->type_name("E");
  app.footer(
      "Exit code 0 when no channel of any pixel differs by more than the tolerance, else 4.\n"
      "Example:\n  atomesh compare new.png old.png --tolerance 2/255 -o difference.png\n");
  return [arguments](Session& session) { return run_compare(*arguments, session); };
}

}  // namespace atomesh::cli
