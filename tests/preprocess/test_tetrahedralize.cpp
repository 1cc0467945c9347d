#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "core/error.h"
#include "core/parallel.h"
#include "core/surface.h"
#include "preprocess/canonical_tetrahedra.h"
#include "preprocess/tetrahedralize.h"
#include "tests/support/lattices.h"

namespace atomesh {
namespace {

TetMesh mesh_of(const Atoms& atoms, const std::string& mesher = "delaunay") {
  TetrahedralizeReport report;
  return tetrahedralize(atoms, {mesher}, report);
}

const std::vector<std::string>& meshers() {
#ifdef ATOMESH_TETGEN
  static const std::vector<std::string> names{"delaunay", "tetgen"};
#else
  static const std::vector<std::string> names{"delaunay"};
#endif
  return names;
}

Atoms turned(Atoms atoms) {
  test::transform(atoms, test::odd_rotation());
  return atoms;
}

Atoms moved(Atoms atoms, const Vec3& offset) {
  test::translate(atoms, offset);
  return atoms;
}

Atoms shaken(Atoms atoms, double amplitude) {
  test::shake(atoms, amplitude, 11);
  return atoms;
}

Atoms joined(Atoms atoms, const Atoms& more) {
  atoms.positions.insert(atoms.positions.end(), more.positions.begin(), more.positions.end());
  atoms.species.insert(atoms.species.end(), more.species.begin(), more.species.end());
  return atoms;
}

struct Sample {
  std::string name;
  Atoms atoms;
};

std::vector<Sample> samples() {
  std::vector<Sample> all;
  for (const test::Lattice& lattice : test::lattices()) {
    const Atoms block = test::cut_block(lattice.cell, 4, 4, 4);
    all.push_back({lattice.name, block});
    all.push_back({lattice.name + " ball", test::cut_sphere(lattice.cell, 4.2 * lattice.nearest_neighbour)});
    all.push_back({lattice.name + " turned", turned(block)});
    all.push_back({lattice.name + " a million Å away", moved(block, Vec3(1e6, -1e6, 1e6))});
    all.push_back({lattice.name + " shaken", shaken(block, 0.05)});
    all.push_back({lattice.name + " shaken by rounding", shaken(block, 1e-14)});
    // One cell thick; sc and its like would be a plane.
    if (lattice.cell.basis.size() > 1) {
      all.push_back({lattice.name + " one layer", test::cut_block(lattice.cell, 6, 6, 1)});
    }
  }
  const UnitCell& sc = test::lattice("sc").cell;
  all.push_back({"needle", test::cut_block(sc, 500, 2, 2)});
  Atoms thin = test::random_atoms(400, 1.0, 5);
  for (Vec3& p : thin.positions) p *= Vec3(1e5, 1.0, 1e-5);
  all.push_back({"needle of random atoms", thin});
  // A million times as many atoms per volume in the middle as around it.
  Atoms dense = test::random_atoms(500, 1.0, 6);
  test::translate(dense, Vec3(49.5));
  all.push_back({"million-to-one density", joined(test::random_atoms(500, 100.0, 7), dense)});
  all.push_back({"random", test::random_atoms(1000, 30.0, 8)});
  return all;
}

// The corner positions of every tetrahedron, so that meshes of differently ordered atoms can be compared.
std::set<std::array<std::array<double, 3>, 4>> shapes(const TetMesh& mesh) {
  std::set<std::array<std::array<double, 3>, 4>> all;
  for (const Tetrahedron& tet : mesh.tetrahedra) {
    std::array<std::array<double, 3>, 4> shape;
    for (int i = 0; i < 4; ++i) {
      const Vec3& p = mesh.vertices[tet[i]];
      shape[i] = {p.x, p.y, p.z};
    }
    std::sort(shape.begin(), shape.end());
    all.insert(shape);
  }
  return all;
}

TEST(Tetrahedralize, IsSoundAndFillsTheHull) {
  for (const Sample& sample : samples()) {
    for (const std::string& mesher : meshers()) {
      const std::string what = sample.name + " by " + mesher;
      TetrahedralizeReport report;
      const TetMesh mesh = tetrahedralize(sample.atoms, {mesher}, report);
      EXPECT_EQ(report.mesher, mesher);
      ASSERT_EQ(validate(mesh), std::vector<std::string>{}) << what;
      EXPECT_TRUE(mesh.delaunay);
      EXPECT_GT(mesh.tetrahedra.size(), 0U) << what;
      ASSERT_EQ(mesh.vertices.size(), sample.atoms.size()) << what;

      const Surface surface = extract_surface(mesh);
      ASSERT_EQ(validate(surface, mesh), std::vector<std::string>{}) << what;
      const double filled = volume(mesh);
      EXPECT_NEAR(filled / enclosed_volume(surface, mesh.vertices), 1.0, 1e-12) << what;

      std::vector<bool> used(mesh.vertices.size(), false);
      for (const Tetrahedron& tet : mesh.tetrahedra) {
        for (const Index v : tet) used[v] = true;
      }
      EXPECT_EQ(std::count(used.begin(), used.end(), false), 0) << what;
    }
  }
}

TEST(Tetrahedralize, TheHullOfABlockIsTheBlock) {
  const UnitCell& cell = test::lattice("nacl").cell;
  for (const Vec3& offset : {Vec3(0.0), Vec3(1e6)}) {
    const TetMesh mesh = mesh_of(moved(test::cut_block(cell, 5, 4, 3), offset));
    const double a = 2.82;  // the last plane of a conventional cell is half an edge short
    const double exact = (9 * a) * (7 * a) * (5 * a);
    // A coordinate a million Å away is rounded to 1e-10 Å.
    EXPECT_NEAR(volume(mesh) / exact, 1.0, offset.x == 0.0 ? 1e-12 : 1e-10);
    EXPECT_NEAR(area(extract_surface(mesh), mesh.vertices), 2 * a * a * (9 * 7 + 7 * 5 + 5 * 9), 1e-6);
  }
}

TEST(Tetrahedralize, MeshersAgreeOnHullAndVolume) {
  if (meshers().size() < 2) GTEST_SKIP() << "built without TetGen";
  for (const Sample& sample : samples()) {
    const TetMesh cgal = mesh_of(sample.atoms, "delaunay");
    const TetMesh tetgen = mesh_of(sample.atoms, "tetgen");
    EXPECT_NEAR(volume(cgal) / volume(tetgen), 1.0, 1e-12) << sample.name;
    EXPECT_NEAR(area(extract_surface(cgal), cgal.vertices) / area(extract_surface(tetgen), tetgen.vertices), 1.0, 1e-9)
        << sample.name;
    // Where no five atoms share a sphere there is only one answer, and one way to cut anew what rounding has frayed.
    if (sample.name == "random" || sample.name == "million-to-one density" || sample.name.ends_with("turned")) {
      EXPECT_EQ(cgal.tetrahedra, tetgen.tetrahedra) << sample.name;
    }
  }
}

TEST(Tetrahedralize, DoesNotDependOnThreadsOrOnTheOrderOfTheAtoms) {
  for (const Sample& sample : samples()) {
    set_threads(1);
    const TetMesh one = mesh_of(sample.atoms);
    set_threads(2);
    const TetMesh two = mesh_of(sample.atoms);
    set_threads(0);
    EXPECT_EQ(one.tetrahedra, two.tetrahedra) << sample.name;
    EXPECT_EQ(shapes(one), shapes(mesh_of(test::shuffled(sample.atoms, 4)))) << sample.name;
  }
}

TEST(Tetrahedralize, FewOrFlatAtomsHaveNoTetrahedra) {
  const std::vector<std::vector<Vec3>> flat{
      {},
      {{1, 2, 3}},
      {{1, 2, 3}, {4, 5, 6}},
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
      {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {5, 5, 5}},
      {{1, 0, 7}, {0, 1, 7}, {3, 3, 7}, {0.3, 0.1, 7}, {-1, 2, 7}, {4, 1, 7}},
      {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}},
  };
  for (const auto& positions : flat) {
    for (const std::string& mesher : meshers()) {
      const TetMesh mesh = mesh_of(test::atoms_at(positions), mesher);
      EXPECT_TRUE(mesh.tetrahedra.empty());
      EXPECT_EQ(validate(mesh), std::vector<std::string>{});
      EXPECT_TRUE(extract_surface(mesh).triangles.empty());
    }
  }
}

// What a line is in a file rounded to some digits.
TEST(Tetrahedralize, NearlyFlatAtomsAreSound) {
  for (const double thickness : {1e-15, 1e-12, 1e-9, 1e-6}) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> share(0.0, 30.0);
    std::vector<Vec3> line, layer;
    for (int i = 0; i < 100; ++i) {
      line.emplace_back(share(random), thickness * share(random), thickness * share(random));
      layer.emplace_back(share(random), share(random), thickness * share(random));
    }
    for (const auto& positions : {line, layer}) {
      const TetMesh judge = mesh_of(test::atoms_at(positions), "delaunay");
      for (const std::string& mesher : meshers()) {
        const TetMesh mesh = mesh_of(test::atoms_at(positions), mesher);
        EXPECT_EQ(validate(mesh), std::vector<std::string>{}) << mesher << ' ' << thickness;
        EXPECT_NEAR(volume(mesh), volume(judge), 1e-6 * volume(judge)) << mesher << ' ' << thickness;
      }
    }
  }
}

TEST(Tetrahedralize, OneTetrahedron) {
  for (const std::string& mesher : meshers()) {
    const TetMesh mesh = mesh_of(test::atoms_at({{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, 0}}), mesher);
    ASSERT_EQ(mesh.tetrahedra.size(), 1U);
    EXPECT_DOUBLE_EQ(volume(mesh), 1.0 / 6.0);
  }
}

TEST(Tetrahedralize, AtomsOnOnePlaceShareTheVertexOfTheFirst) {
  Atoms atoms = test::atoms_at({{0, 0, 0}, {1, 0, 0}, {0.0, -0.0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 0}});
  // Two species on one site.
  atoms.species[4] = atoms.add_species("Fe");
  for (const std::string& mesher : meshers()) {
    TetrahedralizeReport report;
    const TetMesh mesh = tetrahedralize(atoms, {mesher}, report);
    EXPECT_EQ(report.merged_vertices, 3U);
    EXPECT_EQ(mesh.vertex_atom, (std::vector<Index>{0, 1, 3, 5}));
    EXPECT_EQ(mesh.tetrahedra.size(), 1U);
    EXPECT_EQ(validate(mesh), std::vector<std::string>{});
  }
}

TEST(Tetrahedralize, PerfectCrystalsHaveNoSlivers) {
  // Smallest angles of whole cells: those of graphite's, between layers, are the sharpest.
  const std::map<std::string, double> angle{{"sc", 35},      {"nacl", 35},     {"fcc", 54},       {"bcc", 44},
                                            {"diamond", 19}, {"graphite", 11}, {"perovskite", 35}};
  for (const test::Lattice& lattice : test::lattices()) {
    const Atoms block = test::cut_block(lattice.cell, 5, 5, 5);
    for (const Atoms& atoms : {block, turned(block), moved(turned(block), Vec3(1e6, -1e6, 1e6))}) {
      for (const std::string& mesher : meshers()) {
        TetrahedralizeReport report;
        const TetMesh mesh = tetrahedralize(atoms, {mesher}, report);
        EXPECT_GT(min_dihedral_degrees(mesh), angle.at(lattice.name)) << lattice.name << " by " << mesher;
        EXPECT_EQ(validate(mesh), std::vector<std::string>{}) << lattice.name << " by " << mesher;
      }
    }
  }
}

TEST(Tetrahedralize, TurningACrystalDoesNotAddCells) {
  for (const char* name : {"sc", "nacl", "fcc", "bcc"}) {
    const Atoms block = test::cut_block(test::lattice(name).cell, 5, 5, 5);
    TetrahedralizeReport straight, askew;
    const TetMesh mesh = tetrahedralize(block, {}, straight);
    EXPECT_EQ(tetrahedralize(turned(block), {}, askew).tetrahedra.size(), mesh.tetrahedra.size()) << name;
    EXPECT_EQ(straight.slivers_removed, 0U) << name;
    EXPECT_GT(askew.slivers_removed, 100U) << name;
  }
}

TEST(Tetrahedralize, AutoSaysWhatItChoseAndWhy) {
  TetrahedralizeReport report;
  tetrahedralize(test::random_atoms(10, 1.0, 1), {}, report);
  EXPECT_EQ(report.mesher, "delaunay");
  EXPECT_FALSE(report.why.empty());
}

TEST(Tetrahedralize, AutoLeavesManyGrainsToDelaunay) {
  const UnitCell& cell = test::lattice("fcc").cell;
  const Atoms atoms = test::cut_block(cell, 9, 9, 9);
  Crystal crystal{{cell}, {}};
  TetrahedralizeReport report;
  tetrahedralize(atoms, crystal, 0.0, {}, report);
  EXPECT_EQ(report.mesher, "pattern") << report.why;
  // The same crystal under many names.
  for (int grain = 0; grain < 40; ++grain) crystal.grains.push_back(cell);
  crystal.grain_of.assign(atoms.size(), 0);
  tetrahedralize(atoms, crystal, 0.0, {}, report);
  EXPECT_EQ(report.mesher, "delaunay");
  EXPECT_NE(report.why.find("grains"), std::string::npos) << report.why;
}

TEST(Tetrahedralize, UnknownMesherNamesTheNearest) {
  TetrahedralizeReport report;
  try {
    tetrahedralize(test::random_atoms(10, 1.0, 1), {"tetgem"}, report);
    FAIL() << "no error";
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"tetgen\""), std::string::npos) << error.what();
  }
}

TEST(Tetrahedralize, RefusesPositionsThatAreNotFinite) {
  TetrahedralizeReport report;
  Atoms atoms = test::random_atoms(10, 1.0, 1);
  atoms.positions[7].z = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(tetrahedralize(atoms, {}, report), Error);
  atoms.positions[7].z = std::numeric_limits<double>::infinity();
  EXPECT_THROW(tetrahedralize(atoms, {}, report), Error);
}

TEST(Tetrahedralize, CanBeCancelledOnTheWay) {
  const Atoms atoms = test::random_atoms(50000, 100.0, 2);
  for (const std::string& mesher : meshers()) {
    Progress* running = nullptr;
    Progress progress([&](std::string_view, double fraction) {
      if (fraction > 0.1) running->request_cancel();
    });
    running = &progress;
    TetrahedralizeReport report;
    EXPECT_THROW(
        {
          tetrahedralize(atoms, {mesher}, report, progress);
          progress.check();
        },
        CancelledError);
  }
}

TEST(CanonicalTetrahedra, SmallestFirstAndOrientationKept) {
  // The twelve even permutations of (4, 5, 6, 7) become it, the twelve odd ones its mirror image.
  Tetrahedron tet{4, 5, 6, 7};
  std::set<Tetrahedron> found;
  do {
    const Tetrahedron result = canonical(tet);
    found.insert(result);
    const auto inversions = [](const Tetrahedron& t) {
      int count = 0;
      for (int i = 0; i < 4; ++i) {
        for (int j = i + 1; j < 4; ++j) count += t[i] > t[j] ? 1 : 0;
      }
      return count;
    };
    EXPECT_EQ(inversions(result) % 2, inversions(tet) % 2);
  } while (std::next_permutation(tet.begin(), tet.end()));
  EXPECT_EQ(found, (std::set<Tetrahedron>{{4, 5, 6, 7}, {4, 5, 7, 6}}));
}

// Against the sort of the whole list, with vertices that have none, a few and very many tetrahedra.
TEST(CanonicalTetrahedra, OrderIsThatOfASortAtAnyNumberOfThreads) {
  constexpr Index vertices = 5000;
  std::mt19937_64 generator(3);
  std::uniform_int_distribution<Index> any(10, vertices - 1);
  std::vector<Tetrahedron> given;
  while (given.size() < 40000) {
    Tetrahedron t{any(generator), any(generator), any(generator), any(generator)};
    if (given.size() % 20 == 0) t[given.size() % 4] = 7;
    if (std::set<Index>(t.begin(), t.end()).size() == 4) given.push_back(t);
  }
  std::vector<Tetrahedron> expected = given;
  for (Tetrahedron& t : expected) t = canonical(t);
  std::sort(expected.begin(), expected.end());
  for (const int count : {1, 2, 3, 7}) {
    set_threads(count);
    std::vector<Tetrahedron> ordered = given;
    put_in_canonical_order(ordered, vertices);
    EXPECT_EQ(ordered, expected) << count;
  }
  set_threads(0);
  std::vector<Tetrahedron> none;
  put_in_canonical_order(none, 3);
  EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace atomesh
