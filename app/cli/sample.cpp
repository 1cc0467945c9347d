// atomesh sample NAME -o FILE: a sample material, and the truth about what was planted in it.
#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <memory>

#include "app/cli/commands.h"
#include "app/cli/output_file.h"
#include "app/cli/session.h"
#include "app/cli/species_count.h"
#include "app/cli/text_table.h"
#include "app/cli/text_values.h"
#include "core/error.h"
#include "core/text_file.h"
#include "preprocess/write_atoms.h"
#include "samples/samples.h"

namespace atomesh::cli {
namespace {

struct SampleArguments {
  std::string name;
  std::string output;
  std::string truth;
  SampleOptions options;
  bool list = false;
};

int list_samples(Session& session) {
  TextTable table({"name", "atoms", "what it is"});
  Json json = Json::array();
  for (const SampleInfo& sample : sample_table()) {
    table.row({std::string(sample.name), grouped(sample.seed_atoms), std::string(sample.description)});
    json.push(Json::object({{"name", sample.name},
                            {"title", sample.title},
                            {"atoms", sample.seed_atoms},
                            {"description", sample.description}}));
  }
  session.print_text(table.text());
  session.write_json(Json::object({{"samples", json}}));
  return exit_done;
}

Json cell_json(const UnitCell& cell) {
  Json basis = Json::array();
  for (const BasisAtom& atom : cell.basis) {
    basis.push(Json::object({{"species", atom.species}, {"position", atom.position}}));
  }
  return Json::object(
      {{"primitive", Json::array({cell.primitive[0], cell.primitive[1], cell.primitive[2]})}, {"basis", basis}});
}

// Positions for a machine to look for; beside them the species and the atoms' indices.
Json truth_json(const Sample& sample) {
  Json vacancies = Json::array();
  Json vacancy_species = Json::array();
  for (const SampleTruth::Site& site : sample.truth.vacancies) {
    vacancies.push(site.position);
    vacancy_species.push(site.species);
  }
  Json extras = Json::array();
  Json extra_atoms = Json::array();
  for (const Index atom : sample.truth.extras) {
    extras.push(sample.atoms.positions[atom]);
    extra_atoms.push(atom);
  }
  Json displaced = Json::array();
  for (const Index atom : sample.truth.displaced) displaced.push(atom);
  // Foreign atoms on sites, which stand among the extras too and their sites among the vacancies.
  Json substitutions = Json::array();
  Json substitution_atoms = Json::array();
  for (const SampleTruth::Substitution& substitution : sample.truth.substitutions) {
    substitutions.push(sample.atoms.positions[substitution.atom]);
    substitution_atoms.push(substitution.atom);
  }
  return Json::object({{"atoms", sample.atoms.size()},
                       {"unit_cell", sample.unit_cell ? cell_json(*sample.unit_cell) : Json()},
                       {"vacancies", vacancies},
                       {"vacancy_species", vacancy_species},
                       {"extras", extras},
                       {"extra_atoms", extra_atoms},
                       {"substitutions", substitutions},
                       {"substitution_atoms", substitution_atoms},
                       {"displaced", displaced}});
}

int run_sample(const SampleArguments& arguments, Session& session) {
  if (arguments.list) return list_samples(session);
  if (arguments.name.empty()) throw UsageError("sample: which one? atomesh sample --list names them");
  if (arguments.output.empty()) throw UsageError("sample: expected -o FILE (.dat or .xyz)");
  check_output(arguments.output, {".dat", ".xyz"});
  if (!arguments.truth.empty()) check_output_folder(arguments.truth);

  const auto start = std::chrono::steady_clock::now();
  const Sample sample = make_sample(arguments.name, arguments.options, session.progress());
  session.progress().stage("write_atoms");
  write_atoms(arguments.output, sample.atoms, sample.unit_cell, session.progress());
  if (!arguments.truth.empty()) {
    AtomicFile file(arguments.truth);
    file.write(truth_json(sample).text());
    file.commit();
  }
  const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();

  const SampleTruth& truth = sample.truth;
  const auto bytes = std::filesystem::file_size(arguments.output);
  session.print("{}: {} atoms ({}); planted: {} vacancies, {} extra atoms, {} displaced; {}, {} ms", arguments.output,
                grouped(sample.atoms.size()), species_text(sample.atoms), grouped(truth.vacancies.size()),
                grouped(truth.extras.size()), grouped(truth.displaced.size()), byte_size(bytes), milliseconds(ms));
  session.write_json(Json::object({{"name", arguments.name},
                                   {"seed", arguments.options.seed},
                                   {"atoms", sample.atoms.size()},
                                   {"species", species_json(sample.atoms)},
                                   {"vacancies", truth.vacancies.size()},
                                   {"extras", truth.extras.size()},
                                   {"displaced", truth.displaced.size()},
                                   {"output", Json::object({{"file", arguments.output}, {"bytes", bytes}})},
                                   {"total_ms", ms}}));
  return exit_done;
}

}  // namespace

Command add_sample(CLI::App& app) {
  auto arguments = std::make_shared<SampleArguments>();
  app.add_option("NAME", arguments->name, "The sample to grow; see --list");
  app.add_option("-o,--output", arguments->output, "The atoms file to write, .dat or .xyz")->type_name("FILE");
  app.add_option_function<std::string>(
         "--atoms", [arguments](const std::string& text) { arguments->options.atoms = parse_count("--atoms", text); },
         "Atoms aimed at, as nearly as the lattice allows; 0: as many as the published data set has [0]")
      ->type_name("N");
  app.add_option_function<std::string>(
         "--seed", [arguments](const std::string& text) { arguments->options.seed = parse_count("--seed", text); },
         "Seed of every random choice [1]")
      ->type_name("S");
  app.add_option("--truth", arguments->truth, "Also write what was planted, and where, as JSON")->type_name("FILE");
  app.add_flag("--list", arguments->list, "List the samples and exit");
  app.footer("Example:\n  atomesh sample diamond-vacancy --atoms 20000 -o diamond.dat --truth diamond.json\n");
  return [arguments](Session& session) { return run_sample(*arguments, session); };
}

}  // namespace atomesh::cli
