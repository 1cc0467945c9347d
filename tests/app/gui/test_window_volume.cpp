// Volumes in the window by the graphics card (here mostly: by OpenGL in software): the pictures of the renderers,
// beside surface and balls in the same context.
#include <epoxy/gl.h>  // before Qt's
#include <gtest/gtest.h>

#include <QLabel>
#include <QPainter>
#include <QSignalSpy>
#include <QTest>
#include <algorithm>
#include <map>
#include <vector>

#include "app/gui/card_view.h"
#include "app/gui/view_input.h"
#include "tests/app/gui/window_volume_fixture.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;
using test::child;
using test::wait_for;
using test::WindowVolume;

TEST_F(WindowVolume, IsTheRenderersPicture) {
  draw_with(ViewOptions::Drawing::gpu);
  choose(Mode::volume);
  ASSERT_TRUE(settled());
  ASSERT_TRUE(window->viewport().drawn_by_gpu());
  EXPECT_TRUE(log.contains("The graphics card draws the volume")) << log.toStdString();
  watch_card();
  for (const char* projection : {"parallel", "perspective"}) {
    for (const char* rays : {"1", "2"}) {
      workspace().set("view.projection", projection);
      workspace().set("quality.supersampling", rays);
      ASSERT_TRUE(settled());
      ASSERT_TRUE(window->viewport().drawn_by_gpu()) << log.toStdString();
      const Image image = screen();
      test::keep_screenshot(window->viewport().screenshot(), std::string("volume-") + projection + rays);
      const Image havs = rendered("havs");
      // To the rounding of a byte.
      EXPECT_LE(compare_images(image, havs).max, 0.51 / 255.0) << projection << rays;
      EXPECT_LE(compare_images(image, rendered("cpu")).max, 4.0 / 255.0) << projection << rays;
      Image nothing(image.width, image.height);
      std::fill(nothing.pixels.begin(), nothing.pixels.end(), workspace().shown().background);
      EXPECT_GT(compare_images(image, nothing).rmse, 0.01);
    }
  }
}

TEST_F(WindowVolume, TakesTurnsWithSurfaceAndBalls) {
  draw_with(ViewOptions::Drawing::gpu);
  std::map<Mode, Image> first;
  for (int round = 0; round < 3; ++round) {
    for (const Mode mode : {Mode::surface, Mode::volume, Mode::atoms, Mode::volume}) {
      choose(mode);
      ASSERT_TRUE(settled()) << mode_name(mode);
      ASSERT_TRUE(window->viewport().drawn_by_gpu()) << mode_name(mode) << log.toStdString();
      watch_card();
      const Image image = screen();
      const auto [known, is_new] = first.try_emplace(mode, image);
      if (!is_new) {
        EXPECT_EQ(compare_images(image, known->second).max, 0.0) << mode_name(mode) << " in round " << round;
      }
    }
  }
}

TEST_F(WindowVolume, IsWholeAgainAtRest) {
  draw_with(ViewOptions::Drawing::gpu);
  choose(Mode::volume);
  workspace().set("quality.supersampling", "4");  // takes long
  ASSERT_TRUE(settled());
  QSignalSpy painted(&card(), SIGNAL(painted(double, bool)));
  QSignalSpy rests(&window->viewport(), &Viewport::became_settled);
  workspace().set("view.azimuth", "31");
  EXPECT_FALSE(window->viewport().settled());
  ASSERT_TRUE(wait_for([&] { return !painted.isEmpty(); }));
  if (painted[0][1].toBool() && !gpu_of_this_machine().software) GTEST_SKIP() << "this card is too fast for it";
  EXPECT_FALSE(painted[0][1].toBool()) << "was quick: " << painted[0][0].toDouble() << " ms";
  EXPECT_FALSE(window->viewport().settled());
  ASSERT_TRUE(settled());
  EXPECT_EQ(rests.size(), 1);
  EXPECT_TRUE(painted.last()[1].toBool());
  EXPECT_LT(painted[0][0].toDouble(), painted.last()[0].toDouble());
  EXPECT_LE(compare_images(screen(), rendered("havs")).max, 0.51 / 255.0);
}

// The whole picture is drawn in slices; what happens in between is heeded.
TEST_F(WindowVolume, IsRefinedAndStartsOverWhenItChanges) {
  draw_with(ViewOptions::Drawing::gpu);
  choose(Mode::volume);
  workspace().set("quality.supersampling", "4");  // takes long
  ASSERT_TRUE(settled());
  const auto& frame = child<QLabel>(*window, "frame");
  EXPECT_FALSE(frame.text().contains("of 2")) << frame.text().toStdString();
  QSignalSpy refining(&window->viewport(), &Viewport::refining);
  const auto refined = [&](double fraction) {
    return wait_for([&] { return !refining.isEmpty() && refining.last()[0].toDouble() > fraction; });
  };
  workspace().set("view.azimuth", "31");
  if (!refined(0.1) && !gpu_of_this_machine().software) GTEST_SKIP() << "this card is too fast for it";
  ASSERT_FALSE(refining.isEmpty());
  EXPECT_TRUE(frame.text().contains(", picture 1 of 2 (")) << frame.text().toStdString();
  EXPECT_FALSE(window->viewport().settled());
  test::keep_screenshot(window->grab().toImage(), "volume-refining");
  // Another view: little of it at first.
  QSignalSpy painted(&card(), SIGNAL(painted(double, bool)));
  workspace().set("view.azimuth", "32");
  ASSERT_TRUE(wait_for([&] { return !painted.isEmpty(); }));
  EXPECT_FALSE(painted[0][1].toBool());
  refining.clear();
  ASSERT_TRUE(refined(0.2));
  // What lies over it is another, and nothing starts over.
  const double reached = refining.last()[0].toDouble();
  ViewOptions options = workspace().view_options();
  options.scale_bar = true;
  workspace().set_view_options(options);
  painted.clear();
  refining.clear();
  ASSERT_TRUE(wait_for([&] { return !painted.isEmpty() && !refining.isEmpty(); }));
  EXPECT_FALSE(painted[0][1].toBool());
  EXPECT_GE(refining[0][0].toDouble(), reached);
  options.scale_bar = false;
  workspace().set_view_options(options);
  // Away and back: it goes on with the same picture.
  choose(Mode::xray);
  ASSERT_TRUE(settled());
  choose(Mode::volume);
  ASSERT_TRUE(settled());
  EXPECT_TRUE(painted.last()[1].toBool());
  EXPECT_FALSE(frame.text().contains("of 2")) << frame.text().toStdString();
  EXPECT_LE(compare_images(screen(), rendered("havs")).max, 0.51 / 255.0);
}

// Of many cells.
TEST_F(WindowVolume, IsOfFewerCellsWhileItMoves) {
  Material material = test::box_material(36, 36, 36, 2.0, test::shaking(0.3, 5));
  test::add_defects(material, 3);
  const std::string path = folder.path() / "box.crb";
  write_material(path, material);
  draw_with(ViewOptions::Drawing::gpu);
  choose(Mode::volume);
  window->open(QString::fromStdString(path));
  ASSERT_TRUE(wait_for([&] { return workspace().document()->path == path && window->viewport().settled(); }));
  ASSERT_TRUE(window->viewport().drawn_by_gpu());
  test::keep_screenshot(window->viewport().screenshot(), "volume-rests");
  const auto& view = child<CardView>(*window, "card_view");
  std::vector<Detail> details;
  std::vector<double> times;
  QObject::connect(&view, &CardView::painted, window.get(), [&](double ms, bool whole) {
    details.push_back(view.detail());
    times.push_back(ms);
    EXPECT_EQ(whole, view.detail().whole());
  });
  for (const char* azimuth : {"31", "32", "33", "34", "35", "36"}) {
    const std::size_t before = details.size();
    workspace().set("view.azimuth", azimuth);
    ASSERT_TRUE(wait_for([&] { return details.size() > before; }));
  }
  if (details.front().whole() && !gpu_of_this_machine().software) GTEST_SKIP() << "this card is too fast for it";
  ASSERT_FALSE(details.front().whole()) << "was quick: " << times.front() << " ms";
  EXPECT_LT(details.front().cells, 1.0);
  test::keep_screenshot(window->viewport().screenshot(), "volume-moves");
  ASSERT_TRUE(settled());
  test::keep_screenshot(window->viewport().screenshot(), "volume-rests-again");
  EXPECT_TRUE(details.back().whole());
  EXPECT_LT(times[1], times.back());
  for (std::size_t i = 0; i < times.size(); ++i) {
    RecordProperty("frame " + std::to_string(i), std::to_string(details[i].stride) + ' ' +
                                                     std::to_string(details[i].cells) + ' ' + std::to_string(times[i]));
  }
  EXPECT_LE(compare_images(screen(), rendered("havs")).max, 0.51 / 255.0);
}

TEST_F(WindowVolume, IsPickedAsThatOfTheProcessor) {
  std::vector<Pick> picks;
  for (const auto who : {ViewOptions::Drawing::gpu, ViewOptions::Drawing::cpu}) {
    draw_with(who);
    choose(Mode::volume);
    ASSERT_TRUE(settled());
    workspace().clear_picks();
    QSignalSpy looked_up(&window->viewport().input(), &ViewInput::looked_up);
    QTest::mouseClick(&window->viewport(), Qt::LeftButton, Qt::NoModifier, window->viewport().rect().center());
    ASSERT_TRUE(wait_for([&] { return !looked_up.isEmpty(); }));
    ASSERT_EQ(workspace().picks().size(), 1U);
    picks.push_back(workspace().picks().front());
  }
  EXPECT_EQ(picks[0].position, picks[1].position);
}

TEST_F(WindowVolume, HasInItWhatTheRenderersHave) {
  draw_with(ViewOptions::Drawing::gpu);
  choose(Mode::volume);
  ASSERT_TRUE(settled());
  watch_card();
  const Image nothing_in_it = screen();
  for (const char* solid : {"walls", "atoms", "defects"}) {
    workspace().set("volume.solid", solid);
    for (const char* projection : {"perspective", "parallel"}) {
      workspace().set("view.projection", projection);
      ASSERT_TRUE(settled());
      ASSERT_TRUE(window->viewport().drawn_by_gpu()) << log.toStdString();
      const Image image = screen();
      test::keep_screenshot(window->viewport().screenshot(), std::string("volume-with-") + solid + '-' + projection);
      EXPECT_LE(compare_images(image, rendered("havs")).max, 0.51 / 255.0) << solid << projection;
      EXPECT_LE(compare_images(image, rendered("cpu")).max, 4.0 / 255.0) << solid << projection;
      EXPECT_GT(compare_images(image, nothing_in_it).rmse, 0.005) << solid << projection;
    }
    // With another map.
    workspace().set("volume.alpha_length", "1");
    ASSERT_TRUE(settled());
    EXPECT_LE(compare_images(screen(), rendered("havs")).max, 0.51 / 255.0) << solid;
    workspace().set("volume.alpha_length", "4");
  }
  EXPECT_FALSE(log.contains("The processor draws the volume")) << log.toStdString();
  workspace().set("volume.solid", "none");
  workspace().reset("view.projection");
  ASSERT_TRUE(settled());
  EXPECT_EQ(compare_images(screen(), nothing_in_it).max, 0.0);
}

// The card lays over its picture what Qt would.
TEST_F(WindowVolume, HasTheOverlayOverIt) {
  draw_with(ViewOptions::Drawing::gpu);
  workspace().set("background", "0.2,0.4,0.6,0.5");
  for (const Mode mode : {Mode::volume, Mode::surface}) {
    draw_with(ViewOptions::Drawing::gpu);
    choose(mode);
    ASSERT_TRUE(settled());
    QImage expected = window->viewport().screenshot();
    const Image bare = test::to_image(expected);
    ViewOptions options = workspace().view_options();
    options.legend = options.tripod = options.scale_bar = true;
    workspace().set_view_options(options);
    ASSERT_TRUE(settled());
    ASSERT_TRUE(window->viewport().drawn_by_gpu());
    const QImage& overlay = child<CardView>(*window, "card_view").overlay();
    ASSERT_EQ(overlay.size(), expected.size());
    QPainter(&expected).drawImage(0, 0, overlay);
    const Image shown = screen();
    EXPECT_GT(compare_images(shown, bare).max, 0.5) << mode_name(mode);
    EXPECT_LE(compare_images(shown, test::to_image(expected)).max, 1.01 / 255.0) << mode_name(mode);
  }
}

TEST_F(WindowVolume, IsTheProcessorsWhereOpenGlIsSoftwareAndNobodySaysOtherwise) {
  draw_with(ViewOptions::Drawing::automatic);
  choose(Mode::volume);
  ASSERT_TRUE(settled());
  EXPECT_EQ(window->viewport().drawn_by_gpu(), !gpu_of_this_machine().software);
  if (gpu_of_this_machine().software) {
    EXPECT_TRUE(log.contains("in software")) << log.toStdString();
  }
}

}  // namespace
