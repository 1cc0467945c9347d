// A small diamond with vacancies, made once for all tests of a binary by the program itself.
#pragma once

#include <gtest/gtest.h>

#include "app/gui/document.h"
#include "core/progress.h"
#include "tests/app/program.h"

namespace atomesh::gui {

// The folder holds d.dat and d.crb.
class DiamondTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    place = std::make_unique<testing::Workplace>();
    place->run({"sample", "diamond-vacancy", "--atoms", "4000", "-o", "d.dat"});
    preprocessed = place->run({"preprocess", "d.dat", "-o", "d.crb"});
  }
  static void TearDownTestSuite() { place.reset(); }
  void SetUp() override { ASSERT_EQ(preprocessed.exit_code, 0) << preprocessed.err; }

  static std::string path(const std::string& name) { return place->path(name).string(); }
  static Document open(const std::string& name = "d.crb") { return open_document(path(name), {}, no_progress()); }
  static void cli(const std::vector<std::string>& arguments) {
    const testing::Outcome outcome = place->run(arguments);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }

  static inline std::unique_ptr<testing::Workplace> place;
  static inline testing::Outcome preprocessed;
};

}  // namespace atomesh::gui
