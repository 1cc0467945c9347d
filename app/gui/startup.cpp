#include "app/gui/startup.h"

#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QtGlobal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "app/gui/gpu_scene.h"
#include "app/gui/job.h"

namespace atomesh::gui {

namespace {

constexpr int exit_unavailable = 3;

// Qt's last warnings before it gives up; the first of them names the display.
std::string& reason_of_qt() {
  static std::string reason;
  return reason;
}

QtMessageHandler& handler_before() {
  static QtMessageHandler handler = nullptr;
  return handler;
}

void take_message(QtMsgType type, const QMessageLogContext& context, const QString& message) {
  const std::string line = message.toStdString();
  if (type == QtFatalMsg) {
    const std::string& reason = reason_of_qt();
    const std::string first = line.substr(0, line.find('\n'));
    const std::string why = without_window(reason.empty() ? first : reason);
    std::fprintf(stderr, "atomesh: %s\n", why.c_str());
    std::fflush(stderr);
    std::_Exit(exit_unavailable);
  }
  const std::string category = context.category != nullptr ? context.category : "";
  if (type == QtWarningMsg && category.starts_with("qt.qpa")) {
    if (reason_of_qt().empty()) reason_of_qt() = line;
    return;
  }
  if (handler_before() != nullptr) handler_before()(type, context, message);
}

}  // namespace

std::string without_window(const std::string& reason) {
  return "no window can be opened here: " + reason +
         "\nThese work without one:\n"
         "  atomesh render FILE -o picture.png    draws a picture\n"
         "  atomesh preprocess FILE -o OUT.crb    makes volume, surface and defects of atoms\n"
         "  atomesh defects FILE, atomesh info FILE, atomesh convert IN OUT, …; see atomesh --help";
}

std::string missing_display(const std::function<const char*(const char*)>& variable) {
  const auto given = [&](const char* name) {
    const char* const value = variable(name);
    return value != nullptr && *value != '\0';
  };
  if (given("DISPLAY") || given("WAYLAND_DISPLAY") || given("QT_QPA_PLATFORM")) return "";
  return "there is no display (neither DISPLAY nor WAYLAND_DISPLAY is set)";
}

PlatformGuard::PlatformGuard() {
  reason_of_qt().clear();
  handler_before() = qInstallMessageHandler(take_message);
}

PlatformGuard::~PlatformGuard() {
  qInstallMessageHandler(handler_before());
}

void prefer_x() {
  if (qEnvironmentVariableIsEmpty("QT_QPA_PLATFORM") && !qEnvironmentVariableIsEmpty("DISPLAY")) {
    qputenv("QT_QPA_PLATFORM", "xcb");
  }
}

std::string missing_opengl() {
  QOpenGLContext context;
  if (!context.create()) return "its display has no OpenGL that can be used; 3.2 or later is needed";
  QOffscreenSurface surface;
  surface.setFormat(context.format());
  surface.create();
  if (!surface.isValid() || !context.makeCurrent(&surface)) {
    return "its display has no OpenGL that can be drawn with; 3.2 or later is needed";
  }
  const GpuInfo info = gpu_info([&](const char* name) {
    const QFunctionPointer function = context.getProcAddress(name);
    void* address = nullptr;
    static_assert(sizeof(address) == sizeof(function));
    std::memcpy(&address, &function, sizeof(address));
    return address;
  });
  context.doneCurrent();
  if (info.sufficient) return "";
  return "its OpenGL is " + info.version + " (" + info.renderer + "); 3.2 or later is needed";
}

int end_process(int exit_code) {
  if (!Job::any_left()) return exit_code;
  std::fflush(nullptr);
  std::_Exit(exit_code);
}

}  // namespace atomesh::gui
