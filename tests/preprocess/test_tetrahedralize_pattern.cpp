#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/error.h"
#include "core/parallel.h"
#include "core/surface.h"
#include "preprocess/carve.h"
#include "preprocess/insert_points.h"
#include "preprocess/mend_tetrahedra.h"
#include "preprocess/tetrahedralize.h"
#include "preprocess/tetrahedralize_pattern.h"
#include "samples/samples.h"
#include "tests/support/lattices.h"

namespace atomesh {
namespace {

TetMesh mesh_of(const Atoms& atoms, std::vector<Tetrahedron> tetrahedra, bool delaunay) {
  TetMesh mesh;
  mesh.vertices = atoms.positions;
  mesh.vertex_atom.resize(atoms.size());
  std::iota(mesh.vertex_atom.begin(), mesh.vertex_atom.end(), Index{0});
  mesh.tetrahedra = std::move(tetrahedra);
  mesh.delaunay = delaunay;
  return mesh;
}

struct Pattern {
  TetMesh mesh;  // carved
  PatternReport report;
};

Pattern by_pattern(const Atoms& atoms, const Crystal& crystal, const PatternOptions& options = {}) {
  Pattern result;
  auto tetrahedra =
      tetrahedralize_pattern(atoms.positions, assign_lattice_sites(atoms, crystal, {}), options, result.report);
  EXPECT_EQ(result.report.done, !tetrahedra.empty());
  EXPECT_FALSE(result.report.why.empty());
  const TetMesh whole = mesh_of(atoms, std::move(tetrahedra), result.report.delaunay);
  EXPECT_EQ(validate(whole), std::vector<std::string>{}) << result.report.why;
  CarveReport report;
  result.mesh = carve(whole, {}, report);
  return result;
}

struct Full {
  TetMesh mesh;  // carved
  CarveReport report;
};

Full by_delaunay(const Atoms& atoms) {
  Full result;
  TetrahedralizeReport report;
  result.mesh = carve(tetrahedralize(atoms, {"delaunay"}, report), {}, result.report);
  return result;
}

// Vertices that one mesh has a tetrahedron at and the other has not.
std::size_t missing(const TetMesh& mesh, const TetMesh& from) {
  std::vector<int> used(mesh.vertices.size(), 0);
  for (const Tetrahedron& t : mesh.tetrahedra) {
    for (const Index v : t) used[v] |= 1;
  }
  for (const Tetrahedron& t : from.tetrahedra) {
    for (const Index v : t) used[v] |= 2;
  }
  return static_cast<std::size_t>(std::count(used.begin(), used.end(), 1));
}

void expect_same(const Atoms& atoms, const Pattern& pattern, const std::string& what) {
  ASSERT_TRUE(pattern.report.done && pattern.report.delaunay) << what << ": " << pattern.report.why;
  const Full full = by_delaunay(atoms);
  EXPECT_NEAR(volume(pattern.mesh) / volume(full.mesh), 1.0, 1e-9) << what;
  EXPECT_NEAR(area(extract_surface(pattern.mesh), atoms.positions) / area(extract_surface(full.mesh), atoms.positions),
              1.0, 1e-6)
      << what;
  EXPECT_EQ(missing(full.mesh, pattern.mesh), 0U) << what;
}

Atoms noisy(Atoms atoms, double sigma, std::uint64_t seed = 1) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal(0.0, sigma);
  for (Vec3& p : atoms.positions) {
    for (int k = 0; k < 3; ++k) p[k] += normal(generator);
  }
  return atoms;
}

Atoms thinned(const Atoms& atoms, double share, std::uint64_t seed = 3) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform;
  std::vector<Index> kept;
  for (Index i = 0; i < atoms.size(); ++i) {
    if (uniform(generator) > share) kept.push_back(i);
  }
  return atoms.subset(kept);
}

UnitCell turned(UnitCell cell, const Mat3& rotation) {
  for (Vec3& v : cell.primitive) v = rotation * v;
  for (BasisAtom& atom : cell.basis) atom.position = rotation * atom.position;
  return cell;
}

Atoms joined(Atoms atoms, const Atoms& more) {
  for (std::size_t i = 0; i < more.size(); ++i) {
    atoms.positions.push_back(more.positions[i]);
    atoms.species.push_back(atoms.add_species(more.species_name(i)));
  }
  return atoms;
}

TEST(TetrahedralizePattern, PerfectCrystalsAreDelaunay) {
  for (const test::Lattice& lattice : test::lattices()) {
    for (const bool turn : {false, true}) {
      Atoms atoms = test::shuffled(test::cut_sphere(lattice.cell, 8.0 * lattice.nearest_neighbour), 2);
      UnitCell cell = lattice.cell;
      if (turn) {
        test::transform(atoms, test::odd_rotation());
        cell = turned(cell, test::odd_rotation());
      }
      const Pattern pattern = by_pattern(atoms, {{cell}, {}});
      expect_same(atoms, pattern, lattice.name);
      EXPECT_GT(pattern.report.stamped, pattern.report.filled) << lattice.name;
    }
  }
}

TEST(TetrahedralizePattern, VacanciesInterstitialsAndForeignAtoms) {
  for (const test::Lattice& lattice : test::lattices()) {
    Atoms atoms = thinned(test::cut_sphere(lattice.cell, 9.0 * lattice.nearest_neighbour), 0.01);
    const std::uint16_t foreign = atoms.add_species("Xe");
    for (std::size_t i = 0; i < atoms.size(); i += 50) atoms.species[i] = foreign;
    atoms.positions.push_back(Vec3(0.31, 0.87, -0.53));
    atoms.species.push_back(foreign);
    expect_same(atoms, by_pattern(atoms, {{lattice.cell}, {}}), lattice.name);
  }
}

TEST(TetrahedralizePattern, CellGivenNeedNotBeExact) {
  for (const test::Lattice& lattice : test::lattices()) {
    UnitCell given = lattice.cell;
    for (Vec3& v : given.primitive) v *= 1.001;
    for (BasisAtom& atom : given.basis) {
      atom.position *= 1.001;
      for (int k = 0; k < 3; ++k) atom.position[k] = std::round(1e4 * atom.position[k]) / 1e4;
    }
    const Atoms atoms = test::cut_sphere(lattice.cell, 8.0 * lattice.nearest_neighbour);
    const Pattern pattern = by_pattern(atoms, {{given}, {}});
    expect_same(atoms, pattern, lattice.name);
    EXPECT_GT(pattern.report.stamped, pattern.report.filled) << lattice.name;
  }
}

TEST(TetrahedralizePattern, NoiseKeepsThePattern) {
  for (const test::Lattice& lattice : test::lattices()) {
    for (const double percent : {1.0, 3.0}) {
      const double sigma = 0.01 * percent * lattice.nearest_neighbour;
      const Atoms atoms = noisy(thinned(test::cut_sphere(lattice.cell, 8.0 * lattice.nearest_neighbour), 0.01), sigma);
      const Pattern pattern = by_pattern(atoms, {{lattice.cell}, {}});
      const std::string what = lattice.name + ", noise of " + std::to_string(percent) + " %";
      ASSERT_TRUE(pattern.report.done) << what << ": " << pattern.report.why;
      EXPECT_FALSE(pattern.report.delaunay) << what;
      EXPECT_EQ(pattern.report.off_sites, 0U) << what;
      const Full full = by_delaunay(atoms);
      EXPECT_EQ(missing(full.mesh, pattern.mesh), 0U) << what;
      // The two differ at the surface, where Delaunay spans or drops slivers that noise has opened between atoms of
      // one plane: about as thick as the noise.
      const double layer = area(extract_surface(full.mesh), atoms.positions) * sigma;
      EXPECT_NEAR(volume(pattern.mesh), volume(full.mesh), layer) << what;
      EXPECT_GT(min_dihedral_degrees(pattern.mesh), percent == 1.0 ? 5.0 : 3.0) << what;
      EXPECT_GT(min_dihedral_degrees(pattern.mesh), 5.0 * min_dihedral_degrees(full.mesh)) << what;
    }
  }
}

TEST(TetrahedralizePattern, RoundedFileKeepsThePattern) {
  for (const test::Lattice& lattice : test::lattices()) {
    Atoms atoms = test::cut_sphere(lattice.cell, 8.0 * lattice.nearest_neighbour);
    test::transform(atoms, test::odd_rotation());
    for (Vec3& p : atoms.positions) p = glm::round(1e4 * p) / 1e4;
    const Pattern pattern = by_pattern(atoms, {{turned(lattice.cell, test::odd_rotation())}, {}});
    ASSERT_TRUE(pattern.report.done) << lattice.name << ": " << pattern.report.why;
    EXPECT_EQ(pattern.report.mended, 0U) << lattice.name;
    const Full full = by_delaunay(atoms);
    EXPECT_EQ(missing(full.mesh, pattern.mesh), 0U) << lattice.name;
    EXPECT_NEAR(volume(pattern.mesh) / volume(full.mesh), 1.0, 1e-4) << lattice.name;
    EXPECT_GT(min_dihedral_degrees(pattern.mesh), 5.0) << lattice.name;
  }
}

TEST(TetrahedralizePattern, BentCrystal) {
  for (const char* name : {"fcc", "nacl", "diamond"}) {
    const test::Lattice& lattice = test::lattice(name);
    Atoms atoms = test::cut_where(lattice.cell, Vec3(50, 9, 9), [](const Vec3&) { return true; });
    for (Vec3& p : atoms.positions) {
      const double angle = p.x / 300.0;
      p = Vec3((300.0 + p.y) * std::sin(angle), (300.0 + p.y) * std::cos(angle), p.z);
    }
    atoms = noisy(atoms, 0.01 * lattice.nearest_neighbour);
    const Pattern pattern = by_pattern(atoms, {{lattice.cell}, {}});
    ASSERT_TRUE(pattern.report.done) << name << ": " << pattern.report.why;
    const Full full = by_delaunay(atoms);
    EXPECT_EQ(missing(full.mesh, pattern.mesh), 0U) << name;
    EXPECT_NEAR(volume(pattern.mesh) / volume(full.mesh), 1.0, 0.02) << name;
    EXPECT_GT(min_dihedral_degrees(pattern.mesh), 5.0) << name;
  }
}

TEST(TetrahedralizePattern, NoisyInterstitialsAreInserted) {
  for (const char* name : {"fcc", "bcc", "nacl", "diamond"}) {
    const test::Lattice& lattice = test::lattice(name);
    const Atoms host = test::cut_sphere(lattice.cell, 8.0 * lattice.nearest_neighbour);
    Atoms atoms = host;
    const double a = lattice.cell.primitive[0].x;
    for (const Vec3& p : {Vec3(0.27, 0.26, 0.77), Vec3(1.5, 0.25, 0), Vec3(-1.24, 0.76, -0.5)}) {
      atoms.positions.push_back(a * (p + 0.03));
      atoms.species.push_back(0);
    }
    atoms = noisy(atoms, 0.01 * lattice.nearest_neighbour);
    const Pattern pattern = by_pattern(atoms, {{lattice.cell}, {}});
    ASSERT_TRUE(pattern.report.done) << name << ": " << pattern.report.why;
    EXPECT_EQ(pattern.report.inserted, pattern.report.off_sites) << name;
    EXPECT_GE(pattern.report.inserted, 2U) << name;
    EXPECT_EQ(missing(by_delaunay(atoms).mesh, pattern.mesh), 0U) << name;
    Atoms without = atoms;
    without.positions.resize(host.size());
    without.species.resize(host.size());
    EXPECT_NEAR(volume(pattern.mesh) / volume(by_pattern(without, {{lattice.cell}, {}}).mesh), 1.0, 1e-3) << name;
  }
}

TEST(TetrahedralizePattern, CracksThatSitesBridgeOpen) {
  // Two halves of one crystal drawn apart by four interatomic distances, and shaken: their sites go on across.
  const test::Lattice& nacl = test::lattice("nacl");
  Atoms atoms = noisy(test::cut_where(nacl.cell, Vec3(17), [](const Vec3&) { return true; }), 0.03);
  for (Vec3& p : atoms.positions) p.x += p.x > 0.5 ? 4.0 * 2.82 : 0.0;
  const Pattern pattern = by_pattern(atoms, {{nacl.cell}, {}});
  ASSERT_TRUE(pattern.report.done) << pattern.report.why;
  for (const Tetrahedron& t : pattern.mesh.tetrahedra) {
    Bounds bounds;
    for (const Index v : t) bounds.add(atoms.positions[v]);
    EXPECT_LT(bounds.extent().x, 2.0 * 2.82);
  }
  EXPECT_NEAR(volume(pattern.mesh), volume(by_delaunay(atoms).mesh), 0.05 * 34.0 * 34.0);
}

TEST(TetrahedralizePattern, SlidHalvesAndGrainsAreExactParts) {
  const test::Lattice& fcc = test::lattice("fcc");
  Atoms slid = test::cut_where(fcc.cell, Vec3(20), [](const Vec3&) { return true; });
  for (Vec3& p : slid.positions) p += p.z > 0.1 ? Vec3(0.31, 0.17, 0.05) : Vec3(0.0);  // less than the tolerance
  const Pattern two = by_pattern(slid, {{fcc.cell}, {}});
  EXPECT_EQ(two.report.parts, 2U);
  expect_same(slid, two, "slid");

  const UnitCell other = turned(fcc.cell, test::odd_rotation());
  const Atoms grains = joined(test::cut_where(fcc.cell, Vec3(20), [](const Vec3& p) { return p.x < -0.6; }),
                              test::cut_where(other, Vec3(20), [](const Vec3& p) { return p.x > 0.6; }));
  const Pattern pattern = by_pattern(grains, {{fcc.cell, other}, {}});
  EXPECT_EQ(pattern.report.parts, 2U);
  expect_same(grains, pattern, "grains");

  // Shaken, neither way serves.
  const Pattern refused = by_pattern(noisy(grains, 0.05), {{fcc.cell, other}, {}});
  EXPECT_FALSE(refused.report.done);
  EXPECT_NE(refused.report.why.find("1 other grain"), std::string::npos) << refused.report.why;
}

TEST(TetrahedralizePattern, DislocationsAreRefused) {
  const test::Lattice& fcc = test::lattice("fcc");
  Atoms atoms = test::cut_where(fcc.cell, Vec3(35, 35, 20), [](const Vec3&) { return true; });
  for (Vec3& p : atoms.positions) p.z += 3.615 * std::atan2(p.y - 0.7, p.x - 0.5) / (2 * std::numbers::pi);
  const Pattern pattern = by_pattern(atoms, {{fcc.cell}, {}});
  EXPECT_FALSE(pattern.report.done);
  EXPECT_NE(pattern.report.why.find("dislocation"), std::string::npos) << pattern.report.why;
}

Atoms rounded(Atoms atoms, double step) {
  for (Vec3& p : atoms.positions) p = glm::round(p / step) * step;
  return atoms;
}

// As files have them: the tetrahedra of the exact crystal, and no slivers from rounding.
TEST(TetrahedralizePattern, CoordinatesRoundedInAFile) {
  for (const char* name : {"nacl", "diamond", "bcc"}) {
    const test::Lattice& lattice = test::lattice(name);
    for (const bool turn : {false, true}) {
      const UnitCell cell = turn ? turned(lattice.cell, test::odd_rotation()) : lattice.cell;
      const Atoms exact = thinned(test::cut_where(cell, Vec3(11), [](const Vec3&) { return true; }), 0.01);
      const Pattern reference = by_pattern(exact, {{cell}, {}});
      ASSERT_TRUE(reference.report.delaunay) << name << ": " << reference.report.why;
      for (const double step : {1e-6, 1e-4, 1e-3}) {
        const Pattern pattern = by_pattern(rounded(exact, step), {{cell}, {}});
        const std::string what = std::string(name) + (turn ? " turned " : " ") + std::to_string(step);
        EXPECT_TRUE(pattern.report.done) << what << ": " << pattern.report.why;
        EXPECT_DOUBLE_EQ(pattern.report.rounding, turn ? step : pattern.report.rounding) << what;
        EXPECT_EQ(pattern.mesh.tetrahedra.size(), reference.mesh.tetrahedra.size()) << what;
        EXPECT_GT(min_dihedral_degrees(pattern.mesh), 0.9 * min_dihedral_degrees(reference.mesh)) << what;
      }
    }
  }
}

// Two grains, apart so that none of the atoms counts to the wrong one, have no one perfect crystal to take the
// tetrahedra from.
TEST(TetrahedralizePattern, GrainsRoundedInAFile) {
  const test::Lattice& fcc = test::lattice("fcc");
  const UnitCell other = turned(fcc.cell, test::odd_rotation());
  const Atoms exact = joined(test::cut_where(fcc.cell, Vec3(16), [](const Vec3& p) { return p.x < 0.0; }),
                             test::cut_where(other, Vec3(16), [](const Vec3& p) { return p.x > 4.0; }));
  const Crystal crystal{{fcc.cell, other}, {}};
  const Pattern reference = by_pattern(exact, crystal);
  ASSERT_TRUE(reference.report.delaunay) << reference.report.why;
  for (const double step : {1e-6, 1e-4}) {
    const Pattern pattern = by_pattern(rounded(exact, step), crystal);
    ASSERT_TRUE(pattern.report.done) << pattern.report.why;
    EXPECT_FALSE(pattern.report.delaunay);
    EXPECT_NE(pattern.report.why.find("rounded"), std::string::npos) << pattern.report.why;
    EXPECT_NEAR(volume(pattern.mesh) / volume(reference.mesh), 1.0, 10.0 * step);
    EXPECT_NEAR(
        static_cast<double>(pattern.mesh.tetrahedra.size()) / static_cast<double>(reference.mesh.tetrahedra.size()),
        1.0, 2e-3);
  }
}

TEST(TetrahedralizePattern, SaysWhyNot) {
  const test::Lattice& fcc = test::lattice("fcc");
  const Pattern amorphous = by_pattern(test::random_atoms(2000, 29.0, 4), {{fcc.cell}, {}});
  EXPECT_FALSE(amorphous.report.done);
  const Pattern uncarved =
      by_pattern(test::cut_block(fcc.cell, 6, 6, 6), {{fcc.cell}, {}}, {std::numeric_limits<double>::infinity()});
  EXPECT_FALSE(uncarved.report.done);
  EXPECT_NE(uncarved.report.why.find("carved"), std::string::npos) << uncarved.report.why;
  PatternReport report;
  EXPECT_THROW(tetrahedralize_pattern(test::random_atoms(10, 3.0, 1).positions, {}, {}, report), UsageError);
}

TEST(TetrahedralizePattern, RadiusGivenIsTheOneUsed) {
  const test::Lattice& nacl = test::lattice("nacl");
  const Atoms atoms = test::cut_where(nacl.cell, Vec3(14), [](const Vec3& p) { return glm::length(p) > 5.0; });
  for (const double sigma : {0.0, 0.02}) {
    const Atoms sample = noisy(atoms, sigma);
    const Pattern pattern = by_pattern(sample, {{nacl.cell}, {}}, {3.3});
    ASSERT_TRUE(pattern.report.done) << pattern.report.why;
    EXPECT_EQ(pattern.report.largest_radius, 3.3);
    TetrahedralizeReport report;
    CarveReport carved;
    const TetMesh full = carve(tetrahedralize(sample, {"delaunay"}, report), {3.3}, carved);
    EXPECT_NEAR(volume(pattern.mesh) / volume(full), 1.0, sigma == 0.0 ? 1e-9 : 0.02);
  }
}

TEST(TetrahedralizePattern, DoesNotDependOnThreadsAndCanBeCancelled) {
  const test::Lattice& diamond = test::lattice("diamond");
  const Atoms atoms = thinned(test::cut_sphere(diamond.cell, 25.0), 0.02);
  for (const double sigma : {0.0, 0.08}) {
    const Atoms sample = noisy(atoms, sigma);
    const LatticeSites sites = assign_lattice_sites(sample, {{diamond.cell}, {}}, {});
    PatternReport report;
    set_threads(1);
    const auto one = tetrahedralize_pattern(sample.positions, sites, {}, report);
    set_threads(3);
    const auto three = tetrahedralize_pattern(sample.positions, sites, {}, report);
    set_threads(0);
    EXPECT_EQ(one, three);
    Progress cancelled;
    cancelled.request_cancel();
    EXPECT_THROW(tetrahedralize_pattern(sample.positions, sites, {}, report, cancelled), CancelledError);
  }
}

TEST(TetrahedralizePattern, Samples) {
  // By which way each goes: e exact, t tolerant, - not by pattern.
  const std::map<std::string_view, char> ways{
      {"nacl-cracked", 't'},    {"cu-line-defect", '-'},     {"diamond-vacancy", 'e'}, {"diamond-a-centers", 'e'},
      {"graphite-slided", 'e'}, {"palladium-hydrogen", 'e'}, {"cacuo2-spiral", 'e'},   {"sponge", 't'},
      {"quantum-dot", 't'},     {"quantum-dot-alloyed", 't'}};
  for (const SampleInfo& info : sample_table()) {
    const std::size_t atoms = info.name == "sponge" ? 20000 : 8000;
    const Sample sample = make_sample(info.name, {atoms, 1});
    const UnitCell cell = sample.unit_cell ? *sample.unit_cell : test::lattice("diamond").cell;
    const Pattern pattern = by_pattern(sample.atoms, {{cell}, {}});
    const char way = !pattern.report.done ? '-' : pattern.report.delaunay ? 'e' : 't';
    EXPECT_EQ(way, ways.at(info.name)) << info.name << ": " << pattern.report.why;
    if (way == '-') continue;
    // Of the sponge's ragged walls a few atoms hang on by slivers only.
    EXPECT_LE(pattern.report.missing, info.name == "sponge" ? 20U : 0U) << info.name;
    EXPECT_EQ(validate(pattern.mesh), std::vector<std::string>{}) << info.name;
    EXPECT_EQ(validate(extract_surface(pattern.mesh), pattern.mesh), std::vector<std::string>{}) << info.name;
    EXPECT_GT(min_dihedral_degrees(pattern.mesh), 4.0) << info.name;
  }
}

TEST(MendTetrahedra, AtomsPushedThroughFaces) {
  for (const char* name : {"sc", "fcc", "bcc", "diamond"}) {
    const test::Lattice& lattice = test::lattice(name);
    const Atoms perfect = test::cut_sphere(lattice.cell, 6.0 * lattice.nearest_neighbour);
    PatternReport report;
    const auto tetrahedra =
        tetrahedralize_pattern(perfect.positions, assign_lattice_sites(perfect, {{lattice.cell}, {}}, {}), {}, report);
    ASSERT_TRUE(report.done);
    std::mt19937_64 generator(5);
    std::normal_distribution<double> normal;
    std::size_t replaced = 0;
    for (int trial = 0; trial < 30; ++trial) {
      Atoms atoms = perfect;
      std::size_t pushed = 0;
      while (glm::length(atoms.positions[pushed]) > 3.0 * lattice.nearest_neighbour) {
        pushed = generator() % atoms.size();
      }
      const Vec3 direction = glm::normalize(Vec3(normal(generator), normal(generator), normal(generator)));
      atoms.positions[pushed] += (name == std::string("diamond") ? 0.5 : 0.95) * lattice.nearest_neighbour * direction;
      auto mended = tetrahedra;
      MendReport mend;
      ASSERT_TRUE(mend_tetrahedra(mended, atoms.positions, 100, mend)) << name << " trial " << trial;
      replaced += mend.replaced;
      const TetMesh mesh = mesh_of(atoms, mended, false);
      EXPECT_EQ(validate(mesh), std::vector<std::string>{}) << name << " trial " << trial;
      // The surface did not move.
      EXPECT_NEAR(volume(mesh) / volume(mesh_of(perfect, tetrahedra, false)), 1.0, 1e-9) << name;
      EXPECT_EQ(missing(mesh_of(perfect, tetrahedra, false), mesh), 0U) << name;
    }
    EXPECT_GT(replaced, 0U) << name;
  }
}

TEST(MendTetrahedra, OutsideTetrahedraGo) {
  // Two tetrahedra on one face; the apex of the second is pushed through that face into the first.
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 1}, {0.3, 0.3, 0.2}};
  std::vector<Tetrahedron> tetrahedra{{0, 1, 2, 3}, {0, 2, 1, 4}};
  MendReport report;
  ASSERT_TRUE(mend_tetrahedra(tetrahedra, points, 10, report));
  EXPECT_EQ(report.removed, 1U);
  EXPECT_EQ(report.lost, std::vector<Index>{4});
  EXPECT_EQ(tetrahedra, (std::vector<Tetrahedron>{{0, 1, 2, 3}}));
  // It then is a point inside.
  EXPECT_TRUE(insert_points(tetrahedra, points, report.lost, 2.0).empty());
  EXPECT_EQ(tetrahedra.size(), 4U);
}

TEST(InsertPoints, InsideOnFacesOnEdgesAndOutside) {
  const Atoms host = test::cut_block(test::lattice("nacl").cell, 4, 4, 4);
  const double nearest = 2.82;
  TetrahedralizeReport made;
  const TetMesh before = tetrahedralize(host, {"delaunay"}, made);
  Atoms atoms = host;
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> uniform(0.1 * nearest, 6.9 * nearest);
  for (int n = 0; n < 60; ++n) atoms.positions.emplace_back(uniform(generator), uniform(generator), uniform(generator));
  for (int n = 0; n < 20; ++n) {
    // The middle of an edge, of a face of the cells, of one of the mesh's own faces, and of an outside face.
    const Tetrahedron& t = before.tetrahedra[static_cast<std::size_t>(n) * 61];
    const auto& p = host.positions;
    atoms.positions.push_back(glm::mix(0.5 * (p[t[0]] + p[t[1]]), Vec3(3.5 * nearest), n % 2 == 0 ? 0.0 : 1e-10));
    atoms.positions.push_back((p[t[0]] + p[t[1]] + p[t[2]]) / 3.0);
    atoms.positions.push_back(Vec3(0.0, nearest * (0.3 + 0.2 * n), nearest * 2.2));
  }
  const std::size_t inside = atoms.size();
  atoms.positions.emplace_back(-0.5, 3.0, 3.0);
  atoms.positions.emplace_back(100.0, 3.0, 3.0);
  std::vector<Index> added(atoms.positions.size() - host.size());
  std::iota(added.begin(), added.end(), static_cast<Index>(host.size()));
  atoms.species.resize(atoms.positions.size(), 0);
  auto tetrahedra = before.tetrahedra;
  const std::vector<Index> outside = insert_points(tetrahedra, atoms.positions, added, 1.6 * 0.87 * nearest);
  EXPECT_EQ(outside, (std::vector<Index>{static_cast<Index>(atoms.size() - 2), static_cast<Index>(atoms.size() - 1)}));
  const TetMesh mesh = mesh_of(atoms, tetrahedra, false);
  EXPECT_EQ(validate(mesh), std::vector<std::string>{});
  EXPECT_NEAR(volume(mesh) / volume(before), 1.0, 1e-9);
  std::vector<bool> used(atoms.size(), false);
  for (const Tetrahedron& t : tetrahedra) {
    for (const Index v : t) used[v] = true;
  }
  EXPECT_EQ(std::count(used.begin(), used.end(), true), static_cast<std::ptrdiff_t>(atoms.size() - 2));
  EXPECT_GT(inside, host.size());
}

}  // namespace
}  // namespace atomesh
