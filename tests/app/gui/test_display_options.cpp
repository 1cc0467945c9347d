// The dock of the display options: lights, cut planes, Miller indices, what lies over the picture.
#include <gtest/gtest.h>

#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QLabel>
#include <QPushButton>
#include <QSignalSpy>
#include <QSpinBox>
#include <QTest>
#include <QToolButton>
#include <cmath>

#include "app/gui/display_options.h"
#include "app/gui/number_box.h"
#include "app/gui/parameter_field.h"
#include "app/gui/parameter_hints.h"
#include "app/gui/theme.h"
#include "app/gui/workspace.h"
#include "tests/app/gui/window_test.h"

namespace atomesh::gui {
namespace {

using test::child;

// A cube of 10 Å of a simple cubic crystal, cell 2 Å, about (5, 5, 5).
Document cube(bool with_cell = true) {
  auto material = std::make_shared<Material>();
  const auto species = material->atoms.add_species("Cu");
  for (int i = 0; i < 216; ++i) {
    material->atoms.positions.push_back(2.0 * Vec3(i % 6, i / 6 % 6, i / 36));
    material->atoms.species.push_back(species);
  }
  if (with_cell) {
    UnitCell cell;
    cell.primitive = {Vec3(2, 0, 0), Vec3(0, 2, 0), Vec3(0, 0, 2)};
    cell.basis = {{"Cu", Vec3(0.0)}};
    material->unit_cell = cell;
  }
  Document document;
  document.path = "/data/cube.crb";
  document.kind = FileKind::mesh;  // nothing to read later
  document.material = material;
  return document;
}

class Options : public testing::Test {
 protected:
  void SetUp() override {
    Parameters parameters;
    parameters.mode = Mode::atoms;
    workspace_.show_document(cube(), parameters);
    options_.resize(420, 1200);
    test::show(options_);
  }
  template <class Widget>
  Widget& part(const char* name) {
    return child<Widget>(options_, name);
  }
  void click(const char* name) { QTest::mouseClick(&part<QWidget>(name), Qt::LeftButton); }
  void enter(QWidget& box, const char* text) {
    box.setFocus();
    QTest::keyClick(&box, Qt::Key_A, Qt::ControlModifier);
    QTest::keyClicks(&box, text);
    QTest::keyClick(&box, Qt::Key_Return);
  }
  Workspace workspace_;
  DisplayOptions options_{workspace_, nullptr};
};

TEST_F(Options, HoldsEveryRowOfItsGroups) {
  part<QSpinBox>("light_count").setValue(8);
  part<QSpinBox>("cut_plane_count").setValue(8);
  for (const char* group : {"Display", "Lights", "Cut planes", "View", "Quality"}) {
    for (const std::string& key : keys_of_group(group)) {
      EXPECT_NE(options_.findChild<ParameterField*>(QString::fromStdString(key)), nullptr) << key;
    }
  }
}

TEST_F(Options, LightsComeAndGoAndUndo) {
  auto& count = part<QSpinBox>("light_count");
  EXPECT_EQ(count.value(), 2);
  EXPECT_EQ(options_.findChild<QWidget*>("section Light 3"), nullptr);
  count.setValue(4);
  EXPECT_TRUE(part<QWidget>("section Light 4").isVisible());
  EXPECT_TRUE(workspace_.parameters().lights[3].enabled);
  workspace_.undo();
  EXPECT_EQ(count.value(), 2);
  EXPECT_FALSE(part<QWidget>("section Light 3").isVisible());
  workspace_.redo();
  EXPECT_EQ(count.value(), 4);
  const Light fourth = workspace_.parameters().lights[3];
  click("section Light 3/remove");
  EXPECT_EQ(count.value(), 3);
  EXPECT_EQ(workspace_.parameters().lights[2], fourth);
  click("section Lights/reset");
  EXPECT_EQ(workspace_.parameters().lights, Parameters().lights);
  EXPECT_EQ(count.value(), 2);
}

TEST_F(Options, CutPlanesCutTheMiddleFlipAndGo) {
  auto& count = part<QSpinBox>("cut_plane_count");
  EXPECT_EQ(count.value(), 0);
  count.setValue(2);
  EXPECT_EQ(workspace_.parameters().cut_planes[1].normal, Vec3(0, 1, 0));
  EXPECT_NEAR(workspace_.parameters().cut_planes[1].distance, 5.0, 1e-9);
  click("section Cut plane 2/flip");
  EXPECT_EQ(workspace_.parameters().cut_planes[1].side, CutPlane::Side::greater_equal);
  EXPECT_EQ(part<QToolButton>("section Cut plane 2/fold").text(), "Cut plane 2 (0 1 0)");
  click("section Cut plane 1/remove");
  EXPECT_EQ(count.value(), 1);
  EXPECT_EQ(part<QToolButton>("section Cut plane 1/fold").text(), "Cut plane 1 (0 1 0)");
  workspace_.undo();
  EXPECT_EQ(count.value(), 2);
}

TEST_F(Options, TheSliderOfAPlaneGoesOverTheSample) {
  part<QSpinBox>("cut_plane_count").setValue(1);
  const Bounds& bounds = workspace_.bounds();
  auto& slider = part<QAbstractSlider>("cut_plane.1.distance/slider");
  EXPECT_TRUE(slider.isVisible());
  slider.setValue(slider.maximum());
  EXPECT_GE(workspace_.parameters().cut_planes[0].distance, bounds.max.x - 1e-9);
  EXPECT_LT(workspace_.parameters().cut_planes[0].distance, bounds.max.x + 1.0);
  // Twice as long a normal, twice as far.
  workspace_.set("cut_plane.1.normal", "2,0,0");
  slider.setValue(0);
  slider.setValue(slider.maximum());
  EXPECT_GE(workspace_.parameters().cut_planes[0].distance, 2.0 * bounds.max.x - 1e-9);
}

TEST_F(Options, MillerIndicesMakeAPlane) {
  part<QSpinBox>("cut_plane_count").setValue(1);
  const Parameters before = workspace_.parameters();
  click("section Cut plane 1/hkl");
  auto& dialog = child<QDialog>(options_, "miller_dialog");
  EXPECT_EQ(child<NumberBox>(dialog, "h").text(), "1");
  EXPECT_EQ(child<NumberBox>(dialog, "k").text(), "0");
  enter(child<NumberBox>(dialog, "k"), "1");
  enter(child<NumberBox>(dialog, "offset"), "2");
  auto& unit = child<QComboBox>(dialog, "unit");
  unit.setFocus();
  QTest::keyClick(&unit, Qt::Key_Down);
  const CutPlane plane = workspace_.parameters().cut_planes[0];
  EXPECT_NEAR(plane.normal.x, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(plane.normal.y, std::sqrt(0.5), 1e-12);
  // Two planes of d(110) = 2/√2 Å from the middle, (5, 5, 5).
  EXPECT_NEAR(plane.distance, 10.0 / std::sqrt(2.0) + 2.0 * std::sqrt(2.0), 1e-9);
  test::keep_screenshot(dialog.grab().toImage(), "miller_dialog");
  enter(child<NumberBox>(dialog, "h"), "0");
  enter(child<NumberBox>(dialog, "k"), "0");
  EXPECT_TRUE(child<QLabel>(dialog, "says").text().startsWith("⚠"));
  EXPECT_NEAR(workspace_.parameters().cut_planes[0].normal.y, 1.0, 1e-12);
  dialog.reject();
  EXPECT_EQ(workspace_.parameters(), before);

  click("section Cut plane 1/hkl");
  auto& again = *options_.findChildren<QDialog*>("miller_dialog").last();
  enter(child<NumberBox>(again, "l"), "1");
  again.accept();
  EXPECT_EQ(part<QToolButton>("section Cut plane 1/fold").text(), "Cut plane 1 (1 0 1)");
  workspace_.undo();
  EXPECT_EQ(workspace_.parameters(), before) << "one step";
}

TEST_F(Options, WithoutAUnitCellThePersonIsToldWhatToDo) {
  workspace_.show_document(cube(false));
  part<QSpinBox>("cut_plane_count").setValue(1);
  QSignalSpy complaints(&workspace_, &Workspace::complained);
  click("section Cut plane 1/hkl");
  ASSERT_EQ(complaints.count(), 1);
  EXPECT_TRUE(complaints.front().front().toString().contains("unit cell"));
}

TEST_F(Options, WhatLiesOverThePictureIsChosen) {
  for (const auto& [name, member] : std::initializer_list<std::pair<const char*, bool ViewOptions::*>>{
           {"view_legend", &ViewOptions::legend},
           {"view_scale_bar", &ViewOptions::scale_bar},
           {"view_tripod", &ViewOptions::tripod},
           {"view_cut_handles", &ViewOptions::cut_handles},
           {"view_upright", &ViewOptions::upright}}) {
    auto& check = part<QCheckBox>(name);
    EXPECT_TRUE(check.isChecked()) << name;
    check.click();
    EXPECT_FALSE(workspace_.view_options().*member) << name;
  }
  workspace_.set_view_options({});
  EXPECT_TRUE(part<QCheckBox>("view_tripod").isChecked());
  auto& drawing = part<QComboBox>("view_drawing");
  drawing.setFocus();
  QTest::keyClick(&drawing, Qt::Key_Down);
  EXPECT_EQ(workspace_.view_options().drawing, ViewOptions::Drawing::gpu);
}

TEST_F(Options, SectionsStayAsTheyWereLeft) {
  EXPECT_FALSE(part<QWidget>("view.zoom").isVisible());
  click("section View/fold");
  click("section Display/fold");
  EXPECT_TRUE(part<QWidget>("view.zoom").isVisible());
  EXPECT_FALSE(part<QWidget>("mode").isVisible());
  {
    DisplayOptions next(workspace_, nullptr);
    test::show(next);
    EXPECT_TRUE(child<QWidget>(next, "view.zoom").isVisible());
    EXPECT_FALSE(child<QWidget>(next, "mode").isVisible());
  }
  click("section View/fold");
  click("section Display/fold");
  EXPECT_TRUE(part<QWidget>("mode").isVisible());
}

TEST_F(Options, ButtonsAskForWhatTheWindowDoes) {
  QSignalSpy full(&options_, &DisplayOptions::full_screen_requested);
  QSignalSpy reset(&options_, &DisplayOptions::reset_orientation_requested);
  QSignalSpy help(&options_, &DisplayOptions::help_requested);
  click("full_screen");
  click("reset_orientation");
  click("mouse_controls");
  click("section Lights/help");
  EXPECT_EQ(full.count(), 1);
  EXPECT_EQ(reset.count(), 1);
  ASSERT_EQ(help.count(), 2);
  EXPECT_EQ(help[0][0].toString(), "controls");
  EXPECT_EQ(help[1][0].toString(), "Lights");
}

TEST_F(Options, TheThemeIsChosenAndKept) {
  ThemeKeeper keeper;
  auto& theme = part<QComboBox>("theme");
  theme.setFocus();
  theme.setCurrentIndex(1);
  QTest::keyClick(&theme, Qt::Key_Down);
  EXPECT_TRUE(is_dark(QApplication::palette()));
  EXPECT_EQ(chosen_theme(), Theme::dark);
  QCoreApplication::processEvents();
  test::keep_screenshot(options_.grab().toImage(), "display_options_dark");
  QTest::keyClick(&theme, Qt::Key_Up);
  EXPECT_FALSE(is_dark(QApplication::palette()));
  EXPECT_EQ(chosen_theme(), Theme::light);
  part<QSpinBox>("cut_plane_count").setValue(1);
  QCoreApplication::processEvents();
  // Nothing is wider than the dock, beside a scroll bar.
  EXPECT_LE(child<QWidget>(options_, "section Lights").parentWidget()->minimumSizeHint().width(), 400);
  test::keep_screenshot(options_.grab().toImage(), "display_options_light");
  DisplayOptions later(workspace_, nullptr);
  keeper.choose(Theme::system);
  EXPECT_EQ(child<QComboBox>(later, "theme").currentIndex(), static_cast<int>(Theme::system));
}

}  // namespace
}  // namespace atomesh::gui
