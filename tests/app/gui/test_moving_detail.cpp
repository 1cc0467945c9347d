// How much is drawn while the view moves.
#include <gtest/gtest.h>

#include "app/gui/moving_detail.h"

namespace atomesh::gui {
namespace {

TEST(MovingDetail, IsAllWhereThereIsTime) {
  MovingDetail detail;
  EXPECT_EQ(detail.next(), gl::PictureDetail());  // nothing known
  detail.drew_whole({.cells = 10.0, .pixels = 20.0}, 1);
  EXPECT_EQ(detail.next(), gl::PictureDetail());
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
  detail.forget();
  EXPECT_EQ(detail.next(), gl::PictureDetail());
}

TEST(MovingDetail, KnowsTheCellsTimeThoughTheViewWasThere) {
  MovingDetail detail;
  detail.drew_whole({.cells = 30.0, .pixels = 40.0}, 1);
  const gl::PictureDetail before = detail.next();
  EXPECT_NE(before, gl::PictureDetail());
  detail.drew_whole({.cells = 0.0, .pixels = 30.0}, 1);
  EXPECT_NE(detail.next(), gl::PictureDetail());
}

TEST(MovingDetail, DoesNotSaveOnPixelsWhatCellsTake) {
  MovingDetail detail;
  detail.drew_whole({.cells = 500.0, .pixels = 30.0}, 1);
  EXPECT_EQ(detail.next().stride, 2);
}

}  // namespace
}  // namespace atomesh::gui
