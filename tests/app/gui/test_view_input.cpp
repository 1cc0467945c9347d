// Mouse, wheel and keys on a plain widget: what they do to the workspace.
#include <gtest/gtest.h>

#include <QApplication>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QSignalSpy>
#include <QWheelEvent>
#include <cmath>

#include "app/gui/navigation.h"
#include "app/gui/overlay.h"
#include "app/gui/view_input.h"
#include "tests/app/gui/window_test.h"
#include "tests/render/fixtures.h"
#include "tests/support/temporary_folder.h"

namespace atomesh::gui {
namespace {

constexpr int width = 400;  // of the widget; the view has twice as many device pixels
constexpr int height = 300;
constexpr double ratio = 2.0;

Document document_of(Material material) {
  Document document;
  document.path = "box";
  document.kind = FileKind::mesh;
  document.material = std::make_shared<const Material>(std::move(material));
  return document;
}

class ViewInputTest : public testing::Test {
 protected:
  ViewInputTest() : input_(workspace_, view_) {
    view_.resize(width, height);
    workspace_.set_view_size(static_cast<int>(ratio * width), static_cast<int>(ratio * height));
    Parameters parameters;
    parameters.mode = Mode::atoms;
    parameters.projection = Projection::parallel;
    workspace_.show_document(document_of(test::box_material(4, 4, 4, 3.0)), parameters);
  }

  void mouse(QEvent::Type type, const QPointF& at, Qt::MouseButton button, Qt::MouseButtons buttons,
             Qt::KeyboardModifiers keys = Qt::NoModifier) {
    QMouseEvent event(type, at, view_.mapToGlobal(at), button, buttons, keys);
    QApplication::sendEvent(&view_, &event);
  }
  void press(const QPointF& at, Qt::MouseButton button = Qt::LeftButton, Qt::KeyboardModifiers keys = Qt::NoModifier) {
    mouse(QEvent::MouseButtonPress, at, button, button, keys);
  }
  void move(const QPointF& at, Qt::MouseButton button = Qt::LeftButton, Qt::KeyboardModifiers keys = Qt::NoModifier) {
    mouse(QEvent::MouseMove, at, Qt::NoButton, button, keys);
  }
  void release(const QPointF& at, Qt::MouseButton button = Qt::LeftButton,
               Qt::KeyboardModifiers keys = Qt::NoModifier) {
    mouse(QEvent::MouseButtonRelease, at, button, Qt::NoButton, keys);
  }
  void drag(const QPointF& from, const QPointF& to, Qt::MouseButton button = Qt::LeftButton,
            Qt::KeyboardModifiers keys = Qt::NoModifier) {
    press(from, button, keys);
    for (int step = 1; step <= 8; ++step) move(from + (to - from) * step / 8.0, button, keys);
    release(to, button, keys);
  }
  void click(const QPointF& at, Qt::KeyboardModifiers keys = Qt::NoModifier) {
    QSignalSpy looked_up(&input_, &ViewInput::looked_up);
    press(at, Qt::LeftButton, keys);
    release(at, Qt::LeftButton, keys);
    ASSERT_TRUE(test::wait_for([&] { return !looked_up.isEmpty(); }));
  }
  void double_click(const QPointF& at) {
    QSignalSpy looked_up(&input_, &ViewInput::looked_up);
    press(at);
    release(at);
    mouse(QEvent::MouseButtonDblClick, at, Qt::LeftButton, Qt::LeftButton);
    release(at);
    ASSERT_TRUE(test::wait_for([&] { return !looked_up.isEmpty(); }));
  }
  void wheel(const QPointF& at, int delta) {
    QWheelEvent event(at, view_.mapToGlobal(at), QPoint(), QPoint(0, delta), Qt::NoButton, Qt::NoModifier,
                      Qt::NoScrollPhase, false);
    QApplication::sendEvent(&view_, &event);
  }
  bool key(int code, Qt::KeyboardModifiers keys = Qt::NoModifier) {
    QKeyEvent event(QEvent::KeyPress, code, keys);
    QApplication::sendEvent(&view_, &event);
    // A plain widget leaves keys to others; what was taken is not left.
    return event.isAccepted();
  }

  // Where the widget shows a point of the sample.
  QPointF place_of(const Vec3& point) {
    const CanvasPoint at = *canvas_point(workspace_.camera(), point);
    return QPointF(at.x, at.y) / ratio;
  }
  const Parameters& now() { return workspace_.parameters(); }
  // What the drags of one step from `from` to `to` add up to, as the view's functions have it.
  Parameters expected(const std::function<void(Parameters&, const QPointF&)>& step, const QPointF& from,
                      const QPointF& to) {
    Parameters parameters = now();
    for (int n = 0; n < 8; ++n) step(parameters, (to - from) / 8.0);
    return parameters;
  }
  void expect_view(const Parameters& a, const Parameters& b) {
    EXPECT_NEAR(a.azimuth, b.azimuth, 1e-9);
    EXPECT_NEAR(a.elevation, b.elevation, 1e-9);
    EXPECT_NEAR(a.roll, b.roll, 1e-9);
    EXPECT_NEAR(a.zoom, b.zoom, 1e-9 * b.zoom);
    EXPECT_NEAR(glm::length(a.pan - b.pan), 0.0, 1e-9);
  }

  Workspace workspace_;
  QWidget view_;
  ViewInput input_;
  const QPointF from_{120, 100};
  const QPointF to_{200, 160};
};

TEST_F(ViewInputTest, LeftDragTurnsTheView) {
  const Parameters before = now();
  for (const bool upright : {true, false}) {
    workspace_.set_view_options({.upright = upright});
    const Parameters turned = expected(
        [&](Parameters& p, const QPointF& way) {
          rotate_view(p, workspace_.bounds(), workspace_.rotation_center(), way.x() / height, way.y() / height,
                      upright);
        },
        from_, to_);
    drag(from_, to_);
    expect_view(now(), turned);
    EXPECT_NE(now(), before);
    // All of it is one step.
    EXPECT_EQ(workspace_.history().undo_name(), "Turn the view");
    workspace_.undo();
    EXPECT_EQ(now(), before);
    EXPECT_FALSE(workspace_.history().can_undo());
  }
}

TEST_F(ViewInputTest, TwoDragsAreTwoSteps) {
  drag(from_, to_);
  const Parameters between = now();
  drag(from_, to_);
  workspace_.undo();
  EXPECT_EQ(now(), between);
  EXPECT_TRUE(workspace_.history().can_undo());
}

TEST_F(ViewInputTest, ControlLeftDragTurnsThePicture) {
  // A quarter round the middle, from the right of it to above it: counter-clockwise.
  const QPointF middle = place_of(workspace_.rotation_center());
  press(middle + QPointF(100, 0), Qt::LeftButton, Qt::ControlModifier);
  for (int step = 1; step <= 10; ++step) {
    const double angle = step * std::numbers::pi / 20.0;
    move(middle + 100.0 * QPointF(std::cos(angle), -std::sin(angle)), Qt::LeftButton, Qt::ControlModifier);
  }
  release(middle + QPointF(0, -100), Qt::LeftButton, Qt::ControlModifier);
  EXPECT_NEAR(now().roll, 90.0, 1e-9);
  EXPECT_EQ(now().azimuth, 30.0);
}

TEST_F(ViewInputTest, OtherButtonsMoveTheSample) {
  const std::array<std::pair<Qt::MouseButton, Qt::KeyboardModifiers>, 3> ways{
      {{Qt::RightButton, Qt::NoModifier}, {Qt::MiddleButton, Qt::NoModifier}, {Qt::LeftButton, Qt::AltModifier}}};
  for (const auto& [button, keys] : ways) {
    const QPointF before = place_of(workspace_.rotation_center());
    drag(from_, to_, button, keys);
    const QPointF moved = place_of(workspace_.rotation_center()) - before - (to_ - from_);
    EXPECT_NEAR(std::hypot(moved.x(), moved.y()), 0.0, 1e-9);
    EXPECT_EQ(workspace_.history().undo_name(), "Move the view");
    workspace_.undo();
  }
}

TEST_F(ViewInputTest, ShiftLeftDragZooms) {
  drag({200, 200}, {200, 200 - height / 4.0}, Qt::LeftButton, Qt::ShiftModifier);
  EXPECT_NEAR(now().zoom, 2.0, 1e-9);  // 16 for a whole side
  drag({200, 100}, {200, 100 + height / 2.0}, Qt::LeftButton, Qt::ShiftModifier);
  EXPECT_NEAR(now().zoom, 0.5, 1e-9);
}

TEST_F(ViewInputTest, TheWheelZoomsAboutTheMouse) {
  const Parameters before = now();
  const Vec3 corner = workspace_.bounds().max;
  const QPointF at = place_of(corner);
  for (int n = 0; n < 3; ++n) wheel(at, 120);
  EXPECT_NEAR(now().zoom, std::pow(1.2, 3.0), 1e-12);
  const QPointF moved = place_of(corner) - at;
  EXPECT_NEAR(std::hypot(moved.x(), moved.y()), 0.0, 1e-9);
  const auto* rest = input_.findChild<QTimer*>();
  EXPECT_TRUE(rest->isActive());
  ASSERT_TRUE(test::wait_for([&] { return !rest->isActive(); }));
  wheel(at, -60);
  EXPECT_NEAR(now().zoom, std::pow(1.2, 2.5), 1e-12);
  // The turns that followed one another at once are one step, the one after the rest another.
  workspace_.undo();
  EXPECT_NEAR(now().zoom, std::pow(1.2, 3.0), 1e-12);
  workspace_.undo();
  EXPECT_EQ(now(), before);
}

TEST_F(ViewInputTest, KeysDoWhatTheMouseDoes) {
  const Parameters before = now();
  EXPECT_TRUE(key(Qt::Key_Right));
  EXPECT_NEAR(now().azimuth, before.azimuth - 5.0, 1e-9);
  EXPECT_TRUE(key(Qt::Key_Down));
  EXPECT_NEAR(now().elevation, before.elevation + 5.0, 1e-9);
  EXPECT_TRUE(key(Qt::Key_Left));
  EXPECT_TRUE(key(Qt::Key_Up));
  expect_view(now(), before);
  const QPointF center = place_of(workspace_.rotation_center());
  EXPECT_TRUE(key(Qt::Key_Right, Qt::ShiftModifier));
  EXPECT_NEAR(place_of(workspace_.rotation_center()).x(), center.x() + 0.05 * height, 1e-9);
  EXPECT_TRUE(key(Qt::Key_Up, Qt::ShiftModifier));
  EXPECT_NEAR(place_of(workspace_.rotation_center()).y(), center.y() - 0.05 * height, 1e-9);
  EXPECT_TRUE(key(Qt::Key_Left, Qt::ControlModifier));
  EXPECT_NEAR(now().roll, 5.0, 1e-9);
  for (const int code : {Qt::Key_PageUp, Qt::Key_Plus}) {
    EXPECT_TRUE(key(code));
    EXPECT_NEAR(now().zoom, 1.2, 1e-9);
    EXPECT_TRUE(key(code == Qt::Key_Plus ? Qt::Key_Minus : Qt::Key_PageDown));
    EXPECT_NEAR(now().zoom, 1.0, 1e-9);
  }
  EXPECT_TRUE(key(Qt::Key_Up, Qt::ControlModifier));
  EXPECT_NEAR(now().zoom, 1.2, 1e-9);
  // Other people's keys.
  for (const int code : {Qt::Key_F, Qt::Key_D, Qt::Key_R, Qt::Key_Tab, Qt::Key_Escape}) EXPECT_FALSE(key(code));
  EXPECT_FALSE(key(Qt::Key_Left, Qt::AltModifier));
}

TEST_F(ViewInputTest, ClicksPickAndMeasure) {
  const Parameters before = now();
  const std::vector<Vec3>& atoms = workspace_.document()->material->atoms.positions;
  // The nearest to the viewer, and another on its side.
  const Vec3 forward = workspace_.camera().forward;
  Index nearest = 0;
  for (Index a = 0; a < atoms.size(); ++a) {
    if (glm::dot(atoms[a], forward) < glm::dot(atoms[nearest], forward)) nearest = a;
  }
  QSignalSpy changed(&workspace_, &Workspace::picks_changed);
  click(place_of(atoms[nearest]));
  ASSERT_EQ(workspace_.picks().size(), 1U);
  EXPECT_EQ(workspace_.picks()[0].atom, nearest);
  EXPECT_EQ(workspace_.picks()[0].neighbours.size(), 3U);
  const Index other = nearest == 0 ? 1 : nearest - 1;
  click(place_of(atoms[other]), Qt::ShiftModifier);
  ASSERT_EQ(workspace_.picks().size(), 2U);
  EXPECT_EQ(workspace_.picks()[1].atom, other);
  // Nothing there: a second pick that is none leaves the two, a first clears them.
  click({2, 2}, Qt::ControlModifier);
  EXPECT_EQ(workspace_.picks().size(), 2U);
  click({2, 2});
  EXPECT_TRUE(workspace_.picks().empty());
  // A hand that shakes still clicks.
  QSignalSpy looked_up(&input_, &ViewInput::looked_up);
  const QPointF at = place_of(atoms[nearest]);
  press(at);
  move(at + QPointF(1, 1));
  release(at + QPointF(1, 1));
  ASSERT_TRUE(test::wait_for([&] { return !looked_up.isEmpty(); }));
  EXPECT_EQ(workspace_.picks().size(), 1U);
  EXPECT_TRUE(key(Qt::Key_Escape));
  EXPECT_TRUE(workspace_.picks().empty());
  EXPECT_EQ(now(), before);
  EXPECT_FALSE(workspace_.history().can_undo());
}

TEST_F(ViewInputTest, DragsAreNoClicks) {
  QSignalSpy looked_up(&input_, &ViewInput::looked_up);
  drag(from_, to_);
  drag(from_, to_, Qt::RightButton);
  press(from_, Qt::RightButton);
  release(from_, Qt::RightButton);
  click(from_);  // look-ups end in the order of the clicks
  EXPECT_EQ(looked_up.size(), 1);
}

TEST_F(ViewInputTest, DoubleClickSetsTheRotationCenter) {
  const std::vector<Vec3>& atoms = workspace_.document()->material->atoms.positions;
  const Vec3 forward = workspace_.camera().forward;
  const Vec3 nearest = *std::min_element(atoms.begin(), atoms.end(), [&](const Vec3& a, const Vec3& b) {
    return glm::dot(a, forward) < glm::dot(b, forward);
  });
  const Parameters before = now();
  double_click(place_of(nearest));
  EXPECT_EQ(workspace_.rotation_center(), nearest);
  EXPECT_EQ(now(), before);  // the picture is as it was
  ASSERT_EQ(workspace_.picks().size(), 1U);
  // Turning leaves it where it is.
  const QPointF at = place_of(nearest);
  drag(from_, to_);
  const QPointF moved = place_of(nearest) - at;
  EXPECT_NEAR(std::hypot(moved.x(), moved.y()), 0.0, 1e-6);
  double_click({2, 2});
  EXPECT_EQ(workspace_.rotation_center(), workspace_.bounds().center());
  EXPECT_TRUE(workspace_.picks().empty());
}

TEST_F(ViewInputTest, HandlesOfCutPlanesAreDragged) {
  Parameters cut = now();
  cut.cut_planes[1] = {true, Vec3(0, 0, 1), CutPlane::Side::less_equal, 7.0};
  workspace_.change(cut, "Cut");
  const CutHandle handle = cut_handles(cut, workspace_.bounds(), workspace_.camera()).at(0);
  const Vec3 grip = 0.5 * (handle.foot + handle.tip);
  const QPointF at = place_of(grip);
  QSignalSpy hot(&input_, &ViewInput::hot_plane_changed);
  mouse(QEvent::MouseMove, at, Qt::NoButton, Qt::NoButton);
  EXPECT_EQ(input_.hot_plane(), 1U);
  EXPECT_EQ(view_.cursor().shape(), Qt::OpenHandCursor);
  drag(at, place_of(grip + Vec3(0, 0, 2.0)));
  EXPECT_NEAR(now().cut_planes[1].distance, 9.0, 0.51e-3);
  EXPECT_EQ(now().azimuth, cut.azimuth);
  EXPECT_EQ(workspace_.history().undo_name(), "Move cut plane 2");
  workspace_.undo();
  EXPECT_EQ(now(), cut);
  drag(at, at + QPointF(15, 0), Qt::LeftButton, Qt::ControlModifier);
  EXPECT_NE(now().cut_planes[1].normal, cut.cut_planes[1].normal);
  EXPECT_EQ(now().roll, cut.roll);
  EXPECT_EQ(workspace_.history().undo_name(), "Tilt cut plane 2");
  workspace_.undo();
  EXPECT_EQ(now(), cut);
  mouse(QEvent::MouseMove, {2, 2}, Qt::NoButton, Qt::NoButton);
  EXPECT_FALSE(input_.hot_plane());
  EXPECT_EQ(hot.size(), 2);
  // Hidden, they are in nobody's way.
  workspace_.set_view_options({.cut_handles = false});
  drag(at, place_of(grip + Vec3(0, 0, 2.0)));
  EXPECT_EQ(now().cut_planes[1], cut.cut_planes[1]);
  EXPECT_NE(now().elevation, cut.elevation);
}

TEST_F(ViewInputTest, EscapeGivesUpADrag) {
  const Parameters before = now();
  press(from_);
  move(to_);
  EXPECT_NE(now(), before);
  EXPECT_TRUE(key(Qt::Key_Escape));
  EXPECT_EQ(now(), before);
  move(from_);
  release(from_);
  EXPECT_EQ(now(), before);
  EXPECT_FALSE(workspace_.history().can_undo());
}

TEST_F(ViewInputTest, WithoutADocumentNothingHappens) {
  workspace_.close_document();
  const Parameters before = now();
  drag(from_, to_);
  wheel(from_, 120);
  EXPECT_FALSE(key(Qt::Key_Left));
  EXPECT_EQ(now(), before);
}

// What the view shows is what is looked at, as long as it is what the workspace shows.
TEST_F(ViewInputTest, ThePickIsOfTheScenesSource) {
  const QPointF middle = place_of(workspace_.bounds().center());
  auto picture = std::make_shared<WorkerPicture>();
  picture->material = workspace_.document()->material;
  picture->parameters = workspace_.shown();
  Scene scene = make_scene(*picture->material, picture->parameters);
  scene.balls.clear();
  picture->scene = std::make_shared<const Scene>(std::move(scene));
  input_.set_scene_source([picture] { return picture; });
  click(middle);
  EXPECT_TRUE(workspace_.picks().empty());
  picture->parameters.atoms.scale = 3.0;
  click(middle);
  EXPECT_EQ(workspace_.picks().size(), 1U);
}

// The mode needs no defects; the pick does, and has them once they are read.
TEST_F(ViewInputTest, DefectsComeWhenTheyAreRead) {
  const test::TemporaryFolder folder;
  MaterialParts atoms_only;
  atoms_only.tetrahedra = atoms_only.surface = atoms_only.defects = atoms_only.fields = false;
  const std::string path = test::cracked_salt_crb(folder.path());
  workspace_.show_document(open_document(path, atoms_only, no_progress()), now());
  ASSERT_FALSE(workspace_.document()->material->defects.present());
  click(place_of(workspace_.bounds().center()));
  ASSERT_EQ(workspace_.picks().size(), 1U);
  ASSERT_TRUE(
      test::wait_for([&] { return workspace_.has_parts({.tetrahedra = false, .surface = false, .fields = false}); }));
  const Defects& defects = workspace_.document()->material->defects;
  ASSERT_TRUE(defects.present());
  const Pick& pick = workspace_.picks()[0];
  EXPECT_EQ(pick.defects.positional, defects.positional[pick.atom]);
  EXPECT_EQ(pick.defects.vacancy, defects.vacancy[pick.atom]);
}

}  // namespace
}  // namespace atomesh::gui
