#include "app/gui/run_window.h"

#include <unistd.h>

#include <QApplication>
#include <QIcon>
#include <QSurfaceFormat>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <sstream>

#include "app/gui/file_summary.h"
#include "app/gui/main_window.h"
#include "app/gui/startup.h"
#include "app/gui/theme.h"
#include "app/gui/viewport.h"
#include "core/error.h"

namespace atomesh::gui {

void set_surface_format() {
  QSurfaceFormat format;
  format.setVersion(3, 2);
  format.setProfile(QSurfaceFormat::CoreProfile);
  format.setAlphaBufferSize(8);
  format.setDepthBufferSize(24);
  // A card that is reset makes the context invalid; without this some drivers end the program.
  format.setOption(QSurfaceFormat::ResetNotification);
  QSurfaceFormat::setDefaultFormat(format);
}

namespace {

// Since this process was started, libraries included; the system counts in hundredths of a second.
double ms_of_this_process() {
  std::ifstream status("/proc/self/stat");
  std::string text((std::istreambuf_iterator<char>(status)), {});
  // The 22nd field; the second is a name in parentheses that may have blanks.
  std::istringstream fields(text.substr(text.rfind(')') + 1));
  std::string field;
  for (int i = 3; i <= 22; ++i) fields >> field;
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  const double started = std::strtod(field.c_str(), nullptr) * 1e3 / static_cast<double>(sysconf(_SC_CLK_TCK));
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec) - started;
}

void close_when_shown(MainWindow& window) {
  const auto first = std::make_shared<double>(-1.0);
  QObject::connect(&window.viewport(), &Viewport::frame_shown, &window, [first] {
    if (*first < 0.0) *first = ms_of_this_process();
  });
  QObject::connect(&window.viewport(), &Viewport::became_settled, &window, [first, &window] {
    std::printf("first picture after %.0f ms, complete after %.0f ms\n", *first, ms_of_this_process());
    window.close();
  });
}

}  // namespace

int run_window(const WindowArguments& arguments) {
  QStringList files;
  for (const std::string& file : arguments.files) files << QString::fromStdString(file);
  if (!arguments.parameters.empty()) files << QString::fromStdString(arguments.parameters);
  const FileChoice choice = choose_files(files);
  if (!choice.problem.isEmpty()) throw UsageError(choice.problem.toStdString());
  if (arguments.until_shown && choice.data.isEmpty()) throw UsageError("--until-shown: expected FILE to show");
  if (const std::string reason = missing_display(std::getenv); !reason.empty()) {
    throw UnavailableError(without_window(reason));
  }
  prefer_x();
  set_surface_format();
  int count = 1;
  char name[] = "atomesh";
  char* words[] = {name, nullptr};
  int exit_code = 0;
  {
    std::optional<PlatformGuard> guard(std::in_place);
    QApplication application(count, words);
    QApplication::setApplicationName("atomesh");
    QApplication::setOrganizationName("atomesh");
    QApplication::setDesktopFileName("atomesh");
    QApplication::setWindowIcon(QIcon(":/desktop/atomesh.svg"));
    if (const std::string reason = missing_opengl(); !reason.empty()) throw UnavailableError(without_window(reason));
    guard.reset();
    const ThemeKeeper theme;
    MainWindow window;
    if (arguments.until_shown) close_when_shown(window);
    window.start(choice.data, choice.parameters);
    window.show();
    exit_code = QApplication::exec();
  }
  return end_process(exit_code);
}

}  // namespace atomesh::gui
