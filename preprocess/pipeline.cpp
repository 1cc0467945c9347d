#include "preprocess/pipeline.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <limits>
#include <new>
#include <optional>
#include <type_traits>
#include <utility>

#include "core/content_hash.h"
#include "core/error.h"
#include "core/memory.h"
#include "core/surface.h"
#include "preprocess/assign_scalar.h"
#include "preprocess/memory_needs.h"

namespace atomesh {

namespace {

// Runs the stages of one pipeline: announces each to the progress (where a cancel takes effect), and writes down how
// long it took and how much memory was held.
class StageClock {
 public:
  StageClock(const Material& material, std::vector<StageTime>& times, PipelineReport& report,
             const PipelineOptions& options, Progress& progress)
      : material_(material), times_(times), report_(report), options_(options), progress_(progress) {}

  template <class Work>
  auto operator()(const char* name, Work&& work) {
    tell_last();
    progress_.stage(name);
    reset_peak_memory();
    const auto start = std::chrono::steady_clock::now();
    const auto stop = [&] {
      const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
      times_.push_back({name, elapsed.count()});
      report_.stage_memory.push_back(recent_peak_memory());
      release_free_memory();
    };
    try {
      if constexpr (std::is_void_v<std::invoke_result_t<Work>>) {
        work();
        stop();
      } else {
        auto result = work();
        stop();
        return result;
      }
    } catch (const std::bad_alloc&) {
      throw UnavailableError(std::string(name) + ": the memory ran out; " + memory_advice());
    }
  }

  // What a stage returned is in the material only now that the next one is about to begin.
  void tell_last() {
    if (told_ == times_.size() || !options_.after_stage) return;
    told_ = times_.size();
    options_.after_stage(times_.back(), material_, report_);
  }

 private:
  const Material& material_;
  std::vector<StageTime>& times_;
  PipelineReport& report_;
  const PipelineOptions& options_;
  Progress& progress_;
  std::size_t told_ = 0;
};

bool reduces(const ReduceOptions& options) {
  return !options.mask.empty() || options.keep_every > 1;
}

// What was thinned out or masked no longer has the crystal's neighbours, and a unit cell serves no value of one's own
// choice but the mesher.
bool needs_crystal(const PipelineOptions& options) {
  if (reduces(options.reduce)) return false;
  const bool defects = options.wanted.defects && options.scalar.empty();
  const bool mesh = options.wanted.tetrahedra || options.wanted.surface;
  const std::string& mesher = options.tetrahedralize.mesher;
  return defects || (mesh && options.carve && (mesher == "auto" || mesher == "pattern"));
}

Crystal choose_crystal(const PipelineOptions& options, const std::optional<UnitCell>& of_file, const Atoms& atoms,
                       PipelineReport& report, Progress& progress) {
  const std::string& choice = options.unit_cell;
  Crystal crystal;
  if (choice == "auto" && of_file) crystal.grains = {*of_file};
  if (choice != "auto" && choice != "found" && choice != "none") crystal.grains = {read_unit_cell(choice)};
  report.unit_cell_source = crystal.known() ? "file" : "none";
  if (crystal.known() || choice == "none" || !needs_crystal(options)) return crystal;
  crystal = find_unit_cell(atoms, options.find_cell, report.find_cell, progress);
  if (crystal.known()) report.unit_cell_source = "found";
  return crystal;
}

// A sample of several grains carries the number of each atom's grain, -1 where there is none.
void add_grain_column(const Crystal& crystal, Atoms& atoms) {
  if (crystal.grain_of.empty() || atoms.find_column("grain") != nullptr) return;
  Column column{"grain", std::vector<double>(atoms.size())};
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    column.values[i] = crystal.grain_of[i] == no_grain ? -1.0 : static_cast<double>(crystal.grain_of[i]);
  }
  atoms.columns.push_back(std::move(column));
}

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ","));
}

void describe(const std::string& path, const PipelineOptions& options, const PipelineReport& report,
              Material& material) {
  Provenance& provenance = material.provenance;
  provenance.program = program_version();
  provenance.input = std::filesystem::path(path).filename().string();
  provenance.options = provenance_options(options, report.read.format);
  provenance.options.emplace_back("input_hash", report.read.hash);
  const std::size_t tetrahedra = material.mesh.tetrahedra.size();
  provenance.counts = {
      {"atoms_read", report.read.atoms},
      {"skipped", report.read.skipped},
      {"duplicates", report.read.duplicates},
      {"masked", report.reduce.masked},
      {"thinned_out", report.reduce.dropped},
      {"atoms", material.atoms.size()},
      {"vertices", material.mesh.vertices.size()},
      {"merged_vertices", report.tetrahedralize.merged_vertices},
      {"flat_removed", report.tetrahedralize.flat_removed},
      {"stamped", report.tetrahedralize.pattern.stamped},
      {"carved", report.carve.removed},
      {"tetrahedra_before_simplify", report.simplify.tetrahedra_before},
      {"tetrahedra", tetrahedra},
      {"triangles", material.surface.triangles.size()},
      {"positional_atoms", report.defects.positional_atoms},
      {"vacancy_atoms", report.defects.vacancy_atoms},
      {"extra_atoms", report.defects.extra_atoms},
      {"vacancies", material.defects.vacancies.size()},
      {"extras", material.defects.extras.size()},
      {"substitutions", material.defects.substitutions.size()},
      {"grains", report.find_cell.grains.size()},
  };
}

}  // namespace

std::vector<std::pair<std::string, std::string>> provenance_options(const PipelineOptions& options,
                                                                    const std::string& format) {
  const std::string& cell = options.unit_cell;
  return {
      {"format", format},
      {"frame", std::to_string(options.read.frame)},
      {"type_names", joined(options.read.type_names)},
      {"mask", joined(options.reduce.mask)},
      {"keep_every", std::to_string(options.reduce.keep_every)},
      {"transition_distance", fmt::format("{}", options.reduce.transition_distance)},
      {"boundary_distance", fmt::format("{}", options.reduce.boundary_distance)},
      {"mesher", options.tetrahedralize.mesher},
      {"carve", !options.carve                       ? "off"
                : options.carve_options.radius > 0.0 ? fmt::format("{}", options.carve_options.radius)
                                                     : "auto"},
      {"unit_cell", cell},
      {"unit_cell_hash", cell == "auto" || cell == "found" || cell == "none" ? "" : content_hash_of_file(cell)},
      {"neighbourhood", fmt::format("{}", options.defects.neighbourhood)},
      {"tolerance", fmt::format("{}", options.defects.tolerance)},
      {"noise", options.defects.noise ? fmt::format("{}", *options.defects.noise) : "auto"},
      {"noise_factor", fmt::format("{}", options.defects.noise_factor)},
      {"smoothing", std::to_string(options.defects.smoothing)},
      {"scalar", options.scalar},
      {"simplify", options.simplify ? options.simplify_options.strategy : "off"},
  };
}

std::string program_version() {
  return "atomesh " ATOMESH_VERSION;
}

Material preprocess(const std::string& path, const PipelineOptions& options, PipelineReport& report,
                    Progress& progress) {
  Material material;
  report = {};
  StageClock stage(material, material.provenance.stages, report, options, progress);
  const MaterialParts& wanted = options.wanted;

  Crystal crystal;
  {
    ReadResult read = stage("read_atoms", [&] { return read_atoms(path, options.read, progress); });
    report.read = std::move(read.report);
    material.atoms = std::move(read.atoms);
    crystal = stage("find_unit_cell",
                    [&] { return choose_crystal(options, read.unit_cell, material.atoms, report, progress); });
    if (crystal.known()) material.unit_cell = crystal.grains.front();
    add_grain_column(crystal, material.atoms);
  }
  if (reduces(options.reduce)) {
    if (options.tetrahedralize.mesher == "pattern") {
      throw UsageError(
          "the pattern mesher stamps a whole crystal, not what masking or thinning out leaves of it; "
          "take the mesher auto");
    }
    material.atoms =
        stage("reduce_atoms", [&] { return reduce_atoms(material.atoms, options.reduce, report.reduce, progress); });
  }

  // The surface is the boundary of the mesh. Defects need neither.
  if (wanted.tetrahedra || wanted.surface) {
    // What thinning out left has no nearest-neighbour distance to tell matter from emptiness by.
    const bool thinned = report.reduce.dropped > 0;
    const bool carves = options.carve && (!thinned || options.carve_options.radius > 0.0);
    material.mesh = stage("tetrahedralize", [&] {
      const double radius = carves ? options.carve_options.radius : std::numeric_limits<double>::infinity();
      const Crystal none;
      TetrahedralizeOptions mesher = options.tetrahedralize;
      mesher.must_be_delaunay =
          options.simplify && wanted.tetrahedra && needs_delaunay(options.simplify_options.strategy);
      return tetrahedralize(material.atoms, reduces(options.reduce) ? none : crystal, radius, mesher,
                            report.tetrahedralize, progress);
    });
    if (options.carve && !carves) {
      report.notes.emplace_back(
          "nothing was carved: the sample was thinned out, so no radius can be told from it; give one with --carve");
    } else if (carves) {
      require_memory_for("carve", material.mesh.tetrahedra.size(), "tetrahedra",
                         memory_to_carve(material.mesh.vertices.size(), material.mesh.tetrahedra.size()));
      material.mesh = stage(
          "carve", [&] { return carve(std::move(material.mesh), options.carve_options, report.carve, progress); });
    }
    if (wanted.surface) {
      require_memory_for("extract_surface", material.mesh.tetrahedra.size(), "tetrahedra",
                         memory_to_extract_surface(material.mesh.vertices.size(), material.mesh.tetrahedra.size()));
      material.surface = stage("extract_surface", [&] { return extract_surface(material.mesh, progress); });
    }
  }

  if (wanted.defects && !options.scalar.empty()) {
    material.defects = stage("assign_scalar", [&] { return assign_scalar(material.atoms, options.scalar); });
  } else if (wanted.defects && reduces(options.reduce)) {
    report.notes.emplace_back(
        "defects were not quantified: a reduced sample no longer has the crystal's neighbours; choose what to show "
        "with --scalar");
  } else if (wanted.defects && crystal.known()) {
    require_memory_for("quantify_defects", material.atoms.size(), "atoms",
                       memory_to_quantify_defects(material.atoms.size()));
    material.defects = stage("quantify_defects", [&] {
      return quantify_defects(material.atoms, crystal, options.defects, report.defects, progress);
    });
  } else if (wanted.defects) {
    const std::string& why = report.find_cell.why;
    report.notes.push_back("defects were not quantified: " + (why.empty() ? "no unit cell is known" : why) +
                           "; give one with --unit-cell, or a value to show with --scalar");
  }

  if (options.simplify && wanted.tetrahedra) {
    if (options.before_simplify) options.before_simplify(material);
    require_memory_for("simplify", material.mesh.tetrahedra.size(), "tetrahedra",
                       memory_to_simplify(material.mesh.vertices.size(), material.mesh.tetrahedra.size()));
    stage("simplify", [&] {
      simplify(material.mesh, material.surface, material.atoms, material.defects, options.simplify_options,
               report.simplify, progress);
    });
  }
  if (wanted.tetrahedra || wanted.surface) {
    stage("measure", [&] {
      report.volume = volume(material.mesh, progress);
      report.min_dihedral_deg = min_dihedral_degrees(material.mesh, progress);
      report.surface_area = area(material.surface, material.mesh.vertices);
      report.surface_closed = is_closed(material.surface, progress);
    });
  }

  stage.tell_last();
  describe(path, options, report, material);
  return material;
}

}  // namespace atomesh
