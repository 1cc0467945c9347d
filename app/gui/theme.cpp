#include "app/gui/theme.h"

#include <QApplication>
#include <QDBusConnection>
#include <QDBusMessage>
#include <QDBusPendingCallWatcher>
#include <QDBusPendingReply>
#include <QDBusVariant>
#include <QFileInfo>
#include <QPainter>
#include <QPointer>
#include <QProxyStyle>
#include <QSettings>
#include <QStyleFactory>
#include <QStyleOption>

namespace atomesh::gui {

namespace {

constexpr const char* setting = "window/theme";
constexpr const char* service = "org.freedesktop.portal.Desktop";
constexpr const char* object = "/org/freedesktop/portal/desktop";
constexpr const char* interface = "org.freedesktop.portal.Settings";
constexpr const char* space = "org.freedesktop.appearance";
constexpr const char* scheme_key = "color-scheme";

QPointer<ThemeKeeper>& keeper() {
  static QPointer<ThemeKeeper> only;
  return only;
}

// libdbus would start a bus of its own where there is none.
bool has_session_bus() {
  if (qEnvironmentVariableIsSet("DBUS_SESSION_BUS_ADDRESS")) return true;
  const QString folder = qEnvironmentVariable("XDG_RUNTIME_DIR");
  return !folder.isEmpty() && QFileInfo::exists(folder + QStringLiteral("/bus"));
}

// As the platform's own palette said, before it was replaced by one of ours.
bool platform_is_dark() {
  static const bool dark = is_dark(QApplication::palette());
  return dark;
}

// Fusion draws the frames of check boxes darker than the window, where on a dark one nobody sees them; and its icons of
// "Close" and "OK" are for light ones.
class Style : public QProxyStyle {
 public:
  Style() : QProxyStyle(QStyleFactory::create(QStringLiteral("Fusion"))) {}

  int styleHint(StyleHint hint, const QStyleOption* option, const QWidget* widget,
                QStyleHintReturn* more) const override {
    if (hint == SH_DialogButtonBox_ButtonsHaveIcons) return 0;
    return QProxyStyle::styleHint(hint, option, widget, more);
  }

  void drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter,
                     const QWidget* widget) const override {
    QProxyStyle::drawPrimitive(element, option, painter, widget);
    if (element != PE_IndicatorCheckBox || !is_dark(option->palette)) return;
    painter->save();
    painter->setPen(option->palette.color(QPalette::Mid));
    painter->setBrush(Qt::NoBrush);
    painter->drawRect(option->rect.adjusted(0, 0, -1, -1));
    painter->restore();
  }
};

struct Colors {
  const char* window;
  const char* base;
  const char* alternate;
  const char* text;
  const char* faint;  // what cannot be used now
  const char* button;
  const char* light;
  const char* mid;
  const char* dark;
  const char* highlight;
  const char* link;
};

QPalette palette_of(const Colors& colors) {
  QPalette palette;
  const auto set = [&](QPalette::ColorRole role, const char* color) { palette.setColor(role, QColor(color)); };
  set(QPalette::Window, colors.window);
  set(QPalette::WindowText, colors.text);
  set(QPalette::Base, colors.base);
  set(QPalette::AlternateBase, colors.alternate);
  set(QPalette::Text, colors.text);
  set(QPalette::Button, colors.button);
  set(QPalette::ButtonText, colors.text);
  set(QPalette::BrightText, "#ff4040");
  set(QPalette::ToolTipBase, colors.alternate);
  set(QPalette::ToolTipText, colors.text);
  set(QPalette::PlaceholderText, colors.faint);
  set(QPalette::Light, colors.light);
  set(QPalette::Midlight, colors.alternate);
  set(QPalette::Mid, colors.mid);
  set(QPalette::Dark, colors.dark);
  set(QPalette::Shadow, "#000000");
  set(QPalette::Highlight, colors.highlight);
  set(QPalette::HighlightedText, "#ffffff");
  set(QPalette::Link, colors.link);
  set(QPalette::LinkVisited, colors.link);
  for (const QPalette::ColorRole role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText}) {
    palette.setColor(QPalette::Disabled, role, QColor(colors.faint));
  }
  palette.setColor(QPalette::Disabled, QPalette::Highlight, QColor(colors.mid));
  return palette;
}

}  // namespace

Theme chosen_theme() {
  const QString name = QSettings().value(setting).toString();
  return name == QLatin1String("light") ? Theme::light : name == QLatin1String("dark") ? Theme::dark : Theme::system;
}

QPalette light_palette() {
  return palette_of({"#f3f3f3", "#ffffff", "#e9e9e9", "#1b1b1b", "#757575", "#ebebeb", "#ffffff", "#b0b0b0", "#8c8c8c",
                     "#1a62b5", "#0b57b0"});
}

QPalette dark_palette() {
  return palette_of({"#2b2d30", "#1e1f22", "#36393d", "#e4e6e8", "#94989d", "#393c40", "#4d5156", "#5d6166", "#18191b",
                     "#2f6fc0", "#7db4ff"});
}

bool is_dark(const QPalette& palette) {
  return palette.color(QPalette::Window).lightness() < palette.color(QPalette::WindowText).lightness();
}

QColor error_color(const QPalette& palette) {
  return is_dark(palette) ? QColor("#ff9c94") : QColor("#a80f1a");
}

ThemeKeeper::ThemeKeeper(QObject* parent) : QObject(parent), theme_(chosen_theme()), system_dark_(platform_is_dark()) {
  keeper() = this;
  QApplication::setStyle(new Style);
  apply();
  ask_portal();
}

ThemeKeeper* ThemeKeeper::instance() {
  return keeper();
}

void ThemeKeeper::ask_portal() {
  if (!has_session_bus()) return;
  QDBusConnection bus = QDBusConnection::sessionBus();
  if (!bus.isConnected()) return;
  // QtDBus matches the types of the signal with the slot's only once it has dealt with some; a whole message it takes
  // as it is.
  bus.connect(service, object, interface, QStringLiteral("SettingChanged"), this,
              SLOT(portal_setting_changed(QDBusMessage)));
  QDBusMessage question = QDBusMessage::createMethodCall(service, object, interface, QStringLiteral("Read"));
  question << QString::fromLatin1(space) << QString::fromLatin1(scheme_key);
  auto* watcher = new QDBusPendingCallWatcher(bus.asyncCall(question), this);
  connect(watcher, &QDBusPendingCallWatcher::finished, this, [this](QDBusPendingCallWatcher* call) {
    const QDBusPendingReply<QDBusVariant> reply = *call;
    call->deleteLater();
    if (reply.isError()) return;
    // The answer is a variant in a variant.
    QVariant value = reply.value().variant();
    if (value.canConvert<QDBusVariant>()) value = value.value<QDBusVariant>().variant();
    heard(value.toUInt());
  });
}

void ThemeKeeper::portal_setting_changed(const QDBusMessage& message) {
  const QVariantList arguments = message.arguments();
  if (arguments.size() < 3 || arguments[0].toString() != QLatin1String(space)) return;
  if (arguments[1].toString() != QLatin1String(scheme_key)) return;
  heard(arguments[2].value<QDBusVariant>().variant().toUInt());
}

void ThemeKeeper::heard(uint scheme) {
  if (scheme != 1 && scheme != 2) return;  // no preference: what the platform's palette said
  const bool dark_now = scheme == 1;
  if (dark_now == system_dark_) return;
  system_dark_ = dark_now;
  if (theme_ == Theme::system) apply();
}

bool ThemeKeeper::dark() const {
  return theme_ == Theme::dark || (theme_ == Theme::system && system_dark_);
}

void ThemeKeeper::choose(Theme theme) {
  theme_ = theme;
  QSettings().setValue(setting, theme == Theme::light ? "light" : theme == Theme::dark ? "dark" : "system");
  apply();
}

void ThemeKeeper::apply() {
  QApplication::setPalette(dark() ? dark_palette() : light_palette());
  emit changed();
}

}  // namespace atomesh::gui
