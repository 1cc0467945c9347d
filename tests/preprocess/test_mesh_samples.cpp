// The mesh, its carving and its surface on the samples and on real files.
#include <gtest/gtest.h>

#include <filesystem>

#include "core/surface.h"
#include "preprocess/carve.h"
#include "preprocess/read_atoms.h"
#include "preprocess/tetrahedralize.h"
#include "samples/samples.h"

namespace atomesh {
namespace {

struct Carved {
  TetMesh whole;
  TetMesh mesh;
  Surface surface;
  CarveReport report;
};

Carved carved(const Atoms& atoms) {
  Carved result;
  TetrahedralizeReport report;
  result.whole = tetrahedralize(atoms, {}, report);
  result.mesh = carve(result.whole, {}, result.report);
  result.surface = extract_surface(result.mesh);
  return result;
}

// Surface triangles whose corners all lie deeper than `depth` inside the box around the sample.
std::size_t triangles_inside(const Carved& carved, double depth) {
  const Bounds bounds = bounds_of(carved.mesh.vertices);
  const auto deep = [&](Index v) {
    const Vec3& p = carved.mesh.vertices[v];
    return glm::all(glm::greaterThan(p, bounds.min + depth)) && glm::all(glm::lessThan(p, bounds.max - depth));
  };
  std::size_t count = 0;
  for (const Triangle& t : carved.surface.triangles) count += deep(t[0]) && deep(t[1]) && deep(t[2]) ? 1 : 0;
  return count;
}

TEST(MeshSamples, PoresAreCarvedAndDefectsAreNot) {
  for (const SampleInfo& info : sample_table()) {
    if (info.name == "quantum-dot-alloyed") continue;  // the plain dot's geometry
    // A sponge needs some size to have pores at all; the dots take long to relax.
    const bool dot = info.name.starts_with("quantum-dot");
    const std::size_t atoms = info.name == "sponge" ? 20000 : dot ? 6000 : 8000;
    const Sample sample = make_sample(info.name, {atoms, 1});
    const Carved result = carved(sample.atoms);
    ASSERT_EQ(validate(result.whole), std::vector<std::string>{}) << info.name;
    ASSERT_EQ(validate(result.mesh), std::vector<std::string>{}) << info.name;
    ASSERT_EQ(validate(result.surface, result.mesh), std::vector<std::string>{}) << info.name;
    const double kept = volume(result.mesh) / volume(result.whole);
    const std::size_t inside = triangles_inside(result, 3.0 * result.report.nearest_neighbour);
    if (info.name == "sponge" || info.name == "cacuo2-spiral") {
      EXPECT_LT(kept, 0.9) << info.name;
      EXPECT_GT(kept, 0.1) << info.name;
      EXPECT_GT(inside, 100U) << info.name;
    } else {
      EXPECT_GT(kept, 0.96) << info.name;
      EXPECT_EQ(inside, 0U) << info.name;
    }
  }
}

TEST(MeshSamples, RealFiles) {
  const std::filesystem::path folder = std::filesystem::path(ATOMESH_SHARED_DATA) / "atoms";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared data at " << folder;
  std::size_t files = 0;
  for (const char* name : {"atomman__fcc_Al_disl.dump", "quip__quartz_crack.xyz", "csaransh__data_lammps_Pos1.xyz",
                           "grip__Ti_2130_tilt_lammps_0.462_0.000_2.51_0.59_2_1_500_7000"}) {
    if (!std::filesystem::exists(folder / name)) continue;
    ++files;
    const Carved result = carved(read_atoms(folder / name).atoms);
    EXPECT_EQ(validate(result.whole), std::vector<std::string>{}) << name;
    EXPECT_EQ(validate(result.mesh), std::vector<std::string>{}) << name;
    EXPECT_EQ(validate(result.surface, result.mesh), std::vector<std::string>{}) << name;
    EXPECT_NEAR(volume(result.mesh) / enclosed_volume(result.surface, result.mesh.vertices), 1.0, 1e-12) << name;
    EXPECT_GT(volume(result.mesh), 0.8 * volume(result.whole)) << name;
  }
  EXPECT_GT(files, 0U);
}

}  // namespace
}  // namespace atomesh
