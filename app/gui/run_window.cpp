#include "app/gui/run_window.h"

#include <QApplication>
#include <QSurfaceFormat>

#include "app/gui/main_window.h"
#include "app/gui/theme.h"

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
  set_surface_format();
  int count = 1;
  char name[] = "atomesh";
  char* words[] = {name, nullptr};
  QApplication application(count, words);
  QApplication::setApplicationName("atomesh");
  QApplication::setOrganizationName("atomesh");
  QApplication::setDesktopFileName("atomesh");
  ThemeKeeper theme;
  MainWindow window;
  if (arguments.files.empty()) window.show_loader();
  window.show();
  for (const std::string& file : arguments.files) {
    const QString path = QString::fromStdString(file);
    if (path.endsWith(".crf", Qt::CaseInsensitive)) {
      window.load_parameters(path);
    } else {
      window.open(path);
    }
  }
  return QApplication::exec();
}

}  // namespace atomesh::gui
