// Light and dark: readable, and as the desktop wants it.
#include <gtest/gtest.h>

#include <QApplication>
#include <QDBusConnection>
#include <QDBusMessage>
#include <QDBusVariant>
#include <QProcess>
#include <QSignalSpy>
#include <QStandardPaths>
#include <cmath>

#include "app/gui/theme.h"
#include "tests/app/gui/window_test.h"

namespace atomesh::gui {
namespace {

TEST(Themes, AreReadable) {
  const auto luminance = [](const QColor& color) {
    const auto linear = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
    return 0.2126 * linear(color.redF()) + 0.7152 * linear(color.greenF()) + 0.0722 * linear(color.blueF());
  };
  const auto contrast = [&](const QColor& a, const QColor& b) {
    const double la = luminance(a) + 0.05;
    const double lb = luminance(b) + 0.05;
    return std::max(la, lb) / std::min(la, lb);
  };
  for (const QPalette& palette : {light_palette(), dark_palette()}) {
    // WCAG: 7 is AAA, 4.5 AA, 3 for what cannot be used now.
    EXPECT_GT(contrast(palette.color(QPalette::WindowText), palette.color(QPalette::Window)), 7.0);
    EXPECT_GT(contrast(palette.color(QPalette::Text), palette.color(QPalette::Base)), 7.0);
    EXPECT_GT(contrast(palette.color(QPalette::ButtonText), palette.color(QPalette::Button)), 7.0);
    EXPECT_GT(contrast(palette.color(QPalette::ToolTipText), palette.color(QPalette::ToolTipBase)), 7.0);
    EXPECT_GT(contrast(palette.color(QPalette::HighlightedText), palette.color(QPalette::Highlight)), 4.5);
    EXPECT_GT(contrast(palette.color(QPalette::Link), palette.color(QPalette::Base)), 4.5);
    EXPECT_GT(contrast(error_color(palette), palette.color(QPalette::Window)), 4.5);
    EXPECT_GT(contrast(palette.color(QPalette::Disabled, QPalette::WindowText), palette.color(QPalette::Window)), 3.0);
  }
  EXPECT_FALSE(is_dark(light_palette()));
  EXPECT_TRUE(is_dark(dark_palette()));
}

TEST(Themes, AChoiceIsKept) {
  {
    ThemeKeeper keeper;
    EXPECT_EQ(keeper.theme(), Theme::system);
    keeper.choose(Theme::dark);
    EXPECT_TRUE(is_dark(QApplication::palette()));
  }
  ThemeKeeper keeper;
  EXPECT_EQ(keeper.theme(), Theme::dark);
  EXPECT_TRUE(is_dark(QApplication::palette()));
  keeper.choose(Theme::light);
  EXPECT_FALSE(is_dark(QApplication::palette()));
  keeper.choose(Theme::system);
  EXPECT_EQ(chosen_theme(), Theme::system);
}

// The part of a desktop's portal that says which colors it has.
class Portal : public QObject {
  Q_OBJECT
  Q_CLASSINFO("D-Bus Interface", "org.freedesktop.portal.Settings")

 public:
  uint scheme = 1;

 public slots:  // NOLINT: the name is D-Bus's
  QDBusVariant Read(const QString& space, const QString& key) {
    if (space != "org.freedesktop.appearance" || key != "color-scheme") return QDBusVariant(QString());
    return QDBusVariant(QVariant::fromValue(QDBusVariant(scheme)));
  }
};

TEST(Themes, FollowTheDesktop) {
  const QString program = QStandardPaths::findExecutable("dbus-daemon");
  if (program.isEmpty()) GTEST_SKIP() << "no dbus-daemon here: whether the desktop is followed was not tried";
  QProcess daemon;
  daemon.start(program, {"--session", "--nofork", "--print-address"});
  ASSERT_TRUE(daemon.waitForStarted());
  ASSERT_TRUE(test::wait_for([&] { return daemon.canReadLine(); }));
  const QString address = QString::fromUtf8(daemon.readLine()).trimmed();
  qputenv("DBUS_SESSION_BUS_ADDRESS", address.toUtf8());
  QDBusConnection desktop = QDBusConnection::connectToBus(address, "desktop");
  ASSERT_TRUE(desktop.isConnected());
  Portal portal;
  ASSERT_TRUE(desktop.registerObject("/org/freedesktop/portal/desktop", &portal, QDBusConnection::ExportAllSlots));
  ASSERT_TRUE(desktop.registerService("org.freedesktop.portal.Desktop"));

  const auto change = [&](const char* key, uint value) {
    QDBusMessage signal = QDBusMessage::createSignal("/org/freedesktop/portal/desktop",
                                                     "org.freedesktop.portal.Settings", "SettingChanged");
    signal << QString("org.freedesktop.appearance") << QString(key) << QVariant::fromValue(QDBusVariant(value));
    EXPECT_TRUE(desktop.send(signal));
  };
  ThemeKeeper keeper;
  EXPECT_TRUE(test::wait_for([&] { return keeper.dark(); }, 10000));
  EXPECT_TRUE(is_dark(QApplication::palette()));
  change("color-scheme", 2);
  EXPECT_TRUE(test::wait_for([&] { return !keeper.dark(); }, 10000));
  EXPECT_FALSE(is_dark(QApplication::palette()));
  // What was chosen stands over it.
  keeper.choose(Theme::light);
  QSignalSpy changed(&keeper, &ThemeKeeper::changed);
  change("color-scheme", 1);
  change("accent-color", 3);
  keeper.choose(Theme::system);
  EXPECT_TRUE(test::wait_for([&] { return keeper.dark(); }, 10000));

  desktop.unregisterObject("/org/freedesktop/portal/desktop");
  QDBusConnection::disconnectFromBus("desktop");
  daemon.kill();
  daemon.waitForFinished();
}

}  // namespace
}  // namespace atomesh::gui

#include "test_theme.moc"
