// Forms of the parameter table, driven as by a person: every kind of editor, undo and redo, errors at the field.
#include <gtest/gtest.h>

#include <QAction>
#include <QApplication>
#include <QCheckBox>
#include <QClipboard>
#include <QColorDialog>
#include <QComboBox>
#include <QGuiApplication>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSignalSpy>
#include <QSlider>
#include <QTest>
#include <QToolButton>

#include "app/gui/number_box.h"
#include "app/gui/parameter_field.h"
#include "app/gui/parameter_form.h"
#include "app/gui/parameter_hints.h"
#include "app/gui/workspace.h"
#include "tests/app/gui/window_test.h"
#include "tests/core/random_parameters.h"

namespace atomesh::gui {
namespace {

using test::child;

const std::vector<std::string> species{"Na", "Cl"};

class Form : public testing::Test {
 protected:
  void SetUp() override {
    form_.set_keys(parameter_keys(species));
    test::show(form_);
  }
  std::string now(const std::string& key) const { return get_parameter(workspace_.parameters(), key); }
  template <class Widget>
  Widget& part(const std::string& key, const char* name) {
    return child<Widget>(form_, QString::fromStdString(key + "/" + name));
  }
  void type(QWidget& box, const char* text) {
    box.setFocus();
    QTest::keyClick(&box, Qt::Key_A, Qt::ControlModifier);
    QTest::keyClick(&box, Qt::Key_Delete);
    QTest::keyClicks(&box, text);
    QTest::keyClick(&box, Qt::Key_Return);
  }
  // The one step there is, back and forth: the same text again each time.
  void expect_one_step(const std::string& key, const std::string& before, const std::string& after) {
    EXPECT_NE(before, after) << key;
    EXPECT_EQ(now(key), after) << key;
    EXPECT_EQ(workspace_.history().undo_name(), parameter_row(key).label);
    workspace_.undo();
    EXPECT_EQ(now(key), before) << key;
    EXPECT_FALSE(workspace_.history().can_undo()) << key;
    workspace_.redo();
    EXPECT_EQ(now(key), after) << key;
  }

  Workspace workspace_;
  ParameterForm form_{workspace_};
};

TEST_F(Form, EveryRowOfTheTableHasAnEditorLabelTipAndReset) {
  for (const std::string& key : parameter_keys(species)) {
    ParameterField* field = form_.field(key);
    ASSERT_NE(field, nullptr) << key;
    EXPECT_TRUE(field->isVisible()) << key;
    EXPECT_NE(field->focusProxy(), nullptr) << key;
    EXPECT_EQ(field->toolTip(), parameter_tool_tip(key));
    EXPECT_FALSE(field->modified()) << key;
    EXPECT_FALSE(part<QToolButton>(key, "reset").isVisible()) << key;
  }
  EXPECT_TRUE(form_.modified_keys().empty());
}

// Whatever the values are, showing them changes none.
TEST_F(Form, ShowsAnyParametersWithoutChangingThem) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Parameters random = test::random_parameters(seed, species);
    workspace_.change(random, "random");
    QCoreApplication::processEvents();
    ASSERT_EQ(workspace_.parameters(), random);
  }
  for (const std::string& key : form_.modified_keys()) EXPECT_TRUE(part<QToolButton>(key, "reset").isVisible()) << key;
  EXPECT_GT(form_.modified_keys().size(), 60U);
  workspace_.change({}, "defaults");
  EXPECT_TRUE(form_.modified_keys().empty());
}

TEST_F(Form, ABooleanIsACheckBox) {
  QTest::mouseClick(&part<QCheckBox>("light.3.enabled", "check"), Qt::LeftButton, {}, QPoint(8, 8));
  expect_one_step("light.3.enabled", "false", "true");
}

TEST_F(Form, AChoiceIsAComboBox) {
  auto& combo = part<QComboBox>("mode", "combo");
  combo.setFocus();
  QTest::keyClick(&combo, Qt::Key_Down);
  expect_one_step("mode", "volume-surface", "volume");
  EXPECT_EQ(combo.currentText(), "Volume");
}

TEST_F(Form, ANumberIsTyped) {
  type(part<NumberBox>("volume_surface.face_alpha", "box"), "0.123456789");
  expect_one_step("volume_surface.face_alpha", "0.15", "0.123456789");
  EXPECT_EQ(part<QSlider>("volume_surface.face_alpha", "slider").value(), 123);
}

TEST_F(Form, AWholeNumberIsStepped) {
  auto& box = part<NumberBox>("quality.supersampling", "box");
  box.setFocus();
  QTest::keyClick(&box, Qt::Key_Up);
  expect_one_step("quality.supersampling", "1", "2");
  for (int i = 0; i < 40; ++i) QTest::keyClick(&box, Qt::Key_Up);
  EXPECT_EQ(now("quality.supersampling"), "16");  // and no further
}

TEST_F(Form, ADragOfASliderIsOneStep) {
  auto& slider = part<QSlider>("volume_surface.face_alpha", "slider");
  slider.setSliderDown(true);
  for (int position = 150; position <= 400; position += 5) slider.setSliderPosition(position);
  slider.setSliderDown(false);
  expect_one_step("volume_surface.face_alpha", "0.15", "0.4");
  // The next drag is another.
  slider.setSliderDown(true);
  slider.setSliderPosition(700);
  slider.setSliderDown(false);
  EXPECT_EQ(now("volume_surface.face_alpha"), "0.7");
  workspace_.undo();
  EXPECT_EQ(now("volume_surface.face_alpha"), "0.4");
}

TEST_F(Form, ASliderOfWholeNumbersGetsThroughByKeys) {
  auto& slider = part<QSlider>("quality.samples_per_cell", "slider");
  slider.setFocus();
  for (int i = 0; i < 100; ++i) QTest::keyClick(&slider, Qt::Key_Right);
  EXPECT_EQ(now("quality.samples_per_cell"), "1024");
}

TEST_F(Form, AColorIsChosenInTheDialog) {
  const std::string before = now("surface.color");
  QTest::mouseClick(&part<QPushButton>("surface.color", "button"), Qt::LeftButton);
  auto& dialog = child<QColorDialog>(form_, "surface.color/dialog");
  dialog.setCurrentColor(QColor(255, 0, 0));
  EXPECT_EQ(now("surface.color"), "1,0,0");  // the picture follows
  dialog.setCurrentColor(QColor(0, 255, 0));
  dialog.accept();
  expect_one_step("surface.color", before, "0,1,0");
}

TEST_F(Form, ACancelledColorIsAsBefore) {
  const std::string before = now("volume_surface.base_color");
  QTest::mouseClick(&part<QPushButton>("volume_surface.base_color", "button"), Qt::LeftButton);
  auto& dialog = child<QColorDialog>(form_, "volume_surface.base_color/dialog");
  dialog.setCurrentColor(QColor(255, 0, 0));
  EXPECT_NE(now("volume_surface.base_color"), before);
  dialog.reject();
  EXPECT_EQ(now("volume_surface.base_color"), before);
}

TEST_F(Form, AnOpacityIsTypedBesideItsColor) {
  type(part<NumberBox>("background", "alpha"), "0.25");
  expect_one_step("background", "1,1,1,1", "1,1,1,0.25");
}

TEST_F(Form, AVectorIsThreeBoxes) {
  type(part<NumberBox>("view.pan", "y"), "-2.5");
  expect_one_step("view.pan", "0,0,0", "0,-2.5,0");
  type(part<NumberBox>("view.pan", "x"), "1,2,3");  // a whole one, pasted into the first
  EXPECT_EQ(now("view.pan"), "1,2,3");
  type(part<NumberBox>("cut_plane.1.normal", "x"), "0");
  EXPECT_EQ(now("cut_plane.1.normal"), "1,0,0") << "a plane without a direction";
  EXPECT_FALSE(form_.field("cut_plane.1.normal")->error().isEmpty());
}

TEST_F(Form, ANameIsTyped) {
  auto& combo = part<QComboBox>("volume.field", "text");
  type(*combo.lineEdit(), "pressure");
  expect_one_step("volume.field", "auto", "pressure");
}

TEST_F(Form, AColorMapIsAPresetOrOpensTheEditor) {
  auto& combo = part<QComboBox>("volume.color_map", "combo");
  EXPECT_EQ(combo.currentText(), "viridis");
  combo.setFocus();
  QTest::keyClick(&combo, Qt::Key_Down);
  expect_one_step("volume.color_map", "viridis", "cividis");
  QSignalSpy asked(&form_, &ParameterForm::edit_color_map_requested);
  QTest::mouseClick(&part<QWidget>("volume.color_map", "preview"), Qt::LeftButton);
  EXPECT_EQ(asked.count(), 1);
  workspace_.set("volume.color_map", "0:#000000 1:#ffffff");
  EXPECT_EQ(combo.currentText(), "own");
}

TEST_F(Form, WhatASpeciesHasItselfIsAuto) {
  auto& box = part<NumberBox>("atoms.radius.Na", "box");
  EXPECT_EQ(box.text(), "auto");
  type(box, "1.25");
  expect_one_step("atoms.radius.Na", "auto", "1.25");
  type(box, "auto");
  EXPECT_EQ(now("atoms.radius.Na"), "auto");
  EXPECT_EQ(part<QPushButton>("atoms.color.Na", "button").text(), "auto");
}

TEST_F(Form, WhatIsOutOfRangeIsRefusedAtTheField) {
  const std::string key = "volume_surface.face_alpha";
  auto& box = part<NumberBox>(key, "box");
  auto& message = part<QLabel>(key, "message");
  for (const char* text : {"2", "-0.1", "0.5x", "nan", "", "auto"}) {
    type(box, text);
    EXPECT_EQ(now(key), "0.15") << text;
    EXPECT_EQ(box.text(), text) << "what was typed stays";
    EXPECT_TRUE(message.isVisible()) << text;
    EXPECT_EQ(message.text(), "⚠ Expected a number from 0 to 1");
  }
  EXPECT_FALSE(workspace_.history().can_undo());
  // Another value changing does not touch it; Escape gives it up.
  workspace_.set("xray.alpha_length", "0.5");
  EXPECT_TRUE(message.isVisible());
  QTest::keyClick(&box, Qt::Key_Escape);
  EXPECT_FALSE(message.isVisible());
  EXPECT_EQ(box.text(), "0.15");
  // Put right, it is taken.
  type(box, "7");
  EXPECT_TRUE(message.isVisible());
  type(box, "0.7");
  EXPECT_FALSE(message.isVisible());
  EXPECT_EQ(now(key), "0.7");
}

TEST_F(Form, EveryNumberSaysItsOwnRange) {
  for (const std::string& key : parameter_keys(species)) {
    const ParameterRow& row = parameter_row(key);
    if (row.type != ParameterType::integer && row.type != ParameterType::real) continue;
    const std::string before = now(key);
    type(part<NumberBox>(key, "box"), "1e301");
    EXPECT_EQ(now(key), before) << key;
    EXPECT_EQ(part<QLabel>(key, "message").text(), "⚠ Expected " + QString::fromStdString(expected_value(row))) << key;
  }
  EXPECT_FALSE(workspace_.history().can_undo());
}

TEST_F(Form, ResetBringsBackTheDefault) {
  const std::string key = "light.2.intensity";
  type(part<NumberBox>(key, "box"), "3");
  auto& reset = part<QToolButton>(key, "reset");
  EXPECT_TRUE(reset.isVisible());
  QTest::mouseClick(&reset, Qt::LeftButton);
  EXPECT_EQ(now(key), default_text(key));
  EXPECT_FALSE(reset.isVisible());
  workspace_.undo();
  EXPECT_EQ(now(key), "3");

  workspace_.set("light.1.color", "#ff0000");
  reset_parameters(workspace_, keys_of_group("Lights"), "Reset lights");
  EXPECT_EQ(workspace_.parameters().lights, Parameters().lights);
  EXPECT_EQ(workspace_.history().undo_name(), "Reset lights");
  workspace_.undo();
  EXPECT_EQ(now("light.1.color"), "1,0,0");
  EXPECT_EQ(now(key), "3");
}

TEST_F(Form, AValueIsCopiedAndPasted) {
  workspace_.set("volume_surface.base_color", "0.1,0.2,0.3,0.4");
  form_.field("volume_surface.base_color")->copy();
  EXPECT_EQ(QGuiApplication::clipboard()->text(), "0.1,0.2,0.3,0.4");
  form_.field("volume_surface.extra_color")->paste();
  EXPECT_EQ(now("volume_surface.extra_color"), "0.1,0.2,0.3,0.4");
  QGuiApplication::clipboard()->setText("nonsense");
  form_.field("volume_surface.extra_color")->paste();
  EXPECT_EQ(now("volume_surface.extra_color"), "0.1,0.2,0.3,0.4");
  EXPECT_FALSE(form_.field("volume_surface.extra_color")->error().isEmpty());
}

TEST_F(Form, TabGoesThroughTheRowsInTheirOrder) {
  const auto focus_is = [](const QWidget& widget) { return QApplication::focusWidget() == &widget; };
  // In the form's first order, and in another.
  for (const auto& keys : {std::vector<std::string>{"surface.shininess", "mode", "xray.alpha_length"},
                           std::vector<std::string>{"xray.alpha_length", "surface.shininess", "mode"}}) {
    form_.set_keys(keys);
    QCoreApplication::processEvents();
    QWidget& first = *form_.field(keys.front())->focusProxy();
    first.setFocus();
    for (const std::string& key : keys) {
      EXPECT_TRUE(focus_is(*form_.field(key)->focusProxy())) << key;
      if (parameter_row(key).type == ParameterType::real) {
        QTest::keyClick(QApplication::focusWidget(), Qt::Key_Tab);
        EXPECT_TRUE(focus_is(part<QSlider>(key, "slider"))) << key;
      }
      QTest::keyClick(QApplication::focusWidget(), Qt::Key_Tab);
    }
  }
}

// The window's single letters and digits are shortcuts (q closes the program): not for who is typing.
TEST_F(Form, TypingIsNoShortcut) {
  int shortcuts = 0;
  for (const Qt::Key key : {Qt::Key_A, Qt::Key_Q, Qt::Key_1}) {
    auto* action = new QAction(&form_);
    action->setShortcut(key);
    form_.addAction(action);
    QObject::connect(action, &QAction::triggered, &form_, [&shortcuts] { ++shortcuts; });
  }
  form_.activateWindow();
  ASSERT_TRUE(test::wait_for([&] { return form_.isActiveWindow(); }));
  type(part<NumberBox>("atoms.radius.Na", "box"), "1.1");
  type(part<NumberBox>("atoms.radius.Na", "box"), "auto");
  type(*part<QComboBox>("volume.field", "text").lineEdit(), "q1a");
  EXPECT_EQ(now("volume.field"), "q1a");
  EXPECT_EQ(shortcuts, 0);
  auto& check = part<QCheckBox>("light.3.enabled", "check");
  check.setFocus();
  QTest::keyClick(&check, Qt::Key_Q);
  EXPECT_EQ(shortcuts, 1) << "the shortcuts of this test do work";
}

TEST_F(Form, TheWheelChangesOnlyWhatHasTheFocus) {
  const auto turn = [](QWidget& widget) {
    QWheelEvent event(QPointF(5, 5), widget.mapToGlobal(QPointF(5, 5)), {}, {0, 120}, Qt::NoButton, Qt::NoModifier,
                      Qt::NoScrollPhase, false);
    QCoreApplication::sendEvent(&widget, &event);
  };
  form_.field("view.pan")->setFocus();
  const Parameters before = workspace_.parameters();
  turn(part<NumberBox>("view.zoom", "box"));
  turn(part<QSlider>("view.zoom", "slider"));
  turn(part<QComboBox>("mode", "combo"));
  EXPECT_EQ(workspace_.parameters(), before);
  part<NumberBox>("view.zoom", "box").setFocus();
  turn(part<NumberBox>("view.zoom", "box"));
  EXPECT_EQ(now("view.zoom"), "1.1");
}

}  // namespace
}  // namespace atomesh::gui
