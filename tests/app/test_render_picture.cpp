// Large and progressive pictures of `render`: the same picture whichever way it is drawn, and nothing left of one that
// was not finished.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>

#include "core/image.h"
#include "tests/app/program.h"

namespace atomesh::testing {
namespace {

using nlohmann::json;

const std::vector<std::string> modes{"volume-surface", "volume", "surface", "xray", "atoms"};

// A small diamond, preprocessed once for all tests.
class RenderPicture : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    place = std::make_unique<Workplace>();
    place->run({"sample", "diamond-vacancy", "--atoms", "4000", "-o", "d.dat"});
    preprocessed = place->run({"preprocess", "d.dat", "-o", "d.crb"});
  }
  static void TearDownTestSuite() { place.reset(); }
  void SetUp() override { ASSERT_EQ(preprocessed.exit_code, 0) << preprocessed.err; }

  static json render(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"render", "d.crb"});
    arguments.insert(arguments.end(), {"--json", "-"});
    const Outcome outcome = place->run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return json::parse(outcome.out, nullptr, false);
  }
  static Image picture(const std::string& name) { return read_png(place->path(name).string()); }

  static inline std::unique_ptr<Workplace> place;
  static inline Outcome preprocessed;
};

TEST_F(RenderPicture, InPassesIsTheDirectPicture) {
  for (const std::string& mode : modes) {
    render({"-o", "direct.png", "--mode", mode, "--size", "67x50"});
    const json report = render({"-o", "passes.png", "--mode", mode, "--size", "67x50", "--pass-rows", "7"});
    EXPECT_EQ(report["passes"]["count"], 8);
    EXPECT_EQ(report["passes"]["rows"], 7);
    EXPECT_EQ(place->read("passes.png"), place->read("direct.png")) << mode;
  }
  render({"-o", "direct.png", "--size", "40x31", "--set", "quality.supersampling=3", "--transparent"});
  render({"-o", "passes.png", "--size", "40x31", "--set", "quality.supersampling=3", "--transparent", "--pass-rows",
          "10"});
  EXPECT_EQ(place->read("passes.png"), place->read("direct.png"));
}

TEST_F(RenderPicture, ChannelsInPassesAndProgressiveAreTheDirectOnes) {
  const std::vector<std::string> how[] = {{"--pass-rows", "16"}, {"--progressive", "4"}};
  for (const auto& [mode, channel] :
       {std::pair("xray", "thickness"), std::pair("surface", "id"), std::pair("atoms", "depth")}) {
    const std::string name(channel);
    render({"-o", "a.png", "--mode", mode, "--size", "50x41", "--channel", name + "=a.npy"});
    for (std::vector<std::string> words : how) {
      words.insert(words.end(), {"-o", "b.png", "--mode", mode, "--size", "50x41", "--channel", name + "=b.npy"});
      render(words);
      EXPECT_EQ(place->read("b.npy"), place->read("a.npy")) << mode << " " << words.front();
    }
  }
}

TEST_F(RenderPicture, LargePicturesAreDrawnInPassesByThemselves) {
  // Within 200 MB a pass may take less than a quarter of it; this picture would take 160 MB.
#if defined(__SANITIZE_ADDRESS__)  // the program takes more than that by itself
  const char* const limit = "350";
#else
  const char* const limit = "200";
#endif
  const Outcome outcome = place->run({"render", "d.crb", "-o", "large.png", "--mode", "xray", "--size", "10000x1000",
                                      "--memory-limit", limit, "--threads", "1", "--json", "large.json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("rows at a time"), std::string::npos) << outcome.err;
  const json report = json::parse(place->read("large.json"));
  EXPECT_GE(report["passes"]["count"].get<int>(), 4);
#if !defined(__SANITIZE_ADDRESS__)  // whose allocator keeps what is freed
  EXPECT_LT(report["peak_memory_mb"].get<double>(), 200.0);
#endif
  const Image image = picture("large.png");
  EXPECT_EQ(image.width, 10000);
  EXPECT_EQ(image.height, 1000);
}

TEST_F(RenderPicture, ProgressiveEndsAsTheDirectPictureAndKeepsItsLevels) {
  render({"-o", "direct.png", "--size", "67x50"});
  const json report = render({"-o", "p.png", "--size", "67x50", "--progressive", "8", "--keep-levels"});
  EXPECT_EQ(place->read("p.png"), place->read("direct.png"));
  EXPECT_EQ(place->read("p-7.png"), place->read("direct.png"));
  const json& progressive = report["progressive"];
  EXPECT_EQ(progressive["sub_window"], 8);
  EXPECT_EQ(progressive["complete"], true);
  EXPECT_EQ(progressive["fraction"], 1.0);
  ASSERT_EQ(progressive["levels"].size(), 7U);
  double before = 0.0;
  for (std::size_t level = 0; level < 7; ++level) {
    const json& here = progressive["levels"][level];
    EXPECT_EQ(here["file"], "p-" + std::to_string(level + 1) + ".png");
    EXPECT_GE(here["ms"].get<double>(), before);
    before = here["ms"];
  }
  EXPECT_EQ(progressive["levels"][1]["rows"], 2);
  EXPECT_EQ(progressive["levels"][1]["columns"], 1);
  // The first picture: squares of 8×8 pixels in the colour of their first one.
  const Image first = picture("p-1.png");
  const Image direct = picture("direct.png");
  for (int row = 0; row < 50; ++row) {
    for (int column = 0; column < 67; ++column) {
      ASSERT_EQ(first.at(column, row), direct.at(column & ~7, row & ~7));
    }
  }
}

TEST_F(RenderPicture, NoTimeGivesTheFirstPicture) {
  const json report = render({"-o", "soon.png", "--size", "64x64", "--progressive", "4", "--time-budget", "0"});
  EXPECT_EQ(report["progressive"]["complete"], false);
  EXPECT_EQ(report["progressive"]["fraction"], 0.0625);
  EXPECT_EQ(report["progressive"]["levels"].size(), 1U);
  EXPECT_EQ(picture("soon.png").at(5, 6), picture("soon.png").at(4, 4));
}

TEST_F(RenderPicture, OptionsThatDoNotGoTogetherAreWrongUse) {
  const std::vector<std::string> wrong[] = {{"--progressive", "5"},
                                            {"--time-budget", "100"},
                                            {"--keep-levels"},
                                            {"--progressive", "4", "--time-budget", "-1"},
                                            {"--progressive", "4", "--pass-rows", "10"},
                                            {"--pass-rows", "0"}};
  for (std::vector<std::string> words : wrong) {
    words.insert(words.begin(), {"render", "d.crb", "-o", "wrong.png"});
    const Outcome outcome = place->run(words);
    EXPECT_EQ(outcome.exit_code, 1) << words[4] << outcome.err;
    EXPECT_FALSE(place->exists("wrong.png"));
  }
}

TEST_F(RenderPicture, AProgressivePictureThatDoesNotFitIsRefused) {
  const Outcome outcome = place->run(
      {"render", "d.crb", "-o", "big.png", "--size", "8000x8000", "--progressive", "8", "--memory-limit", "500"});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
  EXPECT_NE(outcome.err.find("--progressive"), std::string::npos) << outcome.err;
  EXPECT_FALSE(place->exists("big.png"));
}

TEST_F(RenderPicture, ALevelIsNotComparedWithItself) {
  const std::vector<std::string> draw{"render", "d.crb",         "-o", "q.png",        "--size",
                                      "40x30",  "--progressive", "4",  "--keep-levels"};
  ASSERT_EQ(place->run(draw).exit_code, 0);
  std::vector<std::string> compared = draw;
  compared.insert(compared.end(), {"--reference", "q-5.png"});
  const Outcome outcome = place->run(compared);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("they would always agree"), std::string::npos) << outcome.err;
}

TEST_F(RenderPicture, TheHistogramCountsEveryAtomInAnyMode) {
  const auto counts = [](const std::string& name) {
    std::istringstream text(place->read(name));
    std::string line;
    std::getline(text, line);
    EXPECT_EQ(line, "scalar_from,scalar_to,value_from,value_to,count");
    std::vector<std::uint64_t> all;
    while (std::getline(text, line)) all.push_back(std::stoull(line.substr(line.rfind(',') + 1)));
    return all;
  };
  const json report = render({"-o", "h.png", "--mode", "surface", "--size", "16x16", "--histogram", "h.csv"});
  const auto all = counts("h.csv");
  ASSERT_EQ(all.size(), 256U);
  EXPECT_EQ(std::accumulate(all.begin(), all.end(), std::uint64_t{0}), report["atoms"].get<std::uint64_t>());
  EXPECT_GT(all.back(), 0U);
  // Weights count.
  render({"-o", "h.png", "--mode", "volume", "--size", "16x16", "--set", "volume.vacancy_multiplier=0", "--histogram",
          "other.csv"});
  EXPECT_NE(counts("other.csv"), all);
  EXPECT_EQ(place->run({"render", "d.crb", "-o", "h.png", "--histogram", "h.txt"}).exit_code, 1);
}

TEST_F(RenderPicture, ACancelLeavesNoFile) {
  const std::vector<std::string> before = place->files();
  const std::vector<std::string> how[] = {{"--pass-rows", "64"}, {"--progressive", "8", "--keep-levels"}};
  for (const std::vector<std::string>& words : how) {
    std::vector<std::string> arguments{"render",    "d.crb",
                                       "-o",        "cancelled.png",
                                       "--size",    "1500x1500",
                                       "--set",     "quality.supersampling=2",
                                       "--channel", "id=cancelled.npy",
                                       "--mode",    "surface"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    // Sooner each time until the picture is not done by then.
    Outcome outcome;
    for (int delay_ms = 200; delay_ms >= 25; delay_ms /= 2) {
      outcome = place->run_interrupted(arguments, delay_ms);
      if (outcome.exit_code != 0) break;
      for (const std::string& file : place->files()) {
        if (std::find(before.begin(), before.end(), file) == before.end()) std::filesystem::remove(place->path(file));
      }
    }
    EXPECT_EQ(outcome.exit_code, 130) << outcome.err;
    EXPECT_EQ(place->files(), before);
  }
}

}  // namespace
}  // namespace atomesh::testing
