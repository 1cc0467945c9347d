#include "app/gui/run_window.h"

#include <QApplication>
#include <QIcon>
#include <QSurfaceFormat>
#include <cstdlib>
#include <optional>

#include "app/gui/file_summary.h"
#include "app/gui/main_window.h"
#include "app/gui/startup.h"
#include "app/gui/theme.h"
#include "core/error.h"

namespace atomesh::gui {

void set_surface_format() {
  QSurfaceFormat format;
  format.setVersion(3, 2);
  format.setProfile(QSurfaceFormat::CoreProfile);
  format.setAlphaBufferSize(8);
  format.setDepthBufferSize(24);
  QSurfaceFormat::setDefaultFormat(format);
}

int run_window(const WindowArguments& arguments) {
  QStringList files;
  for (const std::string& file : arguments.files) files << QString::fromStdString(file);
  if (!arguments.parameters.empty()) files << QString::fromStdString(arguments.parameters);
  const FileChoice choice = choose_files(files);
  if (!choice.problem.isEmpty()) throw UsageError(choice.problem.toStdString());
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
    window.start(choice.data, choice.parameters);
    window.show();
    exit_code = QApplication::exec();
  }
  return end_process(exit_code);
}

}  // namespace atomesh::gui
