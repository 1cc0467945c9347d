// The whole way from a file to a material: what is made, what is left out, what is said about it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "preprocess/pipeline.h"

namespace atomesh {
namespace {

constexpr int side = 5;
constexpr double lattice_constant = 3.0;

// A simple cubic crystal of side³ polonium atoms with its unit cell, one atom missing in the middle.
class Pipeline : public ::testing::Test {
 protected:
  Pipeline()
      : path_((std::filesystem::temp_directory_path() / ("pipeline-" + std::to_string(getpid()) + ".dat")).string()) {
    std::ofstream file(path_);
    file << "primitive\n3 0 0\n0 3 0\n0 0 3\nbasis 1\nPo 0 0 0\n";
    for (int i = 0; i < side; ++i) {
      for (int j = 0; j < side; ++j) {
        for (int k = 0; k < side; ++k) {
          if (i == side / 2 && j == side / 2 && k == side / 2) continue;
          file << "Po " << lattice_constant * i << ' ' << lattice_constant * j << ' ' << lattice_constant * k << '\n';
        }
      }
    }
  }
  ~Pipeline() override { std::filesystem::remove(path_); }

  Material run(const PipelineOptions& options = {}) { return preprocess(path_, options, report_); }
  std::vector<std::string> stages(const Material& material) const {
    std::vector<std::string> names;
    for (const StageTime& stage : material.provenance.stages) names.push_back(stage.name);
    return names;
  }

  std::string path_;
  PipelineReport report_;
};

TEST_F(Pipeline, MakesEverythingByDefault) {
  const Material material = run();
  EXPECT_EQ(material.atoms.size(), static_cast<std::size_t>(side * side * side - 1));
  EXPECT_TRUE(validate(material.mesh).empty());
  EXPECT_TRUE(validate(material.surface, material.mesh).empty());
  const double edge = lattice_constant * (side - 1);
  EXPECT_NEAR(report_.volume, edge * edge * edge, 1e-9);
  EXPECT_NEAR(report_.surface_area, 6.0 * edge * edge, 1e-9);
  EXPECT_TRUE(report_.surface_closed);
  EXPECT_EQ(report_.unit_cell_source, "file");
  ASSERT_EQ(material.defects.vacancies.size(), 1U);
  EXPECT_LT(glm::distance(material.defects.vacancies[0].position, Vec3(0.5 * edge)), 1e-6);
  EXPECT_EQ(stages(material), (std::vector<std::string>{"read_atoms", "find_unit_cell", "tetrahedralize", "carve",
                                                        "extract_surface", "quantify_defects", "measure"}));
  EXPECT_TRUE(report_.notes.empty());
}

// Who shows how it goes hears of each stage once, in order, and finds there what it made.
TEST_F(Pipeline, TellsOfEveryStageWhenItsResultIsInPlace) {
  std::vector<std::string> told;
  std::size_t atoms_after_reading = 0, triangles_after_surface = 0, vacancies_after_defects = 0;
  std::size_t tetrahedra_before_carving = 0;
  PipelineOptions options;
  options.after_stage = [&](const StageTime& finished, const Material& material, const PipelineReport& report) {
    told.push_back(finished.name);
    EXPECT_EQ(report.stage_memory.size(), told.size());
    if (finished.name == "read_atoms") atoms_after_reading = material.atoms.size();
    if (finished.name == "tetrahedralize") tetrahedra_before_carving = material.mesh.tetrahedra.size();
    if (finished.name == "extract_surface") triangles_after_surface = material.surface.triangles.size();
    if (finished.name == "quantify_defects") vacancies_after_defects = material.defects.vacancies.size();
  };
  const Material material = run(options);
  EXPECT_EQ(told, stages(material));
  EXPECT_EQ(atoms_after_reading, material.atoms.size());
  EXPECT_EQ(tetrahedra_before_carving, material.mesh.tetrahedra.size() + report_.carve.removed);
  EXPECT_EQ(triangles_after_surface, material.surface.triangles.size());
  EXPECT_EQ(vacancies_after_defects, 1U);
}

TEST_F(Pipeline, LeavesOutWhatNobodyWants) {
  PipelineOptions options;
  options.wanted = {.atoms = true, .tetrahedra = false, .surface = false, .defects = false};
  const Material balls = run(options);
  EXPECT_EQ(stages(balls), (std::vector<std::string>{"read_atoms", "find_unit_cell"}));
  EXPECT_TRUE(balls.mesh.vertices.empty());
  options.wanted.surface = true;
  const Material surface = run(options);
  EXPECT_FALSE(surface.surface.triangles.empty());
  EXPECT_FALSE(surface.defects.present());
}

TEST_F(Pipeline, OptionsReachTheirStages) {
  PipelineOptions options;
  options.carve = false;
  options.unit_cell = "none";
  const Material material = run(options);
  EXPECT_EQ(stages(material),
            (std::vector<std::string>{"read_atoms", "find_unit_cell", "tetrahedralize", "extract_surface", "measure"}));
  EXPECT_FALSE(material.unit_cell.has_value());
  EXPECT_FALSE(material.defects.present());
  ASSERT_EQ(report_.notes.size(), 1U);
  EXPECT_NE(report_.notes[0].find("--unit-cell"), std::string::npos);
}

TEST_F(Pipeline, UnitCellOfAnotherFile) {
  PipelineOptions options;
  options.unit_cell = path_;
  EXPECT_EQ(run(options).defects.vacancies.size(), 1U);
  options.unit_cell = "no-such-file.dat";
  EXPECT_THROW(run(options), InputError);
}

TEST_F(Pipeline, ScalarTakesThePlaceOfDefects) {
  PipelineOptions options;
  options.scalar = "Po=3";
  const Material material = run(options);
  EXPECT_TRUE(material.defects.present());
  EXPECT_TRUE(material.defects.vacancies.empty());
  const std::vector<std::string> names = stages(material);
  EXPECT_EQ(std::count(names.begin(), names.end(), "assign_scalar"), 1);
  EXPECT_EQ(std::count(names.begin(), names.end(), "quantify_defects"), 0);
}

TEST_F(Pipeline, ReducedSamplesAreNotComparedWithTheCrystal) {
  PipelineOptions options;
  options.reduce.keep_every = 4;
  options.reduce.boundary_distance = 1.0;  // one layer
  const Material material = run(options);
  EXPECT_LT(material.atoms.size(), static_cast<std::size_t>(side * side * side - 1));
  EXPECT_FALSE(material.defects.present());
  ASSERT_EQ(report_.notes.size(), 2U);
  EXPECT_NE(report_.notes[0].find("--carve"), std::string::npos);
  EXPECT_NE(report_.notes[1].find("--scalar"), std::string::npos);
}

TEST_F(Pipeline, ThinnedSamplesAreCarvedOnlyByAGivenRadius) {
  PipelineOptions options;
  options.reduce.keep_every = 4;
  options.reduce.boundary_distance = 1.0;
  const Material whole = run(options);
  const double edge = lattice_constant * (side - 1);
  EXPECT_NEAR(volume(whole.mesh), edge * edge * edge, 1e-9);
  options.carve_options.radius = 1.0;  // smaller than any cell's
  EXPECT_TRUE(run(options).mesh.tetrahedra.empty());
}

TEST_F(Pipeline, ProvenanceTellsOptionsAndCounts) {
  const Provenance provenance = run().provenance;
  EXPECT_TRUE(provenance.program.starts_with("atomesh "));
  EXPECT_EQ(provenance.input, std::filesystem::path(path_).filename().string());
  const auto option = [&](const std::string& name) -> std::string {
    for (const auto& [key, value] : provenance.options) {
      if (key == name) return value;
    }
    return "absent";
  };
  EXPECT_EQ(option("mesher"), "auto");
  EXPECT_EQ(option("carve"), "auto");
  EXPECT_EQ(option("format"), "dat");
  const auto count = [&](const std::string& name) -> std::uint64_t {
    for (const auto& [key, value] : provenance.counts) {
      if (key == name) return value;
    }
    return 999;
  };
  EXPECT_EQ(count("atoms"), static_cast<std::uint64_t>(side * side * side - 1));
  EXPECT_EQ(count("vacancies"), 1U);
  EXPECT_EQ(count("duplicates"), 0U);
}

TEST_F(Pipeline, EveryStageCanCancel) {
  const std::vector<std::string> names = stages(run());
  for (const std::string& name : names) {
    Progress* cancelled = nullptr;
    Progress progress([&](std::string_view stage, double) {
      if (stage == name) cancelled->request_cancel();
    });
    cancelled = &progress;
    // A cancel in the last stage may come after its last look; all before must stop at the next stage's beginning.
    if (name == names.back()) continue;
    EXPECT_THROW(preprocess(path_, {}, report_, progress), CancelledError) << name;
  }
}

}  // namespace
}  // namespace atomesh
