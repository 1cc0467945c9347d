// A window whose volumes the graphics card draws (here mostly: OpenGL in software).
#pragma once

#include <epoxy/gl.h>  // before Qt's
#include <gtest/gtest.h>

#include <QOpenGLWidget>
#include <string>
#include <thread>
#include <vector>

#include "app/gui/card_view.h"
#include "render/gl/context.h"
#include "tests/app/gui/window_fixture.h"
#include "tests/render/fixtures.h"

namespace atomesh::test {

class WindowVolume : public WindowFixture {
 protected:
  void SetUp() override {
    // The driver checks every call.
    QSurfaceFormat format = QSurfaceFormat::defaultFormat();
    format.setOption(QSurfaceFormat::DebugContext);
    QSurfaceFormat::setDefaultFormat(format);
    WindowFixture::SetUp();
    if (IsSkipped()) return;
    if (!gui::gpu_of_this_machine().volumes) GTEST_SKIP() << "no OpenGL 4.3";
    open_salt();
    workspace().set("volume.alpha_length", "4");
    connect_log();
  }
  void TearDown() override {
    window.reset();
    EXPECT_EQ(gl::take_messages(), std::vector<std::string>());
  }

  gui::Workspace& workspace() { return window->workspace(); }
  QOpenGLWidget& card() { return child<QOpenGLWidget>(*window, "card_view"); }
  void connect_log() {
    QObject::connect(&workspace(), &gui::Workspace::said, window.get(),
                     [this](const QString& line) { log += line + '\n'; });
  }
  void draw_with(gui::ViewOptions::Drawing who) {
    gui::ViewOptions options = workspace().view_options();
    options.legend = options.tripod = options.scale_bar = false;
    options.drawing = who;
    workspace().set_view_options(options);
  }
  void choose(Mode mode) { workspace().set("mode", std::string(mode_name(mode))); }
  bool settled() {
    return wait_for([&] { return window->viewport().settled(); });
  }
  // Its errors are collected from then on; a frame with some throws what they are.
  void watch_card() {
    card().makeCurrent();
    gl::collect_messages();
    card().doneCurrent();
  }
  Image screen() { return to_image(window->viewport().screenshot()); }
  Image rendered(const char* name) {
    const gui::Workspace& w = workspace();
    const Scene scene = make_scene(*w.document()->material, w.shown());
    Image image;
    // The window's context may be current in this thread.
    std::thread([&] {
      RenderStats stats;
      image = render(find_renderer(name), scene, w.camera(), w.shown(), stats);
    }).join();
    return image;
  }

  QString log;
};

}  // namespace atomesh::test
