// Stamping against CGAL on all points: the same cells, whatever is wrong with the crystal.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/circumsphere.h"
#include "core/error.h"
#include "core/parallel.h"
#include "preprocess/canonical_tetrahedra.h"
#include "preprocess/carve.h"
#include "preprocess/gather_polytopes.h"
#include "preprocess/stamp_delaunay.h"
#include "preprocess/tetrahedralize.h"
#include "tests/support/lattices.h"
#include "tests/support/meshes.h"

namespace atomesh::test {
namespace {

// A crystal whose sites are known, as the walk over a sample would find them.
struct Placed {
  std::vector<Vec3> points;
  LatticeSites sites;
};

// Each atom near a site of a grain's cell (moved by its offset) gets it; grain g is where `inside` says so.
struct Grain {
  UnitCell cell;
  Vec3 offset{0.0};
  std::function<bool(const Vec3&)> inside = [](const Vec3&) { return true; };
};

Placed place(const std::vector<Vec3>& points, const std::vector<Grain>& grains, double tolerance = 0.5) {
  Placed result;
  result.points = points;
  result.sites.of.resize(points.size());
  for (const Grain& grain : grains) {
    const auto p = static_cast<std::uint16_t>(result.sites.patches.size());
    result.sites.patterns.push_back(make_lattice_template(grain.cell));
    const UnitCell& cell = result.sites.patterns.back().cell;
    LatticePatch patch;
    patch.pattern = p;
    patch.matrix = cell.matrix();
    // The origin is that of the cell given, whose basis was wrapped by whole vectors.
    patch.origin = grain.offset;
    const Mat3 inverse = glm::inverse(cell.matrix());
    for (std::size_t i = 0; i < points.size(); ++i) {
      LatticeSite& site = result.sites.of[i];
      if (site.patch != no_patch || !grain.inside(points[i])) continue;
      double best = tolerance;
      for (std::size_t b = 0; b < cell.basis.size(); ++b) {
        const Vec3 f = glm::round(inverse * (points[i] - grain.offset - cell.basis[b].position));
        const double off = glm::distance(points[i], grain.offset + cell.basis[b].position + cell.matrix() * f);
        if (off >= best) continue;
        best = off;
        site.patch = p;
        site.basis = static_cast<std::uint16_t>(b);
        for (int k = 0; k < 3; ++k) site.cell[k] = static_cast<std::int32_t>(f[k]);
      }
      if (site.patch == p) ++patch.atoms;
    }
    result.sites.patches.push_back(patch);
  }
  return result;
}

// The crystal's radius for carving, and nothing that a sphere of the crystal equals.
double radius_of(const Lattice& l) {
  return 1.83 * make_lattice_template(l.cell).largest_void;
}

// Polytopes of a mesh: corners of all cells on one sphere.
std::set<std::vector<Index>> polytopes(const TetMesh& mesh) {
  const PolytopeTolerance tolerance{1e-7, 1e-6};
  const auto sliver = find_slivers(mesh.tetrahedra, mesh.vertices, tolerance);
  std::set<std::vector<Index>> result;
  std::vector<Index> corners;
  const auto members = gather_polytopes(mesh.tetrahedra, mesh.vertices, face_neighbours(mesh), sliver, tolerance);
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Tetrahedron& t = mesh.tetrahedra[members[i].second];
    corners.insert(corners.end(), t.begin(), t.end());
    if (i + 1 < members.size() && members[i + 1].first == members[i].first) continue;
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    result.insert(corners);
    corners.clear();
  }
  return result;
}

struct Compared {
  StampReport report;
  TetMesh mesh;
};

Compared expect_delaunay(const Placed& placed, double radius, const std::string& what) {
  Compared result;
  result.mesh = mesh_of(placed.points, stamp_delaunay(placed.points, placed.sites, {radius}, result.report));
  result.mesh.delaunay = true;
  EXPECT_EQ(result.mesh.tetrahedra.size(), result.report.stamped + result.report.filled) << what;
  EXPECT_EQ(validate(result.mesh), std::vector<std::string>{}) << what;
  TetrahedralizeReport report;
  CarveReport carve_report;
  const TetMesh carved = carve(tetrahedralize(atoms_at(placed.points), {"delaunay"}, report), {radius}, carve_report);
  EXPECT_NEAR(volume(result.mesh), volume(carved), 1e-9 * volume(carved)) << what;
  const auto expected = polytopes(carved);
  const auto found = polytopes(result.mesh);
  std::size_t missing = 0;
  for (const auto& p : expected) missing += found.count(p) == 0 ? 1 : 0;
  EXPECT_EQ(missing, 0u) << what << " of " << expected.size();
  EXPECT_EQ(found.size(), expected.size()) << what;
  return result;
}

UnitCell turned(UnitCell cell) {
  for (Vec3& v : cell.primitive) v = odd_rotation() * v;
  for (BasisAtom& b : cell.basis) b.position = odd_rotation() * b.position;
  return cell;
}

std::array<int, 3> cells_for(const Lattice& l, double edge) {
  std::array<int, 3> n;
  for (int k = 0; k < 3; ++k) n[k] = static_cast<int>(std::ceil(edge / glm::length(l.cell.primitive[k])));
  return n;
}

Atoms block(const Lattice& l, double edge) {
  const auto n = cells_for(l, edge);
  return cut_block(l.cell, n[0], n[1], n[2]);
}

// Lattices of the tests with a skew primitive one and CsCl's.
std::vector<Lattice> crystals() {
  std::vector<Lattice> all = lattices();
  Lattice skew{"skew", {}, 3.0};
  skew.cell.primitive = {Vec3(3.1, 0, 0), Vec3(1.4, 3.7, 0), Vec3(5.1, -3.3, 4.2)};
  skew.cell.basis = {{"A", Vec3(0.0)}, {"B", Vec3(2.2, 0.4, 1.7)}};
  all.push_back(skew);
  return all;
}

TEST(StampDelaunay, PerfectBlocksNeedNoTriangulation) {
  for (const Lattice& l : crystals()) {
    const Compared c = expect_delaunay(place(block(l, 18.0).positions, {{l.cell}}), radius_of(l), l.name);
    // Where the block's faces are also those of polytopes, whole or without some corners.
    if (l.name == "sc" || l.name == "nacl" || l.name == "fcc" || l.name == "perovskite") {
      EXPECT_EQ(c.report.open_atoms, 0u) << l.name;
      EXPECT_EQ(c.report.filled, 0u) << l.name;
    }
    EXPECT_GT(c.report.stamped, 0u) << l.name;
  }
}

TEST(StampDelaunay, SpheresAndTurnedBlocks) {
  for (const Lattice& l : crystals()) {
    const UnitCell cell = turned(l.cell);
    const Vec3 half(9.0, 8.0, 10.0);
    for (const bool ball : {false, true}) {
      const Atoms atoms = ball ? cut_sphere(cell, 9.5) : cut_where(cell, half, [](const Vec3&) { return true; });
      const Compared c =
          expect_delaunay(place(atoms.positions, {{cell}}), radius_of(l), l.name + (ball ? " ball" : " block"));
      EXPECT_GT(c.report.stamped, 0u) << l.name;
    }
  }
}

TEST(StampDelaunay, VacanciesInterstitialsAndCavities) {
  for (const Lattice& l : crystals()) {
    for (const bool turn : {false, true}) {
      const UnitCell cell = turn ? turned(l.cell) : l.cell;
      Atoms atoms = block(l, 22.0);
      const Vec3 middle = bounds_of(atoms.positions).center();
      remove_nearest(atoms, middle + Vec3(5.0, 4.0, 3.0));
      remove_nearest(atoms, middle + Vec3(5.0, 4.0, 3.0));    // a neighbour of the first
      remove_nearest(atoms, bounds_of(atoms.positions).min);  // a corner of the block
      remove_nearest(atoms, middle + Vec3(-40.0, 0.0, 0.0));  // in its face
      std::vector<Vec3> points;
      for (const Vec3& p : atoms.positions) {
        if (glm::distance(p, middle - Vec3(4.0)) > 0.9 * l.nearest_neighbour) points.push_back(p);
      }
      points.push_back(middle + Vec3(0.31, 0.17, 0.47) * l.nearest_neighbour + Vec3(0, 0, 6.0));
      points.push_back(bounds_of(points).max + Vec3(0.7, 0.6, 0.9));  // beside the block
      points[points.size() / 3] += Vec3(0.11, 0.07, -0.05) * l.nearest_neighbour;
      points[points.size() / 2] += Vec3(0.31, -0.27, 0.05) * l.nearest_neighbour;
      if (turn) {
        for (Vec3& p : points) p = odd_rotation() * p;
      }
      const Compared c = expect_delaunay(place(points, {{cell}}), radius_of(l), l.name);
      EXPECT_GT(c.report.stamped, 0u) << l.name;
    }
  }
}

TEST(StampDelaunay, HalvesThatSlidAndGrainsThatTurned) {
  for (const Lattice& l : crystals()) {
    const auto left = [](const Vec3& p) { return p.x < 0.1; };
    const auto right = [](const Vec3& p) { return p.x >= 0.1; };
    const Vec3 half(11.0, 8.0, 9.0);
    const Vec3 slip(0.3, 0.9, -0.4);
    std::vector<Vec3> points = cut_where(l.cell, half, left).positions;
    std::vector<Vec3> slid = points;
    for (const Vec3& p : cut_where(l.cell, half, right).positions) slid.push_back(p + slip);
    Compared c = expect_delaunay(place(slid, {{l.cell, Vec3(0.0), left}, {l.cell, slip, right}}), radius_of(l),
                                 l.name + " slid");
    EXPECT_GT(c.report.stamped, 0u) << l.name;
    const UnitCell other = turned(l.cell);
    std::vector<Vec3> grains = points;
    for (const Vec3& p : cut_where(other, half, [](const Vec3& q) { return q.x >= 1.0; }).positions)
      grains.push_back(p);
    c = expect_delaunay(place(grains, {{l.cell, Vec3(0.0), left}, {other, Vec3(0.0), right}}), radius_of(l),
                        l.name + " grains");
    EXPECT_GT(c.report.stamped, 0u) << l.name;
  }
}

// Vacancies far inside a block: what CGAL gets does not grow with the block.
TEST(StampDelaunay, OpenAtomsStayNearTheVacancies) {
  const Lattice& l = lattice("nacl");
  std::size_t open = 0;
  for (const int n : {6, 9}) {
    Atoms atoms = cut_block(l.cell, n, n, n);
    for (const Vec3& p : {Vec3(10.0), Vec3(20.0, 12.0, 16.0)}) remove_nearest(atoms, p);
    const Compared c = expect_delaunay(place(atoms.positions, {{l.cell}}), radius_of(l), "nacl");
    EXPECT_LE(c.report.open_atoms, 2u * 26u);
    if (open != 0) {
      EXPECT_EQ(c.report.open_atoms, open);
    }
    open = c.report.open_atoms;
  }
  EXPECT_GE(open, 2u * 6u);
}

// Rounding as files have it, from far below the tolerance to far above: stamped or not, it is a sound mesh of the same
// volume.
TEST(StampDelaunay, RoundedPositions) {
  for (const Lattice& l : crystals()) {
    const double radius = radius_of(l);
    for (const double digit : {1e-10, 1e-8, 1e-7, 1e-6, 1e-5, 1e-3}) {
      const UnitCell cell = turned(l.cell);
      Atoms atoms = cut_where(cell, Vec3(11.0), [](const Vec3&) { return true; });
      remove_nearest(atoms, Vec3(5.0));
      for (Vec3& p : atoms.positions) p = glm::round(p / digit) * digit;
      const Placed placed = place(atoms.positions, {{cell}});
      StampReport report;
      const TetMesh mesh = mesh_of(placed.points, stamp_delaunay(placed.points, placed.sites, {radius}, report));
      EXPECT_EQ(validate(mesh), std::vector<std::string>{}) << l.name << " " << digit;
      TetrahedralizeReport mesh_report;
      CarveReport carve_report;
      const TetMesh carved =
          carve(tetrahedralize(atoms_at(placed.points), {"delaunay"}, mesh_report), {radius}, carve_report);
      EXPECT_NEAR(volume(mesh), volume(carved), 10.0 * digit * std::cbrt(volume(carved)) * std::cbrt(volume(carved)))
          << l.name << " " << digit;
      if (digit < 1e-7) {
        EXPECT_GT(report.stamped, 0u) << l.name << " " << digit;
      }
    }
  }
}

// With a tolerance as wide as the rounding, a file's crystal is cut as the exact one: nothing open that is not open
// there, no sliver, no slit.
TEST(StampDelaunay, RoundedCrystalsAreCutLikeExactOnes) {
  for (const Lattice& l : crystals()) {
    const UnitCell cell = turned(l.cell);
    Atoms exact = cut_where(cell, Vec3(12.0), [](const Vec3&) { return true; });
    remove_nearest(exact, Vec3(5.0));
    remove_nearest(exact, Vec3(-3.0, 2.0, 4.0));
    const double radius = radius_of(l);
    StampReport report;
    const Placed placed = place(exact.positions, {{cell}});
    const auto reference = stamp_delaunay(placed.points, placed.sites, {radius}, report);
    const double angle = min_dihedral_degrees(mesh_of(placed.points, reference));
    for (const double digit : {1e-6, 1e-4, 1e-3}) {
      Placed rounded = placed;
      for (Vec3& p : rounded.points) p = glm::round(p / digit) * digit;
      const double tolerance = 15.0 * digit / make_lattice_template(l.cell).largest_void;
      StampReport found;
      const TetMesh mesh =
          mesh_of(rounded.points, stamp_delaunay(rounded.points, rounded.sites, {radius, tolerance}, found));
      EXPECT_EQ(validate(mesh), std::vector<std::string>{}) << l.name << " " << digit;
      EXPECT_GT(found.stamped, 0u) << l.name << " " << digit;
      EXPECT_EQ(found.stamped + found.filled, reference.size()) << l.name << " " << digit;
      EXPECT_GT(min_dihedral_degrees(mesh), 0.9 * angle) << l.name << " " << digit;
    }
  }
}

// Atoms off their sites by anything between rounding and a bond, among vacancies: whatever side of a tolerance a
// polytope falls on, its neighbours agree.
TEST(StampDelaunay, DisplacementsOfEverySize) {
  std::size_t stamped = 0;
  for (const Lattice& l : crystals()) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const UnitCell cell = turned(l.cell);
      std::mt19937_64 generator(seed);
      std::uniform_real_distribution<double> uniform(0.0, 1.0);
      std::vector<Vec3> points;
      for (Vec3 p : cut_where(cell, Vec3(11.0), [](const Vec3&) { return true; }).positions) {
        if (uniform(generator) < 0.02) continue;
        if (uniform(generator) < 0.01) {
          const double size = std::pow(10.0, -9.0 * uniform(generator));
          for (int k = 0; k < 3; ++k) p[k] += size * (uniform(generator) - 0.5);
        }
        points.push_back(p);
      }
      const double radius = (1.1 + 0.4 * static_cast<double>(seed)) * make_lattice_template(l.cell).largest_void;
      const Placed placed = place(points, {{cell}});
      StampReport report;
      TetMesh mesh = mesh_of(points, stamp_delaunay(points, placed.sites, {radius}, report));
      mesh.delaunay = true;
      EXPECT_EQ(validate(mesh), std::vector<std::string>{}) << l.name << " " << seed;
      TetrahedralizeReport mesh_report;
      CarveReport carve_report;
      const TetMesh carved = carve(tetrahedralize(atoms_at(points), {"delaunay"}, mesh_report), {radius}, carve_report);
      EXPECT_NEAR(volume(mesh), volume(carved), 1e-8 * volume(carved)) << l.name << " " << seed;
      stamped += report.stamped;
    }
  }
  EXPECT_GT(stamped, 10000u);
}

// What is filled once and copied along faces, edges and from vacancy to vacancy is what would be found at each place.
TEST(StampDelaunay, CopiesAreWhatWouldBeFound) {
  std::size_t copied = 0, open = 0, open_without = 0;
  for (const Lattice& l : crystals()) {
    const UnitCell cell = turned(l.cell);
    const Vec3 odd(0.37, -0.81, 0.45);
    std::vector<std::vector<Vec3>> shapes{
        block(l, 26.0).positions, cut_sphere(cell, 13.0).positions,
        cut_where(cell, Vec3(13.0), [&](const Vec3& p) { return glm::dot(p, odd) < 4.0; }).positions};
    Atoms holes = block(l, 26.0);
    for (const Vec3& p : {Vec3(6.0), Vec3(13.0, 12.0, 14.0), Vec3(19.0, 18.0, 7.0)}) remove_nearest(holes, p);
    holes.positions[holes.size() / 2] += Vec3(0.1, 0.2, 0.1);
    shapes.push_back(holes.positions);
    transform(holes, odd_rotation());
    shapes.push_back(holes.positions);
    for (std::size_t n = 0; n < shapes.size(); ++n) {
      const bool is_turned = n == 1 || n == 2 || n == 4;
      const Placed placed = place(shapes[n], {{is_turned ? cell : l.cell}});
      StampReport with, without;
      auto a = stamp_delaunay(placed.points, placed.sites, {radius_of(l), 1e-7, true}, with);
      auto b = stamp_delaunay(placed.points, placed.sites, {radius_of(l), 1e-7, false}, without);
      put_in_canonical_order(a, placed.points.size());
      put_in_canonical_order(b, placed.points.size());
      EXPECT_EQ(a, b) << l.name << " " << n;
      EXPECT_EQ(with.stamped, without.stamped) << l.name << " " << n;
      EXPECT_EQ(without.copied, 0u);
      copied += with.copied;
      open += with.open_atoms;
      open_without += without.open_atoms;
    }
  }
  EXPECT_GT(copied, 1000u);
  EXPECT_LT(open, open_without);
}

// A face's interior costs no more however far it stretches.
TEST(StampDelaunay, OpenAtomsDoNotGrowWithTheFaces) {
  for (const char* name : {"diamond", "bcc"}) {
    const Lattice& l = lattice(name);
    std::vector<std::size_t> open;
    for (const double edge : {50.0, 60.0}) {
      const Placed placed = place(block(l, edge).positions, {{l.cell}});
      StampReport report;
      stamp_delaunay(placed.points, placed.sites, {radius_of(l)}, report);
      open.push_back(report.open_atoms);
    }
    EXPECT_EQ(open[0], open[1]) << name;
  }
}

// Patterns that hold nothing to stamp are no reason to leave anything out.
TEST(StampDelaunay, PatternsWithoutPolytopes) {
  const Lattice& l = lattice("fcc");
  Placed placed = place(block(l, 10.0).positions, {{l.cell}});
  placed.sites.patterns[0].polytopes.clear();
  const Compared c = expect_delaunay(placed, radius_of(l), "fcc");
  EXPECT_EQ(c.report.stamped, 0u);
}

TEST(StampDelaunay, NothingToStamp) {
  const std::vector<Vec3> points = random_atoms(500, 10.0, 7).positions;
  LatticeSites sites;
  sites.of.resize(points.size());
  StampReport report;
  TetMesh mesh = mesh_of(points, stamp_delaunay(points, sites, {1.5}, report));
  mesh.delaunay = true;
  EXPECT_EQ(validate(mesh), std::vector<std::string>{});
  EXPECT_EQ(report.stamped, 0u);
  EXPECT_EQ(report.filled, mesh.tetrahedra.size());
  sites.of.clear();
  EXPECT_TRUE(stamp_delaunay({}, sites, {1.5}, report).empty());
  EXPECT_THROW(stamp_delaunay(points, sites, {1.5}, report), UsageError);
  EXPECT_THROW(stamp_delaunay({}, sites, {0.0}, report), UsageError);
  EXPECT_THROW(stamp_delaunay({}, sites, {1.5, 0.5}, report), UsageError);
}

TEST(StampDelaunay, SameAtAnyNumberOfThreadsAndCancelled) {
  const Lattice& l = lattice("diamond");
  Atoms atoms = block(l, 25.0);
  remove_nearest(atoms, Vec3(11.0));
  const Placed placed = place(atoms.positions, {{l.cell}});
  StampReport report;
  std::vector<std::vector<Tetrahedron>> results;
  for (const int count : {1, 2, 5}) {
    set_threads(count);
    results.push_back(stamp_delaunay(placed.points, placed.sites, {radius_of(l)}, report));
  }
  set_threads(0);
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
  Progress progress;
  progress.request_cancel();
  EXPECT_THROW(stamp_delaunay(placed.points, placed.sites, {radius_of(l)}, report, progress), CancelledError);
}

}  // namespace
}  // namespace atomesh::test
