// Ctrl-C at any moment: the program ends soon, says so by its exit code, and leaves nothing half-written.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/app/program.h"

namespace atomesh::testing {
namespace {

TEST(Cancel, IsAnsweredSoonInEveryStage) {
  const Workplace place;
  ASSERT_EQ(place.run({"sample", "nacl-cracked", "--atoms", "100000", "-o", "a.dat"}).exit_code, 0);
  // From the program's first instructions to its last stages, the search for the cell and the simplification with its
  // pictures among them; once it is done there is nothing to cancel.
  std::vector<double> answers;
  for (const int delay_ms : {0, 2, 5, 10, 20, 40, 80, 120, 200, 300, 450, 600, 900, 1300}) {
    const Outcome outcome =
        place.run_interrupted({"preprocess", "a.dat", "-o", "a.crb", "--unit-cell", "found", "--simplify"}, delay_ms);
    if (outcome.exit_code == 0) {
      EXPECT_TRUE(place.exists("a.crb"));
      std::filesystem::remove(place.path("a.crb"));
      continue;
    }
    EXPECT_EQ(outcome.exit_code, 130) << "after " << delay_ms << " ms: " << outcome.err;
    EXPECT_EQ(place.files(), std::vector<std::string>{"a.dat"}) << "after " << delay_ms << " ms";
    answers.push_back(outcome.ms_after_signal);
  }
  ASSERT_GE(answers.size(), 10U);
  std::sort(answers.begin(), answers.end());
  // The promise is 200 ms; a machine that does other work besides may take a turn or two before ours, but not in most.
  EXPECT_LT(answers[answers.size() / 2], 200.0);
}

}  // namespace
}  // namespace atomesh::testing
