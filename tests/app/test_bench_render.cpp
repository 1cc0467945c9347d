// bench render at tiny sizes: every part runs, and its rows say what machines read.
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/app/program.h"

namespace atomesh::testing {
namespace {

using nlohmann::json;

class BenchRender : public ::testing::Test {
 protected:
  // The rows of one part, each with the keys every row has.
  json rows(const std::string& part, std::vector<std::string> more = {}, const std::string& suite = "render") {
    std::vector<std::string> arguments{"bench", suite, "--quick", "--part", part, "--json", "-", "--repeats", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = place.run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    err = outcome.err;
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
      EXPECT_EQ(row.contains("rate"), row.contains("rate_unit")) << row.dump(1);
    }
    return bench["rows"];
  }

  Workplace place;
  std::string err;
};

TEST_F(BenchRender, VtkStandsBesideEveryIntegrator) {
  std::set<std::string> ours;
  std::set<std::string> theirs;
  for (const json& row : rows("peers", {"--markdown", "bench.md", "--html", "bench.html"})) {
    (row["peer"].is_null() ? ours : theirs).insert(row["what"]);
    if (row.contains("not_run")) {
      EXPECT_NE(row["not_run"].get<std::string>().find("no display"), std::string::npos);
      continue;
    }
    EXPECT_GT(row["ms_median"], 0.0);
    if (row["peer"].is_null()) {
      EXPECT_GT(row["steps"], 1000U);
    } else {
      EXPECT_LT(row["max_error"], 0.3) << row.dump(1);
      EXPECT_GT(row["first_ms"], 0.0);
    }
    if (row["what"] == "volume: atomesh, exact") {
      EXPECT_LT(row["max_error"], 1e-3);
    }
    if (row["what"] == "volume: VTK ray cast, closed form") {
      EXPECT_LT(row["max_error"], 0.012);
    }
    if (row["what"] == "volume: VTK projected tetrahedra") {
      EXPECT_GT(row["settings"]["opengl"].get<std::string>().size(), 3U);
    }
  }
  for (const char* integrator : {"exact", "linear", "preintegrated", "sampled, 4 a cell"}) {
    EXPECT_TRUE(ours.contains(std::string("volume: atomesh, ") + integrator)) << integrator;
  }
  EXPECT_EQ(theirs, (std::set<std::string>{"volume: VTK ray cast", "volume: VTK ray cast, closed form",
                                           "volume: VTK Z sweep", "volume: VTK projected tetrahedra"}));
  EXPECT_NE(place.read("bench.md").find("| case | what | ms |"), std::string::npos);
  EXPECT_NE(place.read("bench.html").find("<svg"), std::string::npos);
}

TEST_F(BenchRender, PeersCanBeLeftOut) {
  for (const json& row : rows("peers", {"--no-peers"})) {
    EXPECT_EQ(row["peer"].is_null(), !row.contains("not_run"));
    if (row.contains("not_run")) {
      EXPECT_EQ(row["not_run"], "not run: --no-peers");
    }
  }
}

TEST_F(BenchRender, EveryModeIsTimedAndJudged) {
  std::set<std::string> modes;
  for (const json& row : rows("modes", {"--full"})) {
    modes.insert(row["settings"]["mode"]);
    EXPECT_TRUE(row["max_error"].is_number());
    EXPECT_LT(row["rmse"], 0.05) << row.dump(1);
    EXPECT_GE(row["ms_median"].get<double>() + 1e-9, row["prepare_ms"].get<double>());
    const std::string mode = row["settings"]["mode"];
    EXPECT_EQ(row["settings"].contains("integrator"), mode == "volume" || mode == "volume-surface");
  }
  EXPECT_EQ(modes, (std::set<std::string>{"volume-surface", "volume", "surface", "xray", "atoms"}));
}

TEST_F(BenchRender, StepsAreCountedAndRated) {
  for (const json& row : rows("rates")) {
    EXPECT_GT(row["steps"], 1000U);
    EXPECT_GT(row["rate"], 0.0);
    EXPECT_EQ(row["rate_unit"], "million ray-primitive steps/s/core");
    EXPECT_FALSE(row.contains("requirements"));  // of meshes this small
  }
}

TEST_F(BenchRender, ThreadsChangeNoPixel) {
  for (const json& row : rows("threads", {"--threads", "2"})) {
    EXPECT_EQ(row["differing_pixels"], 0U);
    EXPECT_GT(row["speedup"], 0.0);
  }
}

TEST_F(BenchRender, MemoryIsMeasuredAtTwoSizes) {
  std::set<int> widths;
  for (const json& row : rows("memory")) {
    widths.insert(row["settings"]["size"][0].get<int>());
    for (const char* key : {"scene_mb", "frame_mb", "memory_mb", "allowed_mb"}) EXPECT_GE(row[key], 0.0) << key;
  }
  EXPECT_EQ(widths, (std::set<int>{96, 384}));
}

TEST_F(BenchRender, FirstPicturesAndFramesOfEveryMode) {
  std::size_t first = 0;
  std::size_t frames = 0;
  for (const json& row : rows("frames")) {
    const std::string what = row["what"];
    if (what.starts_with("first picture")) {
      ++first;
      EXPECT_GE(row["make_scene_ms"], 0.0);
    } else {
      ++frames;
      EXPECT_GT(row["frames_per_second"], 0.0);
    }
  }
  EXPECT_EQ(first, 5U);
  EXPECT_EQ(frames, 5U);
}

TEST_F(BenchRender, TheSeedsTableIsBesideIt) {
  std::set<std::string> modes;
  for (const json& row : rows("seed")) {
    modes.insert(row["what"]);
    EXPECT_EQ(row["suite"], "seed-table");
    EXPECT_GT(row["peer_ms"], 0.0);
  }
  EXPECT_EQ(modes, (std::set<std::string>{"volume-surface", "xray"}));
}

TEST_F(BenchRender, UnknownPartsAndCasesAreRefusedWithTheNearest) {
  const Outcome part = place.run({"bench", "render", "--part", "peer"});
  EXPECT_EQ(part.exit_code, 1);
  EXPECT_NE(part.err.find("did you mean \"peers\"?"), std::string::npos) << part.err;
  const Outcome data = place.run({"bench", "render", "--part", "rates", "--case", "comp"});
  EXPECT_EQ(data.exit_code, 1);
  EXPECT_NE(data.err.find("did you mean \"comb\"?"), std::string::npos) << data.err;
}

// A data set that is not there is named, and the others are measured.
TEST_F(BenchRender, AMissingDataSetIsANote) {
  const json measured = rows("rates", {"--case", "comb", "lattice-8", "--data", "nowhere"});
  EXPECT_NE(err.find("nowhere"), std::string::npos) << err;
  for (const json& row : measured) EXPECT_EQ(row["case"], "lattice-8, iso");
}

TEST_F(BenchRender, VolumesOnOpenGlStandBesideTheCpuAndVtk) {
  std::set<std::string> what;
  for (const json& row : rows("frames", {}, "havs")) {
    what.insert(row["what"]);
    EXPECT_GT(row["frames_per_second"], 0.0);
    EXPECT_FALSE(row["settings"]["opengl"].get<std::string>().empty());
    EXPECT_EQ(row["settings"]["map"], "peaks");
    EXPECT_GT(row["coverage"], 0.02) << row.dump(1);  // of a picture that is not nearly empty
    EXPECT_LT(row["coverage"], 0.5) << row.dump(1);   // a block fills no more of it
    if (!row["what"].get<std::string>().starts_with("havs")) continue;
    EXPECT_GT(row["tetrahedra_drawn"], 1000U);
    EXPECT_GT(row["order_ms"], 0.0);
    EXPECT_EQ(row["wrong_pixels"], 0U);
    EXPECT_LT(row["max_error"], 4.0 / 255.0);
    EXPECT_GT(row["psnr"], 45.0);
  }
  EXPECT_TRUE(what.contains("havs, exact") && what.contains("havs, table") && what.contains("cpu"));
  EXPECT_TRUE(what.contains("VTK projected tetrahedra") || err.find("no display") != std::string::npos) << err;
}

TEST_F(BenchRender, VolumesOfSamplesShowSomethingWhateverTheirScalar) {
  // Many defects; a few; and no defects at all (a sample that --quick would make too small).
  const std::vector<std::vector<std::string>> samples{{"palladium-hydrogen", "peaks", "--quick"},
                                                      {"cu-line-defect", "peaks in haze"},
                                                      {"cacuo2-spiral", "peaks of waves"}};
  for (const std::vector<std::string>& sample : samples) {
    std::vector<std::string> arguments{"bench", "havs",       "--part", "frames", "--json", "-",      "--repeats",
                                       "1",     "--no-peers", "--size", "64x64",  "--case", sample[0]};
    arguments.insert(arguments.end(), sample.begin() + 2, sample.end());
    const Outcome outcome = place.run(arguments);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const json bench = json::parse(outcome.out);
    ASSERT_GE(bench["rows"].size(), 3U);  // havs in some ways, cpu
    const double of_cpu = bench["rows"].back()["coverage"];
    for (const json& row : bench["rows"]) {
      EXPECT_EQ(row["settings"]["map"], sample[1]);
      EXPECT_GE(row["coverage"], 0.02) << row.dump(1);
      EXPECT_NEAR(row["coverage"].get<double>(), of_cpu, 1e-3) << row.dump(1);
    }
  }
}

TEST_F(BenchRender, MoreOfAKBufferLeavesFewerPixelsWrong) {
  std::uint64_t before = std::numeric_limits<std::uint64_t>::max();
  for (const json& row : rows("order", {"--case", "lattice-12-random"}, "havs")) {
    EXPECT_GT(row["coverage"], 0.02) << row.dump(1);
    const std::uint64_t wrong = row["wrong_pixels"];
    if (row["k"] == 0) {
      EXPECT_EQ(wrong, 0U);
      continue;
    }
    EXPECT_LE(wrong, before);
    before = wrong;
  }
  EXPECT_EQ(before, 0U);
}

}  // namespace
}  // namespace atomesh::testing
