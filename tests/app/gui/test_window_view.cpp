// The view of the whole window under the mouse: turned, cut and picked in as a user does, in every mode.
#include <gtest/gtest.h>

#include <QMouseEvent>
#include <QSignalSpy>
#include <QTest>

#include "app/gui/cut_handle.h"
#include "app/gui/main_window.h"
#include "app/gui/overlay.h"
#include "app/gui/view_input.h"
#include "app/gui/viewport.h"
#include "render/scene.h"
#include "tests/app/gui/window_test.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;
using test::wait_for;

class WindowView : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!test::has_opengl()) GTEST_SKIP() << "no display with OpenGL";
    window = std::make_unique<MainWindow>();
    window->resize(1100, 760);
    test::show(*window);
    window->open(QString::fromStdString(test::cracked_salt_crb(folder.path().string())));
    ASSERT_TRUE(settled());
  }

  bool settled() {
    return wait_for([&] { return window->viewport().settled(); });
  }
  Workspace& workspace() { return window->workspace(); }
  void show_mode(Mode mode) {
    workspace().set("mode", std::string(mode_name(mode)));
    ASSERT_TRUE(settled());
  }
  void mouse(QEvent::Type type, const QPoint& at, Qt::MouseButton button, Qt::MouseButtons buttons,
             Qt::KeyboardModifiers keys = Qt::NoModifier) {
    Viewport& view = window->viewport();
    QMouseEvent event(type, at, view.mapToGlobal(at), button, buttons, keys);
    QApplication::sendEvent(&view, &event);
  }
  void drag(const QPoint& from, const QPoint& to, Qt::MouseButton button, Qt::KeyboardModifiers keys = Qt::NoModifier) {
    mouse(QEvent::MouseButtonPress, from, button, button, keys);
    for (int step = 1; step <= 10; ++step) {
      mouse(QEvent::MouseMove, from + (to - from) * step / 10, Qt::NoButton, button, keys);
    }
    mouse(QEvent::MouseButtonRelease, to, button, Qt::NoButton, keys);
  }
  void click(const QPoint& at, Qt::KeyboardModifiers keys = Qt::NoModifier) {
    auto* const input = window->viewport().findChild<ViewInput*>();
    ASSERT_NE(input, nullptr);
    QSignalSpy looked_up(input, &ViewInput::looked_up);
    mouse(QEvent::MouseButtonPress, at, Qt::LeftButton, Qt::LeftButton, keys);
    mouse(QEvent::MouseButtonRelease, at, Qt::LeftButton, Qt::NoButton, keys);
    ASSERT_TRUE(wait_for([&] { return !looked_up.isEmpty(); }));
  }
  QPoint place_of(const Vec3& point) {
    const CanvasPoint at = *canvas_point(workspace().camera(), point);
    const double ratio = window->viewport().devicePixelRatioF();
    return {static_cast<int>(std::floor(at.x / ratio)), static_cast<int>(std::floor(at.y / ratio))};
  }

  test::TemporaryFolder folder;
  std::unique_ptr<MainWindow> window;
};

// In every mode a click gives what pick() gives for a scene of its own; two of them a distance. Pixels of the picture
// change where the marks are.
TEST_F(WindowView, ClicksPickInEveryMode) {
  const QPoint middle = window->viewport().rect().center();
  const QPoint beside = middle + QPoint(24, 8);
  for (const Mode mode : {Mode::volume_surface, Mode::volume, Mode::surface, Mode::xray, Mode::atoms}) {
    show_mode(mode);
    workspace().clear_picks();
    const QImage before = window->viewport().screenshot();
    const Material material = read_material(workspace().document()->path);
    const Scene scene = make_scene(material, workspace().shown());
    const double ratio = window->viewport().devicePixelRatioF();
    const auto expected = [&](const QPoint& at) {
      return pick(material, scene, workspace().camera(), workspace().shown(), static_cast<int>(at.x() * ratio),
                  static_cast<int>(at.y() * ratio));
    };
    ASSERT_TRUE(expected(middle) && expected(beside)) << mode_name(mode);
    click(middle);
    click(beside, Qt::ShiftModifier);
    ASSERT_EQ(workspace().picks().size(), 2U) << mode_name(mode);
    EXPECT_EQ(workspace().picks()[0].atom, expected(middle)->atom) << mode_name(mode);
    EXPECT_EQ(workspace().picks()[1].atom, expected(beside)->atom) << mode_name(mode);
    ASSERT_TRUE(settled());
    const QImage after = window->viewport().screenshot();
    EXPECT_NE(before, after) << mode_name(mode);
    test::keep_screenshot(window->grab().toImage(), "picks-" + std::string(mode_name(mode)));
  }
}

TEST_F(WindowView, DragsTurnMoveAndCut) {
  show_mode(Mode::surface);
  const QPoint middle = window->viewport().rect().center();
  const Parameters before = workspace().parameters();
  const QImage picture = window->viewport().screenshot();
  drag(middle, middle + QPoint(80, 20), Qt::LeftButton);
  drag(middle, middle + QPoint(-30, 10), Qt::RightButton);
  drag(middle + QPoint(90, 0), middle + QPoint(60, -60), Qt::LeftButton, Qt::ControlModifier);
  EXPECT_LT(workspace().parameters().azimuth, before.azimuth);
  EXPECT_GT(workspace().parameters().roll, 0.0);
  ASSERT_TRUE(settled());
  EXPECT_NE(window->viewport().screenshot(), picture);
  for (int step = 0; step < 3; ++step) workspace().undo();
  EXPECT_EQ(workspace().parameters(), before);
  ASSERT_TRUE(settled());
  EXPECT_EQ(window->viewport().screenshot(), picture);

  // A cut plane through the middle, dragged by its arrow.
  Parameters cut = before;
  cut.cut_planes[0] = {true, Vec3(0, 0, 1), CutPlane::Side::less_equal, workspace().bounds().center().z};
  workspace().change(cut, "Cut");
  ASSERT_TRUE(settled());
  const CutHandle handle = cut_handles(workspace().shown(), workspace().bounds(), workspace().camera()).at(0);
  const Vec3 grip = 0.5 * (handle.foot + handle.tip);
  test::keep_screenshot(window->grab().toImage(), "cut-before");
  drag(place_of(grip), place_of(grip + Vec3(0, 0, 5.0)), Qt::LeftButton);
  const double pixel = workspace().camera().pixel * glm::length(grip - workspace().camera().eye);
  EXPECT_NEAR(workspace().parameters().cut_planes[0].distance, cut.cut_planes[0].distance + 5.0, 2.0 * pixel);
  ASSERT_TRUE(settled());
  test::keep_screenshot(window->grab().toImage(), "cut-after");
  EXPECT_EQ(workspace().history().undo_name(), "Move cut plane 1");
}

}  // namespace
