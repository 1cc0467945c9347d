// Light and dark: palettes for the whole program, following the system or as chosen.
#pragma once

#include <QColor>
#include <QDBusMessage>
#include <QObject>
#include <QPalette>

namespace atomesh::gui {

enum class Theme { system, light, dark };

// As kept with the program's settings; Theme::system until chosen.
Theme chosen_theme();

QPalette light_palette();
QPalette dark_palette();
bool is_dark(const QPalette& palette);
// For messages of errors, to be read on the palette's window color.
QColor error_color(const QPalette& palette);

// Style and palette of the application. Made once, after QApplication; follows the desktop's preference
// (org.freedesktop.appearance, where there is a session bus; else the palette that the platform brought) while the
// theme is Theme::system.
class ThemeKeeper : public QObject {
  Q_OBJECT

 public:
  explicit ThemeKeeper(QObject* parent = nullptr);

  Theme theme() const { return theme_; }
  // Keeps it with the settings.
  void choose(Theme theme);
  bool dark() const;
  static ThemeKeeper* instance();  // nullptr before it is made

 signals:
  void changed();

 private slots:
  void portal_setting_changed(const QDBusMessage& message);

 private:
  void ask_portal();
  void heard(uint scheme);
  void apply();

  Theme theme_;
  bool system_dark_;
};

}  // namespace atomesh::gui
