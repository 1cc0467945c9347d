// How much is drawn while the view moves.
#include <gtest/gtest.h>

#include "app/gui/moving_detail.h"

namespace atomesh::gui {
namespace {

TEST(MovingDetail, IsAllWhereThereIsTime) {
  MovingDetail detail;
  detail.drew_whole({.cells = 10.0, .pixels = 20.0}, 1);
  EXPECT_EQ(detail.next(), Detail());
}

TEST(MovingDetail, IsLittleWhereNothingIsKnown) {
  MovingDetail detail;
  EXPECT_EQ(detail.next(), (Detail{.stride = 8}));
  detail.expect(10000.0, 1e6, false);
  EXPECT_EQ(detail.next(), (Detail{.stride = 8}));
  detail.expect(825000.0, 1e6, false);
  EXPECT_EQ(detail.next().stride, 8);
  EXPECT_NEAR(detail.next().cells, 0.1, 1e-12);
}

// Of another volume, or picture, each cell and each ray takes as long.
TEST(MovingDetail, IsExpectedOfOthersByWhatIsKnown) {
  MovingDetail detail;
  detail.expect(1e5, 1e6, false);
  detail.drew_whole({.cells = 5.0, .pixels = 10.0}, 1);
  EXPECT_EQ(detail.next(), Detail());
  detail.expect(2e5, 2e6, false);  // 10 and 20
  EXPECT_EQ(detail.next(), Detail());
  detail.expect(2e5, 8e6, false);  // 10 and 80
  EXPECT_EQ(detail.next(), (Detail{.stride = 2}));
  detail.expect(2e6, 1e5, false);  // 100 and 1
  EXPECT_EQ(detail.next().stride, 1);
  EXPECT_NEAR(detail.next().cells, 0.32, 1e-12);
  detail.expect(1e5, 1e6, true);
  EXPECT_EQ(detail.next(), Detail());
  detail.drew_whole({.cells = 5.0, .solids = 50.0, .pixels = 10.0}, 1);
  EXPECT_EQ(detail.next(), (Detail{.stride = 2}));
  detail.expect(1e5, 1e6, false);  // nothing in it any more
  EXPECT_EQ(detail.next(), Detail());
}

TEST(MovingDetail, IsLessWhereTheWholeWasGivenUp) {
  MovingDetail detail;
  detail.expect(1e5, 1e6, false);
  detail.drew_whole({.cells = 5.0, .pixels = 10.0}, 1);
  detail.gave_up_whole(66.0);
  EXPECT_EQ(detail.next(), (Detail{.stride = 4}));
}

TEST(MovingDetail, IsAsManyRaysAsThereIsTimeFor) {
  MovingDetail detail;
  detail.drew_whole({.cells = 10.0, .pixels = 80.0}, 1);
  EXPECT_EQ(detail.next().stride, 2);
  detail.drew_whole({.cells = 10.0, .pixels = 200.0}, 1);
  EXPECT_EQ(detail.next().stride, 4);
  detail.drew_whole({.cells = 10.0, .pixels = 4000.0}, 1);
  EXPECT_EQ(detail.next().stride, 8);
  // Of n × n rays a pixel one is drawn.
  detail.drew_whole({.cells = 10.0, .pixels = 800.0}, 4);
  EXPECT_EQ(detail.next().stride, 2);
}

TEST(MovingDetail, KnowsTheCellsTimeThoughTheViewWasThere) {
  MovingDetail detail;
  detail.drew_whole({.cells = 30.0, .pixels = 40.0}, 1);
  const Detail before = detail.next();
  EXPECT_NE(before, Detail());
  detail.drew_whole({.cells = 0.0, .pixels = 30.0}, 1);
  EXPECT_NE(detail.next(), Detail());
}

TEST(MovingDetail, IsFewerCellsWhereTheyTakeLong) {
  MovingDetail detail;
  detail.drew_whole({.cells = 10.0, .pixels = 80.0}, 1);
  EXPECT_EQ(detail.next().cells, 1.0);
  detail.drew_whole({.cells = 100.0, .pixels = 3.0}, 1);
  EXPECT_EQ(detail.next(), (Detail{.stride = 1, .cells = 0.3}));
  detail.drew_whole({.cells = 165.0, .pixels = 33.0}, 1);
  EXPECT_EQ(detail.next(), (Detail{.stride = 2, .cells = 0.1}));
}

TEST(MovingDetail, LeavesTimeForWhatStandsInTheVolume) {
  MovingDetail detail;
  detail.drew_whole({.cells = 10.0, .solids = 30.0, .pixels = 10.0}, 1);
  // Half of the budget is left for the others, 16.5 ms, of which the cells have 8.25.
  EXPECT_EQ(detail.next(), (Detail{.stride = 2, .cells = 0.825}));
  detail.drew_whole({.cells = 10.0, .solids = 300.0, .pixels = 10.0}, 1);
  EXPECT_EQ(detail.next(), (Detail{.stride = 2, .cells = 0.825}));
  // Solids that are kept are the same.
  detail.drew_whole({.cells = 0.0, .solids = 0.0, .pixels = 10.0}, 1);
  EXPECT_EQ(detail.next(), (Detail{.stride = 2, .cells = 0.825}));
  detail.drew_whole({.cells = 10.0, .solids = 13.0, .pixels = 9.0}, 1);
  EXPECT_EQ(detail.next(), Detail());
  detail.drew_whole({.cells = 2.0, .solids = 20.0, .pixels = 15.0}, 1);
  EXPECT_EQ(detail.next().stride, 2);
  detail.drew_moving({.cells = 2.0, .solids = 20.0, .pixels = 4.0}, detail.next());
  EXPECT_EQ(detail.next().stride, 2);
  detail.drew_moving({.cells = 2.0, .solids = 20.0, .pixels = 20.0}, detail.next());
  EXPECT_EQ(detail.next().stride, 4);
}

TEST(MovingDetail, FollowsWhatPicturesOnTheWayTake) {
  MovingDetail detail;
  const auto moved = [&](double cells, double pixels) {
    detail.drew_moving({.cells = cells, .pixels = pixels}, detail.next());
    return detail.next().stride;
  };
  detail.drew_whole({.cells = 10.0, .pixels = 4000.0}, 2);
  EXPECT_EQ(detail.next().stride, 8);
  EXPECT_EQ(moved(10.0, 5.0), 4);
  EXPECT_EQ(moved(10.0, 5.0), 2);
  EXPECT_EQ(moved(10.0, 2.0), 2);  // 16 times as many rays would take 32
  EXPECT_EQ(moved(10.0, 5.0), 2);
  EXPECT_EQ(moved(30.0, 5.0), 4);
  EXPECT_EQ(moved(30.0, 5.0), 8);
  EXPECT_EQ(moved(30.0, 5.0), 8);
  // A rest in between changes nothing.
  detail.drew_whole({.cells = 10.0, .pixels = 4000.0}, 2);
  EXPECT_EQ(detail.next().stride, 8);
  // Of other rays a pixel nothing of that holds.
  detail.drew_whole({.cells = 10.0, .pixels = 80.0}, 1);
  EXPECT_EQ(detail.next().stride, 2);
}

}  // namespace
}  // namespace atomesh::gui
