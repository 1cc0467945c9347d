// Progress of a part of the work, inside that of the whole.
#include <gtest/gtest.h>

#include <vector>

#include "core/error.h"
#include "core/progress.h"

namespace atomesh {
namespace {

TEST(Progress, APartsFractionsAreThoseOfTheWhole) {
  std::vector<double> fractions;
  Progress whole([&](std::string_view stage, double fraction) {
    EXPECT_EQ(stage, "work");
    fractions.push_back(fraction);
  });
  whole.stage("work");
  for (const double begin : {0.0, 0.5}) {
    Progress part(whole, begin, begin + 0.5);
    part.stage("of the part");
    part.update(0.5);
    part.update(1.0);
  }
  EXPECT_EQ(fractions, (std::vector<double>{0.0, 0.25, 0.5, 0.75, 1.0}));
  EXPECT_EQ(whole.stage_name(), "work");
}

TEST(Progress, APartIsCancelledWithTheWholeByItselfAndByTheClock) {
  Progress whole;
  Progress part(whole, 0.0, 1.0);
  Progress other(whole, 0.0, 1.0);
  part.request_cancel();
  EXPECT_THROW(part.check(), CancelledError);
  EXPECT_NO_THROW(other.check());
  EXPECT_FALSE(whole.cancelled());
  const auto now = Progress::Clock::now();
  EXPECT_TRUE(Progress(whole, 0.0, 1.0, now).cancelled());
  EXPECT_FALSE(Progress(whole, 0.0, 1.0, now + std::chrono::hours(1)).cancelled());
  whole.request_cancel();
  EXPECT_THROW(other.check(), CancelledError);
  Progress of_part(other, 0.0, 1.0);
  EXPECT_THROW(of_part.update(0.5), CancelledError);
}

}  // namespace
}  // namespace atomesh
