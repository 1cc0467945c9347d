// bench preprocess, part tetrahedralize.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/cli/bench_preprocess.h"
#include "core/circumsphere.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/predicates.h"
#include "preprocess/tetrahedralize.h"
#include "preprocess/tetrahedralize_cgal.h"
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
    {"turned", true, 0, 0, [](PlantedCrystalOptions& o) { o.rotation = 1; }},
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

struct Measured {
  Times times;
  std::size_t tetrahedra = 0;
  double bytes = 0.0;  // beyond the atoms, at the peak
  double bytes_each() const { return tetrahedra > 0 ? bytes / static_cast<double>(tetrahedra) : 0.0; }
};

// One crystal, every mesher; one line of the table.
class Case {
 public:
  Case(const PreprocessBench& bench, const std::string& structure, const Variant& variant, std::size_t atoms)
      : bench_(bench), variant_(variant) {
    PlantedCrystalOptions options;
    options.structure = structure;
    options.atoms = atoms;
    variant.change(options);
    const std::size_t most = atoms < 50000 ? 1 : 20;  // a small crystal has no room for twenty
    options.vacancies = std::min(most, variant.vacancies);
    options.interstitials = std::min(most, variant.interstitials);
    bench.session.progress().stage("grow " + structure);
    sample_ = make_planted_crystal(options, bench.session.progress());
    crystal_.grains = {*sample_.unit_cell};
    const std::size_t defects = options.vacancies + options.interstitials;
    name_ = fmt::format("{}, {}{}, {} atoms", structure, defects > 0 ? std::to_string(defects) + " " : "", variant.name,
                        grouped(sample_.atoms.size()));
  }

  // Cells in the order of `headings`.
  std::vector<std::string> run(bool delaunay, bool tetgen) {
    measure_stock();
    std::vector<std::string> cells{name_, milliseconds(stock_.times.median)};
    std::vector<std::string> behind{fmt::format("{:.0f}", stock_.bytes_each())};
    measure_ours("pattern", cells, behind);
    if (delaunay) {
      measure_ours("delaunay", cells, behind);
    } else {
      cells.emplace_back();
    }
    if (tetgen) {
      measure_ours("tetgen", cells, behind);
    } else {
      cells.emplace_back();
    }
    cells.insert(cells.end(), behind.begin(), behind.end());
    return cells;
  }

  static std::vector<std::string> headings() {
    return {"crystal",    "CGAL, ms",    "pattern, ms",    "× CGAL",     "× CGAL, CPU", "delaunay, ms",
            "TetGen, ms", "CGAL, B/tet", "pattern, B/tet", "tetrahedra", "stamped",     "mesh"};
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
  }

  // Times go to `cells`; what else there is to say of the pattern's mesh to `behind`, the columns after all times.
  void measure_ours(const std::string& mesher, std::vector<std::string>& cells, std::vector<std::string>& behind) {
    const bool pattern = mesher == "pattern";
    TetrahedralizeReport report;
    TetMesh mesh;
    Measured ours;
    try {
      const PeakMemory memory;
      ours.times = measure(
          pattern ? bench_.options.repeats : 1, bench_.session, name_ + ": " + mesher,
          [&] {
            mesh = {};
            mesh = tetrahedralize(sample_.atoms, crystal_, 0.0, {.mesher = mesher}, report, bench_.session.progress());
          },
          0);
      ours.bytes = memory.grown();
    } catch (const UnavailableError&) {
      cells.emplace_back("not built in");  // TetGen alone can be left out
      return;
    }
    ours.tetrahedra = mesh.tetrahedra.size();
    bench_.session.progress().stage("validate");
    const bool valid = validate(mesh, 1).empty();
    const double deepest = mesh.delaunay && valid ? deepest_in_sphere(mesh) : 0.0;
    const bool delaunay = mesh.delaunay && valid && deepest <= delaunay_tolerance;
    const double ratio = stock_.times.median / ours.times.median;

    BenchRow row = make_row(mesher, ours, pattern ? threads() : 1);
    row.peer = "CGAL";
    row.max_error = deepest;
    row.more.insert(row.more.end(), {{"peer_ms", stock_.times.median},
                                     {"ratio", ratio},
                                     {"cpu_ratio", stock_.times.cpu / ours.times.cpu},
                                     {"mesher", report.mesher},
                                     {"why", report.why},
                                     {"valid", valid},
                                     {"delaunay", delaunay}});
    cells.push_back(milliseconds(ours.times.median));
    if (pattern) {
      const double stamped = static_cast<double>(report.pattern.stamped) / static_cast<double>(ours.tetrahedra);
      row.more.emplace_back("stamped", stamped);
      if (variant_.required && sample_.atoms.size() > smallest_required) {
        row.requirements.push_back({"tetrahedralize: times CGAL's sequential Delaunay", 20.0, true, ratio, "×"});
        row.requirements.push_back({"tetrahedralize: peak bytes a tetrahedron", 64.0, false, ours.bytes_each(), " B"});
      }
      cells.push_back(fmt::format("{:.1f}", ratio));
      cells.push_back(fmt::format("{:.1f}", stock_.times.cpu / ours.times.cpu));
      const std::string sound = !valid ? "NOT VALID" : delaunay ? "Delaunay" : "valid";
      behind.insert(behind.end(), {fmt::format("{:.0f}", ours.bytes_each()), grouped(ours.tetrahedra),
                                   fmt::format("{:.1f} %", 100.0 * stamped),
                                   sound + (report.mesher == "pattern" ? "" : ", by " + report.mesher)});
    } else if (!valid) {
      cells.back() += ", NOT VALID";
    }
    bench_.result.add(std::move(row));
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
  const Variant& variant_;
  Sample sample_;
  Crystal crystal_;
  std::string name_;
  Measured stock_;
};

}  // namespace

void bench_tetrahedralize(const PreprocessBench& bench) {
  TextTable table(Case::headings());
  std::vector<std::size_t> sizes{bench.atoms(200000)};
  if (bench.options.atoms == 0) {
    if (bench.options.full) {
      sizes.push_back(1000000);
    } else {
      bench.result.not_measured("tetrahedralize: the same, 1,000,000 atoms", "--full");
    }
  }
  const bool small = sizes[0] <= 50000;
  for (const std::size_t atoms : sizes) {
    for (const char* structure : {"rock-salt", "fcc", "bcc", "diamond"}) {
      for (const Variant& variant : variants) {
        // CGAL needs seconds for each: by default every variant of one structure, and of the others the two that
        // matter most.
        const bool first = std::string_view(structure) == "rock-salt";
        const bool perfect = &variant == variants;
        const bool usual = first || &variant - variants < 2;
        if (!bench.options.full && !usual) continue;
        // A million atoms take CGAL half a minute: there every structure's perfect and its defective crystal.
        if (atoms > 500000 && &variant - variants >= 2) continue;
        const bool peers = small || (bench.options.full && atoms < 500000);
        table.row(Case(bench, structure, variant, atoms).run(perfect || peers, (first && perfect) || peers));
      }
    }
  }
  bench.result.tables.push_back(
      {"Tetrahedralization", std::move(table),
       fmt::format("Wall clock, once each (pattern: median of {}). CGAL: Delaunay_triangulation_3 over EPICK from a "
                   "range, one thread, points to triangulation. The others are --mesher pattern ({} threads; the unit "
                   "cell known), delaunay and tetgen: atoms to finished mesh. × CGAL: how many times faster the "
                   "pattern is, by the clock, as required, and by processor time. B/tet: the most memory held beyond "
                   "the atoms, by tetrahedron of the result. Stamped: share of the pattern's tetrahedra that needed "
                   "no triangulation. Empty: not run.",
                   bench.options.repeats, threads())});
}

}  // namespace atomesh::cli
