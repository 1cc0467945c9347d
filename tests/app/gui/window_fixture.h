// A main window on a display, and what its tests do again and again.
#pragma once

#include <gtest/gtest.h>

#include <QTest>
#include <memory>

#include "app/gui/main_window.h"
#include "app/gui/viewport.h"
#include "core/material_file.h"
#include "render/renderer.h"
#include "render/scene.h"
#include "tests/app/gui/window_test.h"
#include "tests/render/fixtures.h"
#include "tests/support/temporary_folder.h"

namespace atomesh::test {

class WindowFixture : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_opengl()) GTEST_SKIP() << "no display with OpenGL";
    window = std::make_unique<gui::MainWindow>();
    window->resize(900, 640);
    show(*window);
  }

  void open_salt() {
    window->open(QString::fromStdString(cracked_salt_crb(folder.path().string())));
    ASSERT_TRUE(wait_for([&] { return window->viewport().settled(); }));
  }
  // What the command line draws of the same.
  Image picture_of_cli() {
    const gui::Workspace& workspace = window->workspace();
    const Material material = read_material(workspace.document()->path);
    const Scene scene = make_scene(material, workspace.shown());
    const Camera camera = make_camera(workspace.shown(), scene.bounds, workspace.width(), workspace.height());
    RenderStats stats;
    return render(find_renderer("cpu"), scene, camera, workspace.shown(), stats);
  }
  void press(Qt::Key key, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    window->activateWindow();
    ASSERT_TRUE(wait_for([&] { return window->isActiveWindow(); }));
    QTest::keyClick(&window->viewport(), key, modifiers);
  }

  TemporaryFolder folder;
  std::unique_ptr<gui::MainWindow> window;
};

}  // namespace atomesh::test
