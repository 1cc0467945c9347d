// atomesh defects FILE: clusters of defective atoms and sites, as a list a person can check.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>

#include "app/cli/commands.h"
#include "app/cli/defect_table.h"
#include "app/cli/load_material.h"
#include "app/cli/output_file.h"
#include "app/cli/pipeline_options.h"
#include "app/cli/session.h"
#include "app/cli/text_table.h"
#include "app/cli/text_values.h"
#include "core/error.h"
#include "core/text_file.h"
#include "preprocess/cluster_defects.h"

namespace atomesh::cli {
namespace {

struct DefectsArguments {
  std::string input;
  std::string csv;
  std::string kind;
  std::size_t top = 0;
  double distance = 0.0;
  bool sites = false;
  PipelineOptions options;
};

struct Positional {
  std::size_t atoms = 0;
  double max = 0.0;
  double mean = 0.0;  // over those atoms
};

Positional summarize_positional(const Defects& defects) {
  Positional summary;
  double sum = 0.0;
  for (const float value : defects.positional) {
    if (value == 0.0F) continue;
    ++summary.atoms;
    sum += value;
    summary.max = std::max(summary.max, static_cast<double>(value));
  }
  if (summary.atoms > 0) summary.mean = sum / static_cast<double>(summary.atoms);
  return summary;
}

Json defects_json(const Material& material, const std::vector<DefectCluster>& clusters) {
  const Defects& defects = material.defects;
  const auto& species = material.atoms.species_table;
  Json vacancies = Json::array();
  for (const VacancySite& site : defects.vacancies) {
    vacancies.push(
        Json::object({{"position", site.position}, {"species", species[site.species].name}, {"votes", site.votes}}));
  }
  Json extras = Json::array();
  for (const ExtraAtom& extra : defects.extras) {
    extras.push(Json::object({{"atom", extra.atom},
                              {"species", material.atoms.species_name(extra.atom)},
                              {"position", material.atoms.positions[extra.atom]},
                              {"votes", extra.votes}}));
  }
  Json substitutions = Json::array();
  for (const Substitution& s : defects.substitutions) {
    substitutions.push(Json::object({{"atom", s.atom},
                                     {"species", material.atoms.species_name(s.atom)},
                                     {"expected", species[s.expected].name},
                                     {"position", material.atoms.positions[s.atom]}}));
  }
  const Positional positional = summarize_positional(defects);
  Json list = Json::array();
  for (const DefectCluster& cluster : clusters) {
    list.push(Json::object({{"kind", defect_kind_name(cluster.kind)},
                            {"centre", cluster.centre},
                            {"radius", cluster.radius},
                            {"atoms", cluster.atoms.size()},
                            {"vacancies", cluster.vacancies.size()},
                            {"extras", cluster.extras.size()},
                            {"substitutions", cluster.substitutions.size()},
                            {"peak", static_cast<double>(cluster.peak)}}));
  }
  return Json::object(
      {{"vacancies", vacancies},
       {"extras", extras},
       {"substitutions", substitutions},
       {"positional", Json::object({{"atoms", positional.atoms}, {"max", positional.max}, {"mean", positional.mean}})},
       {"clusters", list}});
}

int run_defects(const DefectsArguments& arguments, const CLI::App& app, Session& session) {
  const bool one_kind = !arguments.kind.empty();
  const DefectKind kind = one_kind ? defect_kind_from_name(arguments.kind) : DefectKind::mixed;
  const bool csv_to_stdout = arguments.csv == "-";
  if (csv_to_stdout && session.json_on_standard_output()) {
    throw UsageError("defects: --csv - and --json - cannot both have standard output; give one of them a file");
  }
  if (!arguments.csv.empty() && !csv_to_stdout) check_output(arguments.csv, {".csv"});
  if (arguments.sites && one_kind && kind != DefectKind::vacancy && kind != DefectKind::extra &&
      kind != DefectKind::substitution) {
    throw UsageError("defects: --sites lists vacancies, extra atoms and substitutions; --kind " + arguments.kind +
                     " has no sites");
  }

  const LoadedMaterial loaded =
      load_material(arguments.input, {.atoms = true, .tetrahedra = false, .surface = false, .defects = true}, app,
                    arguments.options, session);
  const Material& material = loaded.material;
  if (material.atoms.size() == 0) {
    throw InputError(arguments.input, 0, "is a mesh without atoms; defects are found from atoms");
  }
  if (!material.defects.present()) {
    throw InputError(
        arguments.input, 0,
        "has no defect values, because no unit cell was known; preprocess the atoms with --unit-cell FILE");
  }
  session.progress().stage("cluster_defects");
  const std::vector<DefectCluster> all = cluster_defects(material, arguments.distance, session.progress());
  std::vector<DefectCluster> clusters;
  std::copy_if(all.begin(), all.end(), std::back_inserter(clusters),
               [&](const DefectCluster& cluster) { return !one_kind || cluster.kind == kind; });
  const std::size_t found = clusters.size();
  if (arguments.top > 0 && found > arguments.top) clusters.resize(arguments.top);

  const TextTable table = arguments.sites
                              ? site_table(material, one_kind ? std::optional(kind) : std::nullopt, arguments.top)
                              : cluster_table(clusters);
  if (csv_to_stdout) {
    session.print_text(table.csv());
  } else {
    const Positional positional = summarize_positional(material.defects);
    const std::size_t substitutions = material.defects.substitutions.size();
    session.print("{} atoms: {} vacancies, {} extra atoms{}, {} atoms displaced (largest value {:.4g}, mean {:.4g})",
                  grouped(material.atoms.size()), grouped(material.defects.vacancies.size()),
                  grouped(material.defects.extras.size()),
                  substitutions > 0 ? fmt::format(" ({} of each make up a substitution)", grouped(substitutions)) : "",
                  grouped(positional.atoms), positional.max, positional.mean);
    session.print("{} clusters{}{}; lengths in Å", grouped(found), one_kind ? " of kind " + arguments.kind : "",
                  clusters.size() < found ? fmt::format(", the {} largest:", clusters.size()) : "");
    if (!table.empty()) session.print_text(table.text());
  }
  if (!arguments.csv.empty() && !csv_to_stdout) {
    AtomicFile file(arguments.csv);
    file.write(table.csv());
    file.commit();
  }
  if (session.json_wanted()) session.write_json(defects_json(material, clusters));
  return exit_done;
}

}  // namespace

Command add_defects(CLI::App& app) {
  auto arguments = std::make_shared<DefectsArguments>();
  app.add_option("FILE", arguments->input, "A .crb or .crt, or an atoms file to preprocess on the way")->required();
  app.add_flag(
      "--sites", arguments->sites,
      "List each vacant site, each extra atom and each substitution (an extra atom on a vacant site) instead of the "
      "clusters; --kind vacancy, extra or substitution: one of them");
  app.add_option("--csv", arguments->csv, "Write the list as CSV to FILE, or to standard output for -")
      ->type_name("FILE|-");
  app.add_option("--kind", arguments->kind,
                 "Only clusters of this kind: vacancy, extra, substitution, positional or mixed")
      ->type_name("KIND");
  app.add_option_function<std::string>(
         "--top", [arguments](const std::string& text) { arguments->top = parse_count("--top", text); },
         "Only the N largest clusters, or the first N sites; 0: all [0]")
      ->type_name("N");
  app.add_option("--join", arguments->distance,
                 "Defective atoms nearer than this (Å) belong to one cluster; 0: 1.3 nearest-neighbour distances")
      ->type_name("LENGTH")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  add_pipeline_options(app, arguments->options);
  app.footer("Example:\n  atomesh defects diamond.crb --kind vacancy --sites --csv vacancies.csv\n");
  return [arguments, &app](Session& session) { return run_defects(*arguments, app, session); };
}

}  // namespace atomesh::cli
