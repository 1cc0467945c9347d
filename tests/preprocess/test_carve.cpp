#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/surface.h"
#include "preprocess/carve.h"
#include "preprocess/tetrahedralize.h"
#include "tests/support/lattices.h"

namespace atomesh {
namespace {

struct Carved {
  TetMesh whole;
  TetMesh mesh;
  CarveReport report;
};

Carved carved(const Atoms& atoms, double radius = 0.0) {
  Carved result;
  TetrahedralizeReport report;
  result.whole = tetrahedralize(atoms, {}, report);
  result.mesh = carve(result.whole, {radius}, result.report);
  return result;
}

// True when some tetrahedron contains the point.
bool covers(const TetMesh& mesh, const Vec3& p) {
  for (const Tetrahedron& tet : mesh.tetrahedra) {
    bool inside = true;
    for (int f = 0; f < 4 && inside; ++f) {
      const auto& c = face_corners[f];
      inside = signed_volume(mesh.vertices[tet[c[0]]], mesh.vertices[tet[c[1]]], mesh.vertices[tet[c[2]]], p) <= 1e-12;
    }
    if (inside) return true;
  }
  return false;
}

void expect_sound(const Carved& result, const std::string& what) {
  EXPECT_EQ(validate(result.mesh), std::vector<std::string>{}) << what;
  const Surface surface = extract_surface(result.mesh);
  EXPECT_EQ(validate(surface, result.mesh), std::vector<std::string>{}) << what;
  EXPECT_TRUE(result.mesh.delaunay);
  EXPECT_EQ(result.mesh.vertices.size(), result.whole.vertices.size());
  EXPECT_EQ(result.mesh.tetrahedra.size() + result.report.removed, result.whole.tetrahedra.size()) << what;
}

TEST(Carve, PerfectBlocksStayWhole) {
  for (const test::Lattice& lattice : test::lattices()) {
    if (lattice.name == "graphite" || lattice.name == "diamond") continue;  // their cut sides are rough: see below
    const Carved result = carved(test::cut_block(lattice.cell, 6, 6, 6));
    expect_sound(result, lattice.name);
    EXPECT_EQ(result.report.removed, 0U) << lattice.name;
    EXPECT_NEAR(result.report.nearest_neighbour, lattice.nearest_neighbour, 1e-9) << lattice.name;
  }
}

TEST(Carve, InsideOfEveryCrystalStaysWhole) {
  // Turned as well as straight: the slivers that rounding leaves there have spheres no larger than their neighbours'.
  for (const test::Lattice& lattice : test::lattices()) {
    for (const bool turn : {false, true}) {
      const double radius = 6.5 * lattice.nearest_neighbour;
      Atoms atoms = test::cut_sphere(lattice.cell, radius);
      if (turn) test::transform(atoms, test::odd_rotation());
      const Carved result = carved(atoms);
      expect_sound(result, lattice.name);
      for (const Triangle& triangle : extract_surface(result.mesh).triangles) {
        for (const Index v : triangle) {
          EXPECT_GT(glm::length(result.mesh.vertices[v]), 0.6 * radius) << lattice.name;
        }
      }
    }
  }
}

TEST(Carve, VacanciesAreNoCavities) {
  for (const test::Lattice& lattice : test::lattices()) {
    const double radius = 5.5 * lattice.nearest_neighbour;
    const Atoms perfect = test::cut_sphere(lattice.cell, radius);
    // The cubic cells of fcc-like lattices hold each kind of site four times in a row.
    const std::size_t step = lattice.cell.basis.size() % 8 == 0 || lattice.name == "fcc" ? 4 : 1;
    for (std::size_t b = 0; b < lattice.cell.basis.size(); b += step) {
      Atoms atoms = perfect;
      const Vec3 first = test::remove_nearest(atoms, lattice.cell.basis[b].position);
      for (int missing = 1; missing <= 2; ++missing) {
        const Carved result = carved(atoms);
        EXPECT_TRUE(covers(result.mesh, first)) << lattice.name << ", " << missing << " missing";
        for (const Triangle& triangle : extract_surface(result.mesh).triangles) {
          for (const Index v : triangle) {
            EXPECT_GT(glm::length(result.mesh.vertices[v]), 0.5 * radius) << lattice.name;
          }
        }
        test::remove_nearest(atoms, first);  // a divacancy next
      }
    }
  }
}

TEST(Carve, ChannelsAndCavitiesGo) {
  for (const test::Lattice& lattice : test::lattices()) {
    for (const bool channel : {false, true}) {
      const auto keep = [&](const Vec3& p) {
        return std::sqrt(p.x * p.x + p.y * p.y + (channel ? 0.0 : p.z * p.z)) > 6.0;
      };
      const Carved result = carved(test::cut_where(lattice.cell, Vec3(14.0), keep));
      const std::string what = lattice.name + (channel ? " channel" : " cavity");
      expect_sound(result, what);
      EXPECT_TRUE(covers(result.whole, Vec3(0.1, 0.2, 0.3))) << what;
      for (const Vec3& p : {Vec3(0.1, 0.2, 0.3), Vec3(2, -2, 1), Vec3(-1, 1, 3)}) {
        EXPECT_FALSE(covers(result.mesh, p)) << what;
      }
      EXPECT_TRUE(covers(result.mesh, Vec3(9.1, 0.3, 0.2))) << what;
      // What is gone is the hole, to within the roughness of its wall.
      const double gone = volume(result.whole) - volume(result.mesh);
      const auto hole = [&](double r) {
        return channel ? std::numbers::pi * r * r * 28.0 : 4.0 / 3.0 * std::numbers::pi * r * r * r;
      };
      EXPECT_GT(gone, hole(6.0 - 0.5 * lattice.nearest_neighbour)) << what;
      EXPECT_LT(gone, hole(6.0 + 1.5 * lattice.nearest_neighbour) + 0.1 * volume(result.whole)) << what;
    }
  }
}

TEST(Carve, ConcaveOutsidesGo) {
  // An L of two arms: what lies between them is outside.
  const UnitCell& cell = test::lattice("nacl").cell;
  const Carved result =
      carved(test::cut_where(cell, Vec3(20, 20, 6), [](const Vec3& p) { return p.x < 0 || p.y < 0; }));
  expect_sound(result, "L");
  EXPECT_TRUE(covers(result.whole, Vec3(6, 6, 0)));
  EXPECT_FALSE(covers(result.mesh, Vec3(6, 6, 0)));
  EXPECT_TRUE(covers(result.mesh, Vec3(-6, 6, 0)));
  EXPECT_TRUE(covers(result.mesh, Vec3(6, -6, 0)));
}

TEST(Carve, PlanesOfGraphiteHoldTogether) {
  const test::Lattice& graphite = test::lattice("graphite");
  const Carved result = carved(test::cut_block(graphite.cell, 10, 10, 4));
  for (double z = 0.5; z < 3.5 * 6.7; z += 1.1) EXPECT_TRUE(covers(result.mesh, Vec3(6.5, 11.3, z))) << z;
}

TEST(Carve, SamplesThatAreMostlySurfaceAreCarvedToo) {
  // Walls two atoms thick about empty cells of 15 Å: no atom is far from a surface.
  const UnitCell& cell = test::lattice("sc").cell;
  const auto wall = [](double x) { return std::abs(std::remainder(x, 20.0)) < 3.4; };
  const Carved result =
      carved(test::cut_where(cell, Vec3(31), [&](const Vec3& p) { return wall(p.x) || wall(p.y) || wall(p.z); }));
  expect_sound(result, "foam");
  EXPECT_FALSE(covers(result.mesh, Vec3(10, 10, 10)));
  EXPECT_FALSE(covers(result.mesh, Vec3(-10, 10, -10)));
  EXPECT_TRUE(covers(result.mesh, Vec3(0.5, 0.5, 0.5)));
}

TEST(Carve, GivenRadiusIsTheOneUsed) {
  const Atoms atoms = test::cut_block(test::lattice("sc").cell, 4, 4, 4);
  const double circumradius = 3.35 * std::sqrt(3.0) / 2.0;
  EXPECT_EQ(carved(atoms, circumradius + 0.01).report.removed, 0U);
  const Carved all = carved(atoms, circumradius - 0.01);
  EXPECT_TRUE(all.mesh.tetrahedra.empty());
  EXPECT_EQ(all.report.bare_vertices, 64U);
  EXPECT_EQ(all.report.radius, circumradius - 0.01);
  EXPECT_THROW(carved(atoms, -1.0), UsageError);
  EXPECT_THROW(carved(atoms, std::nan("")), UsageError);
}

TEST(Carve, NothingToCarve) {
  for (const std::size_t count : {0U, 1U, 3U}) {
    const Carved result = carved(test::random_atoms(count, 5.0, 1));
    EXPECT_TRUE(result.mesh.tetrahedra.empty());
    EXPECT_EQ(result.report.bare_vertices, count);
  }
  const Carved one = carved(test::random_atoms(4, 5.0, 1));
  EXPECT_EQ(one.report.removed + one.mesh.tetrahedra.size(), 1U);
}

TEST(Carve, DoesNotDependOnThreads) {
  const Atoms atoms = test::random_atoms(20000, 60.0, 3);
  set_threads(1);
  const Carved one = carved(atoms);
  set_threads(2);
  const Carved two = carved(atoms);
  set_threads(0);
  EXPECT_EQ(one.mesh.tetrahedra, two.mesh.tetrahedra);
  EXPECT_EQ(one.report.radius, two.report.radius);
}

}  // namespace
}  // namespace atomesh
