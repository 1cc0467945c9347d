// bench preprocess, part tetrahedralize.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/cli/bench_preprocess.h"
#include "core/circumsphere.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/predicates.h"
#include "preprocess/canonical_tetrahedra.h"
#include "preprocess/tetrahedralize.h"
#include "preprocess/tetrahedralize_cgal.h"
#include "preprocess/tetrahedralize_pattern.h"
#include "samples/planted_crystal.h"

namespace atomesh::cli {

namespace {

constexpr std::size_t smallest_required = 190000;  // the requirements speak of 200,000 atoms and more

struct Variant {
  const char* name;
  bool required;  // perfect or lightly defective: the pattern must be 20 times as fast as CGAL
  std::size_t vacancies, interstitials;
  void (*change)(PlantedCrystalOptions&);
};

constexpr void unchanged(PlantedCrystalOptions&) {}

constexpr Variant variants[] = {
    {"perfect", true, 0, 0, unchanged},
    {"vacancies", true, 20, 0, unchanged},
    {"interstitials", true, 0, 20, unchanged},
    {"rotated", true, 0, 0, [](PlantedCrystalOptions& o) { o.rotation = 1; }},
    {"sphere", true, 0, 0, [](PlantedCrystalOptions& o) { o.shape = PlantedShape::sphere; }},
    {"1 % noise", false, 0, 0, [](PlantedCrystalOptions& o) { o.noise = 0.01; }},
};

// How far, as a share of the radius, a vertex reaches into the sphere of a tetrahedron it shares a face with; 0 for a
// mesh that is Delaunay to the last bit. (Delaunay across every face is Delaunay.)
double deepest_in_sphere(const TetMesh& mesh) {
  const std::vector<std::array<Index, 4>> neighbours = face_neighbours(mesh);
  std::vector<double> deepest((mesh.tetrahedra.size() >> 14) + 1, 0.0);
  parallel_for(mesh.tetrahedra.size(), std::size_t{1} << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Tetrahedron& tetrahedron = mesh.tetrahedra[t];
      const auto corner = [&](std::size_t i) -> const Vec3& { return mesh.vertices[tetrahedron[i]]; };
      for (std::size_t f = 0; f < 4; ++f) {
        const Index other = neighbours[t][f];
        if (other == no_index || other < t) continue;
        Index apex = no_index;  // the vertex of the other one that is not on the face
        for (const Index v : mesh.tetrahedra[other]) {
          if (std::find(tetrahedron.begin(), tetrahedron.end(), v) == tetrahedron.end()) apex = v;
        }
        const Vec3& e = mesh.vertices[apex];
        if (in_sphere(corner(0), corner(1), corner(2), corner(3), e) <= 0) continue;
        const Sphere sphere = circumsphere(corner(0), corner(1), corner(2), corner(3));
        const double depth = 1.0 - glm::distance(sphere.center, e) / sphere.radius;
        deepest[begin >> 14] = std::max(deepest[begin >> 14], std::max(depth, 1e-16));
      }
    }
  });
  return *std::max_element(deepest.begin(), deepest.end());
}

// Atoms whose cell is known → mesh, by the pattern. `steps` says how long each of its steps took.
TetMesh mesh_by_pattern(const Sample& sample, TetrahedralizeReport& report, std::string& steps, Session& session) {
  const auto timed = [&](const char* step, auto&& work) {
    const Times times = measure(1, session, step, work, 0);
    steps += fmt::format("{}{} {}", steps.empty() ? "" : ", ", step, milliseconds(times.median));
  };
  steps.clear();
  Progress& progress = session.progress();
  Crystal crystal;
  crystal.grains = {*sample.unit_cell};
  LatticeSites sites;
  PatternReport pattern;
  TetMesh mesh;
  timed("sites", [&] { sites = assign_lattice_sites(sample.atoms, crystal, {}, progress); });
  timed("pattern", [&] {
    mesh.vertices = sample.atoms.positions;
    mesh.tetrahedra = tetrahedralize_pattern(mesh.vertices, std::move(sites), {}, pattern, progress);
  });
  if (!pattern.done) throw UnavailableError(pattern.why);
  timed("order", [&] {
    mesh.vertex_atom.resize(mesh.vertices.size());
    std::iota(mesh.vertex_atom.begin(), mesh.vertex_atom.end(), Index{0});
    put_in_canonical_order(mesh.tetrahedra, mesh.vertices.size());
  });
  mesh.delaunay = pattern.delaunay;
  report.mesher = "pattern";
  report.why = pattern.why;
  return mesh;
}

struct Measured {
  Times times;
  std::size_t tetrahedra = 0;
  double bytes = 0.0;  // beyond the atoms, at the peak
  double bytes_each() const { return tetrahedra > 0 ? bytes / static_cast<double>(tetrahedra) : 0.0; }
};

class Case {
 public:
  Case(const PreprocessBench& bench, TextTable& table, const std::string& structure, const Variant& variant,
       std::size_t atoms)
      : bench_(bench), table_(table), variant_(variant) {
    PlantedCrystalOptions options;
    options.structure = structure;
    options.atoms = atoms;
    variant.change(options);
    const std::size_t most = atoms < 50000 ? 1 : 20;  // a small crystal has no room for twenty
    options.vacancies = std::min(most, variant.vacancies);
    options.interstitials = std::min(most, variant.interstitials);
    bench.session.progress().stage("grow " + structure);
    sample_ = make_planted_crystal(options, bench.session.progress());
    const std::size_t defects = options.vacancies + options.interstitials;
    name_ = fmt::format("{}, {}{}, {} atoms", structure, defects > 0 ? std::to_string(defects) + " " : "", variant.name,
                        grouped(sample_.atoms.size()));
  }

  void run(bool tetgen) {
    measure_stock();
    for (const char* mesher : {"pattern", "delaunay", "tetgen"}) {
      if (std::string_view(mesher) != "tetgen" || tetgen) measure_ours(mesher);
    }
  }

 private:
  void measure_stock() {
    const PeakMemory memory;
    stock_.times = measure(
        1, bench_.session, name_ + ": CGAL", [&] { stock_.tetrahedra = delaunay_cgal_stock(sample_.atoms.positions); },
        0);
    stock_.bytes = memory.grown();
    BenchRow row = make_row("CGAL Delaunay_triangulation_3", stock_, 1);
    row.peer = "CGAL";
    bench_.result.add(std::move(row));
    table_.row({name_, "CGAL", milliseconds(stock_.times.median), milliseconds(stock_.times.cpu), "1",
                grouped(stock_.tetrahedra), fmt::format("{:.0f}", stock_.bytes_each()), "", "", ""});
  }

  void measure_ours(const std::string& mesher) {
    TetrahedralizeOptions options;
    options.mesher = mesher;
    TetrahedralizeReport report;
    std::string steps;  // of the pattern, ms
    TetMesh mesh;
    Measured ours;
    try {
      const PeakMemory memory;
      ours.times = measure(
          mesher == "tetgen" ? 1 : bench_.options.repeats, bench_.session, name_ + ": " + mesher,
          [&] {
            mesh = {};
            mesh = mesher == "pattern" ? mesh_by_pattern(sample_, report, steps, bench_.session)
                                       : tetrahedralize(sample_.atoms, options, report, bench_.session.progress());
          },
          0);
      ours.bytes = memory.grown();
    } catch (const UnavailableError& error) {
      table_.row({name_, mesher, "-", "-", "-", "-", "-", error.what(), "", ""});
      return;
    }
    ours.tetrahedra = mesh.tetrahedra.size();
    bench_.session.progress().stage("validate");
    const bool valid = validate(mesh, 1).empty();
    const double deepest = mesh.delaunay && valid ? deepest_in_sphere(mesh) : 0.0;
    const bool delaunay = mesh.delaunay && valid && deepest <= delaunay_tolerance;
    const double ratio = stock_.times.median / ours.times.median;

    BenchRow row = make_row(mesher, ours, mesher == "pattern" ? threads() : 1);
    row.peer = "CGAL";
    row.max_error = deepest;
    row.more.insert(row.more.end(), {{"peer_ms", stock_.times.median},
                                     {"ratio", ratio},
                                     {"steps_ms", steps.empty() ? Json() : Json(steps)},
                                     {"cpu_ratio", stock_.times.cpu / ours.times.cpu},
                                     {"valid", valid},
                                     {"delaunay", delaunay}});
    std::string required;
    if (mesher == "pattern" && variant_.required && sample_.atoms.size() > smallest_required) {
      row.requirements.push_back({"pattern: times CGAL's sequential Delaunay", 20.0, true, ratio, "×"});
      row.requirements.push_back({"pattern: peak bytes a tetrahedron", 64.0, false, ours.bytes_each(), ""});
      required = row.requirements[0].text() + "; " + row.requirements[1].text();
    }
    bench_.result.add(std::move(row));
    const std::string soundness = !valid ? "NOT VALID" : delaunay ? "valid, Delaunay" : "valid, not Delaunay";
    table_.row({name_, report.mesher, milliseconds(ours.times.median), milliseconds(ours.times.cpu),
                short_number(ratio), grouped(ours.tetrahedra), fmt::format("{:.0f}", ours.bytes_each()), soundness,
                steps, required});
  }

  BenchRow make_row(const std::string& what, const Measured& measured, int cores) const {
    BenchRow row{
        "preprocess", name_, "tetrahedralize: " + what, Json::object({{"threads", cores}}), "", measured.times, {},
        {},           {}};
    row.more = {{"atoms", sample_.atoms.size()},
                {"tetrahedra", measured.tetrahedra},
                {"rate", measured.times.per_core(static_cast<double>(sample_.atoms.size()))},
                {"rate_unit", "atoms/s/core"},
                {"memory_mb", 1e-6 * measured.bytes},
                {"bytes_per_tetrahedron", measured.bytes_each()}};
    return row;
  }

  const PreprocessBench& bench_;
  TextTable& table_;
  const Variant& variant_;
  Sample sample_;
  std::string name_;
  Measured stock_;
};

}  // namespace

void bench_tetrahedralize(const PreprocessBench& bench) {
  TextTable table(
      {"crystal", "mesher", "ms", "CPU ms", "times CGAL", "tetrahedra", "peak B/tet", "mesh", "steps, ms", "required"});
  std::vector<std::size_t> sizes{bench.atoms(200000)};
  if (bench.options.full && bench.options.atoms == 0) sizes.push_back(1000000);
  const bool small = sizes[0] <= 50000;
  for (const std::size_t atoms : sizes) {
    for (const char* structure : {"rock-salt", "fcc", "diamond"}) {
      for (const Variant& variant : variants) {
        // CGAL needs seconds for each: by default every variant of one structure, and of the others the two that
        // matter most.
        const bool first = std::string_view(structure) == "rock-salt";
        const bool usual = first || &variant - variants < 2;
        if (!bench.options.full && !usual) continue;
        const bool tetgen = bench.options.full || small || (first && &variant == variants);
        Case(bench, table, structure, variant, atoms).run(tetgen);
      }
    }
  }
  bench.result.tables.push_back(
      {"Tetrahedralization", std::move(table),
       "CGAL: Delaunay_triangulation_3 over EPICK from a range, sequential, points to triangulation. The others: atoms "
       "to TetMesh, everything included. Bytes: the most memory held beyond the atoms, by tetrahedron of the result."});
}

}  // namespace atomesh::cli
