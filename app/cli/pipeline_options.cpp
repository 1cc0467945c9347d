#include "app/cli/pipeline_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "core/error.h"
#include "core/text_file.h"

namespace atomesh::cli {

namespace {

constexpr const char* reading_group = "Reading atoms";
constexpr const char* stages_group = "Preprocessing (when FILE holds atoms)";
constexpr const char* reduction_group = "Fewer atoms (when FILE holds atoms)";

bool is_pipeline_option(const CLI::Option& option) {
  const std::string& group = option.get_group();
  return group == reading_group || group == stages_group || group == reduction_group;
}

// One of `names`, else a UsageError with the nearest.
void check_choice(std::string_view option, const std::string& word, const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), word) != names.end()) return;
  const std::string nearest = nearest_name(word, names);
  throw UsageError(fmt::format("{}: there is no \"{}\"{}; there are {}", option, word,
                               nearest.empty() ? "" : ", did you mean \"" + nearest + "\"?", fmt::join(names, ", ")));
}

double number(std::string_view option, const std::string& text, double least, std::string_view expected) {
  double value = 0.0;
  if (!parse_real(text, value) || value < least) {
    throw UsageError(fmt::format("{}: expected {}, got \"{}\"", option, expected, text));
  }
  return value;
}

void add_length(CLI::App& app, const char* name, double& target, const char* help, const char* group) {
  app.add_option_function<std::string>(
         name,
         [name, &target](const std::string& text) { target = number(name, text, 0.0, "a length of 0 Å or more"); },
         help)
      ->type_name("LENGTH")
      ->group(group);
}

}  // namespace

void add_pipeline_options(CLI::App& app, PipelineOptions& options, const char* tolerance_names) {
  app.add_option_function<std::string>(
         "--format",
         [&options](const std::string& name) {
           check_choice("--format", name, read_format_names());
           options.read.format = name;
         },
         "Format of the atoms file; default: by extension and, failing that, by content")
      ->type_name("NAME")
      ->group(reading_group);
  app.add_option("--frame", options.read.frame, "Frame of a file with several, from 0; -1: the last")
      ->type_name("N")
      ->check(CLI::Range(-1L, 1000000000L))
      ->capture_default_str()
      ->group(reading_group);
  app.add_option("--type-names", options.read.type_names, "Element of type 1, 2, … of a LAMMPS file")
      ->type_name("EL…")
      ->delimiter(',')
      ->group(reading_group);

  app.add_option_function<std::string>(
         "--mesher",
         [&options](const std::string& name) {
           check_choice("--mesher", name, mesher_names());
           options.tetrahedralize.mesher = name;
         },
         "pattern: stamps the unit cell wherever the crystal is undisturbed; delaunay (CGAL); tetgen; auto: pattern "
         "where it serves, else delaunay [auto]")
      ->type_name("NAME")
      ->group(stages_group);
  app.add_option_function<std::string>(
         "--carve",
         [&options](const std::string& text) {
           options.carve = text != "off";
           if (text == "off" || text == "auto") return;
           const double radius = number("--carve", text, 0.0, "auto, off or a radius above 0 Å");
           if (radius == 0.0)
             throw UsageError("--carve: expected auto, off or a radius above 0 Å, got \"" + text + "\"");
           options.carve_options.radius = radius;
         },
         "Remove tetrahedra whose circumsphere is larger than RADIUS (Å): pores, cavities, concave outsides; auto: "
         "from "
         "the nearest-neighbour distances; off: keep the convex hull [auto]")
      ->type_name("auto|off|RADIUS")
      ->group(stages_group);
  app.add_option(
         "--unit-cell", options.unit_cell,
         "The perfect crystal to compare with: a .dat FILE with primitive and basis; found: told from the atoms; "
         "auto: the file's own, if it has one, else found; none: do not quantify defects")
      ->type_name("FILE|auto|found|none")
      ->capture_default_str()
      ->group(stages_group);
  app.add_option_function<std::string>(
         "--neighbourhood",
         [&options](const std::string& text) {
           options.defects.neighbourhood = number("--neighbourhood", text, 1e-6, "a factor above 0");
         },
         "Radius of the neighbourhood that is compared, in lengths of the longest (reduced) vector of the unit cell "
         "[1]")
      ->type_name("FACTOR")
      ->group(stages_group);
  add_length(app, tolerance_names, options.defects.tolerance,
             "Å within which an atom matches a site; 0: a fraction of the nearest-neighbour distance [0]",
             stages_group);
  app.add_option_function<std::string>(
         "--noise",
         [&options](const std::string& text) {
           options.defects.noise.reset();
           if (text != "auto")
             options.defects.noise = number("--noise", text, 0.0, "auto or an amplitude of 0 Å or more");
         },
         "Thermal amplitude of the atoms, rms per axis; auto: estimated from the sample; 0: none [auto]")
      ->type_name("auto|LENGTH")
      ->group(stages_group);
  app.add_option_function<std::string>(
         "--noise-factor",
         [&options](const std::string& text) {
           options.defects.noise_factor = number("--noise-factor", text, 0.0, "a factor of 0 or more");
         },
         "Displacements between neighbours up to so many thermal amplitudes count as zero [9]")
      ->type_name("FACTOR")
      ->group(stages_group);
  app.add_option("--smoothing", options.defects.smoothing,
                 "Rounds in which displacements are averaged over neighbours, so that what is displaced together "
                 "emerges from thermal noise")
      ->type_name("N")
      ->check(CLI::Range(0, 10))
      ->capture_default_str()
      ->group(stages_group);
  app.add_option("--scalar", options.scalar,
                 "Show a value instead of quantified defects: a column of the file, or values by species as Ga=0,In=1")
      ->type_name("COLUMN|EL=N,…")
      ->group(stages_group);

  app.add_flag("--simplify,!--no-simplify", options.simplify,
               "Take out, without loss, tetrahedra where nothing happens: fewer to store and to draw, but cut planes, "
               "which go by atoms, cut such a mesh coarsely [--no-simplify]")
      ->group(stages_group);
  app.add_option_function<std::string>(
         "--simplify-by",
         [&options](const std::string& name) {
           check_choice("--simplify-by", name, simplify_strategies());
           options.simplify = true;
           options.simplify_options.strategy = name;
         },
         "Simplify by collapse of edges, shortest first, or remove: vertices taken out of a Delaunay mesh, which stays "
         "Delaunay [collapse]")
      ->type_name("NAME")
      ->group(stages_group);

  app.add_option("--mask", options.reduce.mask, "Leave out these species")
      ->type_name("SPECIES…")
      ->delimiter(',')
      ->group(reduction_group);
  app.add_option("--keep-every", options.reduce.keep_every,
                 "Keep one of N atoms where nothing changes; boundary and transitions between species stay whole")
      ->type_name("N")
      ->check(CLI::Range(1UL, 1000000000UL))
      ->capture_default_str()
      ->group(reduction_group);
  add_length(app, "--transition-distance", options.reduce.transition_distance,
             "With --keep-every: keep atoms this near (Å) to another species; 0: 1.1 nearest-neighbour distances [0]",
             reduction_group);
  add_length(app, "--boundary-distance", options.reduce.boundary_distance,
             "With --keep-every: keep atoms this near (Å) to the box; 0: like --transition-distance [0]",
             reduction_group);
}

void reject_pipeline_options(const CLI::App& app, const std::string& path) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() > 0 && is_pipeline_option(*option)) {
      throw UsageError(option->get_name() + " has no effect on " + path +
                       ", which is preprocessed already, or a mesh; give it when preprocessing an atoms file");
    }
  }
}

}  // namespace atomesh::cli
