// atomesh: reads the command line, runs one subcommand, turns every error into a message and an exit code.
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/session.h"
#include "app/gui/run_window.h"
#include "core/error.h"

namespace atomesh::cli {
namespace {

struct Subcommand {
  const char* name;
  const char* description;
  Command (*add)(CLI::App& app);
};

constexpr Subcommand subcommands[] = {
    {"sample", "Grow a sample material with known defects", add_sample},
    {"preprocess", "Atoms file -> volume, surface and crystal defects in a .crb or .crt", add_preprocess},
    {"render", "Draw a picture of a material", add_render},
    {"defects", "List the clusters of defective atoms and sites", add_defects},
    {"info", "Say what a file holds and whether it is sound", add_info},
    {"convert", "Convert between the formats that are read and .dat, .xyz, .crb, .crt, .vtu", add_convert},
    {"compare", "Compare two pictures", add_compare},
    {"bench", "Measure speed, side by side with published figures", add_bench},
};

constexpr int exit_usage = 1;
constexpr int exit_unavailable = 3;

int fail(const std::string& message, int exit_code) {
  std::fprintf(stderr, "atomesh: %s\n", message.c_str());
  return exit_code;
}

std::vector<std::string> subcommand_names() {
  std::vector<std::string> names;
  for (const Subcommand& subcommand : subcommands) names.emplace_back(subcommand.name);
  return names;
}

// "--mod" → "--mode", from the options of the subcommand in use.
std::string nearest_option(const CLI::App& app, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return nearest_name(word.substr(0, word.find('=')), names);
}

// Of a word that stands where a subcommand or a file could.
std::string about_unknown_word(const std::string& word) {
  if (word.find_first_of("./") != std::string::npos) {
    return word + ": there is no such file, and no subcommand of that name";
  }
  const std::string nearest = nearest_name(word, subcommand_names());
  return "no subcommand \"" + word + "\"" + (nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?");
}

int report_parse_error(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  const std::vector<std::string> unknown = app.remaining(true);
  if (chosen.empty()) {
    if (unknown.empty()) return fail(std::string(error.what()) + "\nTry: atomesh --help", exit_usage);
    const std::string& word = unknown.front();
    if (word.starts_with("-")) {
      const std::string nearest = nearest_option(app, word);
      return fail("unexpected argument \"" + word + "\"" + (nearest.empty() ? "" : "; did you mean " + nearest + "?") +
                      "\nTry: atomesh --help",
                  exit_usage);
    }
    return fail(about_unknown_word(word) + "\nTry: atomesh --help", exit_usage);
  }
  const CLI::App& subcommand = *chosen.front();
  std::string message = subcommand.get_name() + ": ";
  if (unknown.empty()) {
    message += error.what();
  } else {
    message += "unexpected argument \"" + unknown.front() + "\"";
    const std::string nearest = unknown.front().starts_with("-") ? nearest_option(subcommand, unknown.front()) : "";
    if (!nearest.empty()) message += "; did you mean " + nearest + "?";
  }
  return fail(message + "\nTry: atomesh " + subcommand.get_name() + " --help", exit_usage);
}

// Words that are no subcommand are files for the window.
int show_window(const std::vector<std::string>& files, const std::string& parameters, bool until_shown) {
  for (const std::string& file : files) {
    if (std::filesystem::is_directory(file)) return fail(file + " is a folder; name a file of it", exit_usage);
    if (!std::filesystem::exists(file)) return fail(about_unknown_word(file) + "\nTry: atomesh --help", exit_usage);
  }
  if (!parameters.empty() && !std::filesystem::exists(parameters)) {
    return fail("--params: there is no file " + parameters, exit_usage);
  }
  // The window's own work is cancelled by closing it; Ctrl-C just ends the program.
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  return gui::run_window({files, parameters, until_shown});
}

int run(int argc, char** argv) {
  CLI::App app(
      "atomesh shows what is buried in a sample: atoms -> volume, surface, crystal defects -> pictures.\n"
      "Without a subcommand it opens its window: with FILE shown in it, else with the loader.\n"
      "Exit codes: 0 done, 1 wrong use, 2 bad input, 3 could not be done here, 4 comparison failed, "
      "130 cancelled.",
      "atomesh");
  app.set_version_flag("--version", "atomesh " ATOMESH_VERSION);
  app.require_subcommand(0, 1);
  std::vector<std::string> files;
  std::string parameters;
  app.add_option("FILE", files,
                 "Shown in the window: atoms, a .crb or .crt, a mesh, or a picture that atomesh made (its view comes "
                 "back); a .crf beside it gives the view")
      ->type_name("");
  app.add_option("--params", parameters, "View parameters for the window")->type_name("F.crf");
  bool until_shown = false;
  app.add_flag("--until-shown", until_shown,
               "Close the window when the picture is complete, and print how long that took");
  app.footer(
      "Example:\n"
      "  atomesh nacl.crb\n"
      "  atomesh sample nacl-cracked -o nacl.dat\n"
      "  atomesh preprocess nacl.dat -o nacl.crb\n"
      "  atomesh render nacl.crb -o nacl.png\n");

  Session session;
  std::vector<std::pair<CLI::App*, Command>> commands;
  for (const Subcommand& subcommand : subcommands) {
    CLI::App* words = app.add_subcommand(subcommand.name, subcommand.description);
    commands.emplace_back(words, subcommand.add(*words));
    session.add_options(*words);
  }

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    return report_parse_error(app, error);
  }
  for (const auto& [words, command] : commands) {
    if (!words->parsed()) continue;
    if (!files.empty() || !parameters.empty()) {
      return fail((files.empty() ? "--params" : files.front()) + " stands before the subcommand " + words->get_name() +
                      "; write it after\nTry: atomesh " + words->get_name() + " --help",
                  exit_usage);
    }
    session.begin();
    const int exit_code = command(session);
    session.finish();
    return exit_code;
  }
  return show_window(files, parameters, until_shown);
}

}  // namespace
}  // namespace atomesh::cli

int main(int argc, char** argv) {
  using atomesh::cli::fail;
  try {
    return atomesh::cli::run(argc, argv);
  } catch (const atomesh::Error& error) {
    return fail(error.what(), error.exit_code());
  } catch (const std::bad_alloc&) {
    return fail("not enough memory; try a thinned-out sample (--keep-every, --mask) or a machine with more",
                atomesh::cli::exit_unavailable);
  } catch (const std::exception& error) {
    return fail(std::string("stopped by an error nobody expected: ") + error.what() +
                    "; please report it with the command line and the file",
                atomesh::cli::exit_unavailable);
  }
}
