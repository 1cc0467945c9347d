// bench error at tiny sizes: every part runs, errors are where they must be, and its rows say what machines read.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/app/program.h"

namespace atomesh::testing {
namespace {

using nlohmann::json;

class BenchError : public ::testing::Test {
 protected:
  json rows(const std::string& part, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"bench", "error", "--quick", "--part", part, "--json", "-", "--repeats", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = place.run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    err = outcome.err;
    json bench = json::parse(outcome.out, nullptr, false);
    EXPECT_FALSE(bench.is_discarded()) << outcome.out;
    EXPECT_GT(bench["rows"].size(), 0U);
    for (const json& row : bench["rows"]) {
      EXPECT_EQ(row["suite"], "error");
      for (const char* key :
           {"case", "what", "settings", "peer", "ms_median", "ms_min", "ms_max", "max_error", "rmse", "psnr"}) {
        EXPECT_TRUE(row.contains(key)) << key << " in " << row.dump(1);
      }
    }
    return bench["rows"];
  }

  Workplace place;
  std::string err;
};

TEST_F(BenchError, ErrorsFallWithTheSamplesAndTheClosedFormHasNone) {
  std::set<std::string> cases;
  std::map<std::string, std::map<int, double>> sampled;
  std::size_t orders = 0;
  std::filesystem::create_directory(place.path("plots"));
  for (const json& row : rows("curves", {"--no-peers", "--size", "128x128", "--html", "error.html", "--svg",
                                         place.path("plots").string()})) {
    const std::string name = row["case"];
    cases.insert(name);
    if (row.contains("order")) {
      ++orders;
      EXPECT_GT(row["order"], 1.5) << name;
      EXPECT_LT(row["order"], 2.5) << name;
      continue;
    }
    EXPECT_GT(row["pixels_judged"], 400U);
    const std::string what = row["what"];
    if (what == "atomesh, exact") {
      EXPECT_LE(row["max_error"], 1e-5) << name;
    }
    for (const int samples : {1, 2, 4, 8, 16}) {
      if (what == "atomesh, sampled, " + std::to_string(samples) + " a cell") sampled[name][samples] = row["max_error"];
    }
  }
  EXPECT_EQ(cases, (std::set<std::string>{"lattice-12, iso, volume", "lattice-12, iso, volume-surface"}));
  EXPECT_EQ(orders, 2U);
  for (const auto& [name, errors] : sampled) {
    ASSERT_EQ(errors.size(), 5U) << name;
    EXPECT_LT(errors.at(16), 0.03 * errors.at(1)) << name;
  }
  EXPECT_NE(place.read("error.html").find("half a step of 8 bits"), std::string::npos);
  EXPECT_NE(place.read("plots/speed-against-error-lattice-12-iso-volume.svg").find("<svg"), std::string::npos);
}

TEST_F(BenchError, EveryModeOfEveryDataSetIsWithinItsLimit) {
  std::set<std::string> modes;
  for (const json& row : rows("scenes", {"--case", "diamond-vacancy", "lattice-8-random"})) {
    modes.insert(row["settings"]["mode"]);
    ASSERT_TRUE(row.contains("requirements"));
    for (const json& requirement : row["requirements"]) EXPECT_TRUE(requirement["met"]) << row.dump(1);
  }
  EXPECT_EQ(modes, (std::set<std::string>{"volume", "volume-surface", "surface", "xray"}));
}

TEST_F(BenchError, VolumesOfSamplesShowSomethingWhateverTheirScalar) {
  // Many defects; a few; and none (a sample that --quick would make too small).
  const Outcome outcome = place.run({"bench", "error", "--part", "scenes", "--json", "-", "--size", "64x64", "--case",
                                     "palladium-hydrogen", "diamond-vacancy", "cacuo2-spiral"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const json bench = json::parse(outcome.out);
  std::map<std::string, std::string> maps;
  for (const json& row : bench["rows"]) {
    const std::string name = row["case"];
    EXPECT_EQ(row["settings"].contains("map"), row["settings"]["mode"] == "volume") << row.dump(1);
    if (row["settings"]["mode"] != "volume") continue;
    maps[name.substr(0, name.find(','))] = row["settings"]["map"];
    EXPECT_GT(row["max_error"], 0.0) << row.dump(1);  // an empty picture has none
    for (const json& requirement : row["requirements"]) EXPECT_TRUE(requirement["met"]) << row.dump(1);
  }
  EXPECT_EQ(maps, (std::map<std::string, std::string>{{"palladium-hydrogen", "peaks"},
                                                      {"diamond-vacancy", "peaks in haze"},
                                                      {"cacuo2-spiral", "peaks of waves"}}));
}

TEST_F(BenchError, HardCasesKeepToWhatIsKnown) {
  std::size_t cases = 0;
  std::size_t inside_out = 0;
  for (const json& row : rows("hard-cases")) {
    if (row.contains("outside_of_colors")) {
      ++inside_out;
      EXPECT_LE(row["outside_of_colors"], 1e-6);
      continue;
    }
    ++cases;
    EXPECT_LE(row["length_error"], 1e-5);
    EXPECT_LE(row["thickness_error"], 1e-5);
    for (const json& requirement : row["requirements"]) EXPECT_TRUE(requirement["met"]) << row.dump(1);
  }
  EXPECT_EQ(cases, 6U);  // the lattices
  EXPECT_EQ(inside_out, 1U);
}

TEST_F(BenchError, WhatIsNotThereIsSaid) {
  const Outcome part = place.run({"bench", "error", "--part", "curve"});
  EXPECT_EQ(part.exit_code, 1);
  EXPECT_NE(part.err.find("did you mean \"curves\"?"), std::string::npos) << part.err;
  const Outcome name = place.run({"bench", "error", "--part", "curves", "--case", "com"});
  EXPECT_EQ(name.exit_code, 1);
  EXPECT_NE(name.err.find("did you mean \"comb\"?"), std::string::npos) << name.err;
  const Outcome data = place.run({"bench", "error", "--part", "scenes", "--case", "comb", "--data", "nowhere"});
  EXPECT_EQ(data.exit_code, 0);
  EXPECT_NE(data.err.find("there is no nowhere/vtkdata__combxyz.bin"), std::string::npos) << data.err;
}

}  // namespace
}  // namespace atomesh::testing
