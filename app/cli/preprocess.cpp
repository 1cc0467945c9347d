// atomesh preprocess IN… -o OUT: every stage from atoms files to .crb or .crt.
#include <CLI/CLI.hpp>
#include <memory>

#include "app/cli/commands.h"
#include "app/cli/load_material.h"
#include "app/cli/output_file.h"
#include "app/cli/pipeline_options.h"
#include "app/cli/preprocess_batch.h"
#include "app/cli/preprocess_file.h"
#include "app/cli/session.h"

namespace atomesh::cli {
namespace {

struct PreprocessArguments {
  std::vector<std::string> inputs;
  std::string output;
  bool force = false;
  PreprocessSettings settings;
};

int run_preprocess(const PreprocessArguments& arguments, Session& session) {
  if (is_batch(arguments.inputs, arguments.output)) {
    return run_batch(plan_batch(arguments.inputs, arguments.output), arguments.settings, arguments.force, session);
  }
  check_output(arguments.output, {".crb", ".crt"});
  const PreprocessedFile file =
      preprocess_file({arguments.inputs.front(), arguments.output}, arguments.settings, session.progress());
  show_notes(file.report, session);
  session.print_text(stage_table(file));
  session.print_text(certificate_text(file));
  if (session.json_wanted()) session.write_json(preprocess_json(file));
  return exit_done;
}

}  // namespace

Command add_preprocess(CLI::App& app) {
  auto arguments = std::make_shared<PreprocessArguments>();
  app.add_option("IN", arguments->inputs,
                 "Atoms files: .dat, .xyz, LAMMPS data or dump; several files, quoted patterns (\"run*/*.dat\") and "
                 "folders (their files with an ending of these formats) make a batch")
      ->required();
  app.add_option("-o,--output", arguments->output,
                 "The file to write, .crb (binary) or .crt (text); of a batch a folder, or a template in which {name} "
                 "is the input's name without its ending, {file} with it, {folder} the name of its folder")
      ->type_name("OUT")
      ->required();
  app.add_flag("--force", arguments->force,
               "In a batch, also make what is up to date: made from the same content with the same options by this "
               "version of the program. A single IN with a single OUT is always made");
  app.add_flag("!--no-compress", arguments->settings.compress,
               "Write a .crb without compression: larger, faster to read");
  add_pipeline_options(app, arguments->settings.options);
  app.footer(
      "A batch goes on past a file that fails, ends with a table of what worked, and exits with the code of the worst "
      "failure.\n"
      "Example:\n"
      "  atomesh preprocess nacl.dat -o nacl.crb\n"
      "  atomesh preprocess hot.dump --type-names Cu -o hot.crb --unit-cell found --simplify\n"
      "  atomesh preprocess dot.xyz -o dot.crb --mask As --keep-every 20 --scalar Ga=0,In=1\n"
      "  atomesh preprocess \"steps/*.dump\" -o meshes/ --type-names Cu\n"
      "  atomesh preprocess a.dat b.xyz -o \"{name}-full.crt\" --carve off\n");
  return [arguments](Session& session) { return run_preprocess(*arguments, session); };
}

}  // namespace atomesh::cli
