// Volumes in the window when OpenGL fails: the processor draws them, the log says why, and the card may be asked again.
#include <epoxy/gl.h>  // before Qt's
#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QEvent>
#include <QOpenGLWidget>
#include <QPointer>
#include <QSignalSpy>
#include <QSurfaceFormat>
#include <functional>
#include <utility>

#include "tests/app/gui/lost_contexts.h"
#include "tests/app/gui/window_volume_fixture.h"
#include "tests/render/gl/instead.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;
using test::Loss;
using test::LostContext;
using test::wait_for;
using test::WindowVolume;

class FailingWindowVolume : public WindowVolume {
 protected:
  void SetUp() override {
    WindowVolume::SetUp();
    if (IsSkipped()) return;
    draw_with(ViewOptions::Drawing::gpu);
    choose(Mode::volume);
    ASSERT_TRUE(settled());
    ASSERT_TRUE(window->viewport().drawn_by_gpu());
    good_ = screen();
    choose(Mode::surface);
    ASSERT_TRUE(settled());
    ASSERT_TRUE(window->viewport().drawn_by_gpu());
  }
  // The processor draws the volume, and says why; the card draws the surface, and the volume where it is told to anew.
  void expect_processor(const char* why) {
    choose(Mode::volume);
    ASSERT_TRUE(settled());
    EXPECT_FALSE(window->viewport().drawn_by_gpu());
    EXPECT_TRUE(log.contains("The graphics card cannot draw this")) << log.toStdString();
    EXPECT_TRUE(log.contains(why)) << log.toStdString();
    EXPECT_EQ(window->viewport().worker_picture()->image, to_qimage(rendered("cpu")));
    EXPECT_EQ(screen().pixels, test::to_image(window->viewport().worker_picture()->image).pixels);
    workspace().set("view.azimuth", "10");
    ASSERT_TRUE(settled());
    EXPECT_FALSE(window->viewport().drawn_by_gpu());
    workspace().reset("view.azimuth");
    choose(Mode::surface);
    ASSERT_TRUE(settled());
    EXPECT_TRUE(window->viewport().drawn_by_gpu());
  }
  void expect_card_again() {
    draw_with(ViewOptions::Drawing::cpu);
    draw_with(ViewOptions::Drawing::gpu);
    choose(Mode::volume);
    ASSERT_TRUE(settled());
    EXPECT_TRUE(window->viewport().drawn_by_gpu());
    EXPECT_EQ(compare_images(screen(), good_).max, 0.0);
  }

  Image good_;
};

TEST_F(FailingWindowVolume, ByAShader) {
  static PFNGLSHADERSOURCEPROC real;
  real = epoxy_glShaderSource;
  {
    const Instead other(
        epoxy_glShaderSource, +[](GLuint shader, GLsizei, const GLchar* const*, const GLint*) {
          const GLchar* nonsense = "#version 430\nvoid main() { nothing(); }";
          real(shader, 1, &nonsense, nullptr);
        });
    expect_processor("nothing");
  }
  expect_card_again();
}

TEST_F(FailingWindowVolume, ByTheCardsMemory) {
  {
    const Instead other(
        epoxy_glMapBufferRange, +[](GLenum, GLintptr, GLsizeiptr, GLbitfield) -> void* { return nullptr; });
    expect_processor("memory");
  }
  expect_card_again();
}

TEST_F(FailingWindowVolume, ByALostContext) {
  // Software drivers have no card to lose, and others tell only who asked for it.
  EXPECT_TRUE(QSurfaceFormat::defaultFormat().testOption(QSurfaceFormat::ResetNotification));
  {
    static bool lost;
    lost = true;
    const Instead other(
        epoxy_glGetGraphicsResetStatus,
        +[]() -> GLenum { return std::exchange(lost, false) ? GL_INNOCENT_CONTEXT_RESET : GL_NO_ERROR; });
    expect_processor("the context is lost");
  }
  expect_card_again();
}

// Contexts that Qt finds lost: what lies on the card goes without a call to OpenGL that would reach another context, or
// none.
class LostWindowVolume : public FailingWindowVolume {
 protected:
  void SetUp() override {
    FailingWindowVolume::SetUp();
    if (IsSkipped()) return;
    choose(Mode::volume);
    ASSERT_TRUE(settled());
    card().makeCurrent();
    if (!test::contexts_can_be_lost()) GTEST_SKIP() << "Qt asks others than GLX";
  }
};

class LosingWindowVolume : public LostWindowVolume, public testing::WithParamInterface<Loss> {
 protected:
  // While it is lost, `act` makes the window notice.
  void lose(const std::function<void()>& act) {
    card().makeCurrent();
    const test::StrayDeletions deletions;
    {
      const LostContext lost(GetParam());
      card().doneCurrent();
      const QPointer<QOpenGLWidget> gone(&card());
      act();
      EXPECT_TRUE(wait_for([&] { return gone.isNull(); }));
      EXPECT_GT(LostContext::noticed(), 0U);
    }
    EXPECT_EQ(test::StrayDeletions::stray(), 0U);
    EXPECT_EQ(test::StrayDeletions::all() == 0, GetParam() == Loss::all);
    ASSERT_TRUE(settled());
    EXPECT_FALSE(window->viewport().drawn_by_gpu());
    EXPECT_TRUE(log.contains("The graphics card cannot draw this, so the processor does: OpenGL: the context "))
        << log.toStdString();
    EXPECT_TRUE(log.contains(GetParam() == Loss::reset ? "is lost" : "cannot be made current")) << log.toStdString();
    EXPECT_EQ(log.count("The graphics card cannot draw this"), 1) << log.toStdString();
    const auto& picture = window->viewport().worker_picture();
    ASSERT_NE(picture, nullptr);
    EXPECT_EQ(picture->image, to_qimage(rendered("cpu")));
  }
};
INSTANTIATE_TEST_SUITE_P(Ways, LosingWindowVolume, testing::Values(Loss::reset, Loss::refused, Loss::all));

TEST_P(LosingWindowVolume, ByThePictureOfAnotherView) {
  lose([&] { workspace().set("view.azimuth", "10"); });
  workspace().reset("view.azimuth");
  expect_card_again();
}

TEST_P(LosingWindowVolume, WhileItIsRefined) {
  workspace().set("quality.supersampling", "4");  // takes long
  ASSERT_TRUE(settled());
  QSignalSpy painted(&card(), SIGNAL(painted(double, bool)));
  workspace().set("view.azimuth", "31");
  ASSERT_TRUE(wait_for([&] { return !painted.isEmpty(); }));
  if (painted[0][1].toBool()) GTEST_SKIP() << "this card is too fast for it";
  lose([] {});
  workspace().reset("view.azimuth");
  workspace().reset("quality.supersampling");
  expect_card_again();
}

TEST_P(LosingWindowVolume, ByANewSize) {
  lose([&] { window->resize(window->width() + 60, window->height() + 40); });
  window->resize(window->width() - 60, window->height() - 40);
  ASSERT_TRUE(settled());
  expect_card_again();
}

// Where its pixels are of another size Qt makes another framebuffer.
TEST_P(LosingWindowVolume, ByAnotherScreen) {
  lose([&] {
    QEvent change(QEvent::ScreenChangeInternal);
    QCoreApplication::sendEvent(&card(), &change);
  });
  expect_card_again();
}

TEST_P(LosingWindowVolume, ByAScreenshot) {
  lose([&] { EXPECT_TRUE(window->viewport().screenshot().isNull()); });
  expect_card_again();
}

TEST_P(LosingWindowVolume, OfASurface) {
  choose(Mode::surface);
  ASSERT_TRUE(settled());
  ASSERT_TRUE(window->viewport().drawn_by_gpu());
  card().makeCurrent();
  {
    const LostContext lost(GetParam());
    card().doneCurrent();
    const QPointer<QOpenGLWidget> gone(&card());
    workspace().set("view.azimuth", "10");
    ASSERT_TRUE(wait_for([&] { return gone.isNull(); }));
  }
  ASSERT_TRUE(settled());
  EXPECT_FALSE(window->viewport().drawn_by_gpu());
  EXPECT_EQ(window->viewport().worker_picture()->image, to_qimage(rendered("cpu")));
  workspace().reset("view.azimuth");
  expect_card_again();
}

// The window goes with it before it notices.
TEST_P(LosingWindowVolume, ByTheEnd) {
  card().makeCurrent();
  const test::StrayDeletions deletions;
  const LostContext lost(GetParam());
  card().doneCurrent();
  window.reset();
  EXPECT_EQ(test::StrayDeletions::stray(), 0U);
  EXPECT_EQ(test::StrayDeletions::all() == 0, GetParam() == Loss::all);
}

// There is no context for the other modes either.
TEST_F(LostWindowVolume, TheProcessorDrawsEveryMode) {
  card().makeCurrent();
  const LostContext lost(Loss::all);
  card().doneCurrent();
  for (const Mode mode : {Mode::volume, Mode::surface, Mode::atoms}) {
    log.clear();
    choose(mode);
    workspace().set("view.azimuth", "10");
    ASSERT_TRUE(settled()) << mode_name(mode);
    EXPECT_FALSE(window->viewport().drawn_by_gpu()) << mode_name(mode);
    EXPECT_TRUE(log.contains("The graphics card cannot draw this, so the processor does: OpenGL: "))
        << log.toStdString();
    EXPECT_EQ(window->viewport().worker_picture()->image, to_qimage(rendered("cpu"))) << mode_name(mode);
  }
}

// CMakeLists.txt has this run with a driver that has less than OpenGL 4.3.
class OldDriver : public test::WindowFixture {};

TEST_F(OldDriver, LeavesVolumesToTheProcessor) {
  if (qEnvironmentVariableIsEmpty("MESA_GL_VERSION_OVERRIDE")) GTEST_SKIP() << "only where it is told to be old";
  if (gpu_of_this_machine().volumes) GTEST_SKIP() << "this driver is not to be told";
  QString log;
  Workspace& workspace = window->workspace();
  QObject::connect(&workspace, &Workspace::said, window.get(), [&log](const QString& line) { log += line + '\n'; });
  workspace.set_view_options({.drawing = ViewOptions::Drawing::gpu});
  workspace.set("mode", "surface");
  open_salt();
  EXPECT_TRUE(window->viewport().drawn_by_gpu());
  workspace.set("mode", "volume");
  ASSERT_TRUE(wait_for([&] { return window->viewport().settled(); }));
  EXPECT_FALSE(window->viewport().drawn_by_gpu());
  EXPECT_TRUE(log.contains("The processor draws the volume: there is no OpenGL 4.3 here, only ")) << log.toStdString();
  EXPECT_EQ(window->viewport().worker_picture()->image, to_qimage(picture_of_cli()));
}

}  // namespace
