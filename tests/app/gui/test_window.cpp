// The whole window as a user drives it: files, modes, keys, undo; its pictures beside those of the command line.
#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QAction>
#include <QDockWidget>
#include <QLabel>
#include <QMenu>
#include <QMenuBar>
#include <QMessageBox>
#include <QSignalSpy>
#include <QStackedWidget>
#include <QTest>
#include <set>

#include "app/gui/help_window.h"
#include "tests/app/gui/window_fixture.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;
using test::all_modes;
using test::child;
using test::wait_for;

class Window : public test::WindowFixture {};

TEST_F(Window, EveryModeShowsTheCommandLinesPicture) {
  open_salt();
  for (const Mode mode : all_modes) {
    window->workspace().set("mode", std::string(mode_name(mode)));
    ASSERT_TRUE(wait_for([&] { return window->viewport().settled(); })) << mode_name(mode);
    EXPECT_EQ(window->viewport().worker_picture()->parameters.mode, mode);
    const QImage expected = to_qimage(picture_of_cli());
    EXPECT_EQ(window->viewport().worker_picture()->image, expected) << mode_name(mode);
    test::keep_screenshot(window->grab().toImage(), "window-" + std::string(mode_name(mode)));
  }
}

TEST_F(Window, TheCardDrawsTheSameSurfaceAndBalls) {
  open_salt();
  ViewOptions options = window->workspace().view_options();
  options.legend = options.tripod = options.scale_bar = false;
  for (const Mode mode : {Mode::surface, Mode::atoms}) {
    options.drawing = ViewOptions::Drawing::gpu;
    window->workspace().set_view_options(options);
    window->workspace().set("mode", std::string(mode_name(mode)));
    ASSERT_TRUE(wait_for([&] { return window->viewport().settled(); })) << mode_name(mode);
    ASSERT_TRUE(window->viewport().drawn_by_gpu());
    const Image card = test::to_image(window->viewport().screenshot());
    test::keep_screenshot(window->viewport().screenshot(), "card-" + std::string(mode_name(mode)));
    options.drawing = ViewOptions::Drawing::cpu;
    window->workspace().set_view_options(options);
    ASSERT_TRUE(wait_for([&] { return window->viewport().settled(); })) << mode_name(mode);
    EXPECT_FALSE(window->viewport().drawn_by_gpu());
    const Image processor = test::to_image(window->viewport().screenshot());
    const ImageDifference difference = compare_images(card, processor, 2.0 / 255.0);
    // Pixels whose ray all but touches an edge.
    EXPECT_LT(difference.pixels_over, card.pixels.size() / 10000) << mode_name(mode);
  }
}

TEST_F(Window, DocksLeaveRoomForTheView) {
  open_salt();
  window->resize(1280, 800);
  for (const QDockWidget* dock : window->findChildren<QDockWidget*>()) {
    EXPECT_LE(dock->widget()->minimumSizeHint().width(), 60 * window->fontMetrics().averageCharWidth())
        << dock->objectName().toStdString();
  }
  EXPECT_TRUE(wait_for([&] { return window->viewport().width() >= 500; })) << window->viewport().width();
}

TEST_F(Window, EveryMenuHasEntriesAndItsKeyForItself) {
  std::set<int> keys;
  for (const QAction* action : window->menuBar()->actions()) {
    ASSERT_NE(action->menu(), nullptr);
    EXPECT_FALSE(action->menu()->isEmpty()) << action->text().toStdString();
    EXPECT_TRUE(keys.insert(QKeySequence::mnemonic(action->text())[0].key()).second) << action->text().toStdString();
  }
  EXPECT_EQ(keys.size(), 6U);
  QList<const QWidget*> others{&child<QStackedWidget>(*window, "pages")};
  for (const QDockWidget* dock : window->findChildren<QDockWidget*>()) others << dock;
  for (const QWidget* other : others) {
    QStringList texts;
    for (const QAbstractButton* button : other->findChildren<QAbstractButton*>()) texts << button->text();
    for (const QLabel* label : other->findChildren<QLabel*>()) {
      if (label->buddy() != nullptr) texts << label->text();
    }
    for (const QString& text : texts) {
      const QKeySequence key = QKeySequence::mnemonic(text);
      EXPECT_TRUE(key.isEmpty() || !keys.contains(key[0].key())) << text.toStdString();
    }
  }
  std::set<QString> shortcuts;
  for (const QAction* action : window->findChildren<QAction*>()) {
    if (action->shortcutContext() != Qt::WindowShortcut) continue;
    for (const QKeySequence& key : action->shortcuts()) {
      EXPECT_TRUE(shortcuts.insert(key.toString()).second) << key.toString().toStdString();
    }
  }
}

TEST_F(Window, KeysOfTheManual) {
  open_salt();
  Workspace& workspace = window->workspace();
  for (int mode = 1; mode <= 5; ++mode) {
    press(Qt::Key_D);
    EXPECT_EQ(workspace.parameters().mode, all_modes[static_cast<std::size_t>(mode % 5)]);
  }
  const Shading before = workspace.parameters().shading;
  press(Qt::Key_S);
  EXPECT_NE(workspace.parameters().shading, before);
  press(Qt::Key_S);
  EXPECT_EQ(workspace.parameters().shading, before);
  workspace.set("view.azimuth", "77");
  workspace.set("view.zoom", "3");
  press(Qt::Key_R);
  EXPECT_EQ(workspace.parameters().azimuth, Parameters().azimuth);
  EXPECT_EQ(workspace.parameters().zoom, 1.0);
  press(Qt::Key_F);
  EXPECT_TRUE(wait_for([&] { return window->isFullScreen(); }));
  press(Qt::Key_F);
  EXPECT_TRUE(wait_for([&] { return !window->isFullScreen(); }));
  press(Qt::Key_H);
  EXPECT_TRUE(wait_for([&] {
    const auto* help = window->findChild<HelpWindow*>();
    return help != nullptr && help->isVisible();
  }));
  window->findChild<HelpWindow*>()->close();
  press(Qt::Key_Z, Qt::ControlModifier);  // the orientation comes back
  EXPECT_EQ(workspace.parameters().azimuth, 77.0);
  press(Qt::Key_Q);
  EXPECT_TRUE(wait_for([&] { return !window->isVisible(); }));
}

TEST_F(Window, WhatCannotBeOpenedIsSaidAndWhatIsOpenStays) {
  open_salt();
  const std::string before = window->workspace().document()->path;
  window->open(QString::fromStdString(folder.file("broken.crb", "ATOMESH?")));
  const auto complaint = [&] { return window->findChild<QMessageBox*>("complaint"); };
  ASSERT_TRUE(wait_for([&] { return complaint() != nullptr; }));
  EXPECT_TRUE(complaint()->text().contains("broken.crb")) << complaint()->text().toStdString();
  complaint()->accept();
  EXPECT_EQ(window->workspace().document()->path, before);
}

}  // namespace
