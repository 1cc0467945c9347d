// bench preprocess at tiny sizes: every part runs, and its rows say what machines read.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "tests/app/program.h"

namespace atomesh::testing {
namespace {

using nlohmann::json;

class Bench : public ::testing::Test {
 protected:
  // The rows of one part, each with the keys every row has.
  json rows(const std::string& part, const std::string& atoms, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"bench", "preprocess", "--part", part, "--atoms", atoms, "--json", "-"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = place.run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    json bench = json::parse(outcome.out, nullptr, false);
    EXPECT_FALSE(bench.is_discarded()) << outcome.out;
    EXPECT_TRUE(bench.contains("machine") && bench.contains("commit"));
    EXPECT_GT(bench["rows"].size(), 0U);
    for (const json& row : bench["rows"]) {
      for (const char* key : {"suite", "case", "what", "settings", "peer", "ms_median", "ms_min", "ms_max", "max_error",
                              "rmse", "psnr"}) {
        EXPECT_TRUE(row.contains(key)) << key << " in " << row.dump(1);
      }
      if (row["ms_median"].is_number()) {
        EXPECT_LE(row["ms_min"], row["ms_median"]);
        EXPECT_LE(row["ms_median"], row["ms_max"]);
      }
      if (row.contains("rate")) {
        EXPECT_TRUE(row.contains("rate_unit")) << row.dump(1);
      }
      if (!row.contains("requirements")) continue;
      for (const json& requirement : row["requirements"]) {
        EXPECT_TRUE(requirement["met"].is_boolean());
        EXPECT_TRUE(requirement["measured"].is_number());
        EXPECT_NE(requirement.contains("at_least"), requirement.contains("at_most"));
      }
    }
    return bench["rows"];
  }

  Workplace place;
};

TEST_F(Bench, MeshersAreSoundAndBesideCgal) {
  std::set<std::string> meshers;
  for (const json& row : rows("tetrahedralize", "1000", {"--markdown", "bench.md", "--html", "bench.html"})) {
    meshers.insert(row["what"]);
    EXPECT_GT(row["tetrahedra"], 3000U);
    EXPECT_TRUE(row.contains("bytes_per_tetrahedron"));
    if (!row.contains("valid")) continue;
    EXPECT_TRUE(row["valid"]) << row.dump(1);
    // Shaken atoms keep the tetrahedra of the crystal they shake about.
    const bool shaken = row["case"].get<std::string>().find("noise") != std::string::npos;
    EXPECT_TRUE(row["delaunay"] || (shaken && row["what"] == "tetrahedralize: pattern")) << row.dump(1);
    EXPECT_LE(row["max_error"], 1e-6);
  }
  EXPECT_TRUE(meshers.contains("tetrahedralize: CGAL Delaunay_triangulation_3"));
  EXPECT_TRUE(meshers.contains("tetrahedralize: delaunay"));
  EXPECT_TRUE(meshers.contains("tetrahedralize: pattern"));
  EXPECT_NE(place.read("bench.md").find("| crystal | CGAL, ms |"), std::string::npos);
  EXPECT_NE(place.read("bench.html").find("<h1>atomesh bench preprocess</h1>"), std::string::npos);
  EXPECT_NE(place.read("bench.html").find("CGAL, ms</th>"), std::string::npos);
}

TEST_F(Bench, DefectValuesAreTimedOnOneCoreAndOnAll) {
  std::set<int> neighbours;
  for (const json& row : rows("quantify_defects", "1000")) {
    if (row["what"] != "quantify_defects") continue;
    neighbours.insert(row["settings"]["neighbours"].get<int>());
    EXPECT_EQ(row["rate_unit"], "atoms/s/core");
  }
  EXPECT_EQ(neighbours, (std::set<int>{18, 26}));
}

TEST_F(Bench, SimplificationIsLosslessBesideVtk) {
  std::set<std::string> strategies;
  bool vtk = false;
  for (const json& row : rows("simplify", "6000")) {
    vtk = vtk || row["peer"] == "VTK";
    if (!row.contains("lossless")) continue;
    strategies.insert(row["settings"]["strategy"]);
    EXPECT_TRUE(row["lossless"]) << row.dump(1);
    EXPECT_LE(row["share_of_bound"], 100.0);
    EXPECT_LT(row["tetrahedra_after"], row["tetrahedra_before"]);
    EXPECT_GE(row["tetrahedra_after"], row["least_tetrahedra"]);
    if (row.contains("valid")) {
      EXPECT_TRUE(row["valid"]) << row.dump(1);
      EXPECT_TRUE(row["psnr"].is_null() || row["psnr"] > 40.0) << row.dump(1);
    }
  }
  EXPECT_EQ(strategies, (std::set<std::string>{"collapse", "remove"}));
  EXPECT_TRUE(vtk);
}

TEST_F(Bench, AFileIsTimedStageByStage) {
  const json all = rows("pipeline", "4000");
  std::set<std::string> stages;
  for (const json& stage : all[0]["stages"]) stages.insert(stage["name"]);
  for (const char* stage : {"read_atoms", "tetrahedralize", "quantify_defects", "write_crb"}) {
    EXPECT_TRUE(stages.contains(stage)) << stage;
  }
  EXPECT_GT(all[0]["memory_mb"], 1.0);
  EXPECT_EQ(all[0]["unit_cell"], "file");
  EXPECT_EQ(all[1]["unit_cell"], "found");
  EXPECT_LT(all[2]["tetrahedra"], all[0]["tetrahedra"]);  // simplified
  EXPECT_EQ(all[3]["suite"], "seed-table");
}

TEST_F(Bench, PlantedTruthIsFound) {
  std::size_t levels = 0;
  for (const json& row : rows("truth", "10000")) {
    if (!row.contains("requirements")) {
      EXPECT_GT(row["vacancies"]["planted"], 0U);
      continue;
    }
    ++levels;
    for (const json& requirement : row["requirements"]) EXPECT_TRUE(requirement["met"]) << row.dump(1);
  }
  EXPECT_EQ(levels, 2U);  // without noise, and 1 %
}

TEST_F(Bench, UnitCellsOfCommonStructuresAreFound) {
  std::size_t structures = 0;
  for (const json& row : rows("find_unit_cell", "2000")) {
    if (!row.contains("found")) continue;
    ++structures;
    EXPECT_TRUE(row["right"].is_boolean());
    EXPECT_GE(row["explained"], 0.0);
    EXPECT_LE(row["explained"], 1.0);
  }
  EXPECT_EQ(structures, 36U);  // twelve, each perfect and shaken twice
}

TEST_F(Bench, WindowsAreTimedUntilTheirPictureIsThere) {
  const Outcome outcome = place.run({"bench", "window", "--quick", "--repeats", "1", "--json", "w.json"});
  if (outcome.exit_code == 3 && outcome.err.find("display") != std::string::npos) GTEST_SKIP() << outcome.err;
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const json result = json::parse(place.read("w.json"));
  ASSERT_EQ(result["rows"].size(), 2U);
  for (const json& row : result["rows"]) {
    EXPECT_GT(row["ms_median"], 10.0);
    EXPECT_GE(row["complete_ms"], row["ms_median"]);
  }
}

TEST_F(Bench, UnknownPartsAreRefusedWithTheNearest) {
  const Outcome outcome = place.run({"bench", "preprocess", "--part", "tetrahedralise"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("did you mean \"tetrahedralize\"?"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace atomesh::testing
