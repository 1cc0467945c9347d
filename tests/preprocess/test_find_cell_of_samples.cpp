// The cells of the ten samples and of files that others wrote.
#include <gtest/gtest.h>

#include <filesystem>

#include "preprocess/read_atoms.h"
#include "samples/samples.h"
#include "tests/preprocess/cell_checks.h"

namespace atomesh {
namespace {

namespace fs = std::filesystem;

// What each sample's cell explains: everything but the hydrogen, and the sponge too, whose atoms are a shaken diamond
// crystal although its file names no cell.
TEST(FindCellOfSamples, IsTheFilesOwn) {
  for (const SampleInfo& info : sample_table()) {
    const Sample sample = make_sample(info.name, {.atoms = 20000});
    FindCellReport report;
    const Crystal crystal = find_unit_cell(sample.atoms, {}, report);
    ASSERT_TRUE(report.found) << info.name << ": " << report.why;
    const auto group = find_space_group(crystal.grains[0]);
    ASSERT_TRUE(group) << info.name;
    if (info.name == "sponge") {
      EXPECT_EQ(group->number, 227);
      EXPECT_NEAR(group->a, 5.431, 0.001 * 5.431);
      EXPECT_GT(report.explained, 0.999);
      continue;
    }
    EXPECT_EQ(crystal.grains.size(), 1U) << info.name;
    const auto expected = find_space_group(*sample.unit_cell);
    EXPECT_EQ(group->number, expected->number) << info.name;
    EXPECT_LT(test::relative(group->a, expected->a), 1e-3) << info.name;
    EXPECT_LT(test::relative(group->b, expected->b), 1e-3) << info.name;
    EXPECT_LT(test::relative(group->c, expected->c), 1e-3) << info.name;
    EXPECT_EQ(test::difference_of_cells(crystal.grains[0], *sample.unit_cell, 1e-3, 0.05), "") << info.name;
    EXPECT_GT(report.explained, info.name == "palladium-hydrogen" ? 0.85 : 0.995) << info.name;
  }
}

struct File {
  const char* name;
  std::size_t basis;
  int group;
  double a;  // Å, of the conventional cell
};

class SharedFiles : public testing::TestWithParam<File> {};

TEST_P(SharedFiles, Crystals) {
  const fs::path path = fs::path(ATOMESH_SHARED_DATA) / "atoms" / GetParam().name;
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not here";
  const Atoms atoms = read_atoms(path.string()).atoms;
  FindCellReport report;
  const Crystal crystal = find_unit_cell(atoms, {}, report);
  if (GetParam().basis == 0) {
    EXPECT_FALSE(crystal.known());
    EXPECT_NE(report.why.find("no unit cell"), std::string::npos);
    return;
  }
  ASSERT_TRUE(report.found) << report.why;
  EXPECT_EQ(crystal.grains[0].basis.size(), GetParam().basis);
  const auto group = find_space_group(crystal.grains[0]);
  ASSERT_TRUE(group);
  EXPECT_EQ(group->number, GetParam().group);
  EXPECT_NEAR(group->a, GetParam().a, 1e-3 * GetParam().a);
}

// Lattice parameters: of the potentials the files were made with.
INSTANTIATE_TEST_SUITE_P(Files, SharedFiles,
                         testing::Values(File{"atomman__fcc_Al_base.dump", 1, 225, 4.05},
                                         File{"atomman__fcc_Al_disl.dump", 1, 225, 4.05},
                                         File{"pyscal__conf.bcc", 1, 229, 3.2051},
                                         File{"pyscal__conf.fcc.dump", 1, 225, 4.097},
                                         File{"qdlib__In1242Zn29As1108Cl460_HLE17_48ang_OPT.xyz", 2, 216, 6.001},
                                         File{"lammps_amorphous_Si.xyz", 0, 0, 0.0}),
                         [](const auto& test) {
                           std::string name = test.param.name;
                           for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
                           return name;
                         });

}  // namespace
}  // namespace atomesh
