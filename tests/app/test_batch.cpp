// Preprocessing many files: which are taken, what they become, what is skipped, and what one bad file does to the rest.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace atomesh::testing {
namespace {

using nlohmann::json;

const std::string cube = "Na 0 0 0\nNa 2 0 0\nNa 0 2 0\nNa 0 0 2\nNa 2 2 0\nNa 2 0 2\nNa 0 2 2\nNa 2 2 2\n";

class Batch : public ::testing::Test {
 protected:
  Batch() {
    place.write("a.dat", cube);
    place.write("b.dat", cube + "Na 1 1 1\n");
    place.write("c.xyz", "1\n\nNa 0 0 0\n");
  }

  // The JSON of `preprocess words…`.
  json run(std::vector<std::string> words, int exit_code = 0) const {
    words.insert(words.begin(), "preprocess");
    words.insert(words.end(), {"--json", "-"});
    const Outcome outcome = place.run(words);
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
    json parsed = json::parse(outcome.out, nullptr, false);
    EXPECT_FALSE(parsed.is_discarded()) << outcome.out << outcome.err;
    return parsed;
  }
  static std::vector<std::string> column(const json& batch, const std::string& pointer) {
    std::vector<std::string> values;
    for (const json& file : batch["files"]) values.push_back(file[json::json_pointer(pointer)]);
    return values;
  }
  void expect_usage(std::vector<std::string> words, const std::vector<std::string>& said, int exit_code = 1) const {
    const std::vector<std::string> before = place.files();
    words.insert(words.begin(), "preprocess");
    const Outcome outcome = place.run(words);
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.out << outcome.err;
    for (const std::string& word : said) EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_EQ(place.files(), before);
  }

  const Workplace place;
};

using Names = std::vector<std::string>;

TEST_F(Batch, FilesPatternsAndFoldersBecomeFiles) {
  const json files = run({"b.dat", "a.dat", "-o", "out/"});
  EXPECT_EQ(column(files, "/output/file"), (Names{"out/b.crb", "out/a.crb"}));
  EXPECT_EQ(column(files, "/status"), (Names{"done", "done"}));
  EXPECT_EQ(files["done"], 2);
  EXPECT_EQ(files["files"][0]["input"]["atoms"], 9);
  EXPECT_TRUE(files["files"][0]["error"].is_null());
  EXPECT_TRUE(place.exists("out/a.crb"));

  const json pattern = run({"*.dat", "a.dat", "-o", "{name}-new.crt"});
  EXPECT_EQ(column(pattern, "/output/file"), (Names{"a-new.crt", "b-new.crt"})) << "each file once";
  const json folder = run({".", "-o", "all/{file}.crb"});
  EXPECT_EQ(column(folder, "/output/file"), (Names{"all/a.dat.crb", "all/b.dat.crb", "all/c.xyz.crb"}));
}

TEST_F(Batch, AFileThatLooksLikeAPatternIsAFile) {
  place.write("d[1].dat", cube);
  EXPECT_TRUE(run({"d[1].dat", "-o", "d.crb"}).contains("mesh")) << "one file, one report";
}

TEST_F(Batch, WhatIsUpToDateIsSkipped) {
  EXPECT_EQ(column(run({"*.dat", "-o", "out/"}), "/status"), (Names{"done", "done"}));
  const std::string bytes = place.read("out/a.crb");
  const json again = run({"*.dat", "-o", "out/"});
  EXPECT_EQ(column(again, "/status"), (Names{"skipped", "skipped"}));
  EXPECT_EQ(again["skipped"], 2);
  EXPECT_GT(again["files"][0]["mesh"]["tetrahedra"], 0);
  EXPECT_EQ(place.read("out/a.crb"), bytes);

  place.write("a.dat", cube);  // a newer date
  EXPECT_EQ(column(run({"*.dat", "-o", "out/"}), "/status"), (Names{"skipped", "skipped"}));
  place.write("a.dat", cube + "# what is in it counts\n");
  EXPECT_EQ(column(run({"*.dat", "-o", "out/"}), "/status"), (Names{"done", "skipped"}));
  EXPECT_EQ(column(run({"*.dat", "-o", "out/", "--carve", "off"}), "/status"), (Names{"done", "done"}));
  EXPECT_EQ(column(run({"*.dat", "-o", "out/", "--carve", "off", "--no-compress"}), "/status"),
            (Names{"done", "done"}));
  EXPECT_EQ(column(run({"*.dat", "-o", "out/", "--carve", "off", "--no-compress", "--format", "dat"}), "/status"),
            (Names{"skipped", "skipped"}))
      << "the format they were read in";
  EXPECT_EQ(column(run({"*.dat", "-o", "out/", "--carve", "off", "--no-compress", "--force"}), "/status"),
            (Names{"done", "done"}));
}

TEST_F(Batch, TheUnitCellsContentCounts) {
  place.write("cell.dat", "primitive\n2 0 0\n0 2 0\n0 0 2\nbasis 1\nNa 0 0 0\n");
  const std::vector<std::string> words{"a.dat", "b.dat", "-o", "out/", "--unit-cell", "cell.dat"};
  EXPECT_EQ(run(words)["done"], 2);
  EXPECT_EQ(run(words)["skipped"], 2);
  place.write("cell.dat", "primitive\n2 0 0\n0 2 0\n0 0 2\nbasis 1\nNa 1 1 1\n");
  EXPECT_EQ(run(words)["done"], 2);
}

TEST_F(Batch, DamagedOutputsAreMadeAgain) {
  EXPECT_EQ(run({"a.dat", "b.dat", "-o", "out/"})["done"], 2);
  place.write("out/a.crb", place.read("out/a.crb").substr(0, 300));
  place.write("out/b.crb", "something else");
  EXPECT_EQ(run({"a.dat", "b.dat", "-o", "out/"})["done"], 2);
}

TEST_F(Batch, ABadFileDoesNotStopTheOthers) {
  place.write("bad.dat", "Na 0 0 0\nNa 1 0\n");
  const json batch = run({"a.dat", "bad.dat", "none.dat", "b.dat", "-o", "out/"}, 2);
  EXPECT_EQ(column(batch, "/status"), (Names{"done", "failed", "failed", "done"}));
  EXPECT_EQ(batch["done"], 2);
  EXPECT_EQ(batch["failed"], 2);
  const std::string error = batch["files"][1]["error"];
  EXPECT_NE(error.find("bad.dat:2: "), std::string::npos) << error;
  EXPECT_FALSE(place.exists("out/bad.crb"));

  const Outcome table = place.run({"preprocess", "a.dat", "bad.dat", "-o", "out/"});
  EXPECT_EQ(table.exit_code, 2);
  for (const char* word : {"a.dat", "skipped", "bad.dat", "failed", ":2: ", "0 done, 1 skipped, 1 failed"}) {
    EXPECT_NE(table.out.find(word), std::string::npos) << word << "\n" << table.out;
  }
}

TEST_F(Batch, TheWorstKindIsTheExitCode) {
  place.write("bad.dat", "Na 0 0 0\nNa 1 0\n");
  // Wrong use by one file's species (1), bad input (2).
  EXPECT_EQ(run({"a.dat", "c.xyz", "-o", "out/", "--mask", "Cl"}, 1)["failed"], 2);
  EXPECT_EQ(run({"a.dat", "bad.dat", "-o", "out/", "--mask", "Cl"}, 2)["failed"], 2);
}

TEST_F(Batch, WhatCannotBeMeantIsSaidBeforeAnythingIsDone) {
  place.write("a.xyz", "1\n\nNa 0 0 0\n");
  expect_usage({"a.dat", "a.xyz", "-o", "out/"}, {"a.dat and a.xyz", "out/a.crb", "{file}"});
  expect_usage({"a.dat", "b.dat", "-o", "out.crb"}, {"out.crb", "out/", "{name}"});
  expect_usage({"a.dat", "b.dat", "-o", "{nmae}.crb"}, {"{nmae}", "{name}"});
  expect_usage({"a.dat", "b.dat", "-o", "{name}.png"}, {".crb"});
  expect_usage({"*.cfg", "-o", "{name}.crb"}, {"*.cfg"}, 2);
}

TEST_F(Batch, CtrlCEndsTheBatchWithItsTable) {
  ASSERT_EQ(place.run({"sample", "nacl-cracked", "--atoms", "300000", "-o", "large.dat"}).exit_code, 0);
  const Outcome outcome =
      place.run_interrupted({"preprocess", "large.dat", "b.dat", "-o", "out/", "--mesher", "delaunay"}, 1000);
  EXPECT_EQ(outcome.exit_code, 130) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("0 done, 0 skipped, 0 failed, 2 cancelled"), std::string::npos) << outcome.out;
  EXPECT_FALSE(place.exists("out/b.crb"));
}

TEST_F(Batch, WhatDoesNotFitIsSaidAndNotBegun) {
  ASSERT_EQ(place.run({"sample", "nacl-cracked", "--atoms", "400000", "-o", "large.dat"}).exit_code, 0);
#if defined(__SANITIZE_ADDRESS__)  // which holds so much more before anything is begun
  const char* const limit = "420";
#else
  const char* const limit = "220";
#endif
  const json batch = run({"a.dat", "large.dat", "-o", "out/", "--memory-limit", limit, "--mesher", "delaunay"}, 3);
  EXPECT_EQ(column(batch, "/status"), (Names{"done", "failed"}));
  const std::string error = batch["files"][1]["error"];
  for (const char* word : {"Delaunay", "400,000", " MB", "--keep-every", "--memory-limit"}) {
    EXPECT_NE(error.find(word), std::string::npos) << word << ": " << error;
  }
  expect_usage({"a.dat", "-o", "a.crb", "--memory-limit", "1"}, {"memory limit"});
}

}  // namespace
}  // namespace atomesh::testing
