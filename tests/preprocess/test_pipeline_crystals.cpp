// The whole way on crystals of some thousand atoms: how cell, mesher, noise and simplification work together.
#include <gtest/gtest.h>

#include <set>

#include "core/error.h"
#include "preprocess/pipeline.h"
#include "preprocess/write_atoms.h"
#include "samples/planted_crystal.h"
#include "tests/support/lattices.h"
#include "tests/support/temporary_folder.h"

namespace atomesh {
namespace {

class PipelineCrystals : public ::testing::Test {
 protected:
  Material run(const Atoms& atoms, const std::optional<UnitCell>& cell, const PipelineOptions& options = {}) {
    const std::string path = folder_.file("atoms.dat");
    write_atoms(path, atoms, cell);
    return preprocess(path, options, report_);
  }

  test::TemporaryFolder folder_;
  PipelineReport report_;
};

const PlantedCrystalOptions planted{
    .structure = "rock-salt", .atoms = 9000, .vacancies = 2, .interstitials = 1, .rotation = 5};

TEST_F(PipelineCrystals, PatternAndDelaunayMakeTheSameVolume) {
  const Sample sample = make_planted_crystal(planted);
  const Material stamped = run(sample.atoms, sample.unit_cell);
  EXPECT_EQ(report_.tetrahedralize.mesher, "pattern") << report_.tetrahedralize.why;
  EXPECT_TRUE(stamped.mesh.delaunay);
  EXPECT_TRUE(validate(stamped.mesh).empty());
  EXPECT_TRUE(validate(stamped.surface, stamped.mesh).empty());
  const double stamped_volume = report_.volume;
  const double stamped_area = report_.surface_area;
  PipelineOptions options;
  options.tetrahedralize.mesher = "delaunay";
  const Material whole = run(sample.atoms, sample.unit_cell, options);
  EXPECT_EQ(report_.tetrahedralize.mesher, "delaunay");
  EXPECT_NEAR(stamped_volume, report_.volume, 1e-9 * report_.volume);
  EXPECT_NEAR(stamped_area, report_.surface_area, 1e-6 * report_.surface_area);
  EXPECT_EQ(stamped.defects.vacancies.size(), 2U);
  EXPECT_EQ(whole.defects.vacancies.size(), 2U);
}

TEST_F(PipelineCrystals, PatternGivesWayWhereItDoesNotServe) {
  const Sample sample = make_planted_crystal(planted);
  PipelineOptions options;
  options.carve = false;
  run(sample.atoms, sample.unit_cell, options);
  EXPECT_EQ(report_.tetrahedralize.mesher, "delaunay");
  EXPECT_NE(report_.tetrahedralize.why.find("carve"), std::string::npos);
  options.tetrahedralize.mesher = "pattern";
  EXPECT_THROW(run(sample.atoms, sample.unit_cell, options), UsageError);
  options.carve = true;
  options.unit_cell = "none";
  EXPECT_THROW(run(sample.atoms, sample.unit_cell, options), UsageError);

  // What is masked or thinned out has a cell, but no pattern.
  options.unit_cell = "auto";
  options.reduce.keep_every = 2;
  try {
    run(sample.atoms, sample.unit_cell, options);
    FAIL() << "was meshed by pattern";
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("thinning out"), std::string::npos) << error.what();
  }

  const Atoms gas = test::random_atoms(3000, 40.0, 7);
  run(gas, sample.unit_cell);
  EXPECT_EQ(report_.tetrahedralize.mesher, "delaunay");
  EXPECT_NE(report_.tetrahedralize.why.find("does not serve"), std::string::npos);
}

TEST_F(PipelineCrystals, NoiseDrownsNothingAndLetsTheMeshShrink) {
  PlantedCrystalOptions hot = planted;
  hot.noise = 0.02;
  const Sample sample = make_planted_crystal(hot);
  PipelineOptions options;
  options.unit_cell = "found";
  options.simplify = true;
  bool compared = false;
  options.before_simplify = [&](const Material& whole) {
    compared = true;
    EXPECT_TRUE(validate(whole.mesh).empty());
    EXPECT_GT(whole.mesh.tetrahedra.size(), 40000U);
  };
  const Material material = run(sample.atoms, std::nullopt, options);
  EXPECT_TRUE(compared);
  EXPECT_EQ(report_.unit_cell_source, "found");
  EXPECT_EQ(report_.tetrahedralize.mesher, "pattern") << report_.tetrahedralize.why;
  EXPECT_GT(report_.defects.noise, 0.0);
  EXPECT_EQ(material.defects.vacancies.size(), 2U);
  EXPECT_EQ(material.defects.extras.size(), 1U);
  EXPECT_LT(report_.simplify.tetrahedra_after, report_.simplify.tetrahedra_before / 2);
  EXPECT_TRUE(validate(material.mesh).empty());
  EXPECT_TRUE(validate(material.surface, material.mesh).empty());
}

// Of a noisy crystal the pattern's mesh is not Delaunay: auto does not make what removing vertices cannot take.
TEST_F(PipelineCrystals, RemovingVerticesGetsADelaunayMesh) {
  PlantedCrystalOptions hot = planted;
  hot.noise = 0.01;
  const Sample sample = make_planted_crystal(hot);
  PipelineOptions options;
  options.simplify = true;
  options.simplify_options.strategy = "remove";
  for (const char* mesher : {"auto", "pattern"}) {
    options.tetrahedralize.mesher = mesher;
    const Material material = run(sample.atoms, sample.unit_cell, options);
    EXPECT_EQ(report_.tetrahedralize.mesher, "delaunay");
    EXPECT_NE(report_.tetrahedralize.why.find("Delaunay"), std::string::npos) << report_.tetrahedralize.why;
    EXPECT_TRUE(material.mesh.delaunay);
    EXPECT_LT(report_.simplify.tetrahedra_after, report_.simplify.tetrahedra_before / 2);
  }
  const Sample cold = make_planted_crystal(planted);
  options.tetrahedralize.mesher = "auto";
  run(cold.atoms, cold.unit_cell, options);
  EXPECT_EQ(report_.tetrahedralize.mesher, "pattern") << report_.tetrahedralize.why;
}

TEST_F(PipelineCrystals, GrainsBecomeAColumn) {
  // Two crystals of copper, turned against each other about z by 30 degrees, with a plane between.
  const UnitCell& cell = test::lattice("fcc").cell;
  const auto half = [&](double sign) {
    return test::cut_where(cell, Vec3(60.0), [&](const Vec3& p) {
      return std::abs(p.x) < 26.0 && std::abs(p.y) < 26.0 && std::abs(p.z) < 26.0 && sign * p.x > 0.6;
    });
  };
  Atoms atoms = half(-1.0);
  const double c = std::sqrt(0.75);
  const Mat3 turn(c, 0.5, 0.0, -0.5, c, 0.0, 0.0, 0.0, 1.0);
  const Atoms other = test::cut_where(cell, Vec3(60.0), [&](const Vec3& q) {
    const Vec3 p = turn * q;
    return std::abs(p.x) < 26.0 && std::abs(p.y) < 26.0 && std::abs(p.z) < 26.0 && p.x > 0.6;
  });
  for (std::size_t i = 0; i < other.size(); ++i) {
    atoms.positions.push_back(turn * other.positions[i]);
    atoms.species.push_back(other.species[i]);
  }
  const Material material = run(atoms, std::nullopt);
  ASSERT_EQ(report_.find_cell.grains.size(), 2U);
  const Column* grain = material.atoms.find_column("grain");
  ASSERT_NE(grain, nullptr);
  // Away from the boundary every atom knows its side, and nothing is wrong there.
  std::array<std::set<double>, 2> sides;
  for (std::size_t i = 0; i < material.atoms.size(); ++i) {
    const Vec3& p = material.atoms.positions[i];
    if (std::abs(p.x) < 8.0 || glm::length(p) > 20.0) continue;
    sides[p.x > 0.0 ? 1 : 0].insert(grain->values[i]);
    EXPECT_FALSE(material.defects.defective(i)) << "at " << p.x << ' ' << p.y << ' ' << p.z;
  }
  EXPECT_EQ(sides[0].size(), 1U);
  EXPECT_EQ(sides[1].size(), 1U);
  EXPECT_NE(*sides[0].begin(), *sides[1].begin());
  EXPECT_TRUE(material.defects.vacancies.empty());
  EXPECT_TRUE(validate(material.mesh).empty());
}

}  // namespace
}  // namespace atomesh
