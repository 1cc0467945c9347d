#include <gtest/gtest.h>

#include "core/error.h"
#include "core/parallel.h"
#include "preprocess/canonical_tetrahedra.h"
#include "preprocess/tetrahedralize.h"
#include "tests/preprocess/simplify_checks.h"
#include "tests/support/lattices.h"
#include "tests/support/meshes.h"

namespace atomesh {
namespace {

using test::simplified;
using test::Simplified;

double share(const SimplifyReport& report) {
  return static_cast<double>(report.removed_vertices) / static_cast<double>(report.free_vertices);
}

// A block about the origin with an atom missing, one moved and one shaken in its middle, all marked.
struct Sample {
  Atoms atoms;
  Defects defects;
  TetMesh mesh;
};

Sample sample(const test::Lattice& lattice, double half_width, bool turned) {
  Sample s;
  const double d = lattice.nearest_neighbour;
  s.atoms = test::cut_where(lattice.cell, Vec3(half_width * d), [](const Vec3&) { return true; });
  std::vector<Vec3> places{test::remove_nearest(s.atoms, Vec3(0.0))};
  places.push_back(test::remove_nearest(s.atoms, Vec3(2.0 * d, d, 0.0)));
  s.atoms.positions.push_back(places.back() + Vec3(0.2 * d, 0.1 * d, 0.05 * d));
  s.atoms.species.push_back(0);
  if (turned) {
    test::transform(s.atoms, test::odd_rotation());
    for (Vec3& place : places) place = test::odd_rotation() * place;
  }
  s.defects = test::defects_near(s.atoms, places, 1.1 * d);
  s.mesh = test::carved_mesh(s.atoms);
  return s;
}

TEST(Simplify, NearlyEveryFreeVertexOfACrystalGoes) {
  for (const test::Lattice& lattice : test::lattices()) {
    for (const bool turned : {false, true}) {
      const Sample s = sample(lattice, 6.3, turned);
      const std::string what = lattice.name + (turned ? " turned" : "");
      for (const std::string& strategy : simplify_strategies()) {
        const Simplified result = simplified(s.mesh, s.atoms, s.defects, strategy, what);
        EXPECT_GE(share(result.report), 0.95) << what << ", " << strategy;
        EXPECT_LT(result.after.tetrahedra.size(), 0.6 * static_cast<double>(s.mesh.tetrahedra.size())) << what;
        EXPECT_EQ(result.after.delaunay, strategy == "remove");
      }
    }
  }
}

TEST(Simplify, CollapseKeepsTetrahedraFat) {
  const Sample s = sample(test::lattice("fcc"), 8.0, false);
  const Simplified result = simplified(s.mesh, s.atoms, s.defects, "collapse", "fcc");
  EXPECT_GT(min_dihedral_degrees(result.after), 0.8);
}

TEST(Simplify, RandomPointsWithoutDefects) {
  const Atoms atoms = test::random_atoms(3000, 30.0, 5);
  TetrahedralizeReport report;
  const TetMesh mesh = tetrahedralize(atoms, {}, report);
  for (const std::string& strategy : simplify_strategies()) {
    const Simplified result = simplified(mesh, atoms, {}, strategy, "random");
    EXPECT_EQ(result.report.frozen_defect, 0U);
    EXPECT_GE(share(result.report), 0.95) << strategy;
  }
}

TEST(Simplify, RandomPointsWithDefectsEverywhere) {
  const Atoms atoms = test::random_atoms(4000, 30.0, 6);
  std::vector<Vec3> places;
  for (int i = 0; i < 40; ++i) places.push_back(atoms.positions[static_cast<std::size_t>(97 * i)]);
  const Defects defects = test::defects_near(atoms, places, 2.0);
  const TetMesh mesh = test::carved_mesh(atoms);
  for (const std::string& strategy : simplify_strategies()) {
    const Simplified result = simplified(mesh, atoms, defects, strategy, "random with defects");
    EXPECT_GT(result.report.frozen_defect, 0U);
    EXPECT_GE(share(result.report), 0.9) << strategy;
  }
}

TEST(Simplify, WhatRemoveLeavesIsTheDelaunayMeshOfWhatIsLeft) {
  // Points in general position have one Delaunay mesh, which CGAL finds from scratch.
  const Atoms atoms = test::random_atoms(1500, 20.0, 7);
  const Defects defects = test::defects_near(atoms, {Vec3(10.0)}, 3.0);
  TetrahedralizeReport report;
  const TetMesh mesh = tetrahedralize(atoms, {}, report);
  const Simplified result = simplified(mesh, atoms, defects, "remove", "random");
  EXPECT_EQ(result.report.removed_vertices, result.report.free_vertices);
  const TetMesh anew = tetrahedralize(test::atoms_of(result.after), {}, report);
  EXPECT_EQ(anew.tetrahedra, result.after.tetrahedra);
}

TEST(Simplify, ShakenCrystals) {
  for (const double amplitude : {1e-12, 1e-9, 1e-6, 1e-3, 0.1}) {
    Atoms atoms = test::cut_block(test::lattice("nacl").cell, 5, 5, 5);
    test::shake(atoms, amplitude, 11);
    const TetMesh mesh = test::carved_mesh(atoms);
    const Defects defects = test::defects_near(atoms, {Vec3(14.1)}, 3.0);
    for (const std::string& strategy : simplify_strategies()) {
      const Simplified result = simplified(mesh, atoms, defects, strategy, "shaken by " + std::to_string(amplitude));
      EXPECT_GE(share(result.report), strategy == "collapse" ? 0.9 : 0.0) << amplitude << ", " << strategy;
    }
  }
}

TEST(Simplify, SpotsWhereTheSurfaceIsNoManifold) {
  // Blocks that meet in an edge, in a vertex, and a block with a hollow whose corner touches the outside.
  const auto edge = [](int i, int j, int) { return (i < 4) != (j < 4); };
  const auto vertex = [](int i, int j, int k) { return !(i < 4 && j < 4 && k < 4) && !(i >= 4 && j >= 4 && k >= 4); };
  const auto hollow = [](int i, int j, int k) { return (i == 0 && j == 0 && k == 0) || (i == 1 && j == 1 && k == 1); };
  const auto ring = [](int i, int j, int) { return i > 1 && i < 6 && j > 1 && j < 6; };
  const TetMesh meshes[]{test::cubes(8, edge), test::cubes(8, vertex), test::cubes(6, hollow), test::cubes(8, ring),
                         test::two_at_an_edge()};
  for (std::size_t m = 0; m < std::size(meshes); ++m) {
    const Atoms atoms = test::atoms_of(meshes[m]);
    const Simplified result = simplified(meshes[m], atoms, {}, "collapse", "mesh " + std::to_string(m));
    EXPECT_GE(result.report.removed_vertices + 20, 0.8 * static_cast<double>(result.report.free_vertices)) << m;
    EXPECT_THROW(simplified(meshes[m], atoms, {}, "remove", ""), UsageError);  // not Delaunay
  }
}

TEST(Simplify, NothingToDo) {
  const Simplified empty = simplified({}, {}, {}, "collapse", "empty");
  EXPECT_EQ(empty.report.least_tetrahedra, 0U);
  const TetMesh one = test::corner_tetrahedron();
  const Simplified single = simplified(one, test::atoms_of(one), {}, "collapse", "one tetrahedron");
  EXPECT_EQ(single.after.tetrahedra.size(), 1U);
  EXPECT_EQ(single.report.least_tetrahedra, 1U);
  // Vertices of no tetrahedron stay.
  TetMesh bare = one;
  bare.vertices.emplace_back(5.0, 5.0, 5.0);
  bare.vertex_atom.push_back(4);
  EXPECT_EQ(simplified(bare, test::atoms_of(bare), {}, "collapse", "bare vertex").after.vertices.size(), 5U);
}

TEST(Simplify, NothingGoesWhereAllIsDefective) {
  const Atoms atoms = test::cut_block(test::lattice("bcc").cell, 6, 6, 6);
  TetMesh mesh = test::carved_mesh(atoms);
  const Defects defects = test::defects_near(atoms, {Vec3(8.6)}, 100.0);
  for (const std::string& strategy : simplify_strategies()) {
    const Simplified result = simplified(mesh, atoms, defects, strategy, "all defective");
    EXPECT_EQ(result.after.tetrahedra, mesh.tetrahedra);
    EXPECT_EQ(result.report.least_tetrahedra, mesh.tetrahedra.size());
    EXPECT_TRUE(result.after.delaunay);  // nothing was done to it
  }
}

TEST(Simplify, AtomsOnOnePlaceAllCount) {
  // Only the second of two atoms on one place is defective; the mesh names the first.
  Atoms atoms = test::cut_block(test::lattice("sc").cell, 7, 7, 7);
  const std::size_t middle = 3 * 49 + 3 * 7 + 3;
  atoms.positions.push_back(atoms.positions[middle]);
  atoms.species.push_back(0);
  Defects defects = test::defects_near(atoms, {}, 1.0);
  defects.extra.back() = 1.0F;
  const TetMesh mesh = test::carved_mesh(atoms);
  for (const std::string& strategy : simplify_strategies()) {
    TetMesh after = mesh;
    Surface surface;
    SimplifyReport report;
    simplify(after, surface, atoms, defects, {strategy}, report);
    EXPECT_GT(report.frozen_defect, 1U);
    EXPECT_GT(report.removed_vertices, 0U);
    EXPECT_TRUE(report.defect_tetrahedra_identical);
    EXPECT_EQ(report.scalar_error, 0.0);
    EXPECT_TRUE(surface.triangles.empty());  // as it was
    EXPECT_EQ(std::count(after.vertex_atom.begin(), after.vertex_atom.end(), middle), 1);
  }
}

TEST(Simplify, SameResultOnAnyNumberOfThreads) {
  const Sample s = sample(test::lattice("diamond"), 6.0, true);
  for (const std::string& strategy : simplify_strategies()) {
    set_threads(1);
    const Simplified one = simplified(s.mesh, s.atoms, s.defects, strategy, "1 thread");
    set_threads(3);
    const Simplified three = simplified(s.mesh, s.atoms, s.defects, strategy, "3 threads");
    set_threads(0);
    EXPECT_EQ(one.after.tetrahedra, three.after.tetrahedra);
    EXPECT_EQ(one.after.vertex_atom, three.after.vertex_atom);
  }
}

TEST(Simplify, OnceIsEnough) {
  const Sample s = sample(test::lattice("fcc"), 7.0, false);
  for (const std::string& strategy : simplify_strategies()) {
    const Simplified once = simplified(s.mesh, s.atoms, s.defects, strategy, "once");
    const Simplified twice = simplified(once.after, s.atoms, s.defects, strategy, "twice");
    EXPECT_LE(twice.report.removed_vertices, once.report.removed_vertices / 100) << strategy;
  }
  // What was removed can be collapsed further, but not the other way round.
  const Simplified removed = simplified(s.mesh, s.atoms, s.defects, "remove", "first");
  simplified(removed.after, s.atoms, s.defects, "collapse", "then");
}

TEST(Simplify, WrongUseIsNamed) {
  const TetMesh mesh = test::cube_of_six();
  TetMesh after = mesh;
  Surface surface;
  SimplifyReport report;
  try {
    simplify(after, surface, test::atoms_of(mesh), {}, {"colapse"}, report);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"collapse\""), std::string::npos) << error.what();
  }
  EXPECT_EQ(after.tetrahedra, mesh.tetrahedra);
}

TEST(Simplify, CancelIsAnswered) {
  const Sample s = sample(test::lattice("nacl"), 8.0, false);
  for (const std::string& strategy : simplify_strategies()) {
    TetMesh mesh = s.mesh;
    Surface surface;
    SimplifyReport report;
    Progress* running = nullptr;
    Progress progress([&](std::string_view, double fraction) {
      if (fraction > 0.1) running->request_cancel();
    });
    running = &progress;
    EXPECT_THROW(simplify(mesh, surface, s.atoms, s.defects, {strategy}, report, progress), CancelledError) << strategy;
  }
}

}  // namespace
}  // namespace atomesh
